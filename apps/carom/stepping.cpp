#include "stepping.hpp"

#include <carom/error.hpp>

#include <chrono>

namespace carom::cli {

void timed_step(World& world, double dt, StepTotals& totals, const AfterStep& after) {
    double left = dt;
    while (left > 0) {
        const auto begin = std::chrono::steady_clock::now();
        const StepReport& report = world.step(left);
        totals.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
        totals.impacts += report.impacts;
        totals.face_impacts += report.face_impacts;
        if (after) after(world);
        if (report.work_cap_reached && report.advanced == 0) {
            throw Error(ErrorCode::out_of_range, "work_cap", "is too small for the next impact: time stands still");
        }
        left = report.behind;
    }
    ++totals.steps;
}

} // namespace carom::cli
