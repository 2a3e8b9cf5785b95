// The viewer without its window: simulation thread, way back, picking, look ahead, cameras, input and settings.
#include "scene/scene_error.hpp"
#include "scene/temporary_folder.hpp"
#include "sound/room.hpp"
#include "viewer/drawings.hpp"
#include "viewer/window/browser.hpp"
#include "viewer/window/camera_rig.hpp"
#include "viewer/window/detail.hpp"
#include "viewer/window/ears.hpp"
#include "viewer/window/history.hpp"
#include "viewer/window/next_impact.hpp"
#include "viewer/window/pace.hpp"
#include "viewer/window/picking.hpp"
#include "viewer/window/session.hpp"
#include "viewer/window/settings.hpp"
#include "viewer/window/simulation.hpp"

#include <carom/base.hpp>

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <optional>
#include <string>
#include <thread>
#include <vector>

namespace carom::viewer {
namespace {

using scene::TemporaryFolder;

World small_gas() {
    World world({.region = Box{{0, 0, 0}, {6, 6, 6}}, .interpolation = true});
    for (int i = 0; i < 27; ++i) {
        world.add({.position = site(i, 3) * 2 + Vec3{1, 1, 1}, .velocity = {1.0 + i % 5, 2.0 - i % 7, 0.5 * i - 6}});
    }
    return world;
}

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

TEST(Frames, ComeAtMostSixtyTimesASecondAndCostNothingInBetween) {
    constexpr int frames = 30;
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t used = std::clock();
    for (int i = 0; i < frames; ++i) pace(std::chrono::steady_clock::now());
    const auto passed = std::chrono::steady_clock::now() - start;
    EXPECT_GE(passed, frames * frame_time);
    EXPECT_LT(static_cast<double>(std::clock() - used) / CLOCKS_PER_SEC,
              0.2 * std::chrono::duration<double>(passed).count());
}

TEST(Frames, AreDrawnAsFinelyAsSixtyASecondAllow) {
    // What a picture costs goes by its pixels, and there is something that it costs in any case.
    const auto settles_at = [](double full, double fixed) {
        Detail detail;
        int changes = 0;
        for (int i = 0; i < 1000; ++i) {
            const int divisor = detail.divisor();
            detail.took(fixed + full / (divisor * divisor));
            if (i >= 500 && detail.divisor() != divisor) ++changes;
        }
        EXPECT_EQ(changes, 0) << "it swings: " << full << " s, " << fixed << " s";
        return detail.divisor();
    };
    EXPECT_EQ(settles_at(0.001, 0.001), 1);
    EXPECT_EQ(settles_at(0.015, 0.001), 1);
    EXPECT_EQ(settles_at(0.06, 0.001), 2);
    EXPECT_EQ(settles_at(0.12, 0.004), 3);
    EXPECT_EQ(settles_at(9, 1), 3);
    for (int i = 0; i < 100; ++i) settles_at(0.002 * i, 0.002);
    Detail detail;
    for (int i = 0; i < 100; ++i) detail.took(0.1);
    EXPECT_EQ(detail.divisor(), Detail::coarsest);
    for (int i = 0; i < 100; ++i) detail.took(0.001);
    EXPECT_EQ(detail.divisor(), 1);
}

// What comes next -----------------------------------------------------------------------------------------------------

TEST(NextImpact, IsTheOneThatTheWorldMakes) {
    for (const bool with_gravity : {false, true}) {
        World world({.gravity = {0, 0, with_gravity ? -9.81 : 0}, .region = Box{{-10, -10, 0}, {10, 10, 20}}});
        const BodyId flyer = world.add({.position = {-5, 0, 5}, .velocity = {4, 0, 3}});
        world.add({.position = {0.5, 0.2, 8}, .mass = infinite_mass, .radius = 1});
        world.add({.position = {5, 5, 9}, .velocity = {-1, -1, 0}});
        const auto next = LookAhead().next_impact(world, flyer, 100);
        ASSERT_TRUE(next);
        while (world.impacts().empty()) world.step(0.1);
        const Impact& first = world.impacts().front();
        EXPECT_NEAR(next->in, first.time, 1e-9);
        EXPECT_EQ(next->other, first.a == flyer ? first.b : first.a);
        EXPECT_EQ(next->face, first.face);
    }
}

TEST(NextImpact, OfFacesPlanesShellsAndNothing) {
    const auto next_in = [](const Region& region) {
        World world({.region = region});
        return LookAhead().next_impact(world, world.add({.velocity = {2, 0, 0}}), 100);
    };
    EXPECT_NEAR(next_in(Box{{-3, -3, -3}, {3, 3, 3}})->in, 1.25, 1e-12);
    EXPECT_EQ(next_in(Box{{-3, -3, -3}, {3, 3, 3}})->face, 1);
    EXPECT_NEAR(next_in(Shell{{0, 0, 0}, 4.5})->in, 2, 1e-12);
    const auto plane = next_in(std::vector<Plane>{{{0, 0, -9}, {0, 0, 1}}, {{5, 0, 0}, {-2, 0, 0}}});
    EXPECT_NEAR(plane->in, 2.25, 1e-12);
    EXPECT_EQ(plane->face, 1);
    EXPECT_FALSE(next_in(OpenSpace{}));
    World world;
    EXPECT_FALSE(LookAhead().next_impact(world, world.add({.mass = infinite_mass}), 100));
}

/// Asks ten times on the way to the first impact: each time it is told, and it is the one that comes.
void expect_first_impact_to_be_told(World world, BodyId flyer) {
    LookAhead look_ahead;
    World future = world;
    while (future.impacts().empty()) future.step(0.01);
    const Impact& first = future.impacts().front();
    const double part = (first.time - world.time()) / 10;
    for (int i = 0; i < 10; ++i) {
        const auto next = look_ahead.next_impact(world, flyer, 100);
        ASSERT_TRUE(next);
        EXPECT_NEAR(next->in, first.time - world.time(), 1e-9);
        EXPECT_EQ(next->face, first.face);
        world.step(part);
    }
}

TEST(NextImpact, WithObstacles) {
    const Frustum funnel{{0, 0, 2}, {0, 0, 1}, 1.5, 0.6, 1.9};
    const Mesh slope{{{-5, -5, 0}, {5, -5, 0}, {5, 5, 1}, {-5, 5, 1}}, {{{0, 1, 2}}, {{0, 2, 3}}}};
    for (const Vec3& position : {Vec3{0.9, 0, 8}, Vec3{-4, 1, 8}}) {
        World world({.gravity = {0, 0, -9.81}, .region = Box{{-9, -9, -5}, {9, 9, 20}}, .obstacles = {slope, funnel}});
        expect_first_impact_to_be_told(world,
                                       world.add({.position = position, .velocity = {0, 0.2, 0}, .radius = 0.1}));
    }
}

TEST(NextImpact, WithFacesThatMove) {
    Box shaker{{0, 0, 0}, {4, 4, 9}};
    shaker.faces[4].motion = {.amplitude = 0.3, .angular_frequency = 20};
    World world({.gravity = {0, 0, -9.81}, .region = shaker});
    const BodyId ball = world.add({.position = {2, 2, 6}, .radius = 0.1});
    world.step(0.123); // not at the beginning of the motion
    expect_first_impact_to_be_told(world, ball);
}

TEST(NextImpact, OfWhatLiesOnAnObstacleIsNone) {
    const Mesh table{{{-50, -50, 0}, {50, -50, 0}, {50, 50, 0}, {-50, 50, 0}}, {{{0, 1, 2}}, {{0, 2, 3}}}};
    World world({.gravity = {0, 0, -9.81}, .obstacles = {table}});
    const BodyId ball = world.add({.position = {0, 0, 0.5 + 1e-4}, .restitution = 0});
    LookAhead look_ahead;
    EXPECT_NEAR(look_ahead.next_impact(world, ball, 100)->in, std::sqrt(2e-4 / 9.81), 1e-6);
    world.step(1);
    EXPECT_FALSE(look_ahead.next_impact(world, ball, 100));
}

// Mouse and cameras ---------------------------------------------------------------------------------------------------

TEST(Picking, FindsTheNearestUnderTheMouse) {
    World world({.interpolation = true});
    world.add({.position = {0, 0, 0}});
    world.add({.position = {0, 5, 0}, .radius = 2});
    world.add({.position = {3, 0, 0}, .radius = 1e-6});
    const auto moment = Spectator(scene::ColourBy::material).look(world, false);
    const Camera camera{{0, -10, 0}, {0, 0, 0}};
    const auto slot_at = [&](double x, double y) {
        const auto found = body_at(*moment, 0, camera, {x, y, 400, 200});
        return found ? static_cast<int>(found->slot) : -1;
    };
    // Half the height of the picture is 10 tan 20 degrees = 3.64 m at the bodies.
    EXPECT_EQ(slot_at(200, 100), 0);
    EXPECT_EQ(slot_at(200 + 0.7 * 100 / 3.64, 100), 1);
    EXPECT_EQ(slot_at(200 + 3 * 100 / 3.64 + 1, 101), 2); // a pixel beside it
    EXPECT_EQ(slot_at(10, 10), -1);
}

TEST(Cameras, TurnShiftAndComeNearer) {
    Input input;
    CameraRig rig;
    rig.set_camera({{0, -10, 0}, {0, 0, 0}});
    const auto drag = [&](MouseButton button, double x, double y) {
        input.move_mouse(100, 100);
        input.press(button);
        input.move_mouse(100 + x, 100 + y);
        rig.move(input, 0.1, 1, 200);
        input.release(button);
        input.next_frame();
    };
    drag(MouseButton::left, 60, 20);
    EXPECT_NEAR(length(rig.camera().position), 10, 1e-9);
    EXPECT_LT(rig.camera().position.x, -1); // what is seen turns with the mouse
    EXPECT_GT(rig.camera().position.z, 1);
    for (int i = 0; i < 20; ++i) drag(MouseButton::left, 0, 500); // never over the pole
    EXPECT_GT(rig.camera().position.z, 9.9);
    EXPECT_GT(std::hypot(rig.camera().position.x, rig.camera().position.y), 0.1);
    rig.set_camera({{0, -10, 0}, {0, 0, 0}});
    input.turn_wheel(1);
    rig.move(input, 0.1, 1, 200);
    input.next_frame();
    EXPECT_NEAR(rig.camera().position.y, -8.8, 1e-9);
    rig.set_camera({{0, -10, 0}, {0, 0, 0}});
    drag(MouseButton::right, 100, 0); // half the height of the picture
    EXPECT_NEAR(rig.camera().target.x, -10 * std::tan(0.349066), 1e-4);
    EXPECT_EQ(rig.camera().position.x, rig.camera().target.x);
}

TEST(Cameras, FlyAndFollow) {
    Input input;
    CameraRig rig;
    rig.set_camera({{0, -10, 0}, {0, 0, 0}});
    rig.set_mode(CameraMode::fly);
    input.press(Key::w);
    rig.move(input, 1, 10, 200);
    EXPECT_NEAR(rig.camera().position.y, -3, 1e-9); // 0.7 sizes in a second
    input.release(Key::w);
    rig.follow({9, 9, 9});
    EXPECT_NEAR(rig.camera().position.y, -3, 1e-9);
    rig.set_mode(CameraMode::follow);
    rig.follow({9, 9, 9});
    EXPECT_EQ(rig.camera().target, (Vec3{9, 9, 9}));
    EXPECT_NEAR(length(rig.camera().position - rig.camera().target), 10, 1e-9);
}

TEST(Inputs, TellClicksFromDrags) {
    Input input;
    input.move_mouse(5, 5);
    input.press(MouseButton::left);
    input.move_mouse(6, 5);
    input.release(MouseButton::left);
    EXPECT_TRUE(input.clicked());
    EXPECT_TRUE(input.is_down(MouseButton::left)); // for this frame: it came and went within it
    input.next_frame();
    EXPECT_FALSE(input.clicked());
    EXPECT_FALSE(input.is_down(MouseButton::left));
    input.press(MouseButton::left);
    input.move_mouse(60, 5);
    input.release(MouseButton::left);
    EXPECT_FALSE(input.clicked());
    input.press(Key::space);
    input.press(Key::space); // what the system repeats is no second time
    EXPECT_EQ(input.pressed().size(), 1U);
}

// Ears ----------------------------------------------------------------------------------------------------------------

using test::Room;

TimedStrike strike_at(double time) { return {time, {.position = {0, 1, 0}, .restitution = 0}}; }

TEST(Hearing, IsInTimeWithThePicture) {
    Room room;
    Ears ears(test::speaker_in(room));
    ASSERT_TRUE(test::eventually([&] { return ears.audible(); }));
    // Frames of 50 ms that show 0.2 s of the world each; the simulation is ahead by two of them.
    const std::vector<double> times{0.1, 0.5, 0.85, 1.3};
    std::size_t next = 0;
    for (int frame = 0; frame < 10; ++frame) {
        const double before = 0.2 * frame;
        for (; next < times.size() && times[next] <= before + 0.6; ++next) {
            const TimedStrike strike = strike_at(times[next]);
            ears.add({&strike, 1});
        }
        ears.hear(before, before + 0.2, 0.05, {});
        test::pass(room, 0.05);
    }
    const std::vector<double> heard = test::onsets(room);
    ASSERT_EQ(heard.size(), times.size());
    for (std::size_t i = 0; i < times.size(); ++i) EXPECT_NEAR(heard[i], 0.025 + times[i] / 4, 0.005) << i;
    EXPECT_EQ(ears.heard(), times.size());
    EXPECT_EQ(ears.problem(), "");
}

TEST(Hearing, ForgetsWhatDoesNotHappenAnyMore) {
    Room room;
    Ears ears(test::speaker_in(room));
    ASSERT_TRUE(test::eventually([&] { return ears.audible(); }));
    const std::vector<TimedStrike> strikes{strike_at(0.5), strike_at(1.5)};
    ears.add(strikes);
    ears.hear(1, 1, 0.1, {});   // the first one is late, and heard at once
    ears.hear(1, 0.9, 0.1, {}); // a step back
    ears.hear(0.9, 9, 0.1, {});
    EXPECT_EQ(ears.heard(), 1U);
    ears.add(strikes);
    ears.begin_scene({});
    ears.hear(0, 9, 0.1, {});
    EXPECT_EQ(ears.heard(), 1U);
}

TEST(Hearing, SaysWhyThereIsNoneAndTriesAgain) {
    Room room;
    room.plugged = false;
    Ears ears(test::speaker_in(room));
    ASSERT_TRUE(test::eventually([&] { return !ears.problem().empty(); }));
    EXPECT_EQ(ears.problem(), "sound: there is no sound device");
    const TimedStrike strike = strike_at(0.5);
    ears.add({&strike, 1});
    ears.hear(0, 1, 0.1, {});
    EXPECT_EQ(ears.heard(), 0U);
    test::plug(room, true);
    ears.try_again();
    ASSERT_TRUE(test::eventually([&] { return ears.audible(); }));
    EXPECT_EQ(ears.problem(), "");
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

// Sessions ------------------------------------------------------------------------------------------------------------

constexpr const char* two_balls = R"(
title = "Two balls"
[run]
dt = 0.1
[world]
gravity = [0, 0, -10]
[region]
kind = "box"
min = [-5, -5, 0]
max = [5, 5, 10]
[[bodies]]
position = [[-2, 0, 1], [2, 0, 8]]
restitution = 0.5
[camera]
position = [0, -20, 5]
target = [0, 0, 5]
[picture]
time_scale = 2
)";

TEST(Sessions, ShowTimeAsItIsAskedFor) {
    const TemporaryFolder folder;
    Session session(folder.write("two.toml", two_balls));
    EXPECT_EQ(session.title(), "Two balls");
    for (int i = 0; i < 30; ++i) session.advance(1.0 / 60, true);
    EXPECT_NEAR(session.time(), 1, 1e-9); // of half a second, twice as fast
    EXPECT_NEAR(session.lag(), 0, 1e-9);
    session.set_paused(true);
    session.advance(1, true);
    EXPECT_NEAR(session.time(), 1, 0.1 + 1e-9);
    const std::uint64_t steps = session.status().steps;
    session.step();
    session.advance(0, true);
    EXPECT_EQ(session.status().steps, steps + 1);
    session.step_back();
    session.step_back();
    session.advance(0, true);
    EXPECT_EQ(session.status().steps, steps - 1);
    EXPECT_NEAR(session.time(), 0.1 * static_cast<double>(steps - 1), 1e-12);
}

TEST(Sessions, KeepUpWithTheClock) {
    // Steps as long as frames: what is shown must not wait for each of them in turn.
    const TemporaryFolder folder;
    Session session(folder.write("one.toml", "[[bodies]]\nposition = [0, 0, 0]\n"));
    auto next = std::chrono::steady_clock::now();
    double asked_for = 0;
    for (int i = 0; i < 60; ++i) {
        session.advance(1.0 / 60, false);
        asked_for += 1.0 / 60;
        next += std::chrono::microseconds(16667);
        std::this_thread::sleep_until(next);
    }
    EXPECT_GT(session.time(), 0.7 * asked_for);
    EXPECT_NEAR(session.time() + session.lag(), asked_for, 1e-9);
}

TEST(Sessions, SayHowFarTheyLag) {
    const TemporaryFolder folder;
    Session session(folder.write("two.toml", two_balls));
    session.advance(1000, false); // 20 000 steps are not done at once
    EXPECT_GT(session.lag(), 1000);
    session.set_paused(true);
    session.advance(1, false);
    EXPECT_EQ(session.lag(), 0);
}

TEST(Sessions, RestartWithoutWaitingForAStep) {
    const TemporaryFolder folder;
    Session session(folder.write("two.toml", two_balls));
    session.advance(1, true);
    EXPECT_NEAR(session.time(), 2, 1e-9);
    session.advance(1000, false); // 20 000 steps
    session.restart();
    session.restart();
    int frames = 0;
    while (session.moment()->era < 2 && ++frames < 10'000) {
        session.advance(1e-3, false);
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    EXPECT_EQ(session.time(), 0);
    EXPECT_LT(session.status().steps, 3U); // it goes on from there, and not to where it was
    EXPECT_TRUE(session.plots().empty());
    session.advance(0.5, true);
    EXPECT_NEAR(session.time(), 1, 1e-9);
}

TEST(Sessions, PickShootAndChange) {
    const TemporaryFolder folder;
    Session session(folder.write("two.toml", two_balls));
    session.set_paused(true);
    session.advance(0, true);
    const Place at_right{300 + 300 * 2 / (20 * std::tan(0.349066)), 300 - 300 * 3 / (20 * std::tan(0.349066)), 600,
                         600};
    session.pick_at(at_right);
    session.advance(0, true);
    ASSERT_TRUE(session.picked());
    EXPECT_EQ(session.picked()->slot, 1U);
    ASSERT_TRUE(session.status().picked);
    EXPECT_EQ(session.status().picked->body.position.z, 8);
    EXPECT_NEAR(session.status().picked->next->in, std::sqrt(2 * 7.5 / 10), 1e-9);

    session.projectile = {0.25, 3, 50};
    session.shoot({300, 300, 600, 600});
    session.advance(0, true);
    EXPECT_EQ(session.status().bodies, 3U);
    EXPECT_EQ(session.status().problem, "");
    EXPECT_EQ(session.moment()->radii->back(), 0.25F);
    EXPECT_LT(session.moment()->position.back().y, -4); // inside the box, at its wall
    session.projectile.radius = 30;
    session.shoot({300, 300, 600, 600});
    session.advance(0, true);
    EXPECT_EQ(session.status().bodies, 3U);
    EXPECT_NE(session.status().problem, "");

    session.set_gravity({0, 0, 0});
    session.set_restitution(1);
    session.set_drag({.linear = 0.5});
    session.set_paused(false);
    for (int i = 0; i < 60; ++i) session.advance(1.0 / 60, true);
    EXPECT_EQ(session.status().problem, "");
    EXPECT_EQ(session.moment()->position[1], (Vec3{2, 0, 8})); // nothing pulls it down any more
}

TEST(Sessions, OpenSnapshotsAndRefuseOtherFiles) {
    const TemporaryFolder folder;
    World world = small_gas();
    world.step(0.1);
    const std::vector<std::byte> bytes = world.save();
    const auto file = folder.write("gas.carom", {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    Session session(file);
    session.advance(0.1, true);
    EXPECT_EQ(session.status().bodies, 27U);
    EXPECT_GT(session.time(), 0.1);
    EXPECT_THROW(Session(folder.write("cut.carom", {reinterpret_cast<const char*>(bytes.data()), 100})),
                 scene::SceneError);
    EXPECT_THROW(Session(folder.path() / "missing.carom"), scene::SceneError);
    EXPECT_THROW(Session(folder.write("bad.toml", "x = 1")), scene::SceneError);
}

TEST(Sessions, HearFromTheCameraAndWithWhomItFollows) {
    const TemporaryFolder folder;
    Session session(folder.write("two.toml", two_balls));
    EXPECT_EQ(session.sound_settings().reference_distance, 10); // half the way to the target
    sound::Listener listener = session.listener();
    EXPECT_EQ(listener.position, (Vec3{0, -20, 5}));
    EXPECT_EQ(listener.forward, (Vec3{0, 1, 0}));
    EXPECT_EQ(listener.velocity, Vec3{});
    session.pick(session.moment()->ids->at(1));
    session.rig().set_mode(CameraMode::follow);
    session.advance(0.05, true); // a step: it falls
    EXPECT_NEAR(session.listener().velocity.z, -1, 1e-9);
    session.rig().set_camera({{0, 0, 9}, {0, 0, 0}, {0, 0, 1}}); // straight down: up is not along it
    listener = session.listener();
    EXPECT_NEAR(dot(listener.up, listener.forward), 0, 1e-12);
}

TEST(Sessions, AreFineWithoutBodies) {
    const TemporaryFolder folder;
    Session session(folder.write("empty.toml", ""));
    session.advance(0.1, true);
    session.pick_at({5, 5, 10, 10});
    EXPECT_FALSE(session.picked());
    EXPECT_TRUE(session.draw().bodies.empty());
    session.shoot({5, 5, 10, 10});
    session.advance(0, true);
    EXPECT_EQ(session.status().bodies, 1U);
}

TEST(Browsers, ListScenesInOrderAndSayWhatIsWrong) {
    const TemporaryFolder folder;
    (void)folder.write("b.toml", two_balls);
    (void)folder.write("a.toml", "nonsense = 1");
    (void)folder.write("c.txt", "");
    const Browser browser(folder.path());
    ASSERT_EQ(browser.entries().size(), 2U);
    EXPECT_NE(scene_at_start(browser.entries()[0].file).problem.find("nonsense"), std::string::npos);
    EXPECT_EQ(scene_at_start(browser.entries()[1].file).moment->position.size(), 2U);
    EXPECT_TRUE(Browser(folder.path() / "nowhere").entries().empty());
}

// What is remembered --------------------------------------------------------------------------------------------------

TEST(ViewSettings, ComeBack) {
    const TemporaryFolder folder;
    Settings settings;
    settings.width = 640;
    settings.height = 480;
    settings.volume = 0.25;
    settings.muted = true;
    settings.cameras["/scenes/a b.toml"] = {{1, 2, 3}, {4, 5, 6}, {0, 1, 0}, 25};
    const auto file = folder.path() / "deep/er/view.json";
    save_settings(settings, file);
    const Settings back = load_settings(file);
    EXPECT_EQ(back.width, 640);
    EXPECT_EQ(back.height, 480);
    EXPECT_EQ(back.volume, 0.25);
    EXPECT_TRUE(back.muted);
    const Camera& camera = back.cameras.at("/scenes/a b.toml");
    EXPECT_EQ(camera.position, (Vec3{1, 2, 3}));
    EXPECT_EQ(camera.target, (Vec3{4, 5, 6}));
    EXPECT_EQ(camera.up, (Vec3{0, 1, 0}));
    EXPECT_EQ(camera.field_of_view, 25);
}

TEST(ViewSettings, ThatMakeNoSenseAreTheUsualOnes) {
    const TemporaryFolder folder;
    EXPECT_EQ(load_settings(folder.path() / "missing.json").width, Settings{}.width);
    for (const char* text :
         {"", "{", "[]", "3", R"({"width": "x"})", R"({"width": -5, "height": 1e9, "cameras": {}})",
          R"({"volume": "x", "cameras": {}})",
          R"({"cameras": {"a": {"position": [1, 2], "target": [0, 0, 0], "up": [0, 0, 1], "field_of_view": 4}}})",
          R"({"cameras": {"a": {"position": [1, 2, 3], "target": [1, 2, 3], "up": [0, 0, 1], "field_of_view": 4}}})"}) {
        const Settings settings = load_settings(folder.write("view.json", text));
        EXPECT_EQ(settings.width, Settings{}.width) << text;
        EXPECT_EQ(settings.height, Settings{}.height) << text;
        EXPECT_TRUE(settings.cameras.empty()) << text;
    }
}

} // namespace
} // namespace carom::viewer
