// Restitution that depends on the approach speed, in a world.

#include <carom/carom.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace {

using carom::Body;
using carom::BodyId;
using carom::PowerLaw;
using carom::RestitutionLaw;
using carom::Vec3;
using carom::World;
using carom::WorldOptions;

constexpr PowerLaw falling{.restitution = 0.5, .speed = 1, .exponent = 0.1};

double by_power(double v) { return std::min(1.0, 0.5 * std::pow(v, -0.1)); }

WorldOptions with_law(const RestitutionLaw& law) { return {.materials = {{.key = 1, .restitution = law}}}; }

/// Speed along z after an impact by that before, of a ball that glances off something below the origin at v along -z.
double measured(WorldOptions options, double v, const std::vector<Body>& others = {}) {
    options.threads = 1;
    World world(options);
    for (const Body& other : others) world.add(other);
    const BodyId ball =
        world.add({.position = {-1.5, 0, 1}, .velocity = {3 * v, 0, -v}, .restitution = 0.1, .material = 1});
    world.step(1 / v);
    EXPECT_EQ(world.impacts().size(), 1U);
    return world.get(ball).velocity.z / v;
}

constexpr std::array speeds{1e-3, 0.1, 1.0, 7.0, 300.0};

TEST(RestitutionLaws, HoldAtFacesStaticBodiesAndObstacles) {
    for (const double v : speeds) {
        WorldOptions at_plane = with_law(falling);
        at_plane.region = std::vector<carom::Plane>{{}};
        EXPECT_NEAR(measured(at_plane, v), by_power(v), 1e-12) << v;
        WorldOptions at_disc = with_law(falling);
        at_disc.obstacles = {carom::Frustum{.height = 0, .base_radius = 5, .top_radius = 0}};
        EXPECT_NEAR(measured(at_disc, v), by_power(v), 1e-12) << v;
        const Body fixed{.position = {0, 0, -1}, .mass = carom::infinite_mass, .radius = 1, .restitution = 0};
        EXPECT_NEAR(measured(with_law(falling), v, {fixed}), by_power(v), 1e-12) << v;
        at_plane.region = std::vector<carom::Plane>{{.surface = {.restitution = 0.75}}};
        EXPECT_NEAR(measured(at_plane, v), 0.75, 1e-12) << v;
    }
}

/// Two bodies with those materials meet at v along x, and glance; the ratio of the relative speeds along x.
double of_pair(WorldOptions options, double v, std::uint32_t a, std::uint32_t b) {
    options.threads = 1;
    World world(options);
    const BodyId left =
        world.add({.position = {-1, -2, 0}, .velocity = {v, 2 * v, 0}, .restitution = 0.25, .material = a});
    const BodyId right = world.add({.position = {1, 0, 0}, .mass = 3, .restitution = 0.25, .material = b});
    world.step(2 / v);
    return (world.get(right).velocity.x - world.get(left).velocity.x) / v;
}

TEST(RestitutionLaws, HoldBetweenBodies) {
    WorldOptions options = with_law(falling);
    options.material_rules = {{.a = 2, .b = 2, .law = PowerLaw{0.9, 10, 0.5}}, {.a = 1, .b = 3, .restitution = 0.625}};
    for (const double v : speeds) {
        EXPECT_NEAR(of_pair(options, v, 1, 1), by_power(v), 1e-12) << v;
        EXPECT_NEAR(of_pair(options, v, 1, 0), std::max(by_power(v), 0.25), 1e-12) << v;
        EXPECT_NEAR(of_pair(options, v, 2, 2), std::min(1.0, 0.9 * std::pow(v / 10, -0.5)), 1e-12) << v;
        EXPECT_NEAR(of_pair(options, v, 3, 1), 0.625, 1e-12) << v;
    }
}

TEST(RestitutionLaws, WhatRestsIsLeftToTheLimitAtTheSpeedOfAFall) {
    constexpr double g = 9.81;
    WorldOptions options = with_law(falling);
    options.gravity = {0, 0, -g};
    options.region = std::vector<carom::Plane>{{}};
    World world(options);
    const BodyId ball = world.add({.position = {0, 0, 1}, .radius = 0.1, .restitution = 1, .material = 1});
    double last = 0;
    for (int i = 0; i < 600 && !world.held(ball); ++i) {
        world.step(1.0 / 60);
        for (const carom::Impact& impact : world.impacts()) {
            // Bounces from heights follow the law, and the last one is below the limit.
            if (last > 0) {
                EXPECT_NEAR(impact.approach_speed / last, by_power(last), 1e-6);
            }
            last = impact.approach_speed;
        }
    }
    ASSERT_TRUE(world.held(ball));
    const double fall = g * world.options().rest_time;
    const double e = by_power(fall);
    EXPECT_LT(2 * e * last, (1 - e) * fall);
}

TEST(RestitutionLaws, PilesOfThemComeToRest) {
    WorldOptions options = with_law(carom::Viscoelastic{.dissipation = 0.03, .modulus = 1e4});
    options.gravity = {0, 0, -9.81};
    options.region = carom::Box{{0, 0, 0}, {1, 1, 4}};
    World world(options);
    for (int k = 0; k < 64; ++k) {
        const int layer = k / 16;
        const int row = k / 4 % 4;
        world.add({.position = {0.13 + 0.24 * (k % 4) + 0.01 * layer, 0.13 + 0.24 * row, 0.5 + 0.3 * layer},
                   .radius = 0.1,
                   .friction = 0.3,
                   .material = 1});
    }
    const double weight = 64 * 9.81;
    for (int i = 0; i < 600; ++i) world.step(1.0 / 60);
    EXPECT_EQ(world.report().held, 64U);
    double force = 0;
    for (const carom::Contact& contact : world.contacts()) {
        if (contact.face == 4) force += contact.force;
    }
    EXPECT_NEAR(force / weight, 1, 1e-3);
}

} // namespace
