// Shots at a plate of spheres: at any speed none passes. The plate is a triangular layer of static spheres, one metre
// thick. Spheres that touch leave holes for shots of less than 2 / sqrt(3) - 1 = 0.1547 sphere radii; spheres that
// overlap enough leave none even for points.

#include "scene/random.hpp"

#include <carom/carom.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <vector>

namespace {

using carom::Body;
using carom::BodyId;
using carom::Precision;
using carom::Vec3;
using carom::World;
using carom::scene::Random;

constexpr double sphere_radius = 0.5;
constexpr double plate_radius = 3;
constexpr double closed_radius = 2; ///< within it, the plate has no edge to slip past
constexpr double target_radius = 1;
constexpr double dt = 1.0 / 64;

/// A kind of shots, and the plate that must stop it.
struct Trial {
    double pitch;        ///< m between neighbours in the plate
    double least_radius; ///< m, of a shot
    double largest_radius;
    std::size_t salvo;  ///< shots that fly at once
    std::size_t salvos; ///< per decade of speeds
};

/// Points never meet each other, so that many may fly at once. Other shots go one by one: none is struck by another
/// behind the edge of the plate.
constexpr Trial points{.pitch = 0.8, .least_radius = 0, .largest_radius = 0, .salvo = 32, .salvos = 1300};
constexpr Trial balls{.pitch = 1, .least_radius = 0.0775, .largest_radius = 0.5, .salvo = 1, .salvos = 4000};

struct Score {
    std::uint64_t shots = 0;
    std::uint64_t struck = 0; ///< the plate
    std::uint64_t passed = 0;
};

double length_in_plane(const Vec3& v) { return std::hypot(v.x, v.y); }

std::vector<Vec3> plate_positions(double pitch) {
    std::vector<Vec3> positions;
    const double row_distance = std::sqrt(0.75) * pitch;
    const int rows = static_cast<int>(plate_radius / row_distance);
    const int columns = static_cast<int>(plate_radius / pitch);
    for (int row = -rows; row <= rows; ++row) {
        for (int column = -columns; column <= columns; ++column) {
            const Vec3 position{(column + (row % 2 != 0 ? 0.5 : 0)) * pitch, row * row_distance, 0};
            if (length_in_plane(position) < plate_radius) positions.push_back(position);
        }
    }
    return positions;
}

World plate(const Trial& trial, Precision precision, bool serial) {
    World world({.precision = precision, .serial_reference = serial});
    for (const Vec3& position : plate_positions(trial.pitch)) {
        world.add({.position = position, .mass = carom::infinite_mass, .radius = sphere_radius, .restitution = 0},
                  carom::Overlap::accept);
    }
    return world;
}

/// Half of the shots come from close by and aslant, the others straight down from up to half a step away: there are
/// no digits in the speed of a fast shot to aim from so far.
Body random_shot(const Trial& trial, double travel, Random& random) {
    constexpr double steepest = 0.5;
    Body shot;
    shot.radius = random.uniform(trial.least_radius, trial.largest_radius);
    const Vec3 target = random.on_circle() * (target_radius * std::sqrt(random.unit()));
    const bool near = random.unit() < 0.5;
    const double height = near ? random.uniform(1, 2) : random.log_uniform(1, std::max(2.0, travel / 2));
    const Vec3 direction = Vec3{0, 0, -1} + (near ? random.on_circle() * random.uniform(0, steepest) : Vec3{});
    shot.position = target - direction * height;
    shot.velocity = direction * (travel / dt / carom::length(direction));
    if (random.unit() < 0.5) shot.restitution = 0.3 * std::floor(4 * random.unit());
    return shot;
}

/// True if the straight line that ends here came through the plate, or if the shot lies in its lower half.
bool came_through_plate(const Body& shot) {
    if (shot.position.z > 0) return false;
    const double since = shot.velocity.z < 0 ? shot.position.z / shot.velocity.z : 0;
    return length_in_plane(shot.position - shot.velocity * since) < closed_radius;
}

/// Fires one salvo, whose shots move between `least_travel` and `most_travel` metres in a step, and steps until the
/// slowest would be through.
void fire(World& world, const Trial& trial, double least_travel, double most_travel, Random& random, Score& score) {
    std::vector<BodyId> ids;
    std::vector<Vec3> velocities;
    for (std::size_t k = 0; k < trial.salvo; ++k) {
        ids.push_back(world.add(random_shot(trial, random.log_uniform(least_travel, most_travel), random)));
        velocities.push_back(world.get(ids.back()).velocity);
    }
    const int steps = static_cast<int>(std::ceil(3 / least_travel));
    for (int i = 0; i < steps; ++i) world.step(dt);
    for (std::size_t k = 0; k < ids.size(); ++k) {
        const Body shot = world.get(ids[k]);
        if (shot.velocity != velocities[k]) ++score.struck;
        if (came_through_plate(shot)) ++score.passed;
    }
    score.shots += ids.size();
    world.remove(ids);
}

/// From a tenth of the plate's thickness in a step up to what the world holds.
void expect_none_passes(const char* name, const Trial& trial, Precision precision, bool serial = false) {
    const double fastest = precision == Precision::double_precision ? 0x1p21 : 0x1p41;
    World world = plate(trial, precision, serial);
    Random random(12);
    Score score;
    double travel = 0.1;
    while (travel < fastest) {
        const double faster = std::min(10 * travel, fastest);
        for (std::size_t k = 0; k < trial.salvos; ++k) {
            fire(world, trial, travel, faster, random, score);
        }
        travel = faster;
    }
    std::printf("figure: %llu %s at a plate, 0.1 to %.3g thicknesses a step: %llu passed\n",
                static_cast<unsigned long long>(score.shots), name, fastest,
                static_cast<unsigned long long>(score.passed));
    EXPECT_EQ(score.passed, 0U);
    EXPECT_EQ(score.struck, score.shots);
}

TEST(Tunnelling, NoPointPassesInDouble) { expect_none_passes("points (double)", points, Precision::double_precision); }
TEST(Tunnelling, NoPointPassesInSingle) { expect_none_passes("points (single)", points, Precision::single_precision); }
TEST(Tunnelling, NoBallPassesInDouble) { expect_none_passes("balls (double)", balls, Precision::double_precision); }
TEST(Tunnelling, NoBallPassesInSingle) { expect_none_passes("balls (single)", balls, Precision::single_precision); }

TEST(Tunnelling, NonePassesInOneQueue) {
    Trial few = points;
    few.salvos /= 40;
    expect_none_passes("points (double, serial)", few, Precision::double_precision, true);
    expect_none_passes("points (single, serial)", few, Precision::single_precision, true);
}

} // namespace
