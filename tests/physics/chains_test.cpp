// Cradles and chains in a line, and Galperin's billiard: exact sequences of impacts.

#include <carom/carom.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <vector>

namespace {

using carom::BodyId;
using carom::World;

struct Outcome {
    std::vector<double> velocities;
    std::uint64_t impacts = 0;
};

/// `count` balls in a row with gaps (m); the first `moving` of them come in together at 1 m/s.
Outcome strike(std::size_t count, std::size_t moving, double e, double gap) {
    World world;
    std::vector<BodyId> ids;
    for (std::size_t i = 0; i < count; ++i) {
        const double distance = i < moving ? 0.25 : 0;
        ids.push_back(world.add({.position = {static_cast<double>(i) * (1 + gap) - distance, 0, 0},
                                 .velocity = {i < moving ? 1.0 : 0.0, 0, 0},
                                 .restitution = e}));
    }
    for (int i = 0; i < 4000; ++i) world.step(1.0 / 60);
    Outcome outcome;
    for (const BodyId id : ids) outcome.velocities.push_back(world.get(id).velocity.x);
    outcome.impacts = world.ledger().impacts;
    return outcome;
}

void expect_velocities(const Outcome& outcome, const std::vector<double>& expected, double tolerance = 1e-14) {
    ASSERT_EQ(outcome.velocities.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(outcome.velocities[i], expected[i], tolerance) << i;
}

TEST(Cradle, AsManyOutAsIn) {
    for (const double gap : {0.0, 1.0 / 1024}) {
        const Outcome one = strike(5, 1, 1, gap);
        expect_velocities(one, {0, 0, 0, 0, 1});
        EXPECT_EQ(one.impacts, 4U);
        const Outcome two = strike(5, 2, 1, gap);
        expect_velocities(two, {0, 0, 0, 1, 1});
        EXPECT_EQ(two.impacts, 6U);
        const Outcome three = strike(5, 3, 1, gap);
        expect_velocities(three, {0, 0, 1, 1, 1});
        EXPECT_EQ(three.impacts, 6U);
    }
}

TEST(Cradle, InelasticWithSmallGaps) {
    const Outcome three = strike(3, 1, 0.9, 1.0 / 1024);
    expect_velocities(three, {0.047625, 0.049875, 0.9025});
    EXPECT_EQ(three.impacts, 3U);
    const Outcome five = strike(5, 1, 0.9, 1.0 / 1024);
    std::printf("figure: cradle of five, e = 0.9: %.9f %.9f %.9f %.9f %.9f m/s after %llu impacts\n",
                five.velocities[0], five.velocities[1], five.velocities[2], five.velocities[3], five.velocities[4],
                static_cast<unsigned long long>(five.impacts));
    // The reference has nine decimals: half a unit of the last, and a little for our own rounding.
    expect_velocities(five, {0.043525082, 0.045372965, 0.047296641, 0.049299062, 0.81450625}, 5.1e-10);
    EXPECT_EQ(five.impacts, 10U);
}

TEST(Cradle, FirstPassOfALongChain) {
    const std::size_t count = 20;
    const double e = 0.9;
    const Outcome outcome = strike(count, 1, e, 1.0 / 1024);
    EXPECT_NEAR(outcome.velocities.back(), std::pow((1 + e) / 2, static_cast<double>(count - 1)), 1e-13);
}

// McNamara & Young, Phys. Fluids A 4, 496 (1992): three balls collapse below e = 7 - 4 sqrt 3. The TC rule ends it.
TEST(Cradle, CollapseInOneDimensionEnds) {
    const double critical = 7 - 4 * std::sqrt(3.0);
    World world;
    const double e = 0.5 * critical;
    world.add({.position = {-1.5, 0, 0}, .velocity = {1, 0, 0}, .restitution = e});
    world.add({.position = {0, 0, 0}, .restitution = e});
    world.add({.position = {1.5, 0, 0}, .velocity = {-1, 0, 0}, .restitution = e});
    std::uint64_t conversions = 0;
    for (int i = 0; i < 600; ++i) conversions += world.step(1.0 / 60).tc_conversions;
    std::printf("figure: collapse of three in a line at half the critical e: %llu impacts, %llu by the TC rule\n",
                static_cast<unsigned long long>(world.ledger().impacts), static_cast<unsigned long long>(conversions));
    EXPECT_GT(conversions, 0U);
    EXPECT_LT(world.ledger().impacts, 10000U);
    EXPECT_NEAR(world.momentum().x, 0, 1e-15);
}

TEST(Cradle, SymmetricTieKeepsMomentumGapsAndMirrorsAndDoesNotGainEnergy) {
    for (const double e : {1.0, 0.5, 0.0}) {
        World world;
        World mirrored;
        for (const double side : {-1.0, 0.0, 1.0}) {
            world.add({.position = {2 * side, 0, 0}, .velocity = {-side, 0, 0}, .restitution = e});
            mirrored.add({.position = {-2 * side, 0, 0}, .velocity = {side, 0, 0}, .restitution = e});
        }
        const std::vector<BodyId> ids = world.ids();
        const std::vector<BodyId> mirrored_ids = mirrored.ids();
        double least_gap = 1;
        for (int i = 0; i < 300; ++i) {
            world.step(1.0 / 60);
            mirrored.step(1.0 / 60);
            for (std::size_t k = 0; k < 3; ++k) {
                const carom::Body body = world.get(ids[k]);
                const carom::Body other = mirrored.get(mirrored_ids[k]);
                ASSERT_EQ(body.position.x, -other.position.x) << "e " << e << ", step " << i;
                ASSERT_EQ(body.velocity.x, -other.velocity.x) << "e " << e << ", step " << i;
                if (k > 0) least_gap = std::min(least_gap, body.position.x - world.get(ids[k - 1]).position.x - 1);
            }
        }
        std::printf("figure: symmetric tie of three, e = %g: momentum %.2g kg m/s, least gap %.2g m, mirrored bits\n",
                    e, world.momentum().x, least_gap);
        EXPECT_GE(least_gap, -1e-9) << e;
        EXPECT_NEAR(world.momentum().x, 0, 1e-15) << e;
        EXPECT_LE(world.energy().kinetic, 1 + 1e-15) << e;
    }
}

// Galperin, Regular and Chaotic Dynamics 8, 375 (2003): impacts between a wall, a ball of mass 1 and one of mass 100^k
// that comes in count the digits of pi.
TEST(Pi, DigitsAsImpacts) {
    constexpr std::array<std::uint64_t, 6> digits{3, 31, 314, 3141, 31415, 314159};
    double mass = 1;
    for (const std::uint64_t expected : digits) {
        carom::WorldOptions options;
        options.region = std::vector<carom::Plane>{{.normal = {1, 0, 0}}};
        options.record_impacts = false;
        World world(options);
        world.add({.position = {2, 0, 0}});
        world.add({.position = {4, 0, 0}, .velocity = {-1, 0, 0}, .mass = mass});
        for (int i = 0; i < 200; ++i) world.step(0.125);
        const std::uint64_t impacts = world.ledger().impacts + world.ledger().face_impacts;
        std::printf("figure: pi, mass %g kg: %llu impacts, energy drift %.2g\n", mass,
                    static_cast<unsigned long long>(impacts), world.energy().kinetic / (0.5 * mass) - 1);
        EXPECT_EQ(impacts, expected) << "mass " << mass;
        EXPECT_NEAR(world.energy().kinetic / (0.5 * mass), 1, 1e-10) << "mass " << mass;
        mass *= 100;
    }
}

} // namespace
