// Coming to rest against faces and static bodies, sliding, and being let go.

#include <carom/carom.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace {

using carom::Body;
using carom::BodyId;
using carom::Vec3;
using carom::World;
using carom::WorldOptions;

constexpr double g = 9.81;

WorldOptions floor_world(const Vec3& normal = {0, 0, 1}) {
    WorldOptions options;
    options.gravity = {0, 0, -g};
    options.region = std::vector<carom::Plane>{{.normal = normal}};
    return options;
}

void run(World& world, double seconds, double dt = 1.0 / 60) {
    const double end = world.time() + seconds;
    while (world.time() < end - dt / 2) world.step(dt);
}

TEST(Rest, ABodyThatLiesStaysAndDoesNothing) {
    for (const double e : {0.0, 0.5, 1.0}) {
        World world(floor_world());
        const BodyId ball = world.add({.position = {0, 0, 0.1}, .radius = 0.1, .restitution = e});
        run(world, 10);
        EXPECT_TRUE(world.held(ball)) << e;
        EXPECT_NEAR(world.get(ball).position.z, 0.1, 2 * world.resolution());
        EXPECT_EQ(world.ledger().face_impacts, 0U) << e;
    }
}

TEST(Rest, SupportsGiveWhatPressesABody) {
    WorldOptions options;
    options.gravity = {-3, 4, -g};
    options.region = carom::Box{{0, 0, 0}, {10, 10, 10}};
    World world(options);
    world.add({.position = {1, 9, 1}, .mass = 2, .restitution = 0});
    run(world, 10);
    const std::vector<carom::Contact> contacts = world.contacts();
    ASSERT_EQ(contacts.size(), 3U);
    constexpr std::array<double, 3> expected{6, 8, 2 * g};
    constexpr std::array<std::uint32_t, 3> faces{0, 3, 4};
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(contacts[k].face, static_cast<std::int32_t>(faces.at(k)));
        EXPECT_FALSE(contacts[k].b.is_set());
        EXPECT_NEAR(contacts[k].force, expected.at(k), 1e-9);
        EXPECT_EQ(contacts[k].friction, Vec3{});
    }
    EXPECT_NEAR(length(contacts[2].position - Vec3{0.5, 9.5, 0}), 0, 1e-9);
    const std::vector<double> forces = world.face_forces();
    ASSERT_EQ(forces.size(), 6U);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(forces.at(faces.at(k)), contacts[k].force);
    EXPECT_EQ(forces[1], 0);
}

TEST(Rest, AFrictionlessBodySlidesOnForEver) {
    World world(floor_world());
    const BodyId ball = world.add({.position = {0, 0, 0.5}, .velocity = {1e-3, 0, 0}, .restitution = 0.3});
    run(world, 60);
    EXPECT_TRUE(world.held(ball));
    EXPECT_EQ(world.get(ball).velocity, (Vec3{1e-3, 0, 0}));
    EXPECT_NEAR(world.get(ball).position.x, 0.06, 1e-9);
}

TEST(Rest, FrictionStopsASlidingBody) {
    World world(floor_world());
    const BodyId ball = world.add({.position = {0, 0, 0.5}, .velocity = {3, 0, 0}, .restitution = 0, .friction = 0.5});
    run(world, 3);
    // v^2 / (2 mu g), but for the last step, which brings it to a stop evenly.
    EXPECT_NEAR(world.get(ball).position.x, 9 / (2 * 0.5 * g), 0.5 * 0.5 * g / 3600);
    EXPECT_EQ(world.get(ball).velocity, Vec3{});
    EXPECT_NEAR(world.ledger().lost_to_friction, 4.5, 1e-9);
}

TEST(Rest, ASlopeHoldsBelowTheAngleOfFrictionOnly) {
    const double mu = 0.5;
    for (const double factor : {0.99, 1.01}) {
        const double angle = std::atan(mu) * factor;
        World world(floor_world({std::sin(angle), 0, std::cos(angle)}));
        const Vec3 normal{std::sin(angle), 0, std::cos(angle)};
        const BodyId ball = world.add({.position = normal * 0.5, .restitution = 0, .friction = mu});
        run(world, 2);
        const double expected = factor < 1 ? 0 : 0.5 * (g * std::sin(angle) - mu * g * std::cos(angle)) * 4;
        EXPECT_NEAR(length(world.get(ball).position - normal * 0.5), expected, 1e-9) << factor;
        EXPECT_TRUE(world.held(ball));
    }
}

