// Bodies whose radii grow: exact times of impact, what growth does to them, and compression to dense packings.

#include "physics/balance.hpp"
#include "physics/lattice.hpp"
#include "scene/overlap_search.hpp"

#include <carom/carom.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

namespace {

using carom::BodyId;
using carom::infinite_mass;
using carom::Vec3;
using carom::World;
using carom::test::balance;
using carom::test::lattice;

constexpr double g = 9.81;

/// Two bodies, one of which grows: |4 - 0.5 t| = 1 + 0.25 t, and then the surfaces part at e times their approach.
TEST(Growth, APairMeetsAtTheExactTimeAndParts) {
    for (const double e : {1.0, 0.5, 0.0}) {
        for (const auto precision : {carom::Precision::double_precision, carom::Precision::single_precision}) {
            World world({.precision = precision});
            const BodyId a = world.add({.mass = 2, .restitution = e, .growth = 0.25});
            const BodyId b = world.add({.position = {4, 0, 0}, .velocity = {-0.5, 0, 0}, .mass = 3, .restitution = 0});
            const double before = balance(world);
            const bool is_double = precision == carom::Precision::double_precision;
            const double rounding = is_double ? 1e-14 : 1e-6;
            world.step(5);
            ASSERT_EQ(world.impacts().size(), 1U);
            EXPECT_NEAR(world.impacts()[0].offset, 4, 4 * rounding);
            EXPECT_NEAR(world.impacts()[0].approach_speed, 0.75, rounding);
            EXPECT_NEAR(world.get(b).velocity.x - world.get(a).velocity.x, e * 0.75 + 0.25, rounding);
            EXPECT_NEAR(world.momentum().x, -1.5, 3 * rounding);
            EXPECT_NEAR(balance(world), before, 10 * rounding);
            EXPECT_EQ(world.get(a).radius, 0.5 + 5 * 0.25);
            EXPECT_EQ(world.get(a).growth, 0.25);
            EXPECT_EQ(world.get(b).radius, 0.5);
            // Now as fast as the surfaces are, it does not catch up.
            world.step(3);
            EXPECT_EQ(world.report().impacts, 0U);
        }
    }
}

/// A ball above a static one that grows, and a growing ball above the floor: |z| = R + G t with gravity is a quadratic.
TEST(Growth, FallingBodiesMeetWhatGrowsAtTheExactTime) {
    World world({.gravity = {0, 0, -g}, .region = std::vector<carom::Plane>{{.point = {0, 0, -5}}}});
    world.add({.mass = infinite_mass, .radius = 1, .growth = 0.5});
    const BodyId above = world.add({.position = {0, 0, 6}, .velocity = {0, 0, 1}});
    const BodyId aside = world.add({.position = {20, 0, 0}, .restitution = 0.5, .growth = 0.75});
    world.step(1.25);
    ASSERT_EQ(world.impacts().size(), 2U);
    // 4.5 + (1 - 0.5) t = g t^2 / 2, and the same with 4.5 - 0.75 t.
    const double pair = (0.5 + std::sqrt(0.25 + 2 * g * 4.5)) / g;
    const double wall = (-0.75 + std::sqrt(0.75 * 0.75 + 2 * g * 4.5)) / g;
    EXPECT_EQ(world.impacts()[0].a, aside);
    EXPECT_NEAR(world.impacts()[0].offset, wall, 1e-14);
    // The speed is that of the fall at the rounded place, up to 2^-41 m away: g / (9 m/s) times that.
    EXPECT_NEAR(world.impacts()[0].approach_speed, g * wall + 0.75, 6e-13);
    EXPECT_NEAR(world.impacts()[1].offset, pair, 1e-14);
    EXPECT_NEAR(world.impacts()[1].approach_speed, g * pair - 1 + 0.5, 6e-13);
    EXPECT_NEAR(world.get(above).velocity.z, g * pair - 1 + 2 * 0.5 - g * (1.25 - pair), 1e-12);
    EXPECT_NEAR(balance(world), g * 6 + 0.5, 1e-10);
}

TEST(Growth, InAShell) {
    for (const double gravity : {0.0, -g}) {
        World world({.gravity = {0, 0, gravity}, .region = carom::Shell{.radius = 10}});
        world.add({.position = {0, 0, 1}, .velocity = {0, 0, -2}, .growth = 0.5});
        world.step(5);
        ASSERT_GE(world.impacts().size(), 1U);
        // 10 - 0.5 - 0.5 t = -(1 - 2 t + gravity t^2 / 2)
        const double time = gravity == 0 ? 10.5 / 2.5 : (-2.5 + std::sqrt(2.5 * 2.5 + 2 * g * 10.5)) / g;
        EXPECT_NEAR(world.impacts()[0].offset, time, 1e-14);
        EXPECT_NEAR(balance(world), 2 - gravity, 1e-9);
    }
}

/// Growing bodies in a box under gravity: what grows leans, and does not fall through.
TEST(Growth, LiftsWhatLiesOnIt) {
    carom::Box box{{0, 0, 0}, {2, 2, 9}};
    World world({.gravity = {0, 0, -g}, .region = box});
    const BodyId below = world.add({.position = {1, 1, 0.5}, .restitution = 0.2, .growth = 0.05});
    const BodyId above = world.add({.position = {1, 1, 1.5}, .restitution = 0.2});
    const double before = balance(world);
    for (int k = 0; k < 240; ++k) world.step(1.0 / 60);
    // Contacts follow what grows: they give way by a weight or two, and a piece's growth, 0.05 m/s / 480 /s.
    EXPECT_NEAR(world.get(below).radius, 0.7, 1e-12);
    EXPECT_NEAR(world.get(below).position.z, 0.7, 2e-3);
    EXPECT_NEAR(world.get(above).position.z, 1.9, 4e-3);
    EXPECT_NEAR(balance(world), before, 1e-9);
}

/// Faster than contacts bear, it is a blow: the one above gets its growth, and e times what it came with.
TEST(Growth, StrikesWhatLiesOnIt) {
    World world({.gravity = {0, 0, -g}, .region = carom::Box{{0, 0, 0}, {2, 2, 9}}, .sleeping = false});
    const BodyId below = world.add({.position = {1, 1, 0.5}, .mass = 1e6, .restitution = 0.2});
    const BodyId above = world.add({.position = {1, 1, 1.5}, .restitution = 0.2});
    for (int k = 0; k < 120; ++k) world.step(1.0 / 60);
    ASSERT_LT(world.energy().kinetic, 1e-9);
    world.set({{below}}, {.growth = {{1.0}}});
    world.step(1.0 / 480);
    const auto is_theirs = [&](const carom::Impact& i) { return i.b.is_set(); };
    ASSERT_GE(std::ranges::count_if(world.impacts(), is_theirs), 1);
    EXPECT_NEAR(std::ranges::find_if(world.impacts(), is_theirs)->approach_speed, 1, 0.05);
    EXPECT_GT(world.get(above).velocity.z, 1.1);
}

/// A growing ball above a plate's face, beside its edge and its corner, and outside and inside a tube: always 1.5 m
/// from touching, so after 6 s of 0.25 m/s, and then the surfaces part at e times their approach.
TEST(Growth, AnObstacleIsMetAtTheExactTime) {
    const carom::Mesh plate{.vertices = {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}}, .triangles = {{0, 1, 2}}};
    const carom::Frustum tube{.height = 4, .base_radius = 4, .top_radius = 4};
    const double diagonal = std::sqrt(2.0);
    struct Case {
        carom::Obstacle obstacle;
        Vec3 place;
        Vec3 away; ///< unit vector, the way the ball is thrown
    };
    const std::vector<Case> cases{
        {plate, {3, 3, 2}, {0, 0, 1}},   {plate, {3, 3, -2}, {0, 0, -1}},
        {plate, {3, -2, 0}, {0, -1, 0}}, {plate, {-diagonal, -diagonal, 0}, {-1 / diagonal, -1 / diagonal, 0}},
        {tube, {0, 6, 2}, {0, 1, 0}},    {tube, {2, 0, 2}, {-1, 0, 0}},
        {tube, {4, 0, 6}, {0, 0, 1}}};
    for (const Case& c : cases) {
        for (const double e : {1.0, 0.5}) {
            World world({.obstacles = {c.obstacle}});
            const BodyId id = world.add({.position = c.place, .restitution = e, .growth = 0.25});
            const double before = balance(world);
            world.step(6.5);
            ASSERT_EQ(world.impacts().size(), 1U);
            EXPECT_NEAR(world.impacts()[0].offset, 6, 1e-10); // 2^-40 m / (0.25 m/s), and the root of 2
            EXPECT_NEAR(world.impacts()[0].approach_speed, 0.25, 1e-12);
            EXPECT_LT(length(world.get(id).velocity - c.away * (0.25 * (1 + e))), 1e-11);
            EXPECT_NEAR(balance(world), before, 1e-14);
        }
    }
}

