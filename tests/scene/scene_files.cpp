// Scene files: what each key does, and what is said about every kind of mistake.
#include "bits.hpp"
#include "scene/scene.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace carom::scene {
namespace {

Scene parsed(std::string_view text, const Overrides& overrides = {}) { return parse_scene(text, "s.toml", overrides); }

// What the keys do ---------------------------------------------------------------------------------------------------

TEST(SceneFile, AnEmptyFileIsAnEmptyWorld) {
    const Scene scene = parsed("");
    EXPECT_EQ(scene.name, "s");
    EXPECT_EQ(scene.title, "s");
    EXPECT_EQ(scene.bodies.size(), 0U);
    EXPECT_EQ(scene.options.precision, Precision::double_precision);
    EXPECT_TRUE(std::holds_alternative<OpenSpace>(scene.options.region));
    EXPECT_EQ(scene.run.time, 10);
    EXPECT_FALSE(scene.run.steps);
}

TEST(SceneFile, ReadsTheWorld) {
    const Scene scene = parsed(R"(
title = "T"
seed = 9
[world]
gravity = [0, 1, -9.81]
drag = { linear = 0.5, quadratic = 0.25 }
resolution = "2^-30"
origin = [1000000000, 0, -5]
rest_time = 0.01
collapse_time = 1e-6
work_cap = 1000
interpolation = true
overlap = "accept"
)");
    const WorldOptions& options = scene.options;
    EXPECT_EQ(scene.title, "T");
    EXPECT_EQ(scene.seed, 9U);
    EXPECT_EQ(options.gravity, (Vec3{0, 1, -9.81}));
    EXPECT_EQ(options.drag.linear, 0.5);
    EXPECT_EQ(options.drag.quadratic, 0.25);
    EXPECT_EQ(options.resolution, 0x1p-30);
    EXPECT_EQ(options.origin, (std::array<std::int64_t, 3>{1000000000, 0, -5}));
    EXPECT_EQ(options.rest_time, 0.01);
    EXPECT_EQ(options.collapse_time, 1e-6);
    EXPECT_EQ(options.work_cap, 1000U);
    EXPECT_TRUE(options.interpolation);
    EXPECT_EQ(scene.overlap, Overlap::accept);
    EXPECT_EQ(parsed("[world]\nresolution = 0.25\ndrag = 2").options.resolution, 0.25);
    EXPECT_EQ(parsed("[world]\ndrag = 2").options.drag.linear, 2);
}

TEST(SceneFile, ReadsRunAndOutput) {
    const Scene scene = parsed(R"(
[run]
steps = 30
dt = "1/60"
precision = "single"
threads = 3
[output]
timeline_every = 0.5
checkpoint_every = 2
energy_plot = false
record_impacts = true
least_recorded_impulse = 0.125
check_overlap = false
)");
    EXPECT_EQ(scene.run.steps, 30U);
    EXPECT_EQ(scene.run.dt, 1.0 / 60);
    EXPECT_EQ(scene.run.time, 0.5);
    EXPECT_EQ(scene.run.threads, 3U);
    EXPECT_EQ(scene.options.precision, Precision::single_precision);
    EXPECT_EQ(scene.outputs.timeline_every, 0.5);
    EXPECT_EQ(scene.outputs.checkpoint_every, 2);
    EXPECT_FALSE(scene.outputs.energy_plot);
    EXPECT_TRUE(scene.outputs.record_impacts);
    EXPECT_TRUE(scene.options.record_impacts);
    EXPECT_EQ(scene.options.least_recorded_impulse, 0.125);
    EXPECT_FALSE(scene.outputs.check_overlap);
    EXPECT_FALSE(parsed("").options.record_impacts);
}

TEST(SceneFile, ReadsCameraAndPicture) {
    const ViewSettings view = parsed(R"(
[camera]
target = [1, 2, 3]
up = [0, 3, 0]
field_of_view = 30
[[camera.path]]
time = 0
position = [9, 0, 0]
target = [0, 0, 0]
[[camera.path]]
time = 2.5
position = [0, 9, 0]
target = [0, 0, 1]
field_of_view = 60
[picture]
colour_by = "impact_rate"
time_scale = 0.5
moment = 1.5
trails = 2
forces = true
)")
                                  .view;
    EXPECT_FALSE(view.camera.position);
    EXPECT_EQ(view.camera.target, (Vec3{1, 2, 3}));
    EXPECT_EQ(view.camera.up, (Vec3{0, 1, 0}));
    ASSERT_EQ(view.camera.path.size(), 2U);
    EXPECT_EQ(view.camera.path[0].field_of_view, 30);
    EXPECT_EQ(view.camera.path[1].time, 2.5);
    EXPECT_EQ(view.camera.path[1].position, (Vec3{0, 9, 0}));
    EXPECT_EQ(view.camera.path[1].target, (Vec3{0, 0, 1}));
    EXPECT_EQ(view.camera.path[1].field_of_view, 60);
    EXPECT_EQ(view.picture.colour_by, ColourBy::impact_rate);
    EXPECT_EQ(view.picture.time_scale, 0.5);
    EXPECT_EQ(view.picture.moment, 1.5);
    EXPECT_EQ(view.picture.trails, 2);
    EXPECT_TRUE(view.picture.forces);
    EXPECT_FALSE(parsed("").view.picture.moment);
}

TEST(SceneFile, TheCommandLineGoesFirst) {
    constexpr const char* text = "[run]\nsteps = 30\ndt = 0.5\nprecision = \"single\"\nthreads = 3";
    Overrides overrides;
    overrides.time = 4;
    overrides.dt = 0.25;
    overrides.threads = 1;
    overrides.precision = Precision::double_precision;
    overrides.checkpoint_every = 7;
    const Scene scene = parsed(text, overrides);
    EXPECT_FALSE(scene.run.steps);
    EXPECT_EQ(scene.run.time, 4);
    EXPECT_EQ(scene.run.dt, 0.25);
    EXPECT_EQ(scene.run.threads, 1U);
    EXPECT_EQ(scene.options.precision, Precision::double_precision);
    EXPECT_EQ(scene.outputs.checkpoint_every, 7);
    Overrides steps;
    steps.steps = 8;
    EXPECT_EQ(parsed(text, steps).run.time, 4);
    EXPECT_EQ(parsed("[run]\ntime = 99", steps).run.steps, 8U);
}

TEST(SceneFile, ReadsABox) {
    const Scene scene = parsed(R"(
[region]
kind = "box"
min = [0, 0, 0]
max = [1, 2, 3]
restitution = 0.5
faces = { x = "periodic", y_min = { friction = 0.1 }, z_min = { restitution = 0 }, z_max = "open" }
)");
    const Box& box = std::get<Box>(scene.options.region);
    EXPECT_EQ(box.max, (Vec3{1, 2, 3}));
    EXPECT_EQ(box.faces[0].kind, FaceKind::periodic);
    EXPECT_EQ(box.faces[1].kind, FaceKind::periodic);
    EXPECT_EQ(box.faces[2].kind, FaceKind::reflecting);
    EXPECT_EQ(box.faces[2].surface.restitution, 0.5);
    EXPECT_EQ(box.faces[2].surface.friction, 0.1);
    EXPECT_FALSE(box.faces[3].surface.friction);
    EXPECT_EQ(box.faces[4].surface.restitution, 0);
    EXPECT_EQ(box.faces[5].kind, FaceKind::open);
}

TEST(SceneFile, ReadsMotions) {
    const Scene scene = parsed(R"(
[region]
kind = "box"
min = [0, 0, 0]
max = [1, 2, 3]
faces = { x_max = { motion = { velocity = 0.5 } }, z_min = { motion = { amplitude = 0.1, angular_frequency = 20, phase = 1, surface_velocity = [1, 0, 0] } } }
)");
    const Box& box = std::get<Box>(scene.options.region);
    EXPECT_EQ(box.faces[1].motion, (FaceMotion{.velocity = 0.5}));
    EXPECT_EQ(box.faces[4].motion,
              (FaceMotion{.amplitude = 0.1, .angular_frequency = 20, .phase = 1, .surface_velocity = {1, 0, 0}}));
    EXPECT_EQ(box.faces[0].motion, FaceMotion{});
    const Scene planes = parsed("[region]\nkind = \"planes\"\nplane = [{ motion = { velocity = -2 } }]\n");
    EXPECT_EQ(std::get<std::vector<Plane>>(planes.options.region)[0].motion, (FaceMotion{.velocity = -2}));
}

TEST(SceneFile, ReadsPlanesAndShells) {
    const Scene planes = parsed(R"(
[region]
kind = "planes"
[[region.plane]]
point = [0, 0, 1]
normal = [0, 0, 4]
restitution = 0.5
[[region.plane]]
normal = [1, 0, 0]
)");
    const auto& list = std::get<std::vector<Plane>>(planes.options.region);
    ASSERT_EQ(list.size(), 2U);
    EXPECT_EQ(list[0].point, (Vec3{0, 0, 1}));
    EXPECT_EQ(list[0].normal, (Vec3{0, 0, 1}));
    EXPECT_EQ(list[0].surface.restitution, 0.5);
    EXPECT_FALSE(list[1].surface.restitution);
    const Scene shell = parsed("[region]\nkind = \"shell\"\nradius = 5\ncentre = [1, 2, 3]\nfriction = 0.25");
    EXPECT_EQ(std::get<Shell>(shell.options.region).radius, 5);
    EXPECT_EQ(std::get<Shell>(shell.options.region).centre, (Vec3{1, 2, 3}));
    EXPECT_EQ(std::get<Shell>(shell.options.region).surface.friction, 0.25);
    EXPECT_TRUE(std::holds_alternative<OpenSpace>(parsed("[region]\nkind = \"open\"").options.region));
}

TEST(SceneFile, ReadsListedBodies) {
    const Scene scene = parsed(R"(
[[bodies]]
position = [1, 2, 3]
velocity = [4, 5, 6]
mass = 7
radius = 8
restitution = 0.5
friction = 0.25

[[bodies]]
position = [[100, 0, 0], [200, 0, 0]]
velocity = [[1, 0, 0], [0, 0, 0]]
mass = [3, inf]

[[bodies]]
position = [[300, 0, 0], [400, 0, 0]]
velocity = [0, 1, 0]
radius = [1, 2]
density = 2
)");
    const BodyTable& bodies = scene.bodies;
    ASSERT_EQ(bodies.size(), 5U);
    EXPECT_EQ(bodies.position[0], (Vec3{1, 2, 3}));
    EXPECT_EQ(bodies.position[2], (Vec3{200, 0, 0}));
    EXPECT_EQ(bodies.velocity[0], (Vec3{4, 5, 6}));
    EXPECT_EQ(bodies.velocity[1], (Vec3{1, 0, 0}));
    EXPECT_EQ(bodies.velocity[4], (Vec3{0, 1, 0}));
    EXPECT_EQ(bodies.radius, (std::vector<double>{8, 0.5, 0.5, 1, 2}));
    EXPECT_EQ(bodies.restitution, (std::vector<double>{0.5, 1, 1, 1, 1}));
    EXPECT_EQ(bodies.friction, (std::vector<double>{0.25, 0, 0, 0, 0}));
    EXPECT_EQ(bodies.mass[0], 7);
    EXPECT_EQ(bodies.mass[1], 3);
    EXPECT_EQ(bodies.mass[2], infinite_mass);
    EXPECT_NEAR(bodies.mass[3], 8 * std::numbers::pi / 3, 1e-14);
    EXPECT_NEAR(bodies.mass[4], 64 * std::numbers::pi / 3, 1e-13);
    ASSERT_EQ(scene.sources.size(), 3U);
    EXPECT_EQ(scene.sources[1].key, "bodies[1]");
    EXPECT_EQ(scene.sources[1].line, 10);
    EXPECT_EQ(scene.sources[1].first, 1U);
    EXPECT_EQ(scene.sources[1].count, 2U);
}

TEST(SceneFile, MaterialsAndTheirRules) {
    const Scene scene = parsed(R"(
[[material]]
name = "ice"
restitution = 0.5
friction = 0.125
[[material]]
name = "rock"
restitution = 0.75
[[material_rule]]
between = ["rock", "ice"]
restitution = 0.25
friction = 0.5
[[bodies]]
position = [0, 0, 0]
material = "rock"
[[bodies]]
position = [5, 0, 0]
material = "ice"
friction = 2
[[bodies]]
position = [10, 0, 0]
)");
    EXPECT_EQ(scene.bodies.material, (std::vector<std::uint32_t>{2, 1, 0}));
    EXPECT_EQ(scene.bodies.restitution, (std::vector<double>{0.75, 0.5, 1}));
    EXPECT_EQ(scene.bodies.friction, (std::vector<double>{0, 2, 0}));
    ASSERT_EQ(scene.options.material_rules.size(), 1U);
    EXPECT_EQ(scene.options.material_rules[0].a, 2U);
    EXPECT_EQ(scene.options.material_rules[0].b, 1U);
    EXPECT_EQ(scene.options.material_rules[0].restitution, 0.25);
    EXPECT_EQ(scene.options.material_rules[0].friction, 0.5);
}

TEST(SceneFile, LawsOfRestitution) {
    const Scene scene = parsed(R"(
[[material]]
name = "rock"
[[material]]
name = "ice"
restitution = { law = "power", restitution = 0.32, speed = 0.01, exponent = 0.234 }
[[material_rule]]
between = ["rock", "ice"]
restitution = { law = "viscoelastic", dissipation = 1e-5, modulus = 1e9 }
[[bodies]]
position = [0, 0, 0]
material = "ice"
)");
    ASSERT_EQ(scene.options.materials.size(), 1U);
    EXPECT_EQ(scene.options.materials[0].key, 2U);
    EXPECT_EQ(scene.options.materials[0].restitution, RestitutionLaw(PowerLaw{0.32, 0.01, 0.234}));
    ASSERT_EQ(scene.options.material_rules.size(), 1U);
    EXPECT_EQ(scene.options.material_rules[0].law, RestitutionLaw(Viscoelastic{1e-5, 1e9}));
    const World world = make_world(scene);
    EXPECT_EQ(world.options().materials[0].restitution, scene.options.materials[0].restitution);
}

TEST(SceneFile, TiedAttractorsAndOrbitsAroundThem) {
    const Scene scene = parsed(R"(
[[attractor]]
position = [0, 0, 1000]
strength = -2
softening = 0.5
[[attractor]]
body = "moon"
strength = 8
[[bodies]]
position = [5000, 0, 0]
[[bodies]]
name = "moon"
position = [100, 0, 0]
velocity = [0, 0, 3]
radius = 1
[[bodies]]
position = [102, 0, 0]
around = "moon"
velocity = { distribution = "orbit", normal = [0, 0, 1] }
)");
    ASSERT_EQ(scene.attractors.size(), 2U);
    EXPECT_EQ(scene.attractors[0].position, (Vec3{0, 0, 1000}));
    EXPECT_EQ(scene.attractors[0].strength, -2);
    EXPECT_EQ(scene.attractors[0].softening, 0.5);
    EXPECT_FALSE(scene.attractors[0].body);
    EXPECT_EQ(scene.attractors[1].body, 1U);
    EXPECT_NEAR(length(scene.bodies.velocity[2] - Vec3{0, 2, 3}), 0, 1e-14); // the moon's own velocity included
}

TEST(SceneFile, EveryGeneratorMakesItsBodies) {
    const Scene scene = parsed(R"(
[region]
kind = "box"
min = [0, 0, 0]
max = [100, 100, 100]
[[attractor]]
name = "sun"
position = [50, 50, 50]
strength = 1
[[bodies]]
generator = "lattice"
count = 27
max = [20, 20, 20]
[[bodies]]
generator = "lattice"
sites = [2, 3, 4]
min = [20, 0, 0]
max = [40, 20, 20]
jitter = 0.1
[[bodies]]
generator = "jittered_lattice"
count = 10
min = [0, 20, 0]
max = [20, 40, 20]
[[bodies]]
generator = "fcc"
count = 30
min = [0, 0, 20]
max = [20, 20, 40]
[[bodies]]
generator = "random"
count = 40
radius = { distribution = "log_uniform", min = 0.1, max = 2 }
density = 3
velocity = { distribution = "maxwell", kT = 2, drift = [100, 0, 0] }
[[bodies]]
generator = "cloud"
count = 50
outer = 20
[[bodies]]
generator = "shell"
count = 60
around = "sun"
inner = 30
outer = 40
velocity = { distribution = "radial", speed = -1 }
[[bodies]]
generator = "disc"
count = 70
centre = [50, 50, 80]
normal = [1, 1, 1]
outer = 15
thickness = 2
radius = { distribution = "uniform", min = 0.1, max = 0.2 }
)");
    const BodyTable& bodies = scene.bodies;
    ASSERT_EQ(bodies.size(), 27U + 24 + 10 + 30 + 40 + 50 + 60 + 70);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            ASSERT_GE(length(bodies.position[i] - bodies.position[j]), bodies.radius[i] + bodies.radius[j]) << i << j;
        }
    }
}

