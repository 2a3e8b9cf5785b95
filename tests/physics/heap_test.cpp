// Stacks, heaps and trains of bodies that lean on each other: bounded work, no energy gained, no sinking.

#include "scene/overlap_search.hpp"

#include <carom/carom.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <string>
#include <variant>
#include <vector>

namespace {

using carom::Precision;
using carom::Vec3;
using carom::World;
using carom::WorldOptions;

constexpr double g = 9.81;

struct Heap {
    const char* name;
    carom::Region region{};
    std::vector<carom::Body> bodies{};
    double friction = 0;
    std::vector<double> restitutions{0, 0.2, 0.6, 0.9};
};

const carom::Box narrow_box{{0, 0, 0}, {2, 2, 20}};

Heap stack(const char* name, int count, double top_mass = 1, double friction = 0) {
    Heap heap{.name = name, .region = narrow_box, .friction = friction};
    for (int i = 0; i < count; ++i) heap.bodies.push_back({.position = {1 + 0.01 * (i % 3), 1, 1 + 1.5 * i}});
    heap.bodies.back().mass = top_mass;
    return heap;
}

/// Bodies one on top of the other, touching, at rest.
Heap tower() {
    Heap heap{.name = "tower", .region = narrow_box};
    for (int i = 0; i < 6; ++i) heap.bodies.push_back({.position = {1, 1, 0.5 + i}});
    return heap;
}

/// Layers of four that fall into the box, each turned a little against the one below.
Heap rain() {
    Heap heap{.name = "rain", .region = narrow_box, .friction = 0.2, .restitutions = {0.2, 0.9}};
    for (int k = 0; k < 24; ++k) {
        const int layer = k / 4;
        const double angle = 0.8 + 1.5707963267948966 * k + 0.1 * std::sin(1.0 * k);
        const Vec3 place{1 + 0.65 * std::cos(angle), 1 + 0.65 * std::sin(angle), 0.6 + layer};
        heap.bodies.push_back({.position = place, .radius = 0.4});
    }
    return heap;
}

/// Bodies that slide down a slope, against a wall at its end.
Heap train() {
    const double angle = 0.4;
    const Vec3 normal{std::sin(angle), 0, std::cos(angle)};
    const Vec3 down{std::cos(angle), 0, -std::sin(angle)};
    Heap heap{.name = "train", .friction = 0.1};
    heap.region = std::vector<carom::Plane>{{.normal = normal}, {.point = {10, 0, 0}, .normal = {-1, 0, 0}}};
    for (int i = 0; i < 6; ++i) heap.bodies.push_back({.position = normal * 0.5 + down * (1.2 * i)});
    return heap;
}

Heap shell() {
    Heap heap{.name = "shell", .region = carom::Shell{.radius = 4}, .friction = 0.1, .restitutions = {0.2, 0.9}};
    for (int i = -1; i <= 1; ++i) {
        for (int j = -1; j <= 1; ++j) heap.bodies.push_back({.position = {1.1 * i + 0.01 * j, 1.1 * j, 0.1 * i}});
    }
    return heap;
}

std::vector<Heap> heaps() {
    return {stack("three", 3), stack("six", 6, 1, 0.3), stack("heavy", 3, 1000), tower(), rain(), train(), shell()};
}

World make(const Heap& heap, double e, WorldOptions options) {
    options.gravity = {0, 0, -g};
    options.region = heap.region;
    World world(options);
    for (carom::Body body : heap.bodies) {
        body.restitution = e;
        body.friction = heap.friction;
        world.add(body);
    }
    return world;
}

/// 1/s^2: the square of the rate at which a contact swings, a quarter of the rate of the pieces of a step. There are
/// 480 of these a second, and two a second for each time that a body outweighs one below it.
double swing_squared(const Heap& heap) {
    double lightest = heap.bodies.front().mass;
    double heaviest = lightest;
    for (const carom::Body& body : heap.bodies) {
        lightest = std::min(lightest, body.mass);
        heaviest = std::max(heaviest, body.mass);
    }
    const double swing = 2 * std::numbers::pi * 0.25 * std::max(480.0, 2 * heaviest / lightest);
    return lightest * swing * swing;
}

void expect_bounded(const Heap& heap, double e, Precision precision, double dt) {
    WorldOptions options;
    options.precision = precision;
    World world = make(heap, e, options);
    carom::scene::OverlapSearch search(world);
    const auto count = static_cast<double>(heap.bodies.size());
    const double most = 4 * dt / options.collapse_time * count;
    double weight = 0;
    for (const carom::Body& body : heap.bodies) weight += g * body.mass;
    // Each impact rounds the places of its bodies.
    const double rounding = weight * (precision == Precision::double_precision ? 1e-9 : 1e-5);
    // A step has as many pieces as keep contacts from giving way to their loads by more.
    double overlap_bound = 0.01;
    if (std::holds_alternative<carom::Shell>(heap.region)) {
        // What slides in a shell leaves it by v^2 dt^2 / 2 R in a step before it is put back; v^2 is at most 4 g R.
        overlap_bound += 2 * g * dt * dt;
    }
    const double start = world.energy().total();
    double lowest = start;
    double impacts = 0;
    double rise = 0;
    double overlap = 0;
    while (world.time() < 2) {
        const carom::StepReport& report = world.step(dt);
        impacts = std::max(impacts, static_cast<double>(report.impacts + report.face_impacts));
        ASSERT_LE(impacts, most) << world.time();
        const double energy = world.energy().total();
        rise = std::max(rise, energy - lowest);
        lowest = std::min(lowest, energy);
        overlap = std::max(overlap, search.find(world).largest);
    }
    // Each contact is a spring, and gives back no more than it took.
    const double springs = count * 0.5 * swing_squared(heap) * overlap * overlap;
    std::printf("figure: heap %s, e = %g, %s, dt = %.4f s: at most %.2f impacts a body in %g s, energy rises by %.2g J "
                "(at most %.2g), overlap %.2g diameters (%.2g)\n",
                heap.name, e, precision == Precision::double_precision ? "double" : "single", dt,
                impacts * options.collapse_time / dt / count, options.collapse_time, rise, springs + rounding, overlap,
                overlap_bound);
    EXPECT_LE(rise, springs + rounding);
    EXPECT_LE(overlap, overlap_bound);
    if (precision == Precision::single_precision) return; // no book has what rounding does to velocities
    const carom::Ledger& ledger = world.ledger();
    EXPECT_NEAR(world.energy().total() + ledger.lost_to_restitution + ledger.lost_to_friction, start, rounding);
}

void expect_bounded(const Heap& heap) {
    for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
        for (const double dt : {1.0 / 60, 1.0 / 240}) {
            for (const double e : heap.restitutions) {
                SCOPED_TRACE(std::string(heap.name) + ", e = " + std::to_string(e));
                expect_bounded(heap, e, precision, dt);
            }
        }
    }
}

