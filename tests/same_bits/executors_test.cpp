// carom's own executors keep what executor.hpp says, also where several threads use one.

#include "scene/workloads.hpp"

#include <carom/world.hpp>

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace {

using carom::Executor;
using carom::World;

std::array<std::shared_ptr<Executor>, 3> executors() {
    return {carom::make_serial_executor(), carom::make_default_executor(3), carom::make_thread_executor(3)};
}

TEST(Executors, RunEachPartOnce) {
    for (const auto& executor : executors()) {
        for (std::size_t parts = 0; parts < 100; ++parts) {
            std::vector<int> runs(parts);
            executor->run(
                parts, [](void* context, std::size_t part) { ++(*static_cast<std::vector<int>*>(context))[part]; },
                &runs);
            EXPECT_EQ(runs, std::vector<int>(parts, 1));
        }
    }
}

TEST(Executors, TooManyThreadsAreRefused) {
    for (const auto make : {carom::make_default_executor, carom::make_thread_executor}) {
        for (const unsigned threads : {4097U, 1'000'000U}) {
            try {
                make(threads);
                ADD_FAILURE() << threads << " were not refused";
            } catch (const carom::Error& error) {
                EXPECT_EQ(error.code(), carom::ErrorCode::out_of_range);
                EXPECT_EQ(error.what(), "threads: must be at most 4096, got " + std::to_string(threads));
            }
        }
    }
    World world({.threads = 2});
    EXPECT_THROW(world.set_threads(5000), carom::Error);
    EXPECT_EQ(world.options().threads, 2U);
}

TEST(Executors, ThrowOnceNoPartRunsAnyMore) {
    for (const auto& executor : executors()) {
        for (int repeat = 0; repeat < 100; ++repeat) {
            std::atomic<int> running{0};
            const auto task = [](void* context, std::size_t part) {
                auto& count = *static_cast<std::atomic<int>*>(context);
                ++count;
                std::this_thread::yield();
                --count;
                if (part % 4 == 1) throw std::runtime_error("a task");
            };
            EXPECT_THROW(executor->run(16, task, &running), std::runtime_error);
            EXPECT_EQ(running, 0);
        }
    }
}

TEST(Executors, ServeSeveralWorldsAtTheSameTime) {
    constexpr int steps = 20;
    const World start = carom::scene::make_world(carom::scene::workload("gas", 4096).scene);
    const auto run = [](World& world) {
        for (int i = 0; i < steps; ++i) world.step(1.0 / 60);
    };
    World alone = start;
    alone.set_threads(1);
    run(alone);
    for (const auto& executor : {carom::make_default_executor(3), carom::make_thread_executor(3)}) {
        World one = start;
        one.set_executor(executor);
        World other = one;
        std::thread thread([&] { run(other); });
        run(one);
        thread.join();
        EXPECT_EQ(one.hash(), alone.hash());
        EXPECT_EQ(other.hash(), alone.hash());
    }
}

} // namespace
