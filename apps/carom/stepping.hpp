/// \file
/// Timed steps: what `run` and `bench` share.
#pragma once

#include <carom/events.hpp>
#include <carom/world.hpp>

#include <cstdint>

namespace carom::cli {

/// What steps took and did.
struct StepTotals {
    double seconds = 0; ///< wall time inside World::step
    std::uint64_t steps = 0;
    std::uint64_t impacts = 0;      ///< body with body
    std::uint64_t face_impacts = 0; ///< body with a wall
    std::uint64_t capped = 0;       ///< steps that ended early at the work cap
};

/// One step of `dt`, added to `totals`. A step that ends early at the work cap is not gone on with: the cap is there
/// so that every step ends soon, whatever the world falls behind.
void timed_step(World& world, double dt, StepTotals& totals);

} // namespace carom::cli
