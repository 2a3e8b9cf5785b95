// Piles: bodies that lean on others that move come to rest, and what they rest on carries them.

#include "scene/overlap_search.hpp"

#include <carom/carom.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <tuple>
#include <vector>

namespace {

using carom::BodyId;
using carom::Vec3;
using carom::World;
using carom::WorldOptions;

constexpr double g = 9.81;
constexpr double dt = 1.0 / 60;

/// Its bodies stay awake: what is tested is the pile.
WorldOptions box_world(double side) {
    WorldOptions options;
    options.sleeping = false;
    options.gravity = {0, 0, -g};
    carom::Box box{{0, 0, 0}, {side, side, 100}};
    for (carom::Face& face : box.faces) face.surface.restitution = 0;
    box.faces[5].kind = carom::FaceKind::open;
    options.region = box;
    return options;
}

/// Spheres that fall as a lattice, a little out of order.
World heap(int side, int layers, double friction, WorldOptions options) {
    World world(std::move(options));
    const double spacing = 1.1;
    for (int k = 0; k < layers; ++k) {
        for (int j = 0; j < side; ++j) {
            for (int i = 0; i < side; ++i) {
                const Vec3 off{0.02 * std::sin(3.0 * i + 7 * j + 11 * k), 0.02 * std::sin(5.0 * i + 2 * j + 3 * k), 0};
                world.add({.position = Vec3{0.5 + i, 0.5 + j, 0.5 + k} * spacing + off,
                           .restitution = 0.3,
                           .friction = friction});
            }
        }
    }
    return world;
}

void run(World& world, double seconds, double step = dt) {
    const double end = world.time() + seconds;
    while (world.time() < end - step / 2) world.step(step);
}

double kinetic_per_body(const World& world) { return world.energy().kinetic / static_cast<double>(world.size()); }

TEST(Pile, AHeapComesToRestAndNothingIsDampedOnTheWay) {
    World world = heap(4, 10, 0.5, box_world(4.4));
    const double start = world.energy().total();
    run(world, 10);
    carom::scene::OverlapSearch search(world);
    const auto overlaps = search.find(world);
    const carom::Ledger& ledger = world.ledger();
    std::printf(
        "figure: a heap of 160 after 10 s: %.2g J of kinetic energy a body, overlap %.2g diameters (mean %.2g)\n",
        kinetic_per_body(world), overlaps.largest, overlaps.mean);
    EXPECT_LE(kinetic_per_body(world), 1e-5);
    EXPECT_LE(overlaps.mean, 0.003);
    EXPECT_LE(overlaps.largest, 0.02);
    EXPECT_EQ(world.report().held, world.size());
    EXPECT_GE(world.report().contacts, world.size());
    EXPECT_GT(world.report().seconds.contacts, 0);
    EXPECT_NEAR(world.energy().total() + ledger.lost_to_restitution + ledger.lost_to_friction, start, 1e-9 * start);
}

WorldOptions sleepy_world(double side) {
    WorldOptions options = box_world(side);
    options.sleeping = true;
    return options;
}

TEST(Contacts, ChangesAddUpToWhatThereIs) {
    WorldOptions options = sleepy_world(4.4);
    options.record_contacts = true;
    World world = heap(4, 6, 0.5, options);
    std::vector<carom::ContactChange> there;
    const auto key = [](const auto& c) { return std::tuple(c.a.slot, c.b.slot, c.face); };
    const auto in_order = [&](const auto& x, const auto& y) { return key(x) < key(y); };
    std::size_t ended = 0;
    for (int k = 0; k < 240; ++k) {
        if (k == 180) world.add({.position = {2, 2, 12}, .velocity = {0, 0, -60}, .restitution = 0.3});
        world.step(dt);
        EXPECT_TRUE(std::is_sorted(world.contact_changes().begin(), world.contact_changes().end(), in_order));
        for (const carom::ContactChange& change : world.contact_changes()) {
            const auto place = std::lower_bound(there.begin(), there.end(), change, in_order);
            const bool is_there = place != there.end() && key(*place) == key(change);
            ASSERT_NE(is_there, change.has_begun) << k;
            ended += change.has_begun ? 0 : 1;
            if (change.has_begun) {
                there.insert(place, change);
            } else {
                there.erase(place);
            }
        }
        const std::vector<carom::Contact> contacts = world.contacts();
        ASSERT_TRUE(std::equal(contacts.begin(), contacts.end(), there.begin(), there.end(),
                               [&](const auto& x, const auto& y) { return key(x) == key(y); }))
            << k;
    }
    EXPECT_GT(there.size(), world.size());
    EXPECT_GT(ended, 100U);
}

TEST(Sleep, AHeapFallsAsleepWhereItLiesAndBearsItsWeight) {
    World world = heap(4, 10, 0.5, sleepy_world(4.4));
    World awake = heap(4, 10, 0.5, box_world(4.4));
    const double start = world.energy().total();
    run(world, 10);
    run(awake, 10);
    EXPECT_EQ(awake.report().asleep, 0U);
    EXPECT_EQ(world.report().asleep, world.size());
    EXPECT_EQ(world.report().held, world.size());
    EXPECT_EQ(world.report().contacts, world.contacts().size());
    EXPECT_EQ(world.report().pieces, 0U);
    EXPECT_EQ(world.energy().kinetic, 0);
    // What lies still moves by less than 1e-4 m/s, and here far less.
    for (const BodyId id : world.ids()) {
        EXPECT_LE(length(world.get(id).position - awake.get(awake.ids()[id.slot]).position), 1e-4);
    }
    double weight = 0;
    for (const carom::Contact& contact : world.contacts()) {
        if (contact.face == 4) weight += contact.force;
    }
    EXPECT_NEAR(weight, 160 * g, 1e-3 * 160 * g);
    EXPECT_NEAR(world.face_forces().at(4), weight, 1e-12 * weight);
    const carom::Ledger& ledger = world.ledger();
    EXPECT_NEAR(world.energy().total() + ledger.lost_to_restitution + ledger.lost_to_friction, start, 1e-9 * start);
    EXPECT_NEAR(ledger.outer_impulse.z, 0, 1e-9 * 160 * g * world.time());
}

TEST(Sleep, IslandsWakeWhenSomethingArrivesAndOthersSleepOn) {
    WorldOptions options = sleepy_world(20);
    World world(options);
    for (const double x : {3.0, 17.0}) {
        for (const double z : {0.5, 1.5, 2.5}) {
            world.add({.position = {x, 10, z}, .restitution = 0.3, .friction = 0.5});
        }
    }
    run(world, 2);
    ASSERT_EQ(world.report().asleep, 6U);
    const Vec3 velocity{5, 0, 0};
    world.add({.position = {1, 10, 1.6}, .velocity = velocity, .restitution = 0.3, .friction = 0.5});
    std::uint64_t least = 6;
    while (world.time() < 3) {
        world.step(dt);
        least = std::min(least, world.report().asleep);
    }
    EXPECT_EQ(least, 3U);
    EXPECT_GT(world.get(world.ids()[1]).position.x, 3.1);
    EXPECT_EQ(world.get(world.ids()[4]).position.x, 17);
}

// Too slow for an impact, and for coming to lean: two balls on each other slide into two others.
TEST(Sleep, ACreepingNeighbourWakesAndPushes) {
    World world(sleepy_world(20));
    for (const double z : {0.5, 1.5}) world.add({.position = {5, 10, z}, .restitution = 0.3});
    run(world, 2);
    ASSERT_EQ(world.report().asleep, 2U);
    constexpr double speed = 0.02;
    for (const double z : {0.5, 1.5}) {
        world.add({.position = {3.96, 10, z}, .velocity = {speed, 0, 0}, .restitution = 0.3});
    }
    run(world, 1);
    EXPECT_EQ(world.report().held, 4U);
    EXPECT_EQ(world.report().asleep, 2U);
    run(world, 2);
    EXPECT_EQ(world.report().asleep, 0U);
    EXPECT_NEAR(world.momentum().x, 2 * speed, 1e-12);
    for (const BodyId id : world.ids()) EXPECT_NEAR(world.get(id).velocity.x, speed / 2, 1e-3 * speed);
    EXPECT_EQ(world.ledger().impacts, 0U);
}

TEST(Sleep, EndsWithWhatOneLiesOn) {
    const auto sleeper = [] {
        World world = heap(4, 6, 0.5, sleepy_world(4.4));
        run(world, 3);
        EXPECT_EQ(world.report().asleep, world.size());
        return world;
    };
    World removed = sleeper();
    removed.remove(removed.ids()[5]);
    removed.step(dt);
    EXPECT_EQ(removed.report().asleep, 0U);
    World turned = sleeper();
    turned.set_gravity({g, 0, 0});
    run(turned, 0.1);
    EXPECT_GT(turned.energy().kinetic, 1);
    World pushed = sleeper();
    pushed.change_velocities(std::vector{pushed.ids().back()}, std::vector{Vec3{0, 0, 3}});
    pushed.step(dt);
    EXPECT_GT(pushed.get(pushed.ids().back()).velocity.z, 2);
    World moved = sleeper();
    carom::Body body = moved.get(moved.ids()[0]);
    body.position.z += 20;
    moved.set(moved.ids()[0], body);
    moved.step(dt);
    EXPECT_EQ(moved.report().asleep, 0U);
}

TEST(Sleep, EndsWithWhatMovesAsPrescribed) {
    World world(sleepy_world(20));
    for (const double x : {3.0, 17.0}) {
        for (const double z : {0.5, 1.5, 2.5}) {
            world.add({.position = {x, 10, z}, .restitution = 0.3, .friction = 0.5});
        }
    }
    run(world, 2);
    ASSERT_EQ(world.report().asleep, 6U);
    World on_a_lift = World::load(world.save());
    on_a_lift.set_face_motion(4, {.velocity = 0.125});
    on_a_lift.step(dt);
    EXPECT_EQ(on_a_lift.report().asleep, 0U);
    run(on_a_lift, 2);
    EXPECT_EQ(on_a_lift.report().asleep, 0U);
    EXPECT_NEAR(on_a_lift.get(on_a_lift.ids()[4]).velocity.z, 0.125, 1e-3);
    on_a_lift.set_face_motion(4, {});
    run(on_a_lift, 2);
    EXPECT_EQ(on_a_lift.report().asleep, 6U);
    // A ram that meets one island after 4 s: the other sleeps on.
    world.add({.position = {-18, 10, 1.6}, .velocity = {5, 0, 0}, .mass = carom::infinite_mass});
    run(world, 3.5);
    EXPECT_EQ(world.report().asleep, 6U);
    std::uint64_t least = 6;
    while (world.time() < 7) {
        world.step(dt);
        least = std::min(least, world.report().asleep);
    }
    EXPECT_EQ(least, 3U);
    EXPECT_GT(world.get(world.ids()[1]).position.x, 3.5);
    EXPECT_EQ(world.get(world.ids()[4]).position.x, 17);
}

/// A bullet into a heap that is asleep, then sleep again: the same bits whoever computes, and from a snapshot.
TEST(Sleep, BitsDoNotDependOnThreadsTheSolverOrSnapshots) {
    const auto run_with = [](unsigned threads, bool reference, bool saves) {
        World world = heap(6, 8, 0.5, sleepy_world(6.6));
        world.set_threads(threads);
        world.set_serial_reference(reference);
        std::vector<std::uint64_t> hashes;
        for (int k = 0; k < 400; ++k) {
            if (k == 200) world.add({.position = {3, 3, 20}, .velocity = {1, 2, -80}, .restitution = 0.3});
            if (saves && k % 37 == 0) {
                world = World::load(world.save());
                world.set_threads(threads);
            }
            world.step(dt);
            hashes.push_back(world.hash());
        }
        return hashes;
    };
    const std::vector<std::uint64_t> hashes = run_with(1, false, false);
    EXPECT_EQ(run_with(1, true, false), hashes);
    EXPECT_EQ(run_with(3, false, false), hashes);
    EXPECT_EQ(run_with(2, false, true), hashes);
}

TEST(Pile, ForcesBalanceTheWeightOfEachBody) {
    World world = heap(4, 10, 0.5, box_world(4.4));
    run(world, 10);
    std::vector<Vec3> forces(world.size());
    Vec3 on_floor{};
    for (const carom::Contact& contact : world.contacts()) {
        EXPECT_GT(contact.force, 0);
        EXPECT_NEAR(length(contact.normal), 1, 1e-12);
        EXPECT_LE(length(contact.friction), 0.5 * contact.force * (1 + 1e-9));
        const Vec3 force = contact.normal * contact.force + contact.friction;
        forces[contact.a.slot] -= force;
        if (contact.face == 4) on_floor += force;
        if (contact.b.is_set()) forces[contact.b.slot] += force;
    }
    for (const Vec3& force : forces) EXPECT_NEAR(length(force - Vec3{0, 0, g}), 0, 1e-3 * g);
    const double weight = g * static_cast<double>(world.size());
    EXPECT_NEAR(-on_floor.z, weight, 1e-3 * weight);
    std::printf("figure: the floor under %zu bodies carries %.9f of their weight\n", world.size(),
                -on_floor.z / weight);
}

TEST(Pile, AnyStepGivesTheSameRest) {
    for (const double step : {1.0 / 1000, 1.0 / 240, 1.0 / 60, 1.0 / 20}) {
        WorldOptions options = box_world(10);
        World world(options);
        // Three that touch on the floor, and one on top of them.
        const double far = 1 / std::sqrt(3.0);
        for (int k = 0; k < 3; ++k) {
            const double angle = 2 * std::numbers::pi * k / 3;
            world.add({.position = Vec3{5, 5, 0.5} + Vec3{std::cos(angle), std::sin(angle), 0} * far,
                       .restitution = 0,
                       .friction = 0.5});
        }
        const BodyId top = world.add({.position = {5, 5, 0.6 + std::sqrt(2.0 / 3)}, .restitution = 0, .friction = 0.5});
        run(world, 5, step);
        EXPECT_NEAR(world.get(top).position.z, 0.5 + std::sqrt(2.0 / 3), 1e-3) << step;
        EXPECT_LE(kinetic_per_body(world), 1e-9) << step;
        EXPECT_TRUE(world.held(top)) << step;
    }
}

TEST(Pile, APyramidWithFrictionStays) {
    World world(box_world(20));
    std::vector<BodyId> ids;
    constexpr int base = 4;
    for (int k = 0; k < base; ++k) {
        for (int j = 0; j < base - k; ++j) {
            for (int i = 0; i < base - k; ++i) {
                const Vec3 place{5 + i + 0.5 * k, 5 + j + 0.5 * k, 0.5 + k / std::sqrt(2.0)};
                ids.push_back(world.add({.position = place, .restitution = 0, .friction = 0.5}));
            }
        }
    }
    run(world, 1);
    std::vector<Vec3> before;
    before.reserve(ids.size());
    for (const BodyId id : ids) before.push_back(world.get(id).position);
    run(world, 59);
    double drift = 0;
    for (std::size_t k = 0; k < ids.size(); ++k)
        drift = std::max(drift, length(world.get(ids[k]).position - before[k]));
    std::printf("figure: a pyramid of 30 spheres, mu = 0.5, drifts by %.2g diameters in a minute\n", drift);
    EXPECT_LT(drift, 1e-4);
}

// Without friction it falls apart.
TEST(Pile, APyramidWithoutFrictionFallsApart) {
    World world(box_world(20));
    for (const Vec3& place : {Vec3{5, 5, 0.5}, Vec3{6, 5, 0.5}, Vec3{5.5, 5, 0.5 + std::sqrt(0.75)}}) {
        world.add({.position = place, .restitution = 0});
    }
    const BodyId top = world.ids().back();
    run(world, 3);
    EXPECT_NEAR(world.get(top).position.z, 0.5, 1e-3);
}

TEST(Pile, ABulletIntoAHeapKeepsMomentumAndThrowsBodiesOut) {
    World world = heap(4, 6, 0, box_world(4.4));
    run(world, 8);
    double top = 0;
    for (const BodyId id : world.ids()) top = std::max(top, world.get(id).position.z);
    world.add({.position = {2.3, 2.1, top + 2}, .velocity = {3, 1, -200}, .mass = 2, .restitution = 0.3});
    double highest = 0;
    int impacts = 0;
    int impacts_alone = 0;
    for (int k = 0; k < 60; ++k) {
        const Vec3 before = world.momentum() - world.ledger().outer_impulse;
        world.step(dt);
        const Vec3 after = world.momentum() - world.ledger().outer_impulse;
        EXPECT_LE(length(after - before), 1e-9);
        for (const carom::Impact& impact : world.impacts()) {
            // What touches slowly again and again belongs to a contact.
            if (impact.face >= 0 || impact.approach_speed < 0.01) continue;
            const double m_a = world.get(impact.a).mass;
            const double m_b = world.get(impact.b).mass;
            const double reduced = m_a * m_b / (m_a + m_b);
            // In a collapse e is 1. What lies against a face passes the blow on to it: it takes more to turn it.
            const double e = impact.energy_lost == 0 ? 1 : 0.3;
            const double alone = (1 + e) * reduced * impact.approach_speed;
            EXPECT_GE(impact.impulse, alone * (1 - 1e-9));
            ++impacts;
            if (impact.impulse < alone * (1 + 1e-9)) ++impacts_alone;
        }
        for (const BodyId id : world.ids()) highest = std::max(highest, world.get(id).position.z);
    }
    EXPECT_GT(impacts, 50);
    EXPECT_GE(impacts_alone, 0.8 * impacts);
    EXPECT_GT(highest, top + 0.5);
    for (const BodyId id : world.ids()) EXPECT_GT(world.get(id).position.z, 0.5 - 0.01);
}

TEST(Pile, ElasticBodiesNeverLean) {
    World world(box_world(4.4));
    for (int k = 0; k < 12; ++k) {
        const int layer = k / 3;
        world.add({.position = {1.1 + 1.1 * (k % 3), 1.1 + 0.02 * k, 0.7 + 1.2 * layer}, .restitution = 1});
    }
    const double start = world.energy().total();
    for (int k = 0; k < 120; ++k) {
        world.step(dt);
        EXPECT_EQ(world.report().pieces, 0U);
    }
    // The walls are inelastic here: only what goes to the floor is lost.
    EXPECT_NEAR(world.energy().total() + world.ledger().lost_to_restitution, start, 1e-9 * start);
}

TEST(Pile, ARemovedBodyLetsOthersFall) {
    World world(box_world(4.4));
    const BodyId low = world.add({.position = {1, 1, 0.5}, .restitution = 0});
    const BodyId high = world.add({.position = {1, 1, 1.52}, .restitution = 0});
    run(world, 1);
    EXPECT_TRUE(world.held(high));
    EXPECT_NEAR(world.get(high).position.z, 1.5, 1e-3);
    world.remove(low);
    run(world, 1);
    EXPECT_TRUE(world.held(high));
    EXPECT_NEAR(world.get(high).position.z, 0.5, 1e-9);
}

TEST(Pile, WhatIsLeftOfAHeapThatIsStruckAndTakenAwayComesToRest) {
    World world = heap(4, 6, 0, box_world(4.4));
    run(world, 2);
    for (int k = 0; k < 12; ++k) {
        world.add({.position = {2.3, 2.1, 9}, .velocity = {1, 2, -150}, .restitution = 0.3}, carom::Overlap::accept);
        run(world, 0.1);
        const std::vector<BodyId> ids = world.ids();
        for (std::size_t i = 0; i < ids.size(); i += 4) world.remove(ids[i]);
        world.step(dt);
    }
    EXPECT_LT(world.size(), 20U);
    // Without friction, one ball on another may take its time to topple.
    run(world, 5);
    EXPECT_EQ(world.report().held, world.size());
}

// A heavy body on a light one takes short pieces. A static one above that leans on nobody does not.
TEST(Pile, AStaticBodyIsNoBurden) {
    World world(box_world(10));
    const Vec3 low{0.5, 5, 0.5};
    const Vec3 high = low + Vec3{0.25, 0, std::sqrt(1 - 0.0625)};
    world.add({.position = low, .restitution = 0});
    const BodyId top = world.add({.position = high + Vec3{0, 0, 1e-6}, .restitution = 0});
    const double angle = 0.35;
    world.add({.position = high + Vec3{std::cos(angle), 0, std::sin(angle)} * 0.801,
               .mass = carom::infinite_mass,
               .radius = 0.3,
               .restitution = 0});
    run(world, 1);
    const std::vector<carom::Contact> contacts = world.contacts();
    const auto is_static = [&world](const carom::Contact& c) {
        return c.b.is_set() && world.get(c.b).mass == carom::infinite_mass;
    };
    ASSERT_TRUE(std::any_of(contacts.begin(), contacts.end(), is_static));
    EXPECT_TRUE(world.held(top));
    EXPECT_EQ(world.report().pieces, 8U);
}

TEST(Pile, GoesOnFromASnapshot) {
    World world = heap(3, 6, 0.3, box_world(3.3));
    run(world, 1);
    EXPECT_GT(world.report().pieces, 0U);
    World copy = World::load(world.save());
    EXPECT_EQ(copy.hash(), world.hash());
    run(world, 1);
    run(copy, 1);
    EXPECT_EQ(copy.hash(), world.hash());
}

TEST(Pile, BitsDoNotDependOnThreadsWindowsOrTheSolver) {
    for (const carom::Precision precision : {carom::Precision::double_precision, carom::Precision::single_precision}) {
        std::vector<std::uint64_t> hashes;
        for (const bool reference : {true, false}) {
            for (const unsigned threads : {1U, 2U, 8U}) {
                for (const std::uint32_t windows : {1U, 2U, 7U}) {
                    WorldOptions options = box_world(8.8);
                    options.precision = precision;
                    options.serial_reference = reference;
                    options.threads = threads;
                    options.min_windows = windows;
                    World world = heap(8, 8, 0.2, options);
                    run(world, 1.5);
                    hashes.push_back(world.hash());
                }
            }
        }
        for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes.front());
    }
}

} // namespace
