// What moves as prescribed: kinematic bodies take any momentum, at their exact times of impact, and the books tell the
// work they do.

#include <carom/carom.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace {

using carom::BodyId;
using carom::infinite_mass;
using carom::Vec3;
using carom::World;
using carom::WorldOptions;

constexpr double g = 9.81;

void run(World& world, double seconds, double dt = 1.0 / 60) {
    const double end = world.time() + seconds;
    while (world.time() < end - dt / 2) world.step(dt);
}

/// J: what the bodies have, and what the books say that they lost, less what was done on them. Does not change.
double balance(const World& world) {
    const carom::Ledger& ledger = world.ledger();
    return world.energy().total() + ledger.lost_to_restitution + ledger.lost_to_friction + ledger.lost_to_drag -
           ledger.prescribed_work;
}

TEST(KinematicBody, GivesTheVelocityOfTheFormulaForInfiniteMass) {
    for (const double e : {1.0, 0.5, 0.0}) {
        for (const double speed : {0.25, 3.0, -2.0}) {
            World world;
            const BodyId ball = world.add({.position = {5, 0, 0}, .velocity = {-4, 0, 0}, .mass = 3, .restitution = e});
            const BodyId ram = world.add({.velocity = {speed, 0, 0}, .mass = infinite_mass, .restitution = 0});
            const double before = balance(world);
            world.step(4);
            ASSERT_EQ(world.impacts().size(), 1U);
            EXPECT_NEAR(world.impacts()[0].offset, 4 / (4 + speed), 1e-15);
            EXPECT_NEAR(world.impacts()[0].approach_speed, 4 + speed, 1e-15);
            EXPECT_NEAR(world.get(ball).velocity.x, speed + e * (4 + speed), 1e-14);
            EXPECT_NEAR(balance(world), before, 1e-13);
            EXPECT_NEAR(world.ledger().outer_impulse.x, 3 * (world.get(ball).velocity.x + 4), 1e-13);
            EXPECT_EQ(world.get(ram).velocity, (Vec3{speed, 0, 0}));
            EXPECT_NEAR(world.get(ram).position.x, 4 * speed, 1e-12);
        }
    }
}

/// A ball between a static body and one that comes nearer: v + 2 V more after each stroke.
TEST(KinematicBody, PumpsABallUp) {
    World world;
    world.add({.mass = infinite_mass});
    const BodyId ball = world.add({.position = {3, 0, 0}, .velocity = {1, 0, 0}});
    world.add({.position = {10, 0, 0}, .velocity = {-0.125, 0, 0}, .mass = infinite_mass});
    int strokes = 0;
    while (strokes < 40) {
        world.step(1.0 / 64);
        for (const carom::Impact& impact : world.impacts()) strokes += impact.b.slot == 2 ? 1 : 0;
        ASSERT_NEAR(length(world.get(ball).velocity), 1 + 0.25 * strokes, 1e-12);
    }
    EXPECT_NEAR(balance(world), 0.5, 1e-11);
}

/// A parabola and a body that rises: a quadratic for a head-on pair.
TEST(KinematicBody, MeetsAFallingBodyAtTheExactTime) {
    World world({.gravity = {0, 0, -g}});
    const BodyId ball = world.add({.position = {0, 0, 10}, .velocity = {0, 0, 2}});
    world.add({.velocity = {0, 0, 1.5}, .mass = infinite_mass});
    // 9 + (2 - 1.5) t - g t^2 / 2 = 0
    const double time = (0.5 + std::sqrt(0.25 + 2 * g * 9)) / g;
    world.step(2);
    ASSERT_GE(world.impacts().size(), 1U);
    EXPECT_NEAR(world.impacts()[0].offset, time, 1e-14);
    EXPECT_NEAR(world.impacts()[0].approach_speed, g * time - 0.5, 1e-12);
    EXPECT_GT(world.get(ball).position.z, 1.5 * 2 + 1);
    EXPECT_NEAR(balance(world), g * 10 + 2, 1e-11);
}

