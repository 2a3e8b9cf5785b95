// Piles in worlds that were saved and loaded, or copied: they go on to the same bits, whatever the moment.

#include <carom/carom.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace {

using carom::BodyId;
using carom::Vec3;
using carom::World;

World box_world() { return World({.gravity = {0, 0, -10}, .region = carom::Box{{0, 0, 0}, {4, 4, 9}}}); }

/// Adds a body on the axis of the box.
BodyId stack(World& world, double height) {
    return world.add({.position = {2, 2, height}, .restitution = 0.1, .friction = 0.5});
}

/// Balls of many sizes that fall on each other; every other one grows.
World poured(unsigned seed, int count, double e, double growth) {
    std::mt19937 engine(seed);
    const auto unit = [&engine] { return static_cast<double>(engine()) / 0x1p32; };
    World world = box_world();
    for (int k = 0; k < count; ++k) {
        const double radius = 0.2 + 0.15 * unit();
        const Vec3 place{0.5 + 3 * unit(), 0.5 + 3 * unit(), 0.5 + 0.07 * count * unit()};
        try {
            world.add({.position = place,
                       .radius = radius,
                       .restitution = e,
                       .friction = 0.3,
                       .growth = k % 2 == 0 ? growth : 0});
        } catch (const carom::Error& error) {
            EXPECT_EQ(error.code(), carom::ErrorCode::overlap); // it is left out
        }
    }
    return world;
}

/// One world steps, another is saved and loaded before each step.
void expect_same_when_reloaded(World world, int steps, double dt) {
    World reloaded(world);
    for (int k = 0; k < steps; ++k) {
        reloaded = World::load(reloaded.save());
        world.step(dt);
        reloaded.step(dt);
        ASSERT_EQ(reloaded.hash(), world.hash()) << "after step " << k;
    }
}

TEST(Reload, WhileWhoSleepsIsStruck) {
    for (const double dt : {1.0 / 480, 1.0 / 60}) {
        World world = box_world();
        for (int k = 0; k < 2; ++k) stack(world, 0.5 + k);
        while (world.report().asleep < 2) world.step(1.0 / 60);
        stack(world, 4);
        expect_same_when_reloaded(std::move(world), static_cast<int>(1.2 / dt), dt);
    }
}

TEST(Reload, AfterWhatLiesInAPileWasMadeStatic) {
    for (const int steps : {30, 300}) { // awake and asleep
        for (const std::size_t place : {0U, 1U}) {
            World world = box_world();
            const std::array ids{stack(world, 0.5), stack(world, 1.5)};
            for (int k = 0; k < steps; ++k) world.step(1.0 / 60);
            const std::array mass{carom::infinite_mass};
            world.set(std::array{ids.at(place)}, {.mass = mass});
            expect_same_when_reloaded(std::move(world), 60, 1.0 / 60);
        }
    }
}

TEST(Reload, AfterAPileWasSetElsewhere) {
    World world = box_world();
    const std::array ids{stack(world, 0.5), stack(world, 1.5)};
    for (int k = 0; k < 20; ++k) world.step(1.0 / 60);
    World loaded = World::load(world.save());
    const std::array places{Vec3{3, 3, 3}, Vec3{3.1, 3, 4.2}};
    world.set(ids, {.position = places});
    loaded.set(ids, {.position = places});
    for (int k = 0; k < 100; ++k) {
        world.step(1.0 / 60);
        loaded.step(1.0 / 60);
        ASSERT_EQ(loaded.hash(), world.hash()) << k;
    }
}

TEST(Reload, WhileAPileGrows) {
    World world = poured(5, 120, 0.2, 5e-3);
    for (int k = 0; k < 400; ++k) world.step(1.0 / 250);
    expect_same_when_reloaded(std::move(world), 300, 1.0 / 250);
}

TEST(Reload, AfterTheLastThatGrewWasTakenAway) {
    for (const auto precision : {carom::Precision::single_precision, carom::Precision::double_precision}) {
        World world({.region = carom::Box{{0, 0, 0}, {4, 4, 4}}, .precision = precision});
        const BodyId grower = world.add({.position = {2, 2, 2}, .radius = 0.1, .growth = 1e-3});
        world.add({.position = {1, 1, 1}, .velocity = {1, 0.3, -0.7}, .radius = 0.3});
        world.add({.position = {3, 1, 2}, .velocity = {-1, 0.2, 0.7}, .radius = 0.3});
        world.step(0.1);
        world.remove(grower);
        expect_same_when_reloaded(std::move(world), 50, 0.1);
    }
}

