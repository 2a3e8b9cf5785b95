/// \file
/// What a body will meet next.
#pragma once

#include <carom/world.hpp>

#include <optional>

namespace carom::viewer {

struct NextImpact {
    double in = 0;  ///< s from now
    BodyId other{}; ///< not set where it is a face
    int face = -1;  ///< of the region, or -1
};

/// The first impact of a body within `horizon` s if no other body meets anything before, and neither drag nor
/// attractors act: a look ahead that takes O(bodies). Nothing for static and held bodies.
std::optional<NextImpact> next_impact(const World& world, BodyId id, double horizon);

} // namespace carom::viewer