/// The bits of all that a scene says about its bodies.
std::uint64_t bits_of(const Scene& scene) {
    BitHash hash;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        hash.add(scene.bodies.position[i]);
        hash.add(scene.bodies.velocity[i]);
        hash.add(scene.bodies.mass[i]);
        hash.add(scene.bodies.radius[i]);
    }
    return hash.value();
}

constexpr const char* random_entry = R"(
[[bodies]]
generator = "cloud"
count = 100
centre = [0, 0, 0]
outer = 30
radius = { distribution = "uniform", min = 0.1, max = 1 }
velocity = { distribution = "uniform", min = -1, max = 1 }
)";

TEST(SceneFile, TheSeedDecides) {
    const std::string entry = random_entry;
    EXPECT_EQ(bits_of(parsed(entry)), bits_of(parsed("seed = 1\n" + entry)));
    EXPECT_NE(bits_of(parsed(entry)), bits_of(parsed("seed = 2\n" + entry)));
    EXPECT_EQ(bits_of(parsed(entry)), 14338750413227948819U);
}

TEST(SceneFile, RandomPlacesKeepClearOfLaterEntries) {
    const Scene scene = parsed(std::string(random_entry) + "[[bodies]]\nposition = [0, 0, 0]\nradius = 20\n");
    for (std::size_t i = 0; i < 100; ++i) {
        EXPECT_GE(length(scene.bodies.position[i]), 20 + scene.bodies.radius[i]);
    }
}

