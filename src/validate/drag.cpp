// Quadratic drag, dv/dt = -g - k |v| v, against its closed solutions.

#include "validate/cases.hpp"

#include <carom/world.hpp>

#include <cmath>

namespace carom::validate {

namespace {

constexpr double gravity = 9.81;  // m/s^2
constexpr double k = 0.01;        // 1/m
constexpr double admitted = 1e-4; // relative, at 1/60 s; the error is of second order in dt
constexpr double dt = 1.0 / 60;   // s
constexpr const char* source = "closed solution of dv/dt = -g - k |v| v, k = 0.01 /m";

World with_drag() { return World({.gravity = {0, 0, -gravity}, .drag = {.quadratic = k}, .threads = 1}); }

struct Throw {
    double apex = 0;       ///< m
    double apex_time = 0;  ///< s
    double back_speed = 0; ///< m/s on return
};

/// Thrown up at 30 m/s; the turning points are interpolated within their steps.
Throw throw_up() {
    World world = with_drag();
    const BodyId ball = world.add({.velocity = {0, 0, 30}});
    Throw result;
    Body before = world.get(ball);
    for (;;) {
        const double start = world.time();
        world.step(dt);
        const Body after = world.get(ball);
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

double terminal_speed() {
    World world = with_drag();
    const BodyId ball = world.add(Body{});
    for (int i = 0; i < 3600; ++i) world.step(dt);
    return -world.get(ball).velocity.z;
}

Findings run() {
    const Throw thrown = throw_up();
    const auto row = [](const char* name, const char* setup, double reference, double measured) {
        return exact_row({name, setup, source}, reference, measured, admitted * reference);
    };
    constexpr const char* up = "thrown up at 30 m/s, dt = 1/60 s";
    Findings findings;
    findings.rows = {row("apex with drag, m", up, 32.5493184868, thrown.apex),
                     row("time of the apex, s", up, 2.43881857405, thrown.apex_time),
                     row("speed on return, m/s", up, 21.6651330583, thrown.back_speed),
                     row("terminal speed, m/s", "falling for 60 s, dt = 1/60 s", 31.3209195267, terminal_speed())};
    return findings;
}

} // namespace

std::vector<Task> drag_tasks(Extent /*extent*/) { return {{0, run}}; }

} // namespace carom::validate
