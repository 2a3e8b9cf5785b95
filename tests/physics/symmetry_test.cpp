// Mirrored, turned and reversed worlds.

#include "scene/workloads.hpp"

#include <carom/carom.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>

namespace {

using carom::Body;
using carom::Vec3;
using carom::World;

/// A heap of bodies of many sizes in a box that is symmetric about its centre, with gravity if wanted.
World heap(const std::function<Vec3(const Vec3&)>& turned, carom::Precision precision, const Vec3& gravity) {
    carom::WorldOptions options;
    options.precision = precision;
    options.gravity = turned(gravity);
    carom::Box box{{-4, -4, -4}, {4, 4, 4}};
    for (carom::Face& face : box.faces) face.surface = {.restitution = 0.8, .friction = 0.1};
    options.region = box;
    World world(options);
    for (int i = 0; i < 216; ++i) {
        const int layer = i / 36;
        const Vec3 place{(i % 6) * 1.25 - 3.1, ((i / 6) % 6) * 1.25 - 3.2, layer * 1.25 - 3.15};
        const Vec3 velocity{std::sin(i * 1.3) * 4, std::cos(i * 0.7) * 4, std::sin(i * 2.1 + 1) * 4};
        world.add({.position = turned(place),
                   .velocity = turned(velocity),
                   .mass = 1.0 + i % 7,
                   .radius = 0.3 + 0.03 * (i % 9),
                   .restitution = 0.7 + 0.05 * (i % 7),
                   .friction = 0.02 * (i % 3)});
    }
    return world;
}

void expect_turned(const std::function<Vec3(const Vec3&)>& turned, carom::Precision precision, const Vec3& gravity) {
    World one = heap([](const Vec3& v) { return v; }, precision, gravity);
    World other = heap(turned, precision, gravity);
    for (int i = 0; i < 60; ++i) {
        one.step(1.0 / 60);
        other.step(1.0 / 60);
    }
    EXPECT_GT(one.ledger().impacts, 500U);
    ASSERT_EQ(one.ledger().impacts, other.ledger().impacts);
    const auto ids = one.ids();
    const auto other_ids = other.ids();
    for (std::size_t i = 0; i < ids.size(); ++i) {
        const Body a = one.get(ids[i]);
        const Body b = other.get(other_ids[i]);
        ASSERT_EQ(turned(a.position), b.position) << i;
        ASSERT_EQ(turned(a.velocity), b.velocity) << i;
    }
}

constexpr std::array both{carom::Precision::single_precision, carom::Precision::double_precision};

TEST(Symmetry, MirroredWorldsHaveMirroredBits) {
    for (const carom::Precision precision : both) {
        for (const Vec3& gravity : {Vec3{}, Vec3{1, -2, -9.81}}) {
            expect_turned([](const Vec3& v) { return Vec3{-v.x, v.y, v.z}; }, precision, gravity);
            expect_turned([](const Vec3& v) { return Vec3{v.x, -v.y, v.z}; }, precision, gravity);
            expect_turned([](const Vec3& v) { return Vec3{v.x, v.y, -v.z}; }, precision, gravity);
        }
    }
}

TEST(Symmetry, AQuarterTurnAboutZKeepsTheBits) {
    for (const carom::Precision precision : both) {
        expect_turned([](const Vec3& v) { return Vec3{-v.y, v.x, v.z}; }, precision, {1, -2, -9.81});
    }
}

// Chaos multiplies a difference by some 10 at each impact of a body (VALIDATION: 9 to 20 impacts from 1e-14 to 1e-7),
// so the way back is compared after few impacts each.
TEST(Symmetry, AnElasticGasRunsBackward) {
    carom::scene::Scene scene = carom::scene::workload("gas", 1000).scene;
    World world = carom::scene::make_world(scene);
    const auto ids = world.ids();
    for (int i = 0; i < 30; ++i) world.step(1.0 / 60);
    std::vector<Vec3> velocities(ids.size());
    world.get(ids, {.velocity = velocities});
    for (Vec3& v : velocities) v = -v;
    world.set(ids, {.velocity = velocities}, carom::Overlap::accept);
    for (int i = 0; i < 30; ++i) world.step(1.0 / 60);
    double largest = 0;
    for (std::size_t i = 0; i < ids.size(); ++i) {
        largest = std::max(largest, length(world.get(ids[i]).position - scene.bodies.position[i]));
    }
    const double impacts = 2.0 * static_cast<double>(world.ledger().impacts) / static_cast<double>(ids.size());
    std::printf("figure: gas of 1 000 forward and back, %.2f impacts a body: back to %.3g m\n", impacts, largest);
    EXPECT_GT(impacts, 2);
    EXPECT_LE(largest, 1e-7);
}

} // namespace
