// The simulation behind the window: its thread, the way back, and what is heard of it.
#include "viewer/window/history.hpp"
#include "viewer/window/simulation.hpp"
#include "viewer_session/small_gas.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace carom::viewer {
namespace {

// The way back --------------------------------------------------------------------------------------------------------

TEST(History, GoesBackToTheSameBits) {
    World world = small_gas();
    History history(world, std::size_t{1} << 30U, 7);
    std::vector<std::uint64_t> hashes{world.hash()};
    for (int i = 0; i < 40; ++i) {
        world.step(0.05);
        history.stepped(world);
        hashes.push_back(world.hash());
    }
    for (const std::uint64_t step : {39U, 38U, 28U, 27U, 8U, 1U, 0U}) {
        EXPECT_EQ(history.back_to(step, 0.05).hash(), hashes[step]) << step;
    }
    EXPECT_EQ(history.start().hash(), hashes[0]);
}

TEST(History, DoesNotRepeatWhatTheUserDid) {
    World world = small_gas();
    History history(world, std::size_t{1} << 30U, 100);
    for (int i = 0; i < 10; ++i) {
        world.step(0.05);
        history.stepped(world);
    }
    world.set_gravity({0, 0, -50});
    history.changed(world);
    const BodyId shot = world.add({.position = {0.3, 0.3, 0.3}, .velocity = {3, 3, 3}, .radius = 0.1}, Overlap::accept);
    history.changed(world);
    std::vector<std::uint64_t> hashes;
    for (int i = 0; i < 5; ++i) {
        world.step(0.05);
        history.stepped(world);
        hashes.push_back(world.hash());
    }
    EXPECT_EQ(history.back_to(13, 0.05).hash(), hashes[2]);
    EXPECT_TRUE(history.back_to(10, 0.05).contains(shot)); // the step at which it was shot
    EXPECT_FALSE(history.back_to(9, 0.05).contains(shot));
}

TEST(History, KeepsNoMoreThanItMay) {
    World world = small_gas();
    const std::size_t size = world.save().size();
    History history(world, 5 * size, 1);
    std::vector<std::uint64_t> hashes{world.hash()};
    for (int i = 0; i < 30; ++i) {
        world.step(0.05);
        history.stepped(world);
        hashes.push_back(world.hash());
    }
    EXPECT_LE(history.bytes(), 5 * size);
    EXPECT_GE(history.oldest_step(), 26U);
    const World oldest = history.back_to(3, 0.05); // as far as it goes
    EXPECT_EQ(oldest.hash(), hashes[oldest.step_count()]);
    EXPECT_GE(oldest.step_count(), 26U);
}

// The simulation's thread ---------------------------------------------------------------------------------------------

TEST(Simulations, RunInAThreadOfTheirOwn) {
    World reference = small_gas();
    for (int i = 0; i < 40; ++i) reference.step(0.05);
    Simulation simulation(small_gas(), 0.05, scene::ColourBy::speed);
    simulation.run_to(1.999);
    simulation.wait_until_idle();
    const auto moment = simulation.moment();
    EXPECT_NEAR(moment->end, 2, 1e-12);
    EXPECT_NEAR(moment->begin, 1.95, 1e-12);
    EXPECT_EQ(simulation.status().steps, 40U);
    std::vector<Vec3> expected(27);
    reference.get(reference.ids(), {.position = expected});
    EXPECT_EQ(moment->position, expected);
    const std::vector<PlotRow> rows = simulation.take_rows();
    ASSERT_EQ(rows.size(), 40U);
    EXPECT_NEAR(rows.back().total, reference.energy().total(), 1e-9);
}

TEST(Simulations, StepBackAndRestart) {
    Simulation simulation(small_gas(), 0.05, scene::ColourBy::material);
    simulation.run_to(1.499);
    simulation.wait_until_idle();
    const std::vector<Vec3> at_30 = simulation.moment()->position;
    for (int i = 0; i < 3; ++i) simulation.step();
    for (int i = 0; i < 3; ++i) simulation.step_back();
    simulation.wait_until_idle();
    EXPECT_EQ(simulation.status().steps, 30U);
    EXPECT_EQ(simulation.moment()->position, at_30);
    simulation.restart();
    simulation.step_back(); // there is nothing before the start
    simulation.wait_until_idle();
    EXPECT_EQ(simulation.status().steps, 0U);
    EXPECT_EQ(simulation.moment()->end, 0);
}

TEST(Simulations, TakeChangesBetweenSteps) {
    Simulation simulation(small_gas(), 0.05, scene::ColourBy::material);
    simulation.change([](World& world) { world.add({.position = {2, 2, 2}, .radius = 0.1}); });
    simulation.wait_until_idle();
    EXPECT_EQ(simulation.status().bodies, 28U);
    EXPECT_EQ(simulation.moment()->radii->back(), 0.1F);
    simulation.change([](World& world) { world.add({.radius = -1}); });
    simulation.wait_until_idle();
    EXPECT_NE(simulation.status().problem.find("radius"), std::string::npos);
    EXPECT_EQ(simulation.status().bodies, 28U);
    simulation.step();
    simulation.wait_until_idle();
    EXPECT_EQ(simulation.status().problem, "");
    EXPECT_EQ(simulation.status().steps, 1U);
}

TEST(Simulations, AStepThatFailsStopsThemUntilSomethingChanges) {
    World world({.resolution = 0x1p-40, .interpolation = true}); // 8e6 m to each side
    const BodyId id = world.add({.position = {7e6, 0, 0}, .velocity = {1e6, 0, 0}});
    Simulation simulation(std::move(world), 1, scene::ColourBy::material);
    simulation.run_to(10);
    simulation.wait_until_idle();
    EXPECT_FALSE(simulation.status().problem.empty());
    EXPECT_LT(simulation.status().time, 2);
    simulation.change([id](World& w) { w.set(id, {.position = {0, 0, 0}}); });
    simulation.wait_until_idle();
    EXPECT_EQ(simulation.status().problem, "");
    EXPECT_EQ(simulation.status().time, 10); // now it stands still
}

TEST(Simulations, AnswerWhileAStepIsSlow) {
    // A change that takes half a second holds up the simulation and nobody else.
    Simulation simulation(small_gas(), 0.05, scene::ColourBy::material);
    simulation.change([](World&) { std::this_thread::sleep_for(std::chrono::milliseconds(500)); });
    simulation.run_to(0.2);
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 10; ++i) {
        EXPECT_EQ(simulation.moment()->end, 0);
        EXPECT_EQ(simulation.status().steps, 0U);
    }
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(250));
    simulation.wait_until_idle();
    EXPECT_EQ(simulation.status().steps, 4U);
}