// It turns somewhere within a step: friction must not go on driving it the old way.
TEST(Rest, FrictionNeverDrivesWhatTurnsOnASlope) {
    const double angle = 0.4;
    const double mu = 0.1;
    const Vec3 normal{std::sin(angle), 0, std::cos(angle)};
    const Vec3 up{-std::cos(angle), 0, std::sin(angle)};
    const double pull = g * std::sin(angle);
    const double grip = mu * g * std::cos(angle);
    for (int i = 1; i <= 50; ++i) {
        const double speed = 0.013 * i; // m/s
        World world(floor_world(normal));
        const BodyId ball =
            world.add({.position = normal * 0.5, .velocity = up * speed, .restitution = 0, .friction = mu});
        double before = world.energy().total();
        while (world.time() < 1) {
            world.step(1.0 / 60);
            EXPECT_LE(world.energy().total(), before + 1e-9) << world.time();
            before = world.energy().total();
        }
        // In the one step in which it turns, friction may be missing.
        const double expected = (pull - grip) * (world.time() - speed / (pull + grip));
        EXPECT_NEAR(length(world.get(ball).velocity), expected, 2 * grip / 60) << speed;
        EXPECT_TRUE(world.held(ball));
    }
}

TEST(Rest, AFrictionlessSlopeIsAParabolaInOneDimension) {
    const double angle = 0.4;
    const Vec3 normal{std::sin(angle), 0, std::cos(angle)};
    World world(floor_world(normal));
    const BodyId ball = world.add({.position = normal * 0.5, .restitution = 0});
    const double start = world.energy().total();
    run(world, 3);
    EXPECT_NEAR(length(world.get(ball).velocity), g * std::sin(angle) * 3, 1e-9);
    EXPECT_NEAR(world.energy().total(), start, 1e-9);
}

TEST(Rest, InACornerAgainstThreeFaces) {
    WorldOptions options;
    options.gravity = {-3, -4, -g};
    options.region = carom::Box{{0, 0, 0}, {10, 10, 10}};
    World world(options);
    const BodyId ball = world.add({.position = {4, 5, 6}, .velocity = {1, 2, 3}, .restitution = 0.6});
    run(world, 30);
    EXPECT_TRUE(world.held(ball));
    const Body body = world.get(ball);
    EXPECT_NEAR(length(body.position - Vec3{0.5, 0.5, 0.5}), 0, 1e-11);
    EXPECT_EQ(body.velocity, Vec3{});
    EXPECT_LT(world.ledger().face_impacts, 200U);
}

TEST(Rest, InAWedgeOfSlantedPlanes) {
    WorldOptions options;
    options.gravity = {0, 0, -g};
    options.region = std::vector<carom::Plane>{
        {.normal = {1, 0, 1}}, {.normal = {-1, 0, 2}}, {.normal = {0.1, 1, 1}}, {.normal = {0, -1, 1}}};
    World world(options);
    const BodyId ball = world.add({.position = {0.2, 0.1, 3}, .restitution = 0.5, .friction = 0.1});
    run(world, 60);
    EXPECT_TRUE(world.held(ball));
    EXPECT_LE(length(world.get(ball).velocity), 1e-12);
}

TEST(Rest, StruckBodiesMoveAgain) {
    World world(floor_world());
    const BodyId ball = world.add({.position = {0, 0, 0.5}, .restitution = 0});
    const BodyId cue = world.add({.position = {-3, 0, 0.5}, .velocity = {2, 0, 0}, .restitution = 1});
    run(world, 3);
    EXPECT_EQ(world.get(ball).velocity, (Vec3{2, 0, 0}));
    EXPECT_EQ(world.get(cue).velocity, Vec3{});
    EXPECT_TRUE(world.held(ball));
    EXPECT_EQ(world.ledger().impacts, 1U);
}

