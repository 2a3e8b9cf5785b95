// A world that has found its stride allocates nothing: a step takes what memory earlier steps left. A program of its
// own, because it replaces operator new.

#include "allocations/counting_new.hpp"
#include "scene/workloads.hpp"

#include <carom/carom.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <cstdio>

namespace {

using carom::Precision;
using carom::World;

void step(World& world, int steps, double dt) {
    for (int i = 0; i < steps; ++i) world.step(dt);
}

void expect_none(const char* name, Precision precision, unsigned threads) {
    const carom::scene::Scene scene = carom::scene::workload("gas", 10'000, precision).scene;
    World world = carom::scene::make_world(scene);
    world.set_executor(carom::make_thread_executor(threads));
    world.set_recording(true);
    step(world, 200, scene.run.dt);
    const std::uint64_t before = carom::test::allocations();
    const std::uint64_t impacts_before = world.ledger().impacts;
    step(world, 1000, scene.run.dt);
    const std::uint64_t counted = carom::test::allocations() - before;
    std::printf("figure: gas of 10 000, %s, steps 200 to 1200: %llu allocations\n", name,
                static_cast<unsigned long long>(counted));
    EXPECT_EQ(counted, 0U);
    EXPECT_GT(before, 0U) << "nothing is counted";
    EXPECT_GT(world.ledger().impacts - impacts_before, 300'000U);
    EXPECT_FALSE(world.impacts().empty());
}

TEST(Allocations, NoneOnce200StepsAreDoneInDouble) { expect_none("double, 1 thread", Precision::double_precision, 1); }
TEST(Allocations, NoneOnce200StepsAreDoneInSingle) { expect_none("single, 1 thread", Precision::single_precision, 1); }
TEST(Allocations, NoneOnThreadsInDouble) { expect_none("double, 2 threads", Precision::double_precision, 2); }
TEST(Allocations, NoneOnThreadsInSingle) { expect_none("single, 2 threads", Precision::single_precision, 2); }

} // namespace
