// Times of impact with a plane that vibrates, against a search in long double that looks everywhere.

#include "collision/random_input.hpp"
#include "collision/vibrating_plane.hpp"

#include <carom/time_of_impact.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

namespace {

using carom::no_impact;
using carom::detail::time_to_vibrating_plane;
using carom::detail::Vibration;

struct Case {
    double gap = 0;
    double velocity = 0;
    double acceleration = 0;
    Vibration vibration{};
    double horizon = 0;

    [[nodiscard]] long double gap_at(long double t) const {
        const long double phase = vibration.phase;
        const long double swing = std::sin(phase + vibration.frequency * t) - std::sin(phase);
        return gap + velocity * t + 0.5L * acceleration * t * t - vibration.amplitude * swing;
    }
    [[nodiscard]] double time() const {
        return time_to_vibrating_plane(gap, velocity, acceleration, vibration, horizon);
    }
    /// The first time at which the gap, seen at `samples` places, is not positive: by bisection.
    [[nodiscard]] long double reference(int samples) const {
        const long double step = static_cast<long double>(horizon) / samples;
        for (int k = 1; k <= samples; ++k) {
            if (gap_at(step * k) > 0) continue;
            long double above = step * (k - 1);
            long double below = step * k;
            for (int i = 0; i < 80; ++i) {
                const long double middle = (above + below) / 2;
                (gap_at(middle) > 0 ? above : below) = middle;
            }
            return below;
        }
        return no_impact;
    }
};

TEST(VibratingPlane, IsMetWhereALongSearchFindsIt) {
    std::mt19937 engine(7);
    std::uniform_real_distribution<double> unit(0, 1);
    int hits = 0;
    double worst = 0;
    for (int k = 0; k < 2000; ++k) {
        Case c;
        c.gap = unit(engine) * 0.02;
        c.velocity = 2 * unit(engine) - 1.2;
        c.acceleration = k % 3 == 0 ? 0 : -20 * unit(engine);
        c.vibration = {0.01 * unit(engine), 300 * unit(engine), 10 * unit(engine) - 5};
        c.horizon = 0.25;
        const double time = c.time();
        const long double reference = c.reference(20000);
        // A dip that no sample saw is not missing: the gap itself tells.
        if (time < reference - 1e-9L) {
            EXPECT_NEAR(static_cast<double>(c.gap_at(time)), 0, 1e-16) << k;
            continue;
        }
        ASSERT_EQ(time == no_impact, std::isinf(reference)) << k;
        if (time == no_impact) continue;
        ++hits;
        // The time is as good as the gap, a few roundings of 0.05 m, and the approach make it.
        const double approach = std::abs(static_cast<double>((c.gap_at(time) - c.gap_at(time - 1e-9L)) / 1e-9L));
        const double error = std::abs(static_cast<double>(time - reference)) * approach;
        worst = std::max(worst, error);
        ASSERT_LE(error, 1e-15) << k << " at " << time;
    }
    std::printf("figure: 2000 flights to a vibrating plane, %d impacts, gaps there within %.2g m\n", hits, worst);
    EXPECT_GT(hits, 1000);
}

TEST(VibratingPlane, IsMetAgainAfterAShortHop) {
    // Half a period of a plate that comes and goes faster than gravity: from the touch, parting at any small speed.
    for (const double speed : {1e-3, 1e-6, 1e-9, 1e-12, 0.0}) {
        Case c{.velocity = 0, .acceleration = -9.81, .vibration = {0.005, 100, 0}, .horizon = 1};
        // At the top of the plate's way it falls faster, 50 m/s^2, than the body.
        c.vibration.phase = 0.5 * 3.141592653589793;
        c.velocity = speed + 0.005 * 100 * std::cos(c.vibration.phase);
        const double time = c.time();
        ASSERT_GT(time, 0.03);
        EXPECT_NEAR(static_cast<double>(c.gap_at(time)), 0, 1e-15);
        for (int k = 1; k * 1e-5 < time - 1e-9; ++k) ASSERT_GT(c.gap_at(k * 1e-5), 0) << k;
    }
}

TEST(VibratingPlane, FollowsTheTouchRule) {
    const Vibration still_rising{0.01, 100, 0};
    // The plane comes at 1 m/s.
    EXPECT_EQ(time_to_vibrating_plane(0, 0.5, 0, still_rising, 1), 0);
    EXPECT_EQ(time_to_vibrating_plane(-1e-3, 0.5, 0, still_rising, 1), 0);
    EXPECT_EQ(time_to_vibrating_plane(0, 1.5, 0, still_rising, 1), no_impact);
    EXPECT_EQ(time_to_vibrating_plane(1, 0, 0, still_rising, 1), no_impact);
    EXPECT_EQ(time_to_vibrating_plane(1e-3, -1, 0, still_rising, -1), no_impact);
    // Parting a little, from 1 mm deep: it gets clear, and comes back to the surface, not to where it was.
    const double back = time_to_vibrating_plane(-1e-3, 1.5, -10, still_rising, 1);
    const Case c{-1e-3, 1.5, -10, still_rising, 1};
    EXPECT_NEAR(static_cast<double>(c.gap_at(back)), 0, 1e-15);
    EXPECT_GT(back, 0.2);
}

} // namespace
