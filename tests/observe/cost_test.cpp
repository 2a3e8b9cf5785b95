// What observers cost beside the steps, and that threads change none of their bits.

#include "scene/workloads.hpp"

#include <carom/observers.hpp>

#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>

namespace carom {
namespace {

/// All observers at the intervals that observers.hpp calls sensible: impacts after every step, pairs of bodies after
/// every 100th, all others after every 20th; here bodies collide 0.1 to 1 times in a step.
struct All {
    explicit All(const World& world, double side) : impacts(world), profile(2, 0, side, 20, side * side) {}

    void observe(const World& world, int step) {
        impacts.observe(world);
        if (step % 20 != 0) return;
        energies.observe(world);
        sample.read(world);
        speeds.observe(sample);
        profile.observe(sample);
        slab.observe(sample);
        correlations.observe(sample);
        if (step % 100 != 0) return;
        radial.observe(sample);
        coordination.observe(sample);
    }

    ImpactStatistics impacts;
    Energies energies;
    Sample sample;
    Speeds speeds{15, 50};
    Profile profile;
    SlabPacking slab{2, 5, 10, 100};
    Correlations correlations{20, 5};
    RadialDistribution radial{2, 40};
    Coordination coordination{1e-6};
};

double seconds_since(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

TEST(ObserverCost, IsBelowATenthOfTheSteps) {
    for (const char* name : {"gas", "dense_gas"}) {
        const scene::Scene scene = scene::workload(name, 10'000).scene;
        World world = scene::make_world(scene);
        world.set_threads(1);
        All all(world, std::get<Box>(scene.options.region).max.x);
        double stepping = 0;
        double observing = 0;
        for (int step = 1; step <= 300; ++step) {
            auto begin = std::chrono::steady_clock::now();
            world.step(scene.run.dt);
            stepping += seconds_since(begin);
            begin = std::chrono::steady_clock::now();
            all.observe(world, step);
            observing += seconds_since(begin);
        }
        std::printf("figure: all observers on %s of 10 000: %.1f %% of the steps' time (at most 10 %%)\n", name,
                    100 * observing / stepping);
        EXPECT_LT(observing, 0.1 * stepping) << name;
    }
}

TEST(ObserverCost, ThreadsChangeNoBits) {
    std::vector<double> results;
    for (const unsigned threads : {1U, 3U}) {
        const scene::Scene scene = scene::workload("gas", 2000).scene;
        World world = scene::make_world(scene);
        world.set_threads(threads);
        All all(world, std::get<Box>(scene.options.region).max.x);
        for (int step = 1; step <= 100; ++step) {
            world.step(scene.run.dt);
            all.observe(world, step);
        }
        for (const Estimate& estimate :
             {all.impacts.pressure(), all.impacts.collision_rate(), all.energies.total(), all.speeds.moment(1),
              all.profile.temperature(3), all.radial.g(30), all.correlations.squared_displacement(7)}) {
            results.push_back(estimate.value);
            results.push_back(estimate.standard_error);
        }
    }
    ASSERT_EQ(results.size() % 2, 0U);
    const std::size_t half = results.size() / 2;
    for (std::size_t i = 0; i < half; ++i) EXPECT_EQ(results[i], results[half + i]) << i;
}

} // namespace
} // namespace carom
