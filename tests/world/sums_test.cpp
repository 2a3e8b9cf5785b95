// Sums over all bodies, and the books that say where energy and momentum went: against closed formulas.

#include "world/nearness.hpp"
#include "world/refusals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>

namespace carom {

namespace {

using test::eps;
using test::expect_near;

class Sums : public test::BothPrecisions {};
class Books : public test::BothPrecisions {};

INSTANTIATE_TEST_SUITE_P(Precisions, Sums, test::both_precisions(), test::precision_name);
INSTANTIATE_TEST_SUITE_P(Precisions, Books, test::both_precisions(), test::precision_name);

// ---------------------------------------------------------------------------------------------------------------------
// Sums over all bodies
// ---------------------------------------------------------------------------------------------------------------------

/// Two bodies that move and a static one, with small whole numbers for everything: all sums are exact.
struct SmallNumbers {
    World world;
    BodyId first, second;

    explicit SmallNumbers(Precision precision, const Vec3& gravity = {})
        : world({.gravity = gravity, .precision = precision}) {
        first = world.add({.position = {1, 2, 3}, .velocity = {4, 0, 0}, .mass = 2});
        second = world.add({.position = {-1, 0, 8}, .velocity = {0, 2, -2}, .mass = 3});
        world.add({.position = {100, 50, 25}, .mass = infinite_mass});
    }
};

TEST_P(Sums, SumsOfSmallNumbers) {
    SmallNumbers small(GetParam(), {0, 0, -8});
    const World& world = small.world;
    EXPECT_EQ(world.energy().kinetic, 0.5 * 2 * 16 + 0.5 * 3 * 8);
    EXPECT_EQ(world.energy().potential, 8 * (2 * 3 + 3 * 8));
    EXPECT_EQ(world.energy().total(), 28 + 240);
    EXPECT_EQ(world.momentum(), (Vec3{8, 6, -6}));
    // (1, 2, 3) x (8, 0, 0) + (-1, 0, 8) x (0, 6, -6)
    EXPECT_EQ(world.angular_momentum(), (Vec3{0 - 48, 24 - 6, -16 - 6}));
    // Less (1, 1, 1) x (8, 6, -6).
    EXPECT_EQ(world.angular_momentum({1, 1, 1}), (Vec3{-48 + 12, 18 - 14, -22 + 2}));
    EXPECT_EQ(world.centre_of_mass(), (Vec3{-1.0 / 5, 4.0 / 5, 30.0 / 5}));
}

TEST_P(Sums, SumsWithoutBodiesThatMove) {
    World world({.gravity = {1, 2, 3}, .precision = GetParam()});
    world.add({.position = {1, 2, 3}, .mass = infinite_mass});
    EXPECT_EQ(world.energy().kinetic, 0);
    EXPECT_EQ(world.energy().potential, 0);
    EXPECT_EQ(world.momentum(), Vec3{});
    EXPECT_EQ(world.angular_momentum(), Vec3{});
    EXPECT_EQ(world.centre_of_mass(), Vec3{});
}

TEST_P(Sums, PotentialEnergyOfAttractors) {
    SmallNumbers small(GetParam());
    // 4 m from the first body and softened to 5, sqrt(98) from the second with softening.
    const Attractor placed{.position = {1, 2, -1}, .strength = 6, .softening = 3};
    const Attractor carried{.strength = 5, .softening = 4, .body = small.second};
    small.world.set_attractors(std::array{placed, carried});
    const double by_placed = -6 * (2 / 5.0 + 3 / std::sqrt(98.0));
    // The second body feels nothing of its own attractor.
    const double by_carried = -5 * 2 / std::sqrt(33.0 + 16);
    EXPECT_NEAR(small.world.energy().potential, by_placed + by_carried, 8 * eps * 8);
    small.world.set_attractors(std::array{carried});
    EXPECT_NEAR(small.world.energy().potential, by_carried, 8 * eps * 8);
}

TEST_P(Sums, AnotherOriginShiftsPositionsExactly) {
    SmallNumbers small(GetParam(), {0, 0, -8});
    World& world = small.world;
    world.set_attractors(std::array{Attractor{.position = {7, 7, 7}, .strength = 1}, Attractor{.body = small.first}});
    const std::uint64_t hash = world.hash();
    const Energy energy = world.energy();
    const Vec3 shift{1000, -2000, 3000};
    world.set_origin({1000, -2000, 3000});
    EXPECT_EQ(world.hash(), hash);
    EXPECT_EQ(world.energy().kinetic, energy.kinetic);
    EXPECT_EQ(world.energy().potential, energy.potential);
    EXPECT_EQ(world.get(small.first).position, (Vec3{1, 2, 3} - shift));
    EXPECT_EQ(world.get(small.second).position, (Vec3{-1, 0, 8} - shift));
    EXPECT_EQ(world.attractors()[0].position, (Vec3{7, 7, 7} - shift));
    EXPECT_EQ(world.momentum(), (Vec3{8, 6, -6}));
    EXPECT_EQ(world.angular_momentum(-shift), (Vec3{-48, 18, -22}));
    const Vec3 moment = Vec3{-1, 4, 30} - 5 * shift;
    EXPECT_EQ(world.centre_of_mass(), moment / 5);
    // What is put in is relative to the new origin as well.
    const BodyId third = world.add({.position = {5, 5, 5}});
    world.set_origin({});
    EXPECT_EQ(world.get(third).position, (Vec3{5, 5, 5} + shift));
    EXPECT_EQ(world.get(small.first).position, (Vec3{1, 2, 3}));
}

TEST_P(Sums, AnotherOriginShiftsImpactsAndPositionsBetweenSteps) {
    World here({.region = Box{{0, 0, 0}, {16, 16, 16}}, .precision = GetParam(), .interpolation = true});
    const BodyId id = here.add({.position = {8, 8, 8}, .velocity = {4, 2, 1}, .radius = 0.5});
    World there = here;
    there.set_origin({256, 128, -64});
    const Vec3 shift{256, 128, -64};
    here.step(2);
    there.step(2);
    ASSERT_EQ(here.impacts().size(), 1U);
    ASSERT_EQ(there.impacts().size(), 1U);
    EXPECT_EQ(there.impacts()[0].position, here.impacts()[0].position - shift);
    EXPECT_EQ(there.hash(), here.hash());
    Vec3 between_here;
    Vec3 between_there;
    here.positions_at(1.5, {&id, 1}, {&between_here, 1});
    there.positions_at(1.5, {&id, 1}, {&between_there, 1});
    EXPECT_EQ(between_there, between_here - shift);
}

// ---------------------------------------------------------------------------------------------------------------------
// The books
// ---------------------------------------------------------------------------------------------------------------------

/// Bodies that fly, slide, rest on the floor and on a rock, with everything that acts on them but attractors. The cap
/// bounds what a heap costs; the books are kept all the same.
World busy_world(Precision precision) {
    World world({.gravity = {0.5, -0.25, -9.81},
                 .region = Box{{0, 0, 0}, {12, 12, 30}},
                 .precision = precision,
                 .drag = {.linear = 0.05, .quadratic = 0.01},
                 .work_cap = 1000});
    world.add({.position = {6, 6, 2}, .mass = infinite_mass, .radius = 2, .restitution = 0, .friction = 0.5});
    world.add({.position = {6, 6, 4.5}, .restitution = 0, .friction = 0.5});
    world.add({.position = {2, 10, 0.5}, .velocity = {4, -1, 0}, .mass = 2, .restitution = 0, .friction = 0.125});
    world.add({.position = {10, 10, 0.5}, .mass = 3, .restitution = 0, .friction = 0.5});
    std::mt19937 random(5); // NOLINT(cert-msc51-cpp): fixed
    for (int k = 0; k < 16; ++k) {
        const auto speed = [&random] { return static_cast<double>(random() % 1024) / 128 - 4; };
        const int row = k / 4;
        world.add({.position = {1.5 + 3 * (k % 4), 1.5 + 3.0 * row, 8.0 + k % 5},
                   .velocity = {speed(), speed(), speed()},
                   .mass = 1.0 + k % 3,
                   .restitution = 0.5 + 0.0625 * (k % 8),
                   .friction = 0.0625 * (k % 4)});
    }
    return world;
}

constexpr double top_mass = 3;   ///< kg, in a busy world
constexpr double top_speed = 30; ///< m/s, more than a fall from its ceiling gives

/// How often velocities were rounded so far without being booked as they came out, at most: twice for each partner of
/// an impact, and at the end of each step.
double roundings(const World& world) {
    const Ledger& ledger = world.ledger();
    return 4.0 * static_cast<double>(ledger.impacts) + 2.0 * static_cast<double>(ledger.face_impacts) +
           static_cast<double>(world.step_count() * world.size());
}

TEST_P(Books, MomentumComesFromOutside) {
    World world = busy_world(GetParam());
    world.set_attractors(std::array{Attractor{.position = {3, 3, 15}, .strength = 20, .softening = 1},
                                    Attractor{.strength = 5, .softening = 1, .body = world.ids()[7]}});
    const Vec3 start = world.momentum();
    std::uint64_t most_held = 0;
    for (int i = 0; i < 240; ++i) most_held = std::max(most_held, world.step(1.0 / 60).held);
    EXPECT_GT(most_held, 3U);
    EXPECT_GT(world.ledger().impacts, 20U);
    // A rounding of a velocity is at most half a unit in the last place; the sums themselves add as much in double.
    const double tolerance = roundings(world) * top_mass * top_speed * (kept_eps() / 2 + 2 * eps);
    expect_near(world.momentum() - start, world.ledger().outer_impulse, tolerance, "momentum");
    // The balance means something: a single face impact is far above what it tolerates.
    EXPECT_LT(tolerance, 0.1);
}

TEST_P(Books, EnergyGoesWhereTheBooksSay) {
    World world = busy_world(GetParam());
    const double start = world.energy().total();
    for (int i = 0; i < 240; ++i) world.step(1.0 / 60);
    const Ledger& ledger = world.ledger();
    EXPECT_GT(ledger.lost_to_restitution, 10);
    EXPECT_GT(ledger.lost_to_friction, 10);
    EXPECT_GT(ledger.lost_to_drag, 10);
    EXPECT_GT(world.report().held, 3U);
    // Rounding a speed v changes m v^2 / 2 by m v times it, rounding a place moves the body along gravity.
    const double one_rounding =
        top_mass * (top_speed * top_speed * (kept_eps() / 2 + 2 * eps) + 10 * world.resolution());
    const double lost = ledger.lost_to_restitution + ledger.lost_to_friction + ledger.lost_to_drag;
    EXPECT_NEAR(start - world.energy().total(), lost, roundings(world) * one_rounding);
    EXPECT_LT(roundings(world) * one_rounding, 0.01 * lost) << "the balance tolerates too much to mean something";
}

TEST_P(Books, ComingToRestIsLostToRestitution) {
    World world({.gravity = {0, 0, -8}, .region = std::vector<Plane>{{}}, .precision = GetParam()});
    world.add({.position = {0, 0, 4.5}, .mass = 2, .restitution = 0.5});
    for (int i = 0; i < 600; ++i) world.step(1.0 / 60);
    EXPECT_EQ(world.report().held, 1U);
    // m g h, of which not even the last small bounce is missing: some 10 impacts, each rounding the speed of 8 m/s.
    const double tolerance = 32 * 2 * (8 * 8 * kept_eps() + 8 * world.resolution());
    EXPECT_NEAR(world.ledger().lost_to_restitution, 2 * 8 * 4, tolerance);
    EXPECT_EQ(world.ledger().lost_to_friction, 0);
    EXPECT_EQ(world.ledger().lost_to_drag, 0);
    // It fell with no momentum and lies with none.
    expect_near(world.ledger().outer_impulse, {}, tolerance, "outer impulse");
}

} // namespace

} // namespace carom
