// The scenes of this project, and worlds made from scenes: each loads and runs; what the engine refuses is told in the
// words of the file.
#include "scene/scene.hpp"
#include "scene/workloads.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace carom::scene {
namespace {

std::vector<std::string> scene_files() {
    std::vector<std::string> files;
    for (const auto& entry : std::filesystem::directory_iterator("scenes")) {
        if (entry.path().extension() == ".toml") files.push_back(entry.path().string());
    }
    std::sort(files.begin(), files.end());
    return files;
}

TEST(Scenes, AllThatAreNamedInTheDocumentationAreThere) {
    for (const char* name : {"two_bodies", "newtons_cradle", "bouncing_balls", "pi", "gas", "cooling", "rain", "heap",
                             "tower", "hopper", "drum", "shaker", "avalanche", "asteroids"}) {
        EXPECT_TRUE(std::filesystem::exists(std::string("scenes/") + name + ".toml")) << name;
    }
}

TEST(Scenes, EachLoadsAndRunsInBothPrecisions) {
    for (const std::string& file : scene_files()) {
        for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
            Overrides overrides;
            overrides.precision = precision;
            const Scene scene = load_scene(file, overrides);
            EXPECT_NE(scene.title, scene.name) << file;
            World world = make_world(scene);
            EXPECT_EQ(world.size(), scene.bodies.size());
            for (int step = 0; step < 3; ++step) EXPECT_EQ(world.step(scene.run.dt).behind, 0) << file;
            const Energy energy = world.energy();
            EXPECT_TRUE(std::isfinite(energy.total())) << file;
        }
    }
}

TEST(Scenes, EachWorkloadRuns) {
    for (const WorkloadInfo& info : workload_list()) {
        for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
            const Workload made = workload(info.name, 1000, precision);
            World world = make_world(made.scene);
            const double before = world.energy().total();
            for (int step = 0; step < 5; ++step) EXPECT_EQ(world.step(made.scene.run.dt).behind, 0) << info.name;
            const double lost = world.ledger().lost_to_restitution;
            EXPECT_NEAR(world.energy().total() + lost, before, 1e-6 * before) << info.name;
        }
    }
}

TEST(Scenes, IdsAreInTheOrderOfTheBodies) {
    const Scene scene = parse_scene(R"(
[[bodies]]
generator = "random"
min = [0, 0, 0]
max = [30, 30, 30]
count = 100
[[bodies]]
position = [50, 0, 0]
mass = 7
)",
                                    "s.toml");
    const World world = make_world(scene);
    const std::vector<BodyId> ids = world.ids();
    ASSERT_EQ(ids.size(), 101U);
    EXPECT_EQ(world.get(ids[100]).mass, 7);
    for (std::size_t i = 0; i < 100; ++i) {
        EXPECT_LE(length(world.get(ids[i]).position - scene.bodies.position[i]), 2 * world.resolution());
    }
}

TEST(Scenes, ATiedAttractorMovesWithItsBody) {
    World world = make_world(parse_scene(R"(
[[bodies]]
name = "planet"
position = [0, 0, 0]
mass = inf
radius = 10
[[attractor]]
body = "planet"
strength = 1000
[[bodies]]
position = [30, 0, 0]
velocity = { distribution = "orbit", normal = [0, 0, 1] }
)",
                                         "s.toml"));
    ASSERT_EQ(world.attractors().size(), 1U);
    EXPECT_EQ(world.attractors()[0].body, world.ids()[0]);
    const double period = 2 * std::acos(-1.0) * std::sqrt(30.0 * 30 * 30 / 1000);
    for (int i = 0; i < 1000; ++i) world.step(period / 1000);
    EXPECT_NEAR(length(world.get(world.ids()[1]).position - Vec3{30, 0, 0}), 0, 1e-2); // once around
}

std::string refusal_of(std::string_view text) {
    try {
        (void)make_world(parse_scene(text, "s.toml"));
    } catch (const SceneError& error) {
        return error.what();
    }
    return "nothing was refused";
}

TEST(Scenes, AnOverlapNamesBothBodies) {
    const std::string message = refusal_of(R"(
[[bodies]]
position = [0, 0, 0]

[[bodies]]
position = [[5, 0, 0], [0.75, 0, 0]]
)");
    EXPECT_NE(message.find("bodies["), std::string::npos) << message;
    EXPECT_NE(message.find("overlaps body "), std::string::npos) << message;
    EXPECT_NE(message.find("by 0.25 m"), std::string::npos) << message;
    EXPECT_NE(message.find("body 0"), std::string::npos) << message;
    EXPECT_NE(message.find("body 2"), std::string::npos) << message;
    EXPECT_NE(message.find("line 2"), std::string::npos) << message;
    EXPECT_NE(message.find("overlap = \"accept\""), std::string::npos) << message;
}

TEST(Scenes, AnOverlapAcrossPeriodicFacesNamesBothBodies) {
    const std::string message = refusal_of(R"(
[region]
kind = "box"
min = [0, 0, 0]
max = [9, 9, 9]
faces = { x = "periodic" }
[[bodies]]
position = [[0.25, 5, 5], [8.75, 5, 5]]
)");
    EXPECT_NE(message.find("overlaps body "), std::string::npos) << message;
    EXPECT_NE(message.find("by 0.5 m"), std::string::npos) << message;
}

TEST(Scenes, AnAcceptedOverlapIsTaken) {
    const Scene scene =
        parse_scene("[world]\noverlap = \"accept\"\n[[bodies]]\nposition = [[0, 0, 0], [0.5, 0, 0]]\n", "s.toml");
    EXPECT_EQ(make_world(scene).size(), 2U);
}

TEST(Scenes, WhatTheEngineRefusesIsNamedByEntry) {
    const std::string outside = refusal_of("[region]\nkind = \"box\"\nmin = [0, 0, 0]\nmax = [9, 9, "
                                           "9]\n[[bodies]]\nposition = [[5, 5, 5], [0.25, 5, 5]]\n");
    EXPECT_EQ(outside.substr(0, 20), "s.toml:5: bodies[0].") << outside;
    EXPECT_NE(outside.find("body 1"), std::string::npos) << outside;
    const std::string far_out = refusal_of("[[bodies]]\nposition = [0, 1e9, 0]\n");
    EXPECT_EQ(far_out.substr(0, 20), "s.toml:1: bodies[0].") << far_out;
    EXPECT_NE(far_out.find("resolution"), std::string::npos) << far_out;
}

TEST(Scenes, WhatTheEngineRefusesOfTheWorldIsNamedByKey) {
    const std::string message = refusal_of("[world]\n\nresolution = 4\norigin = [3, 0, 0]\n");
    EXPECT_EQ(message.substr(0, 22), "s.toml:4: world.origin") << message;
}

} // namespace
} // namespace carom::scene
