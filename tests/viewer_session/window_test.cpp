// What the window is made of: its pace, looking ahead, mouse and cameras, and its ears.
#include "sound/room.hpp"
#include "viewer/window/camera_rig.hpp"
#include "viewer/window/detail.hpp"
#include "viewer/window/ears.hpp"
#include "viewer/window/next_impact.hpp"
#include "viewer/window/pace.hpp"
#include "viewer/window/picking.hpp"

#include <carom/world.hpp>

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <ctime>
#include <vector>

namespace carom::viewer {
namespace {

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

} // namespace
} // namespace carom::viewer
