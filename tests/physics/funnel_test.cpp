// A silo of frustums that meet in seams: a tube, the cone below it, its drain, and the disc that closes it.

#include "physics/balance.hpp"

#include <carom/carom.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

namespace {

using carom::Body;
using carom::BodyId;
using carom::Frustum;
using carom::Vec3;
using carom::World;
using carom::test::balance;

/// The seams of the silo lie at heights 0 and `height`, the disc at -`depth`.
struct Silo {
    double radius; ///< m, of the tube
    double height; ///< m, of the cone
    double drain;  ///< m, radius
    double depth;  ///< m, of the drain

    [[nodiscard]] double radius_at(double z) const {
        if (z > height) return radius;
        return z > 0 ? drain + (radius - drain) * z / height : drain;
    }
    [[nodiscard]] World world() const {
        return World(
            {.gravity = {0, 0, -9.81},
             .obstacles = {Frustum{.height = height, .base_radius = drain, .top_radius = radius},
                           Frustum{.base = {0, 0, height}, .height = 9, .base_radius = radius, .top_radius = radius},
                           Frustum{.base = {0, 0, -depth}, .height = depth, .base_radius = drain, .top_radius = drain},
                           Frustum{.base = {0, 0, -depth}, .height = 0, .base_radius = drain, .top_radius = 0}}});
    }
};

class Random {
public:
    double within(double low, double high) { return low + (high - low) * (static_cast<double>(engine_()) / 0x1p32); }
    Silo silo() { return {within(2, 4), within(1, 4), within(0.6, 1.2), within(1, 3)}; }
    /// A ball somewhere above the cone.
    Body ball(const Silo& silo, double radius, double friction) {
        const double rho = (silo.radius - radius) * std::sqrt(within(0, 0.99));
        const double angle = within(0, 2 * std::numbers::pi);
        return {.position = {rho * std::cos(angle), rho * std::sin(angle), silo.height + within(1, 4)},
                .velocity = {within(-3, 3), within(-3, 3), within(-2, 2)},
                .radius = radius,
                .restitution = 0.3,
                .friction = friction};
    }

private:
    std::mt19937 engine_{5};
};

void follow(World& world, int steps) {
    const double before = balance(world);
    for (int k = 0; k < steps; ++k) {
        world.step(1.0 / 60);
        ASSERT_NEAR(balance(world), before, 1e-9);
    }
}

TEST(Funnel, WhatFitsTheDrainComesToRestAtItsBottom) {
    Random random;
    for (int trial = 0; trial < 30; ++trial) {
        const Silo silo = random.silo();
        const double radius = random.within(0.1, 0.55);
        World world = silo.world();
        const BodyId id = world.add(random.ball(silo, radius, 0.3));
        follow(world, 1500);
        const Body body = world.get(id);
        EXPECT_NEAR(body.position.z, radius - silo.depth, 1e-4) << trial;
        EXPECT_EQ(body.velocity, Vec3{}) << trial;
    }
}

/// On the axis, where it touches the cone all round.
TEST(Funnel, WhatDoesNotFitStaysInTheCone) {
    Random random;
    for (int trial = 0; trial < 30; ++trial) {
        Silo silo = random.silo();
        silo.height = std::max(silo.height, silo.radius - silo.drain); // steeper than any friction here
        const double radius = silo.drain * random.within(1.05, 1.5);
        World world = silo.world();
        const BodyId id = world.add(random.ball(silo, radius, 0.1));
        follow(world, 1500);
        const Body body = world.get(id);
        const double slant = (silo.radius - silo.drain) / silo.height;
        const double in_cone = (radius * std::hypot(1, slant) - silo.drain) / slant;
        const double on_rim = std::sqrt(radius * radius - silo.drain * silo.drain);
        // Touched below the rim's height, it is the rim that is touched.
        const bool at_rim = in_cone < radius * slant / std::hypot(1, slant);
        EXPECT_NEAR(body.position.z, at_rim ? on_rim : in_cone, 1e-3) << trial;
        EXPECT_LT(std::hypot(body.position.x, body.position.y), 2e-3) << trial;
        EXPECT_LT(length(body.velocity), 1e-3) << trial;
    }
}

/// Without friction it may go round for ever, over any seam, but never through.
TEST(Funnel, NobodyLeavesThroughASeam) {
    Random random;
    double deepest = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const Silo silo = random.silo();
        const double radius = random.within(0.1, 0.55);
        World world = silo.world();
        const BodyId id = world.add(random.ball(silo, radius, 0));
        for (int k = 0; k < 10; ++k) {
            follow(world, 60);
            const Vec3 x = world.get(id).position;
            const double beyond = std::hypot(x.x, x.y) + radius - silo.radius_at(x.z);
            const double below = -silo.depth - (x.z - radius);
            deepest = std::max({deepest, x.z < 0 ? beyond / radius : 0, below / radius});
            ASSERT_LT(std::hypot(x.x, x.y), silo.radius_at(x.z)) << trial;
        }
    }
    std::printf("figure: 60 balls in silos of four frustums sink at most %.2g of a radius into them\n", deepest);
    // What lies there goes straight for a piece of 1/480 s, in which the wall bends towards it by at most 0.01 of its
    // radius, and contacts undo a fourteenth of an overlap in a piece.
    EXPECT_LT(deepest, 14 * 0.01);
}

} // namespace