TEST(Rest, ABlowFromAboveIsPassedToTheFloor) {
    World world(floor_world());
    world.add({.position = {0, 0, 0.5}, .restitution = 1});
    const BodyId upper = world.add({.position = {0, 0, 3}, .restitution = 1});
    const double start = world.energy().total();
    run(world, 20);
    EXPECT_NEAR(world.energy().total(), start, 1e-9);
    EXPECT_GT(world.get(upper).position.z, 1.5 - 1e-9);
}

TEST(Rest, LetGoWhenGravityTurnsOrTheSupportGoes) {
    WorldOptions options;
    options.gravity = {0, 0, -g};
    World world(options);
    const BodyId rock =
        world.add({.position = {0, 0, -2}, .mass = carom::infinite_mass, .radius = 2, .restitution = 0});
    const BodyId ball = world.add({.position = {0, 0, 0.5}, .restitution = 0.2});
    run(world, 1);
    EXPECT_TRUE(world.held(ball));
    EXPECT_EQ(world.get(ball).position, (Vec3{0, 0, 0.5}));
    world.remove(rock);
    EXPECT_FALSE(world.held(ball));
    run(world, 1);
    EXPECT_NEAR(world.get(ball).position.z, 0.5 - g / 2, 1e-9);
}

TEST(Rest, SlidesOffASphereWhereItShould) {
    // A body that slides from the top of a smooth sphere leaves it at the height of two thirds of the radius.
    WorldOptions options;
    options.gravity = {0, 0, -g};
    World world(options);
    world.add({.mass = carom::infinite_mass, .radius = 9.5, .restitution = 0});
    const BodyId ball = world.add({.position = {0, 0, 10}, .velocity = {0.05, 0, 0}, .restitution = 0});
    const double start = world.energy().total();
    double height = 10;
    for (int i = 0; i < 20000; ++i) {
        world.step(1.0 / 1000);
        if (i > 10 && !world.held(ball)) break;
        height = world.get(ball).position.z;
    }
    EXPECT_NEAR(height, 10 * 2.0 / 3, 0.02);
    EXPECT_NEAR(world.energy().total(), start, 0.02 * g * 10);
}

TEST(Rest, InsideAShell) {
    WorldOptions options;
    options.gravity = {0, 0, -g};
    options.region = carom::Shell{.radius = 5};
    World world(options);
    const BodyId ball = world.add({.position = {1, 0, 0}, .restitution = 0.5, .friction = 0.3});
    run(world, 60);
    EXPECT_TRUE(world.held(ball));
    EXPECT_NEAR(length(world.get(ball).position), 4.5, 1e-9);
    // Friction holds it near the bottom.
    EXPECT_LE(std::abs(world.get(ball).position.x), 4.5 * std::sin(std::atan(0.3)) + 0.01);
}

/// The largest error of the energy of a smooth body that slides inside a shell or off a static sphere for two seconds.
double energy_error(carom::Precision precision, bool shell, double dt, double* resolution) {
    WorldOptions options;
    options.gravity = {0, 0, -g};
    options.precision = precision;
    if (shell) options.region = carom::Shell{.radius = 5};
    World world(options);
    *resolution = world.resolution();
    if (!shell) world.add({.mass = carom::infinite_mass, .radius = 9.5, .restitution = 0});
    const Vec3 place = shell ? Vec3{4.5 * std::sin(1.0), 0, -4.5 * std::cos(1.0)} : Vec3{0, 0, 10};
    const BodyId ball = world.add({.position = place, .velocity = {0, shell ? 0 : 1.0, 0}, .restitution = 0});
    const double start = world.energy().total();
    double error = 0;
    while (world.time() < 2) {
        world.step(dt);
        EXPECT_TRUE(world.held(ball));
        const double booked = world.ledger().lost_to_restitution + world.ledger().lost_to_friction;
        error = std::max(error, std::abs(world.energy().total() + booked - start));
    }
    return error;
}

