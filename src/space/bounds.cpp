#include "space/bounds.hpp"

#include "collision/portable_math.hpp"
#include "space/checks.hpp"

#include <carom/collision.hpp>

#include <algorithm>

namespace carom::core {

namespace {

void check_surface(const Surface& surface, const std::string& where, std::size_t index) {
    if (surface.restitution) check_fraction(*surface.restitution, where + ".restitution", index);
    if (surface.friction) check_not_negative(*surface.friction, where + ".friction", index);
}

/// A face that is not there cannot move.
void check_still(const Face& face, std::size_t index) {
    if (face.motion == FaceMotion{}) return;
    throw Error(ErrorCode::out_of_range, "region.motion", "only a reflecting face can move", index);
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
    first_obstacle_ = faces_of(region);
    if (obstacles.empty()) return;
    if (any_periodic()) {
        throw Error(ErrorCode::out_of_range, "obstacles", "must not stand in a region with periodic faces");
    }
    obstacles_ = std::make_shared<const Obstacles>(obstacles, resolution, origin);
}

void Bounds::add_box(const Box& box, const Resolution& resolution, const Int3& origin) {
    is_box_ = true;
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
            check_still(box.faces[2 * k], 2 * k);
            check_still(box.faces[2 * k + 1], 2 * k + 1);
            continue;
        }
        for (const std::size_t side : {std::size_t{0}, std::size_t{1}}) {
            const Face& face = box.faces[2 * k + side];
            if (face.kind != FaceKind::reflecting) {
                check_still(face, 2 * k + side);
                continue;
            }
            add_wall({.point = side == 0 ? low : high,
                      .normal = axis_vector(k, side == 0 ? -1 : 1),
                      .axis = axis,
                      .surface = face.surface,
                      .face = static_cast<std::int32_t>(2 * k + side)},
                     face.motion);
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
        add_wall({.point = position_units(plane.point, resolution, origin, "region.point", i),
                  .normal = normal,
                  .axis = axis_of(normal),
                  .surface = plane.surface,
                  .face = static_cast<std::int32_t>(i)},
                 plane.motion);
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
    add_wall({.point = position_units(shell.centre, resolution, origin, "region.centre"), .surface = shell.surface},
             {});
}

void Bounds::add_wall(Wall wall, const FaceMotion& motion) {
    walls_.push_back(wall);
    only_axis_walls_ = only_axis_walls_ && wall.axis >= 0;
    set_motion(walls_.size() - 1, motion, "region.motion");
}

void Bounds::set_motion(std::size_t wall, const FaceMotion& motion, const std::string& where) {
    Wall& w = walls_[wall];
    const auto face = static_cast<std::size_t>(w.face);
    check_finite(motion.velocity, where + ".velocity", face);
    check_not_negative(motion.amplitude, where + ".amplitude", face);
    check_not_negative(motion.angular_frequency, where + ".angular_frequency", face);
    check_finite(motion.phase, where + ".phase", face);
    check_finite(motion.surface_velocity, where + ".surface_velocity", face);
    constexpr double along = 1e-6;
    const double out_of_face = dot(motion.surface_velocity, w.normal);
    if (std::abs(out_of_face) > along * length(motion.surface_velocity)) {
        throw Error(ErrorCode::out_of_range, where + ".surface_velocity", "must lie along the face", face);
    }
    w.motion = motion;
    w.motion.surface_velocity -= w.normal * out_of_face;
    w.is_driven =
        motion.velocity != 0 || motion.amplitude * motion.angular_frequency != 0 || motion.surface_velocity != Vec3{};
    w.phase = {motion.phase};
    w.travelled = {w.offset - motion.amplitude * detail::sin(motion.phase)};
    w.offset = rest_offset(w);
    any_driven_ = std::any_of(walls_.begin(), walls_.end(), [](const Wall& other) { return other.is_driven; });
}

double Bounds::rest_offset(const Wall& wall) {
    return wall.travelled.value() + wall.motion.amplitude * detail::sin(wall.phase.value());
}

double Bounds::driven_offset(const Wall& wall, double time) {
    const FaceMotion& motion = wall.motion;
    const double way = wall.offset + motion.velocity * time;
    if (motion.amplitude == 0) return way;
    const double phase = wall.phase.value();
    return way + motion.amplitude * (detail::sin(phase + motion.angular_frequency * time) - detail::sin(phase));
}

Vec3 Bounds::driven_velocity(const Wall& wall, const Int3& /*x*/, const Vec3& /*d*/, double time) {
    const FaceMotion& motion = wall.motion;
    double speed = motion.velocity;
    if (motion.amplitude != 0) {
        speed += motion.amplitude * motion.angular_frequency *
                 detail::cos(wall.phase.value() + motion.angular_frequency * time);
    }
    return motion.surface_velocity - wall.normal * speed;
}

Vec3 Bounds::acceleration(const Wall& wall, double time) {
    const FaceMotion& motion = wall.motion;
    if (!wall.is_driven || motion.amplitude == 0) return {};
    const double most = motion.amplitude * motion.angular_frequency * motion.angular_frequency;
    return wall.normal * (most * detail::sin(wall.phase.value() + motion.angular_frequency * time));
}

double Bounds::farthest_way(double duration) const {
    double farthest = 0;
    for (const Wall& wall : walls_) {
        const FaceMotion& motion = wall.motion;
        const double swing = motion.amplitude * std::min(2.0, motion.angular_frequency * duration);
        farthest = std::max(farthest, std::max(0.0, motion.velocity * duration) + swing);
    }
    return farthest;
}

void Bounds::check_motion(double duration, const Resolution& resolution) const {
    if (!any_driven_) return;
    const auto innermost = [duration](const Wall& wall) {
        return wall.travelled.value() + std::max(0.0, wall.motion.velocity * duration) + wall.motion.amplitude;
    };
    const double half_size = static_cast<double>(world_edge) * resolution.metres;
    for (const Wall& wall : walls_) {
        const auto face = static_cast<std::size_t>(wall.face);
        const double away = std::abs(wall.offset) + std::abs(wall.motion.velocity) * duration + wall.motion.amplitude;
        if (!(away + length(to_metres(wall.point, resolution)) < half_size)) {
            throw Error(ErrorCode::out_of_world, "motion", "would take the face out of the world in this step", face);
        }
        for (const Wall& other : walls_) {
            // Only the faces of a box are known to be opposite.
            if (!wall.is_driven || &other == &wall || (wall.face ^ other.face) != 1 || !is_box_) continue;
            const double apart = std::abs(
                metres_between(component(wall.point, wall.axis), component(other.point, wall.axis), resolution));
            if (innermost(wall) + innermost(other) < apart) continue;
            throw Error(ErrorCode::out_of_range, "motion",
                        "would take the face as far as the opposite one in this step", face);
        }
    }
}

void Bounds::begin_step(double duration, const Resolution& resolution) {
    low_ = {lowest, lowest, lowest};
    high_ = {highest, highest, highest};
    for (const Wall& wall : walls_) {
        const FaceMotion& motion = wall.motion;
        const double swing = motion.amplitude * std::min(2.0, motion.angular_frequency * duration);
        if (wall.axis >= 0) narrow(wall, wall.offset + std::max(0.0, motion.velocity * duration) + swing, resolution);
    }
}

/// Bodies may be where a wall of an axis, moved on by `way` (m), leaves them room.
void Bounds::narrow(const Wall& wall, double way, const Resolution& resolution) {
    const auto units = static_cast<std::int64_t>(std::ceil(way * resolution.per_metre));
    const std::int64_t at = component(wall.point, wall.axis);
    if (component(wall.normal, wall.axis) > 0) {
        component(high_, wall.axis) = std::min(component(high_, wall.axis), Int3::wrapped_difference(at, units));
    } else {
        component(low_, wall.axis) = std::max(component(low_, wall.axis), Int3::wrapped_sum(at, units));
    }
}

void Bounds::end_step(double reached) {
    for (Wall& wall : walls_) {
        if (!wall.is_driven) continue;
        wall.travelled.add(wall.motion.velocity * reached);
        wall.phase.add(wall.motion.angular_frequency * reached);
        wall.offset = rest_offset(wall);
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

Touch Bounds::impact(std::uint32_t wall, const Int3& x, const Vec3& d, double radius, double time,
                     const Resolution& resolution) const {
    if (is_facet(wall)) return obstacles_->impact(wall - first_facet(), x, d, radius);
    return {gap(walls_[wall], x, d, radius, time, resolution), normal(walls_[wall], x, d, resolution)};
}

Vec3 Bounds::normal(const Wall& wall, const Int3& x, const Vec3& d, const Resolution& resolution) const {
    if (shape_ == Shape::flat) return wall.normal;
    return contact_normal(from_centre(wall, x, d, resolution), Vec3{});
}

} // namespace carom::core