TEST(Simulations, AreWatchedAndChangedWhileTheyRun) {
    // For ThreadSanitizer: everything that the window does, while steps go on.
    Simulation simulation(small_gas(), 0.01, scene::ColourBy::speed);
    simulation.hear(true);
    const BodyId first = simulation.moment()->ids->front();
    double last = 0;
    std::size_t rows = 0;
    std::size_t strikes = 0;
    simulation.run_to(2);
    constexpr int orders = 50;
    for (int i = 0; last < 2; ++i) {
        std::this_thread::sleep_for(std::chrono::microseconds(i % 50));
        const auto moment = simulation.moment();
        const Status status = simulation.status();
        EXPECT_EQ(status.bodies, 27U);
        EXPECT_EQ(moment->position.size(), 27U);
        EXPECT_GE(moment->end, last);
        last = moment->end;
        rows += simulation.take_rows().size();
        strikes += simulation.take_strikes().size();
        if (i >= orders) continue;
        simulation.pick(i % 3 == 0 ? std::optional(first) : std::nullopt);
        simulation.show_forces(i % 3 == 0);
        simulation.colour_by(i % 3 == 0 ? scene::ColourBy::impact_rate : scene::ColourBy::speed);
        simulation.change([i](World& world) { world.set_gravity({0, 0, -0.1 * i}); });
    }
    simulation.wait_until_idle();
    rows += simulation.take_rows().size();
    strikes += simulation.take_strikes().size();
    EXPECT_EQ(rows, simulation.status().steps);
    EXPECT_NEAR(simulation.status().time, 2, 0.011);
    EXPECT_GT(strikes, 0U);
}

TEST(Hearing, OfASimulationIsOfItsImpacts) {
    Simulation simulation(small_gas(), 0.05, scene::ColourBy::material);
    simulation.run_to(0.999);
    simulation.wait_until_idle();
    EXPECT_TRUE(simulation.take_strikes().empty()); // nobody listens
    simulation.hear(true);
    simulation.run_to(1.999);
    simulation.wait_until_idle();
    const std::vector<TimedStrike> strikes = simulation.take_strikes();
    World world = small_gas();
    std::vector<double> expected;
    while (world.time() < 1.99) {
        world.step(0.05);
        if (world.time() < 1.01) continue;
        for (const Impact& impact : world.impacts())
            expected.insert(expected.end(), impact.b.is_set() ? 2 : 1, impact.time);
    }
    ASSERT_GT(expected.size(), 10U);
    ASSERT_EQ(strikes.size(), expected.size());
    for (std::size_t i = 0; i < strikes.size(); ++i) EXPECT_NEAR(strikes[i].time, expected[i], 1e-12);
    simulation.run_to(2.999);
    simulation.step_back();
    simulation.wait_until_idle();
    EXPECT_TRUE(simulation.take_strikes().empty()); // of a time that was left
}

} // namespace
} // namespace carom::viewer
