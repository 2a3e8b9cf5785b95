#include "stepping.hpp"

#include <chrono>

namespace carom::cli {

void timed_step(World& world, double dt, StepTotals& totals) {
    const auto begin = std::chrono::steady_clock::now();
    const StepReport& report = world.step(dt);
    totals.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    totals.impacts += report.impacts;
    totals.face_impacts += report.face_impacts;
    if (report.work_cap_reached) ++totals.capped;
    ++totals.steps;
}

} // namespace carom::cli
