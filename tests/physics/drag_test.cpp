// Drag against closed solutions of the quadratic law dv/dt = -g - k |v| v, and its order of convergence.

#include <carom/carom.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace {

using carom::World;
using carom::WorldOptions;

WorldOptions with_drag(carom::Drag drag) {
    WorldOptions options;
    options.gravity = {0, 0, -9.81};
    options.drag = drag;
    return options;
}

struct Throw {
    double apex = 0;       ///< m
    double apex_time = 0;  ///< s
    double back_speed = 0; ///< m/s on return
};

/// Thrown up at 30 m/s with k = 0.01 /m, the turning points interpolated within their steps.
Throw throw_up(double dt) {
    World world(with_drag({.quadratic = 0.01}));
    const carom::BodyId ball = world.add({.velocity = {0, 0, 30}});
    Throw result;
    carom::Body before = world.get(ball);
    while (true) {
        const double start = world.time();
        world.step(dt);
        const carom::Body after = world.get(ball);
        if (before.velocity.z > 0 && after.velocity.z <= 0) {
            const double part = before.velocity.z / (before.velocity.z - after.velocity.z);
            result.apex_time = start + part * dt;
            result.apex = before.position.z + before.velocity.z * part * dt / 2;
        }
        if (after.position.z < 0) {
            const double a = (after.velocity.z - before.velocity.z) / dt;
            const double v = before.velocity.z;
            result.back_speed = std::sqrt(v * v - 2 * a * before.position.z);
            return result;
        }
        before = after;
    }
}

TEST(Drag, ThrownUpAndBack) {
    const Throw result = throw_up(1.0 / 60);
    std::printf("figure: drag: thrown up, apex %.9g m, %.9g s, back at %.9g m/s: %.2g, %.2g, %.2g off (at most 1e-4)\n",
                result.apex, result.apex_time, result.back_speed, result.apex / 32.5493184868 - 1,
                result.apex_time / 2.43881857405 - 1, result.back_speed / 21.6651330583 - 1);
    EXPECT_NEAR(result.apex / 32.5493184868, 1, 1e-4);
    EXPECT_NEAR(result.apex_time / 2.43881857405, 1, 1e-4);
    EXPECT_NEAR(result.back_speed / 21.6651330583, 1, 1e-4);
}

TEST(Drag, TerminalSpeed) {
    World world(with_drag({.quadratic = 0.01}));
    const carom::BodyId ball = world.add(carom::Body{});
    for (int i = 0; i < 60 * 60; ++i) world.step(1.0 / 60);
    const double speed = -world.get(ball).velocity.z;
    std::printf("figure: drag: terminal speed %.10g m/s: %.2g off (at most 1e-4)\n", speed, speed / 31.3209195267 - 1);
    EXPECT_NEAR(speed / 31.3209195267, 1, 1e-4);
}

/// m, after 2 s of fall against quadratic drag from rest: ln(cosh(t sqrt(g k))) / k.
double fall_error(double dt) {
    World world(with_drag({.quadratic = 0.01}));
    const carom::BodyId ball = world.add(carom::Body{});
    const int steps = static_cast<int>(std::lround(2 / dt));
    for (int i = 0; i < steps; ++i) world.step(dt);
    const double exact = std::log(std::cosh(2 * std::sqrt(9.81 * 0.01))) / 0.01;
    return -world.get(ball).position.z - exact;
}

TEST(Drag, SecondOrder) {
    for (const double dt : {1.0 / 15, 1.0 / 30, 1.0 / 60}) {
        const double ratio = fall_error(dt) / fall_error(dt / 2);
        std::printf("figure: drag: error at dt = %.4f s by that at half of it: %.4f (4 +- 0.4)\n", dt, ratio);
        EXPECT_NEAR(ratio, 4, 0.4);
    }
}

TEST(Drag, LinearLawIsExactWithoutGravity) {
    WorldOptions options;
    options.drag = {.linear = 0.5};
    World world(options);
    const carom::BodyId ball = world.add({.velocity = {3, 4, 0}});
    for (int i = 0; i < 100; ++i) world.step(0.02);
    EXPECT_NEAR(world.get(ball).velocity.x, 3 * std::exp(-1.0), 1e-13);
    EXPECT_NEAR(world.ledger().lost_to_drag, 12.5 * (1 - std::exp(-2.0)), 1e-12);
}

} // namespace
