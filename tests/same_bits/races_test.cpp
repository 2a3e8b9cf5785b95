// Worlds so large, in steps so long, that all loops have several parts: ThreadSanitizer looks for races between them.

#include "same_bits/scattering_executor.hpp"
#include "scene/workloads.hpp"

#include <carom/world.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <memory>

namespace {

using carom::World;

constexpr double dt = 1.0 / 6;

World gas(std::uint64_t bodies) {
    return carom::scene::make_world(carom::scene::workload("gas", bodies, carom::Precision::single_precision).scene);
}

void expect_as_alone(World world) {
    World scattered = world;
    world.set_executor(carom::make_serial_executor());
    scattered.set_executor(std::make_shared<carom::test::ScatteringExecutor>());
    for (int i = 0; i < 2; ++i) {
        world.step(dt);
        scattered.step(dt);
    }
    EXPECT_EQ(scattered.hash(), world.hash());
}

TEST(Races, NoneBetweenPartsOfLoops) { expect_as_alone(gas(32768)); }

TEST(Races, NoneWhereForcesKick) {
    World world = gas(10240);
    world.set_drag({.linear = 0.01});
    const std::array attractors{carom::Attractor{.strength = 10, .softening = 1}};
    world.set_attractors(attractors);
    expect_as_alone(world);
}

} // namespace
