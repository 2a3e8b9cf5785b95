// Eight worlds do as the one queue does, to the last bit and impact by impact: on any number of threads, with every
// instruction set, cut into any number of windows, with tasks in any order.

#include "hash/digest.hpp"
#include "hash/small_scenes.hpp"
#include "same_bits/disorderly_executor.hpp"
#include "same_bits/keeps_simd_target.hpp"
#include "same_bits/scattering_executor.hpp"
#include "scene/workloads.hpp"

#include <carom/world.hpp>

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

namespace {

using carom::World;
using carom::scene::Scene;
using carom::test::Disorder;
using carom::test::DisorderlyExecutor;
using carom::test::KeepsSimdTarget;
using carom::test::ScatteringExecutor;

struct Tested {
    const char* name;
    std::uint64_t bodies; ///< of a workload: so many that loops have several parts; 0 for a small scene
    double dt;            ///< s
    int steps;            ///< more than 64: bodies change places in memory on the way, and all lists are made anew
    bool merges;          ///< islands merge in it
};

constexpr std::array worlds{
    // A loop over bodies has parts of 4096 or more; impacts of a window are put in order in slices if they are 512.
    Tested{"gas", 16384, 1.0 / 60, 70, true},         Tested{"dense_gas", 2048, 1.0 / 240, 70, true},
    Tested{"polydisperse", 4096, 1.0 / 15, 70, true}, Tested{"bullets", 2048, 1.0 / 60, 70, true},
    Tested{"open_space", 4096, 1.0 / 15, 70, true},   Tested{"pile", 1500, 1.0 / 60, 80, true},
    Tested{"one_cell", 0, 1.0 / 15, 200, true},       Tested{"three_bodies", 0, 1.0 / 60, 500, false},
    Tested{"corners", 0, 1.0 / 15, 200, false}, // all bodies are one island from the start
    Tested{"heap", 0, 1.0 / 60, 200, true},           Tested{"piston", 0, 1.0 / 30, 200, true},
    Tested{"shaker", 0, 1.0 / 60, 200, true},         Tested{"growing", 0, 1.0 / 15, 200, true},
    Tested{"obstacles", 0, 1.0 / 60, 240, true},
};

void PrintTo(const Tested& tested, std::ostream* out) { *out << tested.name; }

Scene scene_of(const Tested& tested) {
    constexpr auto precision = carom::Precision::double_precision;
    if (tested.bodies > 0) return carom::scene::workload(tested.name, tested.bodies, precision).scene;
    return carom::test::small_scene(tested.name, precision);
}

/// What a step left behind.
struct Moment {
    std::uint64_t state = 0;
    std::uint64_t impact_list = 0;
    std::uint64_t ledger = 0;
    std::size_t impacts = 0;

    friend bool operator==(const Moment&, const Moment&) = default;
};

Moment moment_of(const World& world) {
    carom::test::Digest impact_list;
    impact_list.add(world.impacts());
    carom::test::Digest ledger;
    ledger.add(world.ledger());
    return {world.hash(), impact_list.value(), ledger.value(), world.impacts().size()};
}

class SameBits : public testing::TestWithParam<Tested> {
protected:
    /// Makes the world ready for another way to reach the same.
    using Arrange = std::function<void(World&)>;

    void SetUp() override {
        World reference = start_;
        reference.set_serial_reference(true);
        reference.set_threads(1);
        std::size_t impacts = 0;
        for (int i = 0; i < GetParam().steps; ++i) {
            reference.step(GetParam().dt);
            expected_.push_back(moment_of(reference));
            impacts += expected_.back().impacts;
        }
        EXPECT_GT(impacts, 20U);
    }

    /// Returns how often islands merged.
    std::uint64_t expect_same(const std::string& what, const Arrange& arrange) const {
        World world = start_;
        arrange(world);
        std::uint64_t merges = 0;
        for (std::size_t i = 0; i < expected_.size(); ++i) {
            merges += world.step(GetParam().dt).merges;
            const Moment moment = moment_of(world);
            if (moment == expected_[i]) continue;
            ADD_FAILURE() << what << ", step " << i << ": " << moment.impacts << " impacts, the reference has "
                          << expected_[i].impacts;
            break;
        }
        return merges;
    }

private:
    World start_ = carom::scene::make_world(scene_of(GetParam()));
    std::vector<Moment> expected_;
};

TEST_P(SameBits, OnAnyNumberOfThreads) {
    for (const unsigned threads : {1U, 2U, 3U, 8U}) {
        const std::string count = std::to_string(threads) + " threads";
        const std::uint64_t merges = expect_same(count, [=](World& world) { world.set_threads(threads); });
        EXPECT_EQ(merges > 0, GetParam().merges) << count;
    }
    for (const unsigned threads : {2U, 3U, 8U}) {
        expect_same(std::to_string(threads) + " threads of the standard library",
                    [=](World& world) { world.set_executor(carom::make_thread_executor(threads)); });
    }
    expect_same("7 windows on 3 threads", [](World& world) {
        world.set_min_windows(7);
        world.set_threads(3);
    });
}

// Alone, because `./dev sanitize` has ThreadSanitizer watch it.
TEST_P(SameBits, OnScatteredThreads) {
    expect_same("scattered", [](World& world) { world.set_executor(std::make_shared<ScatteringExecutor>()); });
}

TEST_P(SameBits, WithEveryInstructionSet) {
    const KeepsSimdTarget keeps;
    for (const std::string_view target : carom::simd_targets()) {
        carom::use_simd_target(target);
        const std::string name(target);
        expect_same(name, [](World& world) { world.set_threads(1); });
        expect_same(name + ", the reference", [](World& world) { world.set_serial_reference(true); });
        expect_same(name + ", 2 windows, shuffled", [](World& world) {
            world.set_min_windows(2);
            world.set_executor(std::make_shared<DisorderlyExecutor>(Disorder::shuffled));
        });
    }
}

TEST_P(SameBits, InAnyNumberOfWindows) {
    for (const std::uint32_t windows : {1U, 2U, 7U}) {
        const std::string count = std::to_string(windows);
        expect_same(count + " windows", [=](World& world) { world.set_min_windows(windows); });
        expect_same(count + " windows, the reference", [=](World& world) {
            world.set_min_windows(windows);
            world.set_serial_reference(true);
        });
    }
}

TEST_P(SameBits, InAnyOrderOfTasks) {
    for (const Disorder disorder : {Disorder::reversed, Disorder::shuffled}) {
        const std::string name = disorder == Disorder::reversed ? "reversed" : "shuffled";
        const auto executor = std::make_shared<DisorderlyExecutor>(disorder);
        expect_same(name, [&](World& world) { world.set_executor(executor); });
        EXPECT_TRUE(executor->loops() > 0 || GetParam().bodies == 0); // the small scenes may have none
        expect_same(name + ", 7 windows", [&](World& world) {
            world.set_executor(executor);
            world.set_min_windows(7);
        });
    }
}

INSTANTIATE_TEST_SUITE_P(Worlds, SameBits, testing::ValuesIn(worlds),
                         [](const auto& tested) { return std::string(tested.param.name); });

} // namespace