/// A ball as small as the roundings of its place is not rounded through a plate.
TEST(Growth, WhatShrinksToNothingDoesNotPassAPlate) {
    const carom::Mesh plate{.vertices = {{-5, -5, 0}, {5, -5, 0}, {0, 9, 0}}, .triangles = {{0, 1, 2}}};
    constexpr double radius = 64 * 0x1p-40;
    for (int k = 0; k <= 400; ++k) {
        World world({.obstacles = {plate}});
        const double height = 0.99 + k * 0.01 / 400;
        const BodyId id = world.add({.position = {0.1, 0.2, height + 0.01 * radius},
                                     .velocity = {0.002 * k, -0.001 * k, -1},
                                     .radius = radius,
                                     .restitution = 1,
                                     .growth = -radius});
        world.step(1);
        EXPECT_GT(world.get(id).position.z, 0) << k;
    }
}

/// As LiftsWhatLiesOnIt, on a plate instead of a floor: what grows there does not sink through.
TEST(Growth, WhatLiesOnAnObstacleMayGrow) {
    const carom::Mesh plate{.vertices = {{-5, -5, 0}, {5, -5, 0}, {0, 9, 0}}, .triangles = {{0, 1, 2}}};
    World world({.gravity = {0, 0, -g}, .obstacles = {plate}});
    const BodyId id = world.add({.position = {0, 0, 0.6}, .restitution = 0.2, .growth = 0.05});
    const double before = balance(world);
    for (int k = 0; k < 240; ++k) world.step(1.0 / 60);
    EXPECT_NEAR(world.get(id).radius, 0.7, 1e-12);
    EXPECT_NEAR(world.get(id).position.z, 0.7, 2e-3);
    EXPECT_NEAR(world.get(id).velocity.z, 0.05, 1e-3);
    EXPECT_NEAR(balance(world), before, 1e-9);
    world.set({{id}}, {.growth = {{-0.1}}});
    for (int k = 0; k < 240; ++k) world.step(1.0 / 60);
    EXPECT_NEAR(world.get(id).position.z, 0.3, 2e-3);
    EXPECT_NEAR(balance(world), before, 1e-9);
}

