/// \file
/// What a body will meet next.
#pragma once

#include <carom/world.hpp>

#include <optional>

namespace carom::viewer {

struct NextImpact {
    double in = 0;  ///< s from now
    BodyId other{}; ///< not set where it is a face or an obstacle
    int face = -1;  ///< as in Impact::face, or -1
};

/// Looks ahead for single bodies of a world: the first impact if no other body meets anything before, if none grows,
/// and if neither drag nor attractors act.
class LookAhead {
public:
    /// The first impact within `horizon` s; takes O(bodies). Nothing for static, kinematic and held bodies.
    std::optional<NextImpact> next_impact(const World& world, BodyId id, double horizon);

private:
    /// The first impact with a face or an obstacle: it is tried.
    std::optional<NextImpact> try_alone(const World& world, const Body& body, double horizon);
    void empty_world_like(const World& world);

    std::optional<World> alone_; ///< region and obstacles of the world, and no bodies
};

} // namespace carom::viewer