TEST(KinematicBody, PassesFacesAndStaticBodiesAndGoesRoundAPeriodicWorld) {
    carom::Box box{{0, 0, 0}, {8, 8, 8}};
    for (const std::size_t face : {0U, 1U}) box.faces[face].kind = carom::FaceKind::periodic;
    World world({.gravity = {0, 0, -g}, .region = box, .drag = {.linear = 1}});
    world.add({.position = {4, 4, 4}, .mass = infinite_mass});
    const BodyId driven = world.add({.position = {2, 4, 4}, .velocity = {1, 0, 1}, .mass = infinite_mass});
    for (int k = 0; k < 640; ++k) world.step(1.0 / 64);
    EXPECT_EQ(world.ledger().impacts + world.ledger().face_impacts, 0U);
    EXPECT_NEAR(world.get(driven).position.x, 4, 1e-12);
    EXPECT_NEAR(world.get(driven).position.z, 14, 1e-12);
    EXPECT_EQ(world.momentum(), Vec3{});
    EXPECT_THROW(world.change_velocities({{driven}}, {{Vec3{1, 0, 0}}}), carom::Error);
    world.set(driven, {.position = {2, 4, 4}, .mass = infinite_mass});
    run(world, 1);
    EXPECT_EQ(world.get(driven).position, (Vec3{2, 4, 4}));
}

/// What lay on a static body that begins to move is taken along, and let lie when it stops.
TEST(KinematicBody, CarriesWhatLiesOnIt) {
    World world({.gravity = {0, 0, -g}});
    const BodyId lift = world.add({.position = {0, 0, -100}, .mass = infinite_mass, .radius = 100, .restitution = 0});
    const BodyId ball = world.add({.position = {0, 0, 0.5}, .restitution = 0.5});
    run(world, 0.5);
    EXPECT_TRUE(world.held(ball));
    EXPECT_EQ(world.report().pieces, 0U);
    const double before = balance(world);
    world.set({{lift}}, {.velocity = {{Vec3{0, 0, 1}}}});
    run(world, 4);
    EXPECT_TRUE(world.held(ball));
    // The jerk at the start throws it up; then it leans on the lift, by an overlap of g / w^2 with w = 754 /s.
    EXPECT_NEAR(world.get(ball).position.z - world.get(lift).position.z, 100.5, 2e-5);
    EXPECT_NEAR(world.get(ball).velocity.z, 1, 1e-6);
    EXPECT_NEAR(balance(world), before, 1e-9);
    const auto contacts = world.contacts();
    ASSERT_EQ(contacts.size(), 1U);
    EXPECT_NEAR(contacts[0].force, g, 1e-3);
    world.set({{lift}}, {.velocity = {{Vec3{}}}});
    run(world, 4);
    EXPECT_TRUE(world.held(ball));
    EXPECT_EQ(world.report().pieces, 0U);
    EXPECT_NEAR(balance(world), before, 1e-9);
}

/// What a ram drives into a corner has no room left: the step ends there and says so, as does the next.
TEST(KinematicBody, CrushesNothing) {
    World world({.region = carom::Box{{0, -9, -9}, {9, 9, 9}}});
    const BodyId ball = world.add({.position = {0.5, 0, 0}, .restitution = 0.5});
    world.add({.position = {2.5, 0, 0}, .velocity = {-1, 0, 0}, .mass = infinite_mass, .restitution = 0});
    const carom::StepReport report = world.step(2);
    EXPECT_TRUE(report.crushed);
    EXPECT_NEAR(report.advanced, 1, 1e-6);
    EXPECT_NEAR(report.advanced + report.behind, 2, 1e-12);
    EXPECT_NEAR(world.get(ball).position.x, 0.5, 1e-6);
    EXPECT_TRUE(world.step(1).crushed);
    EXPECT_NEAR(world.time(), 1, 1e-6);
}

} // namespace