TEST(Rest, SlidingOnACurvedSupportKeepsEnergy) {
    for (const bool single : {false, true}) {
        const auto precision = single ? carom::Precision::single_precision : carom::Precision::double_precision;
        const double eps = single ? 0x1p-23 : 0x1p-52;
        for (const bool shell : {true, false}) {
            for (const double dt : {1.0 / 60, 1.0 / 240}) {
                double resolution = 0;
                const double error = energy_error(precision, shell, dt, &resolution);
                // Each step rounds the place twice, along gravity, and a speed of 7 m/s at most three times.
                EXPECT_LE(error, 2 / dt * (2 * g * resolution + 3 * 49 * eps)) << single << shell << dt;
            }
        }
    }
}

TEST(Rest, AShellIsAPendulum) {
    // From rest at an angle of 1 the way to the bottom takes pi / 2 sqrt(r / g) / agm(1, cos(1/2)).
    double a = 1;
    double b = std::cos(0.5);
    for (int i = 0; i < 6; ++i) {
        const double mean = (a + b) / 2;
        b = std::sqrt(a * b);
        a = mean;
    }
    constexpr double r = 4.5;
    const double quarter = std::acos(-1.0) / 2 * std::sqrt(r / g) / a;
    std::vector<double> errors;
    for (const int steps : {50, 100, 200}) {
        WorldOptions options;
        options.gravity = {0, 0, -g};
        options.region = carom::Shell{.radius = 5};
        World world(options);
        const BodyId ball = world.add({.position = {r * std::sin(1.0), 0, -r * std::cos(1.0)}, .restitution = 0});
        for (int i = 0; i < steps; ++i) world.step(quarter / steps);
        EXPECT_NEAR(length(world.get(ball).velocity), std::sqrt(2 * g * r * (1 - std::cos(1.0))), 0.01);
        errors.push_back(std::abs(world.get(ball).position.x));
    }
    EXPECT_LT(errors[0], 0.02);
    EXPECT_LT(errors[1], 0.6 * errors[0]);
    EXPECT_LT(errors[2], 0.6 * errors[1]);
}

TEST(Rest, OnAPlanetThatAttracts) {
    for (const double dt : {1.0 / 240, 1.0 / 60, 1.0 / 20}) {
        World world;
        const BodyId planet = world.add({.mass = carom::infinite_mass, .radius = 100, .restitution = 0});
        world.set_attractors(std::vector<carom::Attractor>{{.strength = 9.81e4, .body = planet}});
        const BodyId ball = world.add({.position = {0, 0, 103}, .restitution = 0.5, .friction = 0.5});
        run(world, 20, dt);
        EXPECT_TRUE(world.held(ball)) << dt;
        EXPECT_NEAR(length(world.get(ball).position), 100.5, 1e-9) << dt;
        EXPECT_LT(world.ledger().impacts, 200U) << dt;
    }
}

/// A ball that comes to lean on others that lie; walls, where there are any, keep these where they are.
struct Lean {
    const char* name;
    carom::Region region;
    std::vector<Vec3> lying;
    Vec3 leaning;
};

std::vector<Lean> leans() {
    const std::vector<carom::Plane> floor{{}};
    const std::vector<carom::Plane> floor_and_wall{{}, {.normal = {1, 0, 0}}};
    return {{"on top", floor, {{0, 0, 0.5}}, {0, 0, 1.6}},
            {"beside the top", floor, {{0, 0, 0.5}}, {0.1, 0.05, 1.6}},
            {"against a wall", floor_and_wall, {{1.2, 0, 0.5}}, {0.5, 0, 1.4}},
            {"squeezed into a box", carom::Box{{0, 0, 0}, {1.8, 1, 10}}, {{1.3, 0.5, 0.5}}, {0.5, 0.5, 1.4}},
            {"on two", floor, {{-0.5, 0, 0.5}, {0.5, 0, 0.5}}, {0, 0, 1.5}},
            {"on three", floor, {{0.6, 0, 0.5}, {-0.3, 0.52, 0.5}, {-0.3, -0.52, 0.5}}, {0, 0, 1.5}}};
}