TEST(Growth, IsRefusedWhereItLeadsNowhere) {
    carom::Box box{{0, 0, 0}, {8, 8, 8}};
    for (const std::size_t face : {0U, 1U}) box.faces[face].kind = carom::FaceKind::periodic;
    World world({.region = box});
    const BodyId id = world.add({.position = {4, 4, 4}, .growth = 1});
    world.step(1.25);
    const auto refuses = [&](double dt) {
        const std::uint64_t before = world.hash();
        try {
            world.step(dt);
            ADD_FAILURE() << dt;
        } catch (const carom::Error& error) {
            EXPECT_EQ(error.code(), carom::ErrorCode::out_of_range);
            EXPECT_EQ(error.field(), "growth");
            EXPECT_EQ(error.index(), id.slot);
        }
        EXPECT_EQ(world.hash(), before);
    };
    // A quarter of the period is 2 m.
    refuses(0.3);
    world.set({{id}}, {.growth = {{-1.0}}});
    world.step(1.75);
    EXPECT_EQ(world.get(id).radius, 0);
    refuses(0.125);
    world.set({{id}}, {.radius = {{1.0}}, .growth = {{0.0}}});
    world.step(1);
    EXPECT_EQ(world.get(id).radius, 1);
    EXPECT_THROW(world.set({{id}}, {.growth = {{std::nan("")}}}), carom::Error);
    EXPECT_THROW(world.add({.position = {4, 4, 6}, .growth = std::nan("")}), carom::Error);
}

