#include "viewer/window/next_impact.hpp"

#include "viewer/stage/bounds.hpp"

#include <carom/time_of_impact.hpp>

#include <array>
#include <cstddef>
#include <limits>
#include <variant>
#include <vector>

namespace carom::viewer {

namespace {

/// m: the sides of a box between faces that are there; without them it goes on for ever.
struct Walls {
    Vec3 low;
    Vec3 high;
};

Walls walls_of(const Box& box) {
    constexpr double far = std::numeric_limits<double>::infinity();
    const auto bound = [&](std::size_t face, double place, double open) {
        return box.faces[face].kind == FaceKind::reflecting ? place : open;
    };
    return {{bound(0, box.min.x, -far), bound(2, box.min.y, -far), bound(4, box.min.z, -far)},
            {bound(1, box.max.x, far), bound(3, box.max.y, far), bound(5, box.max.z, far)}};
}

NextImpact next_face(const Region& region, const Body& body, const Vec3& gravity, double horizon) {
    NextImpact next{no_impact, {}, -1};
    if (const auto* box = std::get_if<Box>(&region)) {
        const Walls walls = walls_of(*box);
        const auto hit =
            time_to_box_inside(body.position, body.velocity, gravity, body.radius, walls.low, walls.high, horizon);
        next = {hit.time, {}, hit.face};
    } else if (const auto* shell = std::get_if<Shell>(&region)) {
        next = {time_to_shell_inside(body.position - shell->centre, body.velocity, gravity, shell->radius - body.radius,
                                     horizon),
                {},
                0};
    } else if (const auto* planes = std::get_if<std::vector<Plane>>(&region)) {
        for (std::size_t i = 0; i < planes->size(); ++i) {
            const Vec3 normal = (*planes)[i].normal / length((*planes)[i].normal);
            const double gap = dot(body.position - (*planes)[i].point, normal) - body.radius;
            const double time = time_to_plane(gap, dot(body.velocity, normal), dot(gravity, normal), horizon);
            if (time < next.in) next = {time, {}, static_cast<int>(i)};
        }
    }
    return next;
}

} // namespace

std::optional<NextImpact> next_impact(const World& world, BodyId id, double horizon) {
    const Body body = world.get(id);
    if (body.mass == infinite_mass || world.held(id)) return std::nullopt;
    const std::vector<BodyId> ids = world.ids();
    std::vector<Vec3> position(ids.size());
    std::vector<Vec3> velocity(ids.size());
    std::vector<double> radius(ids.size());
    std::vector<double> mass(ids.size());
    world.get(ids, {.position = position, .velocity = velocity, .mass = mass, .radius = radius});

    const Vec3& gravity = world.options().gravity;
    const Vec3 periods = periods_of(world.options().region);
    NextImpact next = next_face(world.options().region, body, gravity, horizon);
    for (std::size_t i = 0; i < ids.size(); ++i) {
        if (ids[i] == id) continue;
        const bool still = mass[i] == infinite_mass || world.held(ids[i]);
        const Vec3 way = shortest(position[i] - body.position, periods);
        const Vec3 relative_velocity = velocity[i] - body.velocity;
        const double contact = radius[i] + body.radius;
        const double time = still ? time_to_spheres(way, relative_velocity, -gravity, contact, horizon)
                                  : time_to_spheres(way, relative_velocity, contact, horizon);
        if (time < next.in) next = {time, ids[i], -1};
    }
    if (next.in == no_impact) return std::nullopt;
    return next;
}

} // namespace carom::viewer