/// Impacts of one step in which a ball leans on others, and what must hold meanwhile.
void expect_bounded(const Lean& lean, double e, double mu, double mass) {
    constexpr double dt = 1.0 / 60;
    WorldOptions options;
    options.gravity = {0, 0, -g};
    options.region = lean.region;
    // An impact per quarter of the collapse time and body: a contact alone makes one per half of it.
    const double most = 4 * dt / options.collapse_time * static_cast<double>(lean.lying.size() + 1);
    options.work_cap = static_cast<std::uint64_t>(2 * most);
    World world(options);
    for (const Vec3& x : lean.lying) world.add({.position = x, .restitution = e, .friction = mu});
    world.add({.position = lean.leaning, .mass = mass, .restitution = e, .friction = mu});
    const double start = world.energy().total();
    double lowest = start;
    double rise = 0;
    double sunk = 0;    // into the floor
    double pressed = 0; // into each other
    while (world.time() < 0.5) {
        const carom::StepReport& report = world.step(dt);
        ASSERT_LE(static_cast<double>(report.impacts + report.face_impacts), most) << world.time();
        rise = std::max(rise, world.energy().total() - lowest);
        lowest = std::min(lowest, world.energy().total());
        const std::vector<BodyId> ids = world.ids();
        for (std::size_t k = 0; k < ids.size(); ++k) {
            const Vec3 x = world.get(ids[k]).position;
            sunk = std::max(sunk, 0.5 - x.z);
            for (std::size_t l = 0; l < k; ++l) pressed = std::max(pressed, 1 - length(x - world.get(ids[l]).position));
        }
    }
    const carom::Ledger& ledger = world.ledger();
    EXPECT_NEAR(world.energy().total() + ledger.lost_to_restitution + ledger.lost_to_friction, start, 1e-9 * start);
    // A step has as many pieces as keep contacts from giving way to their loads by more; but for the step in which a
    // body comes to lean, with g rest_time at most.
    EXPECT_LT(std::max(sunk, pressed), 0.01 + (g * options.rest_time + g * dt) * dt);
    // Each contact is a spring, which swings at a quarter of the rate of the pieces, and gives back no more than it
    // took: those of the leaning ball, and those of balls of 1 kg with the floor.
    const double swing = 2 * std::numbers::pi * 0.25 * std::max(480.0, 2 * mass);
    const auto spring = [&](double m, double overlap) { return 0.5 * m * swing * swing * overlap * overlap; };
    const double springs = spring(std::min(mass, 1.0), std::max(sunk, pressed)) + spring(1, sunk);
    EXPECT_LE(rise, static_cast<double>(lean.lying.size() + 1) * springs + 1e-9 * start);
}

// In a corner three faces leave no way to slide along, and at the end of a step no time to.
TEST(Rest, ABodyComesToRestInACornerAtTheVeryEndOfAStep) {
    const auto corner = [] {
        WorldOptions options;
        options.gravity = {-3, -4, -g};
        options.region = carom::Box{{0, 0, 0}, {10, 10, 10}};
        options.record_impacts = true;
        World world(options);
        world.add({.position = {1, 2, 3}, .radius = 0.25, .restitution = 0, .friction = 0.2});
        return world;
    };
    World long_step = corner();
    long_step.step(4);
    ASSERT_EQ(long_step.contacts().size(), 3U);
    World world = corner();
    world.step(long_step.impacts().back().offset);
    world.step(1);
    const Body ball = world.get(world.ids()[0]);
    EXPECT_EQ(ball.velocity, Vec3{});
    EXPECT_NEAR(length(ball.position - Vec3{0.25, 0.25, 0.25}), 0, 4 * world.resolution());
    EXPECT_EQ(world.contacts().size(), 3U);
}

TEST(Rest, LeaningOnABodyThatLiesIsBoundedWork) {
    for (const Lean& lean : leans()) {
        for (const double e : {0.0, 0.3, 0.9}) {
            for (const double mu : {0.0, 0.5}) {
                for (const double mass : {1.0, 1000.0, 0.001}) {
                    SCOPED_TRACE(std::string(lean.name) + ", e = " + std::to_string(e) +
                                 ", mu = " + std::to_string(mu) + ", mass = " + std::to_string(mass));
                    expect_bounded(lean, e, mu, mass);
                }
            }
        }
    }
}

