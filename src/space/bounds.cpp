#include "space/bounds.hpp"

#include "space/checks.hpp"

#include <carom/collision.hpp>

#include <algorithm>

namespace carom::core {

namespace {

void check_surface(const Surface& surface, const std::string& where, std::size_t index) {
    if (surface.restitution) check_fraction(*surface.restitution, where + ".restitution", index);
    if (surface.friction) check_not_negative(*surface.friction, where + ".friction", index);
}

bool is_periodic(const Box& box, std::size_t axis) {
    for (const std::size_t face : {2 * axis, 2 * axis + 1}) {
        if (box.faces[face].kind <= FaceKind::periodic) continue;
        throw Error(ErrorCode::out_of_range, "region.faces", "must be reflecting, open or periodic", face);
    }
    const bool low = box.faces[2 * axis].kind == FaceKind::periodic;
    const bool high = box.faces[2 * axis + 1].kind == FaceKind::periodic;
    if (low != high) {
        throw Error(ErrorCode::out_of_range, "region.faces", "periodic faces come in opposite pairs",
                    low ? 2 * axis + 1 : 2 * axis);
    }
    return low;
}

std::int64_t checked_period(std::int64_t low, std::int64_t high) {
    constexpr std::int64_t longest = std::int64_t{1} << 62;
    std::int64_t length = 0;
    if (__builtin_sub_overflow(high, low, &length) || length > longest) {
        throw Error(ErrorCode::out_of_range, "region.max", "a periodic side must be shorter than half the world");
    }
    return length;
}

Vec3 axis_vector(std::size_t axis, double length) {
    return {axis == 0 ? length : 0, axis == 1 ? length : 0, axis == 2 ? length : 0};
}

/// How many faces a region has in the public API.
std::int32_t faces_of(const Region& region) {
    if (const auto* box = std::get_if<Box>(&region)) return static_cast<std::int32_t>(box->faces.size());
    if (const auto* planes = std::get_if<std::vector<Plane>>(&region)) return static_cast<std::int32_t>(planes->size());
    return std::holds_alternative<Shell>(region) ? 1 : 0;
}

/// -1 unless the unit vector lies along an axis.
int axis_of(const Vec3& unit) {
    if (unit.y == 0 && unit.z == 0) return 0;
    if (unit.x == 0 && unit.z == 0) return 1;
    if (unit.x == 0 && unit.y == 0) return 2;
    return -1;
}

} // namespace

Bounds::Bounds(const Region& region, const std::vector<Obstacle>& obstacles, const Resolution& resolution,
               const Int3& origin) {
    if (const auto* box = std::get_if<Box>(&region)) add_box(*box, resolution, origin);
    if (const auto* planes = std::get_if<std::vector<Plane>>(&region)) add_planes(*planes, resolution, origin);
    if (const auto* shell = std::get_if<Shell>(&region)) add_shell(*shell, resolution, origin);
    if (obstacles.empty()) return;
    if (any_periodic()) {
        throw Error(ErrorCode::out_of_range, "obstacles", "must not stand in a region with periodic faces");
    }
    obstacles_ = std::make_shared<const Obstacles>(obstacles, resolution, origin);
    first_obstacle_ = faces_of(region);
}

void Bounds::add_box(const Box& box, const Resolution& resolution, const Int3& origin) {
    const Int3 low = position_units(box.min, resolution, origin, "region.min");
    const Int3 high = position_units(box.max, resolution, origin, "region.max");
    for (int axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<std::size_t>(axis);
        if (component(high, axis) <= component(low, axis)) {
            throw Error(ErrorCode::out_of_range, "region.max", "must be greater than region.min in every component");
        }
        check_surface(box.faces[2 * k].surface, "region.faces", 2 * k);
        check_surface(box.faces[2 * k + 1].surface, "region.faces", 2 * k + 1);
        if (is_periodic(box, k)) {
            period_[k] = checked_period(component(low, axis), component(high, axis));
            component(period_start_, axis) = component(low, axis);
            continue;
        }
        for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
            const Face& face = box.faces[2 * k + side];
            if (face.kind != FaceKind::reflecting) continue;
            add_wall({side == 0 ? low : high, axis_vector(k, side == 0 ? -1 : 1), axis, face.surface,
                      static_cast<std::int32_t>(2 * k + side)});
        }
    }
}

void Bounds::add_planes(const std::vector<Plane>& planes, const Resolution& resolution, const Int3& origin) {
    constexpr std::size_t most = 64;
    if (planes.size() > most) throw Error(ErrorCode::out_of_range, "region.planes", "at most 64 planes");
    for (std::size_t i = 0; i < planes.size(); ++i) {
        const Plane& plane = planes[i];
        check_finite(plane.normal, "region.normal", i);
        if (plane.normal == Vec3{}) throw Error(ErrorCode::out_of_range, "region.normal", "must not be zero", i);
        check_surface(plane.surface, "region.surface", i);
        const Vec3 normal = contact_normal(-plane.normal, Vec3{});
        add_wall({position_units(plane.point, resolution, origin, "region.point", i), normal, axis_of(normal),
                  plane.surface, static_cast<std::int32_t>(i)});
    }
}

void Bounds::add_shell(const Shell& shell, const Resolution& resolution, const Int3& origin) {
    check_positive(shell.radius, "region.radius");
    const double half_size = static_cast<double>(world_edge) * resolution.metres;
    if (!(shell.radius < half_size)) {
        throw Error(ErrorCode::out_of_range, "region.radius",
                    "must be less than the " + shown(half_size) + " m of the world, got " + shown(shell.radius));
    }
    check_surface(shell.surface, "region.surface", Error::no_index);
    shape_ = Shape::shell;
    shell_radius_ = shell.radius;
    add_wall({position_units(shell.centre, resolution, origin, "region.centre"), {}, -1, shell.surface, 0});
}

void Bounds::add_wall(const Wall& wall) {
    walls_.push_back(wall);
    if (wall.axis < 0) {
        only_axis_walls_ = false;
        return;
    }
    const std::int64_t at = component(wall.point, wall.axis);
    if (component(wall.normal, wall.axis) > 0) {
        component(high_, wall.axis) = std::min(component(high_, wall.axis), at);
    } else {
        component(low_, wall.axis) = std::max(component(low_, wall.axis), at);
    }
}

Int3 Bounds::wrapped(Int3 x) const {
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t length = period(axis);
        if (length == 0) continue;
        std::int64_t offset = 0;
        if (__builtin_sub_overflow(component(x, axis), period_start(axis), &offset)) {
            offset = component(x, axis) % length - period_start(axis) % length;
        }
        offset %= length;
        if (offset < 0) offset += length;
        component(x, axis) = period_start(axis) + offset;
    }
    return x;
}

Touch Bounds::impact(std::uint32_t wall, const Int3& x, const Vec3& d, double radius,
                     const Resolution& resolution) const {
    if (is_facet(wall)) return obstacles_->impact(wall - first_facet(), x, d, radius);
    return {gap(walls_[wall], x, d, radius, resolution), normal(walls_[wall], x, d, resolution)};
}

Vec3 Bounds::normal(const Wall& wall, const Int3& x, const Vec3& d, const Resolution& resolution) const {
    if (shape_ == Shape::flat) return wall.normal;
    return contact_normal(from_centre(wall, x, d, resolution), Vec3{});
}

} // namespace carom::core
