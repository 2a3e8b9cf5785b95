#include "scene/obstacle_reader.hpp"

#include "scene/obj_file.hpp"
#include "scene/surface_reader.hpp"

#include <array>
#include <string_view>

namespace carom::scene {

namespace {

constexpr std::array<std::string_view, 5> kinds{"cylinder", "cone", "frustum", "disc", "mesh"};

/// A direction, of any length but zero, where it starts, and how fast the frustum turns round it.
Frustum read_axis(TableReader& table) {
    Frustum frustum;
    table.read("base", frustum.base, coordinate_range);
    if (const auto axis = table.find("axis")) frustum.axis = axis->direction();
    table.read("angular_velocity", frustum.angular_velocity, rate_range);
    return frustum;
}

Frustum read_cylinder(TableReader& table) {
    Frustum frustum = read_axis(table);
    frustum.height = table.need("height").number(length_range);
    frustum.base_radius = frustum.top_radius = table.need("radius").number(length_range);
    return frustum;
}

/// Its tip is at the base.
Frustum read_cone(TableReader& table) {
    Frustum frustum = read_axis(table);
    frustum.height = table.need("height").number(length_range);
    frustum.base_radius = 0;
    frustum.top_radius = table.need("radius").number(length_range);
    return frustum;
}

Frustum read_frustum(TableReader& table) {
    Frustum frustum = read_axis(table);
    frustum.height = table.need("height").number(radius_range);
    frustum.base_radius = table.need("base_radius").number(radius_range);
    const ValueReader top = table.need("top_radius");
    frustum.top_radius = top.number(radius_range);
    if (frustum.height == 0 && frustum.base_radius == frustum.top_radius) {
        top.fail("must differ from base_radius where the height is 0");
    }
    if (frustum.base_radius == 0 && frustum.top_radius == 0) top.fail("must be > 0 where base_radius is 0");
    return frustum;
}

Frustum read_disc(TableReader& table) {
    Frustum frustum = read_axis(table);
    frustum.height = 0;
    const ValueReader radius = table.need("radius");
    frustum.top_radius = radius.number(length_range);
    frustum.base_radius = 0;
    table.read("hole_radius", frustum.base_radius, radius_range);
    if (!(frustum.base_radius < frustum.top_radius)) radius.fail("must be greater than hole_radius");
    return frustum;
}

Mesh read_mesh(TableReader& table, const std::filesystem::path& folder) {
    Mesh mesh = read_obj(folder / table.need("file").text());
    double scale = 1;
    table.read("scale", scale, length_range);
    Vec3 offset{};
    table.read("offset", offset, coordinate_range);
    for (Vec3& vertex : mesh.vertices) vertex = vertex * scale + offset;
    return mesh;
}

} // namespace

Obstacle read_obstacle(TableReader& table, const std::filesystem::path& folder) {
    Obstacle obstacle;
    switch (table.need("kind").choice(kinds)) {
    case 0:
        obstacle = read_cylinder(table);
        break;
    case 1:
        obstacle = read_cone(table);
        break;
    case 2:
        obstacle = read_frustum(table);
        break;
    case 3:
        obstacle = read_disc(table);
        break;
    default:
        obstacle = read_mesh(table, folder);
        break;
    }
    const Surface surface = read_surface(table);
    std::visit([&surface](auto& shape) { shape.surface = surface; }, obstacle);
    table.finish();
    return obstacle;
}

} // namespace carom::scene