/// Growth alone drives bodies together that lean on each other; in a long step it is more than lists of contacts span.
TEST(Reload, IslandsSeeWhomGrowthStrikes) {
    struct Case {
        double growth; // m/s
        double dt;     // s
        int steps;
    };
    for (const auto& [growth, dt, steps] : {Case{0.02, 0.1, 40}, Case{0.05, 0.3, 12}}) {
        for (unsigned seed = 0; seed < 6; ++seed) {
            World world = poured(seed, 30, 0.8, growth);
            World reference(world);
            reference.set_serial_reference(true);
            for (int k = 0; k < steps; ++k) {
                world.step(dt);
                reference.step(dt);
                ASSERT_EQ(world.hash(), reference.hash()) << seed << ' ' << k;
            }
        }
    }
}

TEST(Reload, CopiesHaveWhatHappenedInTheLastStep) {
    World world({.gravity = {0, 0, -10}, .region = carom::Box{{0, 0, 0}, {4, 4, 9}}, .record_contacts = true});
    stack(world, 0.6);
    std::size_t changes = 0;
    for (int k = 0; k < 60 && changes == 0; ++k) {
        world.step(1.0 / 60);
        changes = world.contact_changes().size();
    }
    ASSERT_EQ(changes, 1U);
    const World copy(world); // NOLINT(performance-unnecessary-copy-initialization): the copy is what is tested
    EXPECT_EQ(copy.contact_changes().size(), 1U);
}

/// What holds a body up is told by the attractors of now, not those of the last step.
TEST(Reload, ForcesAreThoseOfNow) {
    World world({.gravity = {0, 0, -10}, .region = carom::Box{{0, 0, 0}, {10, 10, 10}}});
    world.add({.position = {5, 5, 0.5}, .restitution = 0.1});
    world.set_attractors(std::array{carom::Attractor{.position = {5, 5, 0}, .strength = -2, .softening = 1}});
    for (int k = 0; k < 60; ++k) world.step(1.0 / 60);
    // 0.5 m above it: 2 * 0.5 / 1.25^1.5 less than the weight.
    const double lighter = 10 - 1 / std::pow(1.25, 1.5);
    ASSERT_EQ(world.contacts().size(), 1U);
    EXPECT_NEAR(world.contacts()[0].force, lighter, 1e-9);
    EXPECT_EQ(World::load(world.save()).contacts()[0].force, world.contacts()[0].force);
    world.set_attractors({});
    EXPECT_EQ(world.contacts()[0].force, 10);
}

/// Positions and the region are told from the same origin, and a world made of a region that moves goes on like it.
TEST(Reload, TheRegionIsThatOfNow) {
    carom::Box box{{0, 0, 0}, {10, 10, 10}};
    box.faces[4].motion = {.velocity = 0.1, .amplitude = 0.5, .angular_frequency = 3};
    World world({.region = box});
    world.step(1);
    World again({.region = world.region()});
    world.set_origin({100, 0, 0});
    for (int k = 0; k < 3; ++k) {
        world.step(0.5);
        again.step(0.5);
        const auto here = std::get<carom::Box>(world.region());
        const auto there = std::get<carom::Box>(again.region());
        EXPECT_NEAR(here.min.z, there.min.z, 1e-11);
        EXPECT_EQ(here.min.x, -100);
        EXPECT_EQ(here.max.x, -90);
        EXPECT_EQ(there.max.x, 10);
    }
}

TEST(Reload, PlanesAndShellsAreThoseOfNow) {
    const carom::FaceMotion motion{.velocity = 0.1, .amplitude = 0.5, .angular_frequency = 3};
    World world({.region = std::vector<carom::Plane>{{.point = {1, 2, 0}, .motion = motion}}});
    world.step(1);
    World again({.region = world.region()});
    world.set_origin({100, 0, 0});
    world.step(0.5);
    again.step(0.5);
    const carom::Plane here = std::get<std::vector<carom::Plane>>(world.region()).front();
    const carom::Plane there = std::get<std::vector<carom::Plane>>(again.region()).front();
    EXPECT_EQ(here.point.x, -99);
    EXPECT_NEAR(here.point.z, there.point.z, 1e-11);
    EXPECT_GT(std::abs(here.point.z), 0.01);

    World shell({.region = carom::Shell{.centre = {1, 2, 3}, .radius = 5}});
    shell.set_origin({100, 0, 0});
    EXPECT_EQ(std::get<carom::Shell>(shell.region()).centre, (Vec3{-99, 2, 3}));
}

} // namespace