TEST(SceneFile, ACsvFileIsFoundBesideTheScene) {
    const TemporaryFolder folder;
    (void)folder.write("b.csv", "z,mass,x,y,vy,growth\n3,2,1,2,-0.5,0.1\n6,inf,4,5,0,-0.2\n");
    const auto file = folder.write("s.toml", "[[bodies]]\ngenerator = \"csv\"\nfile = \"b.csv\"\nradius = 0.25\n");
    const BodyTable bodies = load_scene(file).bodies;
    ASSERT_EQ(bodies.size(), 2U);
    EXPECT_EQ(bodies.position[0], (Vec3{1, 2, 3}));
    EXPECT_EQ(bodies.velocity[0], (Vec3{0, -0.5, 0}));
    EXPECT_EQ(bodies.mass[1], infinite_mass);
    EXPECT_EQ(bodies.radius[1], 0.25);
    EXPECT_EQ(bodies.growth, (std::vector<double>{0.1, -0.2}));
}

TEST(SceneFile, TheNumberOfBodiesCanBeLimited) {
    Overrides overrides;
    overrides.max_bodies = 99;
    EXPECT_THROW(parsed(random_entry, overrides), SceneError);
    overrides.max_bodies = 100;
    EXPECT_EQ(parsed(random_entry, overrides).bodies.size(), 100U);
}

} // namespace
} // namespace carom::scene