TEST(Growth, GoesOnAfterASnapshotAndBodiesComeAndGo) {
    World world({.region = carom::Box{{0, 0, 0}, {8, 8, 8}}});
    for (std::size_t k = 0; k < 27; ++k) {
        const auto number = static_cast<int>(k);
        world.add({.position = Vec3{1, 1, 1} + lattice(k, 3) * 2.5,
                   .velocity = {0.3 * (number % 5) - 0.6, 0.2 * (number % 7) - 0.6, 0.4},
                   .growth = k % 2 == 0 ? 0.02 : 0});
    }
    for (int k = 0; k < 100; ++k) world.step(0.02);
    World loaded = World::load(world.save());
    EXPECT_EQ(loaded.hash(), world.hash());
    EXPECT_EQ(world.save(), loaded.save());
    for (World* w : {&world, &loaded}) {
        w->remove(w->ids()[3]);
        w->add({.position = w->get(w->ids()[4]).position, .radius = 0.1}, carom::Overlap::accept);
        for (int k = 0; k < 100; ++k) w->step(0.02);
        EXPECT_NEAR(w->get(w->ids()[0]).radius, 0.5 + 0.02 * w->time(), 1e-13);
    }
    EXPECT_EQ(loaded.hash(), world.hash());
    EXPECT_GT(world.ledger().impacts, 10U);
}

/// Lubachevsky & Stillinger, J. Stat. Phys. 60, 561 (1990): spheres in a periodic box grow from a fluid to a packing
/// that no random insertion reaches. No two overlap on the way.
TEST(Growth, CompressesAFluidToADensePacking) {
    constexpr int row = 9;
    constexpr int count = row * row * row;
    carom::Box box{{0, 0, 0}, {row, row, row}};
    for (carom::Face& face : box.faces) face.kind = carom::FaceKind::periodic;
    // Lists of neighbours last for several windows, and begin in any of them.
    World world({.region = box});
    const auto radius_of = [](double packing) { return std::cbrt(packing * 3 / (4 * std::numbers::pi)); };
    std::vector<Vec3> positions;
    std::vector<Vec3> velocities;
    for (int k = 0; k < count; ++k) {
        positions.push_back(Vec3{0.5, 0.5, 0.5} + lattice(static_cast<std::size_t>(k), row));
        const double turn = 2.399963 * k;
        const double up = 2 * (k * 0.618034 - std::floor(k * 0.618034)) - 1;
        const double across = std::sqrt(1 - up * up);
        velocities.push_back({across * std::cos(turn), across * std::sin(turn), up});
    }
    constexpr double growth = 0.02;
    const double start = radius_of(0.1);
    const double duration = (radius_of(0.6) - start) / growth;
    const std::vector<double> radii(count, start);
    const std::vector<double> rates(count, growth);
    const std::vector<BodyId> ids =
        world.add({.position = positions, .velocity = velocities, .radius = radii, .growth = rates});
    constexpr int steps = 200;
    double worst = 0;
    double largest_imbalance = 0;
    carom::scene::OverlapSearch search(world);
    for (int k = 0; k < steps; ++k) {
        const double before = balance(world);
        world.step(duration / steps);
        largest_imbalance = std::max(largest_imbalance, std::abs(balance(world) / before - 1));
        worst = std::max(worst, search.find(world).largest);
        // Growth heats the fluid.
        world.get(ids, {.velocity = velocities});
        const double scale = std::sqrt(count / (2 * world.energy().kinetic));
        for (Vec3& v : velocities) v *= scale;
        world.set(ids, {.velocity = velocities});
    }
    const double radius = world.get(ids[7]).radius;
    std::printf("figure: %d spheres compressed to packing %.6f with %llu impacts, largest overlap %.2g diameters\n",
                count, 4 * std::numbers::pi / 3 * radius * radius * radius,
                static_cast<unsigned long long>(world.ledger().impacts), worst);
    EXPECT_NEAR(radius, radius_of(0.6), 1e-12);
    EXPECT_LE(worst, 1e-10);
    EXPECT_LE(largest_imbalance, 1e-12);
    EXPECT_GT(world.ledger().impacts, 50U * count);
}

} // namespace
