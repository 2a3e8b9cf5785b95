#include "scene/metrics.hpp"

#include <carom/world.hpp>

#include <gtest/gtest.h>

namespace carom::test {
namespace {

using scene::Books;

TEST(EnergyDrift, CountsBookedLossesAsStillThere) {
    const Books start{.kinetic = 10, .potential = 5};
    EXPECT_EQ(scene::energy_drift(start, {.kinetic = 8, .potential = 4, .dissipated = 3}), 0);
    EXPECT_DOUBLE_EQ(scene::energy_drift(start, {.kinetic = 8, .potential = 4, .dissipated = 3.5}), 0.05);
    EXPECT_DOUBLE_EQ(scene::energy_drift(start, {.kinetic = 20, .potential = -6}), -0.05) << "in the larger of both";
}

TEST(EnergyDrift, SeesAChangeThatAPlainSumWouldLose) {
    const Books start{.kinetic = 1, .potential = 1e17};
    const Books end{.kinetic = 3, .potential = 1e17};
    EXPECT_DOUBLE_EQ(scene::energy_drift(start, end), 2.0 / 3);
}

TEST(EnergyDrift, IsZeroWhereNothingMoves) { EXPECT_EQ(scene::energy_drift({.potential = 1}, {.potential = 2}), 0); }

/// Work and losses go through a driven heap that hardly moves itself.
TEST(EnergyBalance, IsRelativeToTheLargestEnergyAtHand) {
    const Books start{.kinetic = 1e-9, .potential = 5};
    EXPECT_EQ(scene::energy_balance(start, {.kinetic = 1e-9, .potential = 6, .dissipated = 99, .work = 100}), 0);
    EXPECT_DOUBLE_EQ(scene::energy_balance(start, {.kinetic = 1e-9, .potential = 7, .dissipated = 99, .work = 100}),
                     0.01);
    EXPECT_DOUBLE_EQ(scene::energy_balance(start, {.kinetic = 1e-9, .potential = -10}), -1.5) << "of potential ones";
    EXPECT_DOUBLE_EQ(scene::energy_balance({.kinetic = 4}, {.kinetic = 3}), -0.25);
    EXPECT_EQ(scene::energy_balance({}, {}), 0);
}

TEST(MomentumDrift, LeavesOutImpulsesFromOutside) {
    const Books start{.momentum = {1, 2, 3}, .outer_impulse = {1, 0, 0}, .momentum_scale = 8};
    const Books end{.momentum = {1, 2, 5}, .outer_impulse = {1, 0, 2}, .momentum_scale = 10};
    EXPECT_EQ(scene::momentum_drift(start, end), 0);
    const Books off{.momentum = {4, 2, 9}, .outer_impulse = {1, 0, 2}, .momentum_scale = 10};
    EXPECT_DOUBLE_EQ(scene::momentum_drift(start, off), 0.5);
    EXPECT_EQ(scene::momentum_drift({}, {}), 0);
}

TEST(Books, AreThoseOfTheWorld) {
    World world({.gravity = {0, 0, -10}});
    world.add({.position = {0, 0, 2}, .velocity = {3, 0, 4}, .mass = 2});
    world.add({.position = {9, 0, 0}, .mass = infinite_mass});
    const Books books = scene::read_books(world);
    EXPECT_DOUBLE_EQ(books.kinetic, 25);
    EXPECT_DOUBLE_EQ(books.potential, 40);
    EXPECT_DOUBLE_EQ(books.total(), 65);
    EXPECT_DOUBLE_EQ(books.momentum_scale, 10);
    EXPECT_EQ(books.momentum, (Vec3{6, 0, 8}));
    EXPECT_EQ(books.lost(), 0);
    EXPECT_EQ(books.outer_impulse, Vec3{});
}

} // namespace
} // namespace carom::test