TEST(Heap, StacksAreBoundedWork) {
    expect_bounded(stack("three", 3));
    expect_bounded(stack("six", 6, 1, 0.3));
}
TEST(Heap, AHeavyBodyOnTopIsBoundedWork) { expect_bounded(stack("heavy", 3, 1000)); }
TEST(Heap, ATowerIsBoundedWork) { expect_bounded(tower()); }
TEST(Heap, RainIsBoundedWork) { expect_bounded(rain()); }
TEST(Heap, ATrainOnASlopeIsBoundedWork) { expect_bounded(train()); }
TEST(Heap, BodiesInAShellAreBoundedWork) { expect_bounded(shell()); }

TEST(Heap, WindowsAndIslandsDoNotMatter) {
    for (const Heap& heap : heaps()) {
        for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
            std::vector<std::uint64_t> hashes;
            for (const bool reference : {true, false}) {
                for (const std::uint32_t windows : {1U, 7U}) {
                    WorldOptions options;
                    options.precision = precision;
                    options.serial_reference = reference;
                    options.min_windows = windows;
                    World world = make(heap, 0.2, options);
                    while (world.time() < 0.95) world.step(1.0 / 60);
                    hashes.push_back(world.hash());
                }
            }
            for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, hashes.front()) << heap.name;
        }
    }
}

TEST(Heap, ABallAloneStillComesToRest) {
    for (const Precision precision : {Precision::double_precision, Precision::single_precision}) {
        for (const double e : {0.5, 0.9, 0.99}) {
            WorldOptions options;
            options.precision = precision;
            World world =
                make({.name = "alone", .region = narrow_box, .bodies = {{.position = {1, 1, 0.6}}}}, e, options);
            while (world.time() < 60) world.step(1.0 / 60);
            EXPECT_TRUE(world.held(world.ids().front())) << e;
        }
    }
}

} // namespace
