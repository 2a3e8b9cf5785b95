// A cue ball strikes a triangle of fifteen: many bodies at once, and which impacts follow in what order.

#include <carom/carom.hpp>

#include <cmath>
#include <cstdio>
#include <vector>

int main() {
    constexpr double radius = 0.028575; // m
    constexpr double gap = 1e-5;        // m, between neighbours of the rack
    std::vector<carom::Vec3> positions{{-0.6, 0.002, 0}};
    std::vector<carom::Vec3> velocities{{8, 0, 0}};
    for (int row = 0; row < 5; ++row) {
        for (int place = 0; place <= row; ++place) {
            const double across = place - row / 2.0;
            positions.push_back({row * (2 * radius + gap) * std::sqrt(0.75), across * (2 * radius + gap), 0});
            velocities.emplace_back();
        }
    }
    const std::vector<double> radii(positions.size(), radius);
    const std::vector<double> masses(positions.size(), 0.17); // kg
    const std::vector<double> restitutions(positions.size(), 0.95);

    const carom::Box table{{-1.27, -0.635, -1}, {1.27, 0.635, 1}};
    carom::World world({.region = table});
    const std::vector<carom::BodyId> balls = world.add(
        {.position = positions, .velocity = velocities, .mass = masses, .radius = radii, .restitution = restitutions});
    world.step(0.1);
    for (const carom::Impact& i : world.impacts()) {
        if (i.face < 0) std::printf("%.6f s: %2u strikes %2u, %.4f N s\n", i.time, i.a.slot, i.b.slot, i.impulse);
    }
    world.step(0.9);
    world.get(balls, {.position = positions});
    for (std::size_t i = 0; i < balls.size(); ++i) {
        std::printf("ball %2zu is at (%+.3f, %+.3f) m\n", i, positions[i].x, positions[i].y);
    }
    return world.ledger().impacts >= 15 ? 0 : 1;
}