TEST(Rest, AHeavyBodyDoesNotSinkIntoALightOne) {
    WorldOptions options = floor_world();
    options.work_cap = 100000;
    for (const bool islands : {false, true}) {
        for (const std::uint32_t windows : {1U, 7U}) {
            options.serial_reference = !islands;
            options.min_windows = windows;
            World world(options);
            world.add({.position = {0, 0, 0.5}, .restitution = 0});
            const BodyId heavy = world.add({.position = {0, 0, 2}, .mass = 1000, .restitution = 0});
            run(world, 1);
            // Contacts hold a body M on m with pieces of h = m / (2 M) s, and give way to it by no more than h^2 M g /
            // m. In the step in which it comes to lie they swing at w = (pi / 2) 480 /s, and let it sink at M g / (20 m
            // w), by what they stay together.
            const double sunk = 1000 * g / (20 * std::numbers::pi / 2 * 480) / 60;
            EXPECT_GE(world.get(heavy).position.z, 1.5 - 1000 * g / (2000.0 * 2000.0) - sunk);
            EXPECT_LE(world.get(heavy).position.z, 1.5);
            EXPECT_LE(length(world.get(heavy).velocity), 1e-3);
            EXPECT_TRUE(world.held(heavy));
        }
    }
}

TEST(Rest, WindowsAndIslandsDoNotMatterWhereABodyLeans) {
    for (const Lean& lean : leans()) {
        std::vector<std::uint64_t> hashes;
        for (const bool reference : {true, false}) {
            for (const std::uint32_t windows : {1U, 7U}) {
                WorldOptions options;
                options.gravity = {0, 0, -g};
                options.region = lean.region;
                options.serial_reference = reference;
                options.min_windows = windows;
                World world(options);
                for (const Vec3& x : lean.lying) world.add({.position = x, .restitution = 0.3, .friction = 0.2});
                world.add({.position = lean.leaning, .mass = 2, .restitution = 0.3, .friction = 0.2});
                run(world, 0.35);
                hashes.push_back(world.hash());
            }
        }
        for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes.front()) << lean.name;
    }
}

TEST(Rest, WindowsDoNotMatterWhereABodyComesToRestAHairAboveTheFloor) {
    // It stands one unit of the resolution above the floor and reaches that in the third of seven windows of the step.
    // Meanwhile, in the second, it is struck: whether it lies by then must not depend on windows.
    std::vector<std::uint64_t> hashes;
    for (const bool reference : {true, false}) {
        for (const std::uint32_t windows : {1U, 2U, 7U}) {
            WorldOptions options;
            options.gravity = {0, 0, -0.05};
            options.region = std::vector<carom::Plane>{{.normal = {0, 0, 1}}};
            options.precision = carom::Precision::single_precision;
            options.serial_reference = reference;
            options.min_windows = windows;
            World world(options);
            const double z = 0.5 + world.resolution();
            const BodyId body = world.add({.position = {0, 0, z}, .radius = 0.5, .restitution = 0.5});
            world.add({.position = {-1.03, 0, z}, .velocity = {10, 0, 0}, .radius = 0.5, .restitution = 0.5});
            world.step(1.0 / 60);
            EXPECT_GT(world.get(body).velocity.x, 1) << "it is to be struck";
            hashes.push_back(world.hash());
        }
    }
    for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes.front());
}

TEST(Rest, AHeapWithoutAContactSolverStillEnds) {
    WorldOptions options;
    options.gravity = {0, 0, -g};
    options.region = carom::Box{{0, 0, 0}, {2, 2, 20}};
    options.work_cap = 20000;
    World world(options);
    for (int i = 0; i < 6; ++i) world.add({.position = {1 + 0.01 * (i % 3), 1, 1 + 1.5 * i}, .restitution = 0.2});
    for (int i = 0; i < 120; ++i) {
        const carom::StepReport& report = world.step(1.0 / 60);
        EXPECT_GT(report.advanced, 0);
    }
    for (const BodyId id : world.ids()) EXPECT_TRUE(std::isfinite(world.get(id).position.z));
}

} // namespace
