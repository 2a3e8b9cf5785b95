// What the window shows and what its user does there, the scenes that can be opened, and what is remembered.
#include "scene/scene_error.hpp"
#include "scene/temporary_folder.hpp"
#include "viewer/window/browser.hpp"
#include "viewer/window/session.hpp"
#include "viewer/window/settings.hpp"
#include "viewer_session/small_gas.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

namespace carom::viewer {
namespace {

using scene::TemporaryFolder;

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
