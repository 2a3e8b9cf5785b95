// Shots at plates of touching spheres: at any speed none passes that geometry says cannot.

#include "scene/random.hpp"
#include "validate/cases.hpp"

#include <carom/world.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace carom::validate {

namespace {

constexpr double sphere_radius = 0.5; // m
constexpr double plate_radius = 3;    // m
constexpr double target_radius = 1;   // m
constexpr double dt = 1.0 / 64;       // s
constexpr double fastest = 1e6;       // plate thicknesses in a step

double length_in_plane(const Vec3& v) { return std::sqrt(v.x * v.x + v.y * v.y); }

/// A triangular layer of touching static spheres at height `z`; layers of other `stacking` (0 to 2) lie in its hollows.
void add_layer(World& world, double z, int stacking) {
    const double row_distance = std::sqrt(0.75);
    const Vec3 shift{0.5 * stacking, row_distance / 3 * stacking, 0};
    const int rows = static_cast<int>(plate_radius / row_distance);
    for (int row = -rows; row <= rows; ++row) {
        for (int column = -3; column <= 3; ++column) {
            const Vec3 place{column + (row % 2 != 0 ? 0.5 : 0), row * row_distance, z};
            if (length_in_plane(place) >= plate_radius) continue;
            world.add({.position = place + shift, .mass = infinite_mass, .radius = sphere_radius, .restitution = 0},
                      Overlap::accept);
        }
    }
}

struct Score {
    std::uint64_t shots = 0;
    std::uint64_t unstruck = 0;
    std::uint64_t passed = 0;
};

/// True if the straight line that ends here came through the plate within its closed part.
bool came_through(const Body& shot) {
    if (shot.position.z > 0) return false;
    const double since = shot.velocity.z < 0 ? shot.position.z / shot.velocity.z : 0;
    return length_in_plane(shot.position - shot.velocity * since) < plate_radius - 1;
}

/// Straight down at `travel` m in a step.
void fire(World& world, double shot_radius, double travel, scene::Random& random, Score& score) {
    const Vec3 target = random.on_circle() * (target_radius * std::sqrt(random.unit()));
    Body shot{.position = target + Vec3{0, 0, 4}, .velocity = {0, 0, -travel / dt}, .radius = shot_radius};
    if (random.unit() < 0.5) shot.restitution = 0.3 * std::floor(4 * random.unit());
    const BodyId id = world.add(shot);
    const int steps = static_cast<int>(std::ceil(8 / travel));
    for (int i = 0; i < steps; ++i) world.step(dt);
    const Body end = world.get(id);
    ++score.shots;
    if (end.velocity == shot.velocity) ++score.unstruck;
    if (came_through(end)) ++score.passed;
    world.remove(id);
}

Score fire_all(World& world, double least_radius, double largest_radius, std::size_t shots) {
    scene::Random random(51);
    Score score;
    for (std::size_t i = 0; i < shots; ++i) {
        const double travel = random.log_uniform(0.1, fastest);
        fire(world, random.uniform(least_radius, largest_radius), travel, random, score);
    }
    return score;
}

World open_world() { return World({.threads = 1, .record_impacts = false}); }

Findings run_balls(std::size_t shots) {
    World plate = open_world();
    add_layer(plate, 0, 0);
    const Score score = fire_all(plate, 0.1548 * sphere_radius, sphere_radius, shots);
    Findings findings;
    findings.rows.push_back(
        exact_row({"tunnelling: shots that pass",
                   fmt::format("{} balls of r > 0.1547 R at a layer of touching spheres, 0.1 to 1e6 "
                               "thicknesses a step",
                               score.shots),
                   "geometry: holes are 2 / sqrt(3) - 1 radii wide"},
                  0, static_cast<double>(score.passed), 0));
    return findings;
}

Findings run_points(std::size_t shots) {
    World plate = open_world();
    const double layer_distance = std::sqrt(2.0 / 3);
    for (int layer = 0; layer < 3; ++layer) add_layer(plate, -layer * layer_distance, layer);
    const Score score = fire_all(plate, 0, 0, shots);
    Findings findings;
    findings.rows.push_back(exact_row({"tunnelling: shots that strike nothing",
                                       fmt::format("{} points straight down at three layers (ABC) of touching spheres, "
                                                   "0.1 to 1e6 thicknesses a step",
                                                   score.shots),
                                       "geometry: the layers leave no straight way"},
                                      0, static_cast<double>(score.unstruck), 0));
    return findings;
}

} // namespace

std::vector<Task> tunnelling_tasks(Extent extent) {
    const std::size_t shots = extent == Extent::full ? 100'000 : 4000;
    const double cost = static_cast<double>(shots) * 1e-4;
    return {{cost, [shots] { return run_balls(shots); }}, {cost, [shots] { return run_points(shots); }}};
}

} // namespace carom::validate
