// What moves as prescribed, faces and kinematic bodies, takes any momentum, at exact times of impact, and the books
// tell the work that it does.

#include "physics/balance.hpp"
#include "physics/lattice.hpp"

#include <carom/carom.hpp>

#include <gtest/gtest.h>

#include <array>
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

void run(World& world, double seconds, double dt = 1.0 / 60) {
    const double end = world.time() + seconds;
    while (world.time() < end - dt / 2) world.step(dt);
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

/// A box from 0 to `side`, without the face +z.
carom::Box open_box(double side) {
    carom::Box box{{0, 0, 0}, {side, side, side}};
    box.faces[5].kind = carom::FaceKind::open;
    return box;
}

/// A ball between a wall and a piston: each stroke makes it faster by twice the piston's speed.
TEST(Piston, GivesTwiceItsSpeedAtEachStroke) {
    carom::Box box{{0, 0, 0}, {10, 10, 10}};
    box.faces[1].motion.velocity = 0.125;
    World world({.region = box});
    const BodyId ball = world.add({.position = {2, 5, 5}, .velocity = {1, 0, 0}, .radius = 0.25});
    int strokes = 0;
    double gap = 10 - 0.5 - 1.75; // m between the ball and the piston, when the ball is at the wall
    double at_wall = -1.75;       // s
    while (strokes < 60) {
        world.step(1.0 / 64);
        for (const carom::Impact& impact : world.impacts()) {
            if (impact.face != 1) continue;
            const double speed = 1 + 0.25 * strokes;
            // From the wall the ball has gap / (v + V) to go, and back the same way.
            gap = 10 - 0.5 - 0.125 * at_wall;
            const double met = at_wall + gap / (speed + 0.125);
            EXPECT_NEAR(impact.time, met, 1e-11);
            at_wall = met + (9.5 - 0.125 * met) / (speed + 0.25);
            ++strokes;
        }
        ASSERT_NEAR(std::abs(world.get(ball).velocity.x), 1 + 0.25 * strokes, 1e-12);
    }
    EXPECT_NEAR(balance(world), 0.5, 1e-11);
    EXPECT_NEAR(std::get<carom::Box>(world.region()).max.x, 10 - 0.125 * world.time(), 1e-12);
}

/// Slow compression of a gas is adiabatic: dU = -p dV. With p V = Z N k T, Z by Carnahan & Starling (1969), that is
/// T = T0 exp(2/3 (F(eta) - F(eta0))) with F = ln eta + (4 eta - 3 eta^2) / (1 - eta)^2, from Z = 1 + eta da/deta.
TEST(Piston, CompressesAGasAdiabatically) {
    constexpr double side = 10;
    constexpr double radius = 0.1;
    constexpr int row = 10;
    constexpr double speed = 0.03;
    carom::Box box{{0, 0, 0}, {side, side, side}};
    box.faces[4].motion.velocity = speed;
    World world({.region = box});
    std::vector<BodyId> ids;
    double phase = 0;
    for (int k = 0; k < row * row * row; ++k) {
        const Vec3 cell = Vec3{0.5, 0.5, 0.5} + lattice(static_cast<std::size_t>(k), row);
        phase += 2.399963;
        const double up = 2 * ((k * 0.618034) - std::floor(k * 0.618034)) - 1;
        const double across = std::sqrt(1 - up * up);
        ids.push_back(world.add({.position = cell,
                                 .velocity = Vec3{across * std::cos(phase), across * std::sin(phase), up},
                                 .radius = radius}));
    }
    const double start = world.energy().kinetic;
    // The spheres have at most the whole room, and at least that of their centres.
    const auto packing = [&](double height, double margin) {
        const double volume = (side - margin) * (side - margin) * (height - margin);
        return row * row * row * 4.0 / 3 * std::numbers::pi * radius * radius * radius / volume;
    };
    const auto free_energy = [](double eta) {
        return std::log(eta) + (4 * eta - 3 * eta * eta) / ((1 - eta) * (1 - eta));
    };
    world.step_until(side / 2 / speed, 0.05);
    const auto heating = [&](double margin) {
        return std::exp(2.0 / 3 * (free_energy(packing(side / 2, margin)) - free_energy(packing(side, margin))));
    };
    const double least = heating(0);
    const double most = heating(2 * radius);
    const double measured = world.energy().kinetic / start;
    std::printf("figure: a gas compressed to half its volume at 0.03 of its speed: T by %.4f, adiabatic %.4f to %.4f\n",
                measured, least, most);
    // The piston does its work in some N v t / 2 L = 10^4 strokes: one standard error is 1 % of the work, 0.4 % of T.
    EXPECT_GT(measured, least * (1 - 0.01));
    EXPECT_LT(measured, most * (1 + 0.01));
    EXPECT_NEAR(balance(world), start, 1e-10 * start);
}

long double plate_gap(const carom::FaceMotion& plate, long double z, long double v, long double from, long double t) {
    const long double since = t - from;
    return z + v * since - 0.5L * g * since * since - plate.amplitude * std::sin(plate.angular_frequency * t);
}

/// A ball on a plate that vibrates: from impact to impact, against a search in long double.
TEST(Shaker, BallMeetsThePlateAtTheExactTimes) {
    for (const double strength : {1.3, 3.0, 10.0}) {
        carom::FaceMotion plate{.amplitude = 0.002};
        plate.angular_frequency = std::sqrt(strength * g / plate.amplitude);
        carom::Box box = open_box(4);
        box.faces[4].motion = plate;
        World world({.gravity = {0, 0, -g}, .region = box});
        const BodyId ball = world.add({.position = {2, 2, 0.53}, .restitution = 0.8});
        long double from = 0;
        long double z = 0.03L;
        long double v = 0;
        int impacts = 0;
        double worst = 0;
        while (impacts < 60 && world.time() < 5) {
            world.step(1.0 / 4096);
            if (world.held(ball)) break;
            ASSERT_LE(world.impacts().size(), 1U);
            if (world.impacts().empty()) continue;
            const carom::Impact& impact = world.impacts()[0];
            const long double step = 1e-5L;
            long double t = from + step;
            while (plate_gap(plate, z, v, from, t) > 0) t += step;
            long double above = t - step;
            for (int i = 0; i < 60; ++i) {
                const long double middle = (above + t) / 2;
                (plate_gap(plate, z, v, from, middle) > 0 ? above : t) = middle;
            }
            const long double speed = v - g * (t - from);
            const long double plate_speed =
                plate.amplitude * plate.angular_frequency * std::cos(plate.angular_frequency * t);
            // Positions are rounded to 2^-41 m at each impact and step: they come that much later or earlier.
            const double approach = static_cast<double>(plate_speed - speed);
            worst = std::max(worst, std::abs(static_cast<double>(impact.time - t)) * approach);
            ASSERT_NEAR(impact.approach_speed, approach, 1e-8 + 1e-8 / approach);
            // The next flight starts from what the engine has.
            from = impact.time;
            z = plate.amplitude * std::sin(plate.angular_frequency * from);
            const double flown = world.time() - impact.time;
            v = world.get(ball).velocity.z + static_cast<long double>(g) * flown;
            ++impacts;
        }
        std::printf("figure: %d impacts on a plate that shakes at %.1f g: gaps there within %.2g m\n", impacts,
                    strength, worst);
        EXPECT_GT(impacts, 15);
        // Each step rounds the height, by 2.6e-13 m rms: some 10^3 of them in a flight, and 2e4 in all, are 8e-12 m and
        // 4e-11 m, of which g makes 4e-10 J. Four times that.
        EXPECT_LE(worst, 5e-11);
        EXPECT_NEAR(balance(world), g * 0.53, 1.6e-9);
    }
}

/// Weaker than gravity, a shaker does not throw up what lies on it; stronger, it does.
TEST(Shaker, KeepsWhatItDoesNotThrow) {
    for (const double strength : {0.7, 1.5}) {
        carom::Box box = open_box(4);
        box.faces[4].surface.restitution = 0;
        box.faces[4].motion = {.amplitude = 0.01, .angular_frequency = std::sqrt(strength * g / 0.01)};
        World world({.gravity = {0, 0, -g}, .region = box});
        const BodyId ball = world.add({.position = {2, 2, 0.5}, .restitution = 0});
        run(world, 1);
        double highest = 0;
        for (int k = 0; k < 2000; ++k) {
            world.step(1e-3);
            const double plate = std::get<carom::Box>(world.region()).min.z;
            highest = std::max(highest, world.get(ball).position.z - 0.5 - plate);
        }
        std::printf("figure: at %.1f g a ball parts from the plate by %.3g m\n", strength, highest);
        if (strength < 1) {
            // Pieces of 1/480 s in which the body goes straight: the plate bends by a h^2 / 8 = 4e-6 m, and the contact
            // gives way by as much as 1.7 g / w^2 = 3e-5 m.
            EXPECT_LE(highest, 1e-5);
            EXPECT_TRUE(world.held(ball));
        } else {
            EXPECT_GT(highest, 5e-4);
        }
        EXPECT_NEAR(balance(world), g * 0.5, 1e-9);
    }
}

/// Galileo: in a lift that goes at constant velocity everything is as at rest.
TEST(Lift, IsAsARestingWorld) {
    const double speed = 3;
    const auto world_of = [&](double v) {
        carom::Box box{{0, 0, 0}, {4, 4, 4}};
        box.faces[4].motion.velocity = v;
        box.faces[5].motion.velocity = -v;
        World world({.gravity = {0, 0, -g}, .region = box});
        for (int k = 0; k < 12; ++k) {
            const Vec3 place = Vec3{0.7, 0.7, 0.7} + lattice(static_cast<std::size_t>(k), 3);
            world.add(
                {.position = place, .velocity = {0.3 * k - 1, 1 - 0.2 * k, v}, .radius = 0.3, .restitution = 0.95});
        }
        return world;
    };
    World still = world_of(0);
    World lift = world_of(speed);
    std::size_t impacts = 0;
    for (int k = 0; k < 90; ++k) {
        still.step(1.0 / 60);
        lift.step(1.0 / 60);
        ASSERT_EQ(still.impacts().size(), lift.impacts().size());
        impacts += still.impacts().size();
        for (const BodyId id : still.ids()) {
            const Vec3 there = lift.get(lift.ids()[id.slot]).position - Vec3{0, 0, speed * lift.time()};
            // Roundings of 1e-12 m grow with each impact, by a factor of some ten.
            ASSERT_NEAR(length(there - still.get(id).position), 0, 1e-6);
        }
    }
    EXPECT_GT(impacts, 40U);
    EXPECT_NEAR(lift.ledger().lost_to_restitution, still.ledger().lost_to_restitution, 1e-6);
}

/// What rests in the lift goes with it and presses on it with its weight.
TEST(Lift, CarriesAHeap) {
    carom::Box box = open_box(3);
    for (carom::Face& face : box.faces) face.surface.restitution = 0;
    box.faces[4].motion.velocity = 0.5;
    World world({.gravity = {0, 0, -g}, .region = box});
    for (int k = 0; k < 27; ++k) {
        const Vec3 cell = lattice(static_cast<std::size_t>(k), 3);
        const Vec3 place{0.5 + cell.x, 0.5 + cell.y, 0.55 + 1.05 * cell.z};
        world.add({.position = place, .radius = 0.49, .restitution = 0.2, .friction = 0.4});
    }
    const double before = balance(world);
    run(world, 8);
    double kinetic = 0;
    for (const BodyId id : world.ids()) kinetic += 0.5 * length_squared(world.get(id).velocity - Vec3{0, 0, 0.5});
    double weight = 0;
    for (const carom::Contact& contact : world.contacts()) weight += contact.face == 4 ? contact.force : 0;
    EXPECT_LE(kinetic, 27 * 1e-5);
    EXPECT_NEAR(weight, 27 * g, 1e-3 * 27 * g);
    EXPECT_NEAR(balance(world), before, 1e-9 * before);
    world.set_face_motion(4, {});
    run(world, 8);
    EXPECT_NEAR(balance(world), before, 1e-9 * before);
    EXPECT_LE(world.energy().kinetic, 27 * 1e-5);
}

/// A belt takes along what lies on it: it slides at mu g until it is as fast.
TEST(Belt, TakesAlongWhatLiesOnIt) {
    carom::Box box = open_box(100);
    box.faces[4].surface = {.restitution = 0.5, .friction = 0.4};
    box.faces[4].motion.surface_velocity = {2, 0, 0};
    World world({.gravity = {0, 0, -g}, .region = box});
    const BodyId ball = world.add({.position = {50, 50, 0.5}, .restitution = 0.5});
    run(world, 0.25, 1.0 / 64);
    // The overlap of a contact that has just formed lets friction vary a little.
    EXPECT_NEAR(world.get(ball).velocity.x, 0.25 * 0.4 * g, 0.02);
    run(world, 1, 1.0 / 64);
    EXPECT_NEAR(world.get(ball).velocity.x, 2, 1e-6);
    EXPECT_NEAR(world.get(ball).position.z, 0.5, 2e-5);
    EXPECT_EQ(std::get<carom::Box>(world.region()).min, Vec3{});
    // Half of the belt's work warms the ball.
    EXPECT_NEAR(world.ledger().prescribed_work, 4, 0.05);
    EXPECT_NEAR(world.ledger().lost_to_friction + world.ledger().lost_to_restitution, 2, 0.05);
    EXPECT_NEAR(balance(world), g * 0.5, 1e-9);
}

TEST(Face, GoesOnFromWhereItIsAndDoesNotDrift) {
    carom::Box box{{0, 0, 0}, {8, 8, 8}};
    box.faces[4].motion = {.velocity = 1e-3, .amplitude = 0.25, .angular_frequency = 10, .phase = 1};
    World world({.region = box});
    const auto floor_of = [&world] { return std::get<carom::Box>(world.region()).min.z; };
    constexpr double dt = 1e-3;
    constexpr int steps = 1'000'000;
    for (int k = 0; k < steps; ++k) world.step(dt);
    const double after = 1e-3 * dt * steps + 0.25 * (std::sin(10 * dt * steps + 1) - std::sin(1.0));
    EXPECT_NEAR(floor_of(), after, 1e-12);
    world.set_face_motion(4, {.amplitude = 0.125, .angular_frequency = 3, .phase = 2});
    EXPECT_NEAR(floor_of(), after, 1e-12);
    world.step(0.5);
    EXPECT_NEAR(floor_of(), after + 0.125 * (std::sin(3.5) - std::sin(2.0)), 1e-12);
    world.set_face_motion(4, {});
    const double stopped = floor_of();
    world.step(10);
    EXPECT_EQ(floor_of(), stopped);
    EXPECT_THROW(world.add({.position = {4, 4, stopped + 0.4}}), carom::Error);
    world.add({.position = {4, 4, stopped + 0.5}});
}

// Nobody is left whom the contacts of the pile could tell of.
TEST(Face, WhatLiesOnItMayBeTakenAway) {
    carom::Box box{{0, 0, 0}, {20, 20, 50}};
    box.faces[4].motion.velocity = 0.25;
    World world({.gravity = {0, 0, -9.81}, .region = box});
    const std::vector<BodyId> lying{world.add({.position = {2, 10, 0.5}, .restitution = 0}),
                                    world.add({.position = {5, 10, 0.5}, .restitution = 0})};
    for (int k = 0; k < 30; ++k) world.step(1.0 / 60);
    ASSERT_EQ(world.report().held, 2U);
    world.remove(lying);
    const BodyId next = world.add({.position = {10, 10, 20}, .restitution = 0});
    for (int k = 0; k < 180; ++k) world.step(1.0 / 60);
    EXPECT_TRUE(world.held(next));
}

TEST(Face, GoesOnAfterASnapshot) {
    carom::Box box = open_box(6);
    box.faces[4].motion = {.amplitude = 0.05, .angular_frequency = 20};
    box.faces[0].motion.velocity = 0.125;
    World world({.gravity = {0, 0, -g}, .region = box});
    for (int k = 0; k < 8; ++k) {
        const Vec3 cell = lattice(static_cast<std::size_t>(k), 4);
        world.add({.position = {1.5 + 1.2 * cell.x, 2 + 1.2 * cell.y, 0.7}, .restitution = 0.5, .friction = 0.2});
    }
    run(world, 1);
    world.set_face_motion(0, {.velocity = -0.0625});
    world.step(0.01);
    World loaded = World::load(world.save());
    EXPECT_EQ(loaded.hash(), world.hash());
    run(world, 2);
    run(loaded, 2);
    EXPECT_EQ(loaded.hash(), world.hash());
    EXPECT_EQ(loaded.ledger(), world.ledger());
    EXPECT_EQ(std::get<carom::Box>(loaded.region()).min, std::get<carom::Box>(world.region()).min);
    EXPECT_NEAR(world.ledger().outer_impulse.x, world.momentum().x, 1e-9);
}

TEST(Face, RefusesWhatIsNone) {
    carom::Box box{{0, 0, 0}, {4, 4, 4}};
    for (const std::size_t face : {2U, 3U}) box.faces[face].kind = carom::FaceKind::periodic;
    World world({.region = box});
    const auto refuses = [&world](const char* field, std::int32_t face, const carom::FaceMotion& motion) {
        const std::uint64_t before = world.hash();
        try {
            world.set_face_motion(face, motion);
            ADD_FAILURE() << field;
        } catch (const carom::Error& error) {
            EXPECT_EQ(error.field(), field);
        }
        EXPECT_EQ(world.hash(), before);
    };
    const double nan = std::nan("");
    refuses("face", -1, {});
    refuses("face", 6, {});
    refuses("face", 2, {});
    refuses("motion.velocity", 0, {.velocity = nan});
    refuses("motion.amplitude", 0, {.amplitude = -1});
    refuses("motion.angular_frequency", 0, {.angular_frequency = -1});
    refuses("motion.phase", 0, {.phase = nan});
    refuses("motion.surface_velocity", 0, {.surface_velocity = {1, 0, 0}});
    box.faces[2].motion.velocity = 1;
    EXPECT_THROW(World({.region = box}), carom::Error);
    // Two faces 4 m apart that come nearer at 1 m/s each.
    world.set_face_motion(0, {.velocity = 1});
    world.set_face_motion(1, {.velocity = 1});
    world.step(1.5);
    const std::uint64_t before = world.hash();
    try {
        world.step(0.75);
        ADD_FAILURE();
    } catch (const carom::Error& error) {
        EXPECT_EQ(error.code(), carom::ErrorCode::out_of_range);
        EXPECT_EQ(error.field(), "motion");
        EXPECT_EQ(error.index(), 0U);
    }
    EXPECT_EQ(world.hash(), before);
    world.set_face_motion(0, {.velocity = -1});
    world.step(0.75);
}

} // namespace
