#include "viewer/window/next_impact.hpp"

#include "viewer/stage/bounds.hpp"

#include <carom/time_of_impact.hpp>

#include <algorithm>
#include <cstddef>
#include <variant>
#include <vector>

namespace carom::viewer {

namespace {

bool moves(const FaceMotion& motion) { return motion.velocity != 0 || motion.amplitude != 0; }

bool has_moving_faces(const Region& region) {
    if (const auto* box = std::get_if<Box>(&region)) {
        return std::any_of(box->faces.begin(), box->faces.end(), [](const Face& face) { return moves(face.motion); });
    }
    const auto* planes = std::get_if<std::vector<Plane>>(&region);
    return planes != nullptr &&
           std::any_of(planes->begin(), planes->end(), [](const Plane& plane) { return moves(plane.motion); });
}

/// The first impact with another body, before `soonest`.
NextImpact next_body(const World& world, BodyId id, const Body& body, NextImpact soonest) {
    const std::vector<BodyId> ids = world.ids();
    std::vector<Vec3> position(ids.size());
    std::vector<Vec3> velocity(ids.size());
    std::vector<double> radius(ids.size());
    std::vector<double> mass(ids.size());
    world.get(ids, {.position = position, .velocity = velocity, .mass = mass, .radius = radius});
    const Vec3 periods = periods_of(world.options().region);
    for (std::size_t i = 0; i < ids.size(); ++i) {
        if (ids[i] == id) continue;
        const bool falls = mass[i] != infinite_mass && !world.held(ids[i]);
        const Vec3 way = shortest(position[i] - body.position, periods);
        const Vec3 relative_velocity = velocity[i] - body.velocity;
        const double contact = radius[i] + body.radius;
        const double time =
            falls ? time_to_spheres(way, relative_velocity, contact, soonest.in)
                  : time_to_spheres(way, relative_velocity, -world.options().gravity, contact, soonest.in);
        if (time < soonest.in) soonest = {time, ids[i], -1};
    }
    return soonest;
}

} // namespace

/// A face that moves is somewhere else each time.
void LookAhead::empty_world_like(const World& world) {
    if (!alone_ || has_moving_faces(world.options().region)) {
        alone_ = world;
        alone_->remove(alone_->ids());
        alone_->set_drag({});
        alone_->set_attractors({});
        alone_->set_recording(true);
        alone_->set_work_cap(1);
        alone_->set_threads(1);
    }
    alone_->set_gravity(world.options().gravity);
}

std::optional<NextImpact> LookAhead::try_alone(const World& world, const Body& body, double horizon) {
    constexpr double longest = 1; // s, of a step: a body that comes to lie on something may not be met any more
    empty_world_like(world);
    const BodyId id = alone_->add(body, Overlap::accept);
    const double start = alone_->time();
    std::optional<NextImpact> found;
    try {
        while (!found && !alone_->held(id) && alone_->time() < start + horizon) {
            const double begin = alone_->time() - start;
            alone_->step(std::min(longest, horizon - begin));
            if (alone_->impacts().empty()) continue;
            const Impact& impact = alone_->impacts().front();
            found = NextImpact{begin + impact.offset, {}, impact.face};
        }
    } catch (const Error&) { // it leaves the world, or a face runs over another one: nothing is met before
        alone_.reset();
        return std::nullopt;
    }
    alone_->remove(id);
    return found;
}

std::optional<NextImpact> LookAhead::next_impact(const World& world, BodyId id, double horizon) {
    const Body body = world.get(id);
    if (body.mass == infinite_mass || world.held(id)) return std::nullopt;
    const std::optional<NextImpact> face = try_alone(world, body, horizon);
    const NextImpact next = next_body(world, id, body, face.value_or(NextImpact{horizon, {}, -1}));
    if (!next.other.is_set() && !face) return std::nullopt;
    return next;
}

} // namespace carom::viewer
