/// \file
/// Timed steps: what `run` and `bench` share.
#pragma once

#include <carom/events.hpp>
#include <carom/world.hpp>

#include <cstdint>
#include <functional>

namespace carom::cli {

/// What steps took and did.
struct StepTotals {
    double seconds = 0; ///< wall time inside World::step
    std::uint64_t steps = 0;
    std::uint64_t impacts = 0;      ///< body with body
    std::uint64_t face_impacts = 0; ///< body with a wall
};

/// Called after every call of World::step, while World::impacts() is valid.
using AfterStep = std::function<void(const World&)>;

/// Moves `world` on by `dt`, in as many calls as its work cap asks for, and adds to `totals`. Throws carom::Error if
/// the cap lets it come no further.
void timed_step(World& world, double dt, StepTotals& totals, const AfterStep& after = {});

} // namespace carom::cli
