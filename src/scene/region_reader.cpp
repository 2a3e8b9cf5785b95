#include "scene/region_reader.hpp"

#include "scene/surface_reader.hpp"

#include <fmt/format.h>

#include <array>

namespace carom::scene {

namespace {

constexpr std::array<std::string_view, 6> face_names{"x_min", "x_max", "y_min", "y_max", "z_min", "z_max"};
constexpr std::array<std::string_view, 3> axis_names{"x", "y", "z"};

FaceMotion read_motion(TableReader table) {
    FaceMotion motion;
    table.read("velocity", motion.velocity, speed_range);
    table.read("amplitude", motion.amplitude, radius_range);
    table.read("angular_frequency", motion.angular_frequency, not_negative);
    table.read("phase", motion.phase, any_number);
    table.read("surface_velocity", motion.surface_velocity, speed_range);
    table.finish();
    return motion;
}

FaceKind read_face_kind(const ValueReader& value) {
    constexpr std::array<std::string_view, 3> names{"reflecting", "open", "periodic"};
    constexpr std::array<FaceKind, 3> kinds{FaceKind::reflecting, FaceKind::open, FaceKind::periodic};
    return kinds[value.choice(names)];
}

/// A face is the name of its kind, or a table.
void read_face(const ValueReader& value, Face& face) {
    if (value.is_text()) {
        face.kind = read_face_kind(value);
        return;
    }
    if (!value.is_table()) {
        value.fail(R"(must be "reflecting", "open", "periodic" or a table { kind, restitution, friction, motion })");
    }
    TableReader table = value.table();
    if (const auto kind = table.find("kind")) face.kind = read_face_kind(*kind);
    face.surface = read_surface(table, face.surface);
    if (const auto motion = table.find("motion")) {
        if (face.kind != FaceKind::reflecting) motion->fail("is for reflecting faces only");
        face.motion = read_motion(motion->table());
    }
    table.finish();
}

void read_faces(TableReader table, Box& box) {
    for (std::size_t axis = 0; axis < axis_names.size(); ++axis) {
        if (const auto both = table.find(axis_names[axis])) {
            read_face(*both, box.faces[2 * axis]);
            read_face(*both, box.faces[2 * axis + 1]);
        }
    }
    for (std::size_t i = 0; i < face_names.size(); ++i) {
        if (const auto one = table.find(face_names[i])) read_face(*one, box.faces[i]);
    }
    for (std::size_t axis = 0; axis < axis_names.size(); ++axis) {
        const bool low = box.faces[2 * axis].kind == FaceKind::periodic;
        const bool high = box.faces[2 * axis + 1].kind == FaceKind::periodic;
        if (low != high) {
            table.fail(face_names[2 * axis + (low ? 0 : 1)],
                       fmt::format("a periodic face needs a periodic one opposite; write {} = \"periodic\"",
                                   axis_names[axis]));
        }
    }
    table.finish();
}

Region read_box(TableReader& table) {
    Box box;
    box.min = table.need("min").vec3(coordinate_range);
    const ValueReader max = table.need("max");
    box.max = max.vec3(coordinate_range);
    if (!(box.max.x > box.min.x && box.max.y > box.min.y && box.max.z > box.min.z)) {
        max.fail("must be greater than min in every component");
    }
    const Surface surface = read_surface(table);
    for (Face& face : box.faces) face.surface = surface;
    if (const auto faces = table.find("faces")) read_faces(faces->table(), box);
    return box;
}

Region read_planes(TableReader& table) {
    constexpr std::size_t most = 64;
    std::vector<Plane> planes;
    for (TableReader& entry : table.tables("plane")) {
        Plane plane;
        entry.read("point", plane.point, coordinate_range);
        if (const auto normal = entry.find("normal")) plane.normal = normal->direction();
        plane.surface = read_surface(entry);
        if (const auto motion = entry.find("motion")) plane.motion = read_motion(motion->table());
        entry.finish();
        planes.push_back(plane);
    }
    if (planes.empty() || planes.size() > most) {
        table.fail("plane", fmt::format("must be 1 to {} tables [[region.plane]], got {}", most, planes.size()));
    }
    return planes;
}

Region read_shell(TableReader& table) {
    Shell shell;
    table.read("centre", shell.centre, coordinate_range);
    shell.radius = table.need("radius").number(length_range);
    shell.surface = read_surface(table);
    return shell;
}

} // namespace

Region read_region(TableReader table) {
    constexpr std::array<std::string_view, 4> kinds{"open", "box", "planes", "shell"};
    Region region;
    switch (table.need("kind").choice(kinds)) {
    case 1:
        region = read_box(table);
        break;
    case 2:
        region = read_planes(table);
        break;
    case 3:
        region = read_shell(table);
        break;
    default:
        break;
    }
    table.finish();
    return region;
}

} // namespace carom::scene
