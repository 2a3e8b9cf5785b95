// Frustums that turn: what their friction does to bodies that strike them, or lie on them.

#include "physics/lattice.hpp"

#include <carom/carom.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>

namespace {

using carom::BodyId;
using carom::Frustum;
using carom::Vec3;
using carom::World;
using carom::test::lattice;

constexpr double g = 9.81;
constexpr double dt = 1.0 / 60;

void run(World& world, double seconds) {
    for (int k = 0; k < static_cast<int>(std::lround(seconds / dt)); ++k) world.step(dt);
}

/// A disc of 2 m that makes 3 rad/s, counted against the clock if seen from above.
Frustum turntable() { return {.height = 0, .base_radius = 0, .top_radius = 2, .angular_velocity = 3}; }

// A ball comes down on a turntable 1 m from its axis, where that goes at 3 m/s. With what presses it on, (1 + e) m v,
// friction gives it mu (1 + e) v, but no more than the 3 m/s.
TEST(Turning, AnImpactTakesBodiesAlong) {
    for (const double mu : {0.2, 2.0}) {
        World world({.obstacles = {turntable()}});
        const BodyId id = world.add({.position = {1, 0, 0.75},
                                     .velocity = {0, 0, -2},
                                     .mass = 2,
                                     .radius = 0.5,
                                     .restitution = 0.5,
                                     .friction = mu});
        run(world, 0.25);
        const double taken = std::min(mu * 1.5 * 2, 3.0);
        const Vec3 v = world.get(id).velocity;
        EXPECT_NEAR(length(v - Vec3{0, taken, 1}), 0, 1e-14) << mu;
        const carom::Ledger books = world.ledger();
        EXPECT_NEAR(books.prescribed_work, 2 * taken * 3, 1e-13) << mu;
        EXPECT_NEAR(books.lost_to_restitution, 0.5 * 2 * (4 - 1), 1e-13) << mu;
        // Half m of the squares of the sliding.
        EXPECT_NEAR(books.lost_to_friction, 0.5 * 2 * (9 - (3 - taken) * (3 - taken)), 1e-13) << mu;
    }
}

/// A drum of 2 m that lies along y, and takes a ball at its bottom towards +x; 1.5 m are left for the ball's centre.
Frustum drum(double angular_velocity) {
    return {.base = {0, -1, 0},
            .axis = {0, 1, 0},
            .height = 2,
            .base_radius = 2,
            .top_radius = 2,
            .angular_velocity = -angular_velocity};
}

/// rad, from the bottom towards +x.
double angle_of(const World& world, BodyId id) {
    const Vec3 x = world.get(id).position;
    return std::atan2(x.x, -x.z);
}

BodyId add_ball(World& world, double angle, double friction) {
    return world.add({.position = {1.5 * std::sin(angle), 0, -1.5 * std::cos(angle)},
                      .radius = 0.5,
                      .restitution = 0.3,
                      .friction = friction});
}

// The ball goes with the wall: its centre, 1.5 m from the axis, no slower than that at 2 m, once friction has brought
// it up to that speed u, in u / (mu g).
TEST(Turning, ASlowDrumTakesABallAlong) {
    World world({.gravity = {0, 0, -g}, .obstacles = {drum(0.2)}});
    const BodyId id = add_ball(world, 0, 0.5);
    run(world, 1);
    const double wall = 0.2 * 2;
    const double way = wall - 0.5 * wall * wall / (0.5 * g);
    EXPECT_NEAR(angle_of(world, id) * 1.5, way, 0.005 * way);
    EXPECT_NEAR(length(world.get(id).velocity), wall, 0.005 * wall);
}

// Where the wall slides under it, friction carries the ball at the angle whose tangent is mu: there it stays.
TEST(Turning, AFastDrumHoldsABallUpAtTheAngleOfFriction) {
    constexpr double mu = 0.3;
    World world({.gravity = {0, 0, -g}, .obstacles = {drum(5)}});
    const BodyId id = add_ball(world, std::atan(mu), mu);
    double lowest = 10;
    double highest = 0;
    for (int k = 0; k < 300; ++k) {
        world.step(dt);
        lowest = std::min(lowest, angle_of(world, id));
        highest = std::max(highest, angle_of(world, id));
    }
    std::printf("figure: a ball in a turning drum hangs at tan(angle) = %.4f to %.4f, mu = %.2f\n", std::tan(lowest),
                std::tan(highest), mu);
    EXPECT_NEAR(std::tan(lowest), mu, 0.01 * mu);
    EXPECT_NEAR(std::tan(highest), mu, 0.01 * mu);
    // The force along the wall, m g sin(angle), goes with the wall's 10 m/s; the ball keeps none of that work.
    const double work = g * std::sin(std::atan(mu)) * 10 * 300 * dt;
    const carom::Ledger books = world.ledger();
    EXPECT_NEAR(books.prescribed_work, work, 0.01 * work);
    EXPECT_NEAR(books.lost_to_friction + books.lost_to_restitution, work, 0.01 * work);
}

// Without friction nobody knows that a drum turns: not whether a ball bounces, nor whether it rests, nor how it swings.
TEST(Turning, MakesNoDifferenceWithoutFriction) {
    for (const double height : {0.003, 0.005, 0.05}) {
        World still({.gravity = {0, 0, -g}, .obstacles = {drum(0)}});
        World turning({.gravity = {0, 0, -g}, .obstacles = {drum(20)}});
        const auto add = [height](World& world) {
            return world.add(
                {.position = {0.2, 0, height - std::sqrt(1.5 * 1.5 - 0.2 * 0.2)}, .radius = 0.5, .restitution = 0.5});
        };
        const BodyId a = add(still);
        const BodyId b = add(turning);
        for (int k = 0; k < 60; ++k) {
            for (World* world : {&still, &turning}) world->step(dt);
            ASSERT_NEAR(length(turning.get(b).position - still.get(a).position), 0, 1e-9) << height << ", step " << k;
            ASSERT_EQ(turning.held(b), still.held(a)) << height << ", step " << k;
        }
        EXPECT_TRUE(still.held(a));
    }
}

/// 48 balls in a drum that turns at 2 rad/s.
World stirred_heap(carom::WorldOptions options) {
    const Frustum plate{.axis = {0, 1, 0}, .height = 0, .base_radius = 0, .top_radius = 2};
    Frustum front = plate;
    Frustum back = plate;
    front.base = {0, -1, 0};
    back.base = {0, 1, 0};
    options.gravity = {0, 0, -g};
    options.obstacles = {drum(2), front, back};
    World world(options);
    for (std::size_t k = 0; k < 48; ++k) {
        world.add({.position = lattice(k, 4) * 0.45 - Vec3{0.7, 0.7, 0.7},
                   .mass = 1,
                   .radius = 0.2,
                   .restitution = 0.4,
                   .friction = 0.5});
    }
    return world;
}

// What the wall gives is booked: the energy of a heap that it stirs comes out right.
TEST(Turning, TheBooksOfAStirredHeapBalance) {
    World world = stirred_heap({});
    const double before = world.energy().kinetic + world.energy().potential;
    run(world, 6);
    const carom::Ledger books = world.ledger();
    const double after = world.energy().kinetic + world.energy().potential;
    EXPECT_GT(books.prescribed_work, 10);
    EXPECT_NEAR(after + books.lost_to_restitution + books.lost_to_friction, before + books.prescribed_work,
                1e-9 * books.prescribed_work);
    Vec3 centre{};
    for (const BodyId id : world.ids()) centre += world.get(id).position / 48;
    std::printf("figure: the centre of a heap in a turning drum stands %.3f m beside the axis\n", centre.x);
    EXPECT_GT(centre.x, 0.2);
}

// Blows make balls of the heap strike the wall on which they lie.
TEST(Turning, NoResultDependsOnSolverThreadsOrWindows) {
    World islands = stirred_heap({.threads = 1});
    World serial = stirred_heap({.serial_reference = true});
    World windows = stirred_heap({.min_windows = 7, .threads = 3});
    for (int k = 0; k < 180; ++k) {
        for (World* world : {&islands, &serial, &windows}) {
            for (const BodyId id : world->ids()) {
                if ((id.slot + static_cast<std::uint32_t>(k)) % 8 == 0)
                    world->apply_impulses({{id}}, {{{0.6, 0.1, -0.6}}});
            }
            world->step(dt);
        }
        ASSERT_EQ(islands.hash(), serial.hash()) << "step " << k;
        ASSERT_EQ(islands.hash(), windows.hash()) << "step " << k;
    }
}

} // namespace
