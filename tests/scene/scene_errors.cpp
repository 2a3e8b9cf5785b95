// Scene files that are refused: each kind of mistake, with the line and the key that the message must name.
#include "scene/csv.hpp"
#include "scene/scene.hpp"
#include "scene/text_file.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace carom::scene {
namespace {

/// What is said about a scene.
template <class Read>
std::string refusal(const Read& read) {
    try {
        read();
    } catch (const SceneError& error) {
        return error.what();
    }
    return "nothing was refused";
}

/// A scene with a mistake, how the message must begin and what else it must contain.
struct Mistake {
    std::string_view text;
    std::string_view message;
    std::string_view also;
};

// clang-format off: one mistake after the other, its text as it stands in the file
const std::vector<Mistake> mistakes{
    {R"(a = 
)",
     "s.toml:1: ", ""},
    {R"(a = 1
a = 2
)",
     "s.toml:2: ", ""},
    {R"([world]
gravity = [0, 0, -9.81
[run]
)",
     "s.toml:", ""},
    {R"(titel = "x"
)",
     "s.toml:1: titel: unknown key; did you mean 'title'?; allowed here: ",
     "attractor, bodies, material, material_rule, output, region, run, seed, title, world"},
    {R"(
[wrold]
)",
     "s.toml:2: wrold: unknown key; did you mean 'world'?", ""},
    {R"(title = 3
)",
     "s.toml:1: title: must be a text in quotes, got an integer", ""},
    {R"(seed = -1
)",
     "s.toml:1: seed: must be an integer in [0, ", "got -1"},
    {R"(seed = 1.5
)",
     "s.toml:1: seed: must be an integer, got a number", ""},
    {R"(world = 3
)",
     "s.toml:1: world: must be a table, got an integer", ""},
    {R"(run = []
)",
     "s.toml:1: run: must be a table, got an array", ""},
    {R"(title = 2020-01-01
)",
     "s.toml:1: title: must be a text in quotes, got a date or time", ""},
    {R"([world]
graviti = [0, 0, 1]
)",
     "s.toml:2: world.graviti: unknown key; did you mean 'gravity'?", "allowed here: collapse_time, drag, gravity"},
    {R"([world]
gravity = -9.81
)",
     "s.toml:2: world.gravity: must be three numbers [x, y, z], got a number", ""},
    {R"([world]
gravity = [0, 0]
)",
     "s.toml:2: world.gravity: must be three numbers [x, y, z], got an array of 2", ""},
    {R"([world]
gravity = [0, "x", 0]
)",
     "s.toml:2: world.gravity[1]: must be a number, got a text", ""},
    {R"([world]
gravity = [0, 0, inf]
)",
     "s.toml:2: world.gravity[2]: must be finite, got inf", ""},
    {R"([world]
gravity = [
0,
0,
nan]
)",
     "s.toml:5: world.gravity[2]: must be finite, got nan", ""},
    {R"([world]
drag = -1
)",
     "s.toml:2: world.drag: must be >= 0 and finite, got -1", ""},
    {R"([world]
drag = { square = 1 }
)",
     "s.toml:2: world.drag.square: unknown key", "linear, quadratic"},
    {R"([world]
resolution = 0.3
)",
     "s.toml:2: world.resolution: must be a power of two > 0", "got 0.3"},
    {R"([world]
resolution = "2^-3x"
)",
     "s.toml:2: world.resolution: must be a power of two > 0", "got '2^-3x'"},
    {R"([world]
resolution = "2^9999"
)",
     "s.toml:2: world.resolution: must be a power of two", ""},
    {R"([world]
origin = [0.5, 0, 0]
)",
     "s.toml:2: world.origin[0]: must be an integer, got a number", ""},
    {R"([world]
rest_time = 0
)",
     "s.toml:2: world.rest_time: must be > 0 and finite, got 0", ""},
    {R"([world]
collapse_time = -1e-5
)",
     "s.toml:2: world.collapse_time: must be > 0", "got -1e-05"},
    {R"([world]
work_cap = -1
)",
     "s.toml:2: world.work_cap: must be an integer in [0, ", ""},
    {R"([world]
interpolation = 1
)",
     "s.toml:2: world.interpolation: must be true or false, got an integer", ""},
    {R"([world]
overlap = "allow"
)",
     "s.toml:2: world.overlap: must be one of refuse, accept, got 'allow'", ""},
    {R"([run]
time = 0
)",
     "s.toml:2: run.time: must be > 0", ""},
    {R"([run]
time = 1
steps = 2
)",
     "s.toml:3: run.steps: must not stand beside time", ""},
    {R"([run]
steps = 0
)",
     "s.toml:2: run.steps: must be an integer in [1, ", ""},
    {R"([run]
dt = -0.1
)",
     "s.toml:2: run.dt: must be > 0", "got -0.1"},
    {R"([run]
dt = "1/0"
)",
     R"(s.toml:2: run.dt: must be > 0 s: a number, or a text like "1/60")", "got '1/0'"},
    {R"([run]
dt = "a/b"
)",
     "s.toml:2: run.dt: must be > 0 s", ""},
    {R"([run]
dt = 1e-300
)",
     "s.toml:1: run: must take at most 2^53 steps", ""},
    {R"([run]
precision = "duoble"
)",
     "s.toml:2: run.precision: must be one of single, double, got 'duoble'; did you mean 'double'?", ""},
    {R"([run]
threads = 1000000
)",
     "s.toml:2: run.threads: must be an integer in [0, 4096]", ""},
    {R"([run]
precison = "double"
)",
     "s.toml:2: run.precison: unknown key; did you mean 'precision'?", ""},
    {R"([output]
timeline_every = -1
)",
     "s.toml:2: output.timeline_every: must be >= 0", ""},
    {R"([output]
plot = true
)",
     "s.toml:2: output.plot: unknown key", "energy_plot"},
    {R"([region]
min = [0, 0, 0]
)",
     "s.toml:1: region.kind: is missing", ""},
    {R"([region]
kind = "sphere"
)",
     "s.toml:2: region.kind: must be one of open, box, planes, shell, got 'sphere'", ""},
    {R"([region]
kind = "box"
min = [0, 0, 0]
)",
     "s.toml:1: region.max: is missing", ""},
    {R"([region]
kind = "box"
min = [0, 0, 0]
max = [1, 0, 1]
)",
     "s.toml:4: region.max: must be greater than min in every component", ""},
    {R"([region]
kind = "box"
min = [0, 0, 0]
max = [1, 1, 1]
restitution = 1.5
)",
     "s.toml:5: region.restitution: must be in [0, 1], got 1.5", ""},
    {R"([region]
kind = "box"
min = [0, 0, 0]
max = [1, 1, 1]
faces = { z = "closed" }
)",
     "s.toml:5: region.faces.z: must be one of reflecting, open, periodic, got 'closed'", ""},
    {R"([region]
kind = "box"
min = [0, 0, 0]
max = [1, 1, 1]
faces = { top = "open" }
)",
     "s.toml:5: region.faces.top: unknown key", "x, x_max, x_min, y, y_max, y_min, z, z_max, z_min"},
    {R"([region]
kind = "box"
min = [0, 0, 0]
max = [1, 1, 1]
faces = { x_min = "periodic" }
)",
     "s.toml:5: region.faces.x_min: a periodic face needs a periodic one opposite", ""},
    {R"([region]
kind = "box"
min = [0, 0, 0]
max = [1, 1, 1]
[region.faces]
x = 7
)",
     R"(s.toml:6: region.faces.x: must be "reflecting", "open", "periodic" or a table)", ""},
    {R"([region]
kind = "box"
min = [0, 0, 0]
max = [1, 1, 1]
[region.faces]
x = { friction = -1 }
)",
     "s.toml:6: region.faces.x.friction: must be >= 0", ""},
    {R"([region]
kind = "planes"
)",
     "s.toml:1: region.plane: must be 1 to 64 tables [[region.plane]], got 0", ""},
    {R"([region]
kind = "planes"
plane = [{ normal = [0, 0, 0] }]
)",
     "s.toml:3: region.plane[0].normal: must have a direction", ""},
    {R"([region]
kind = "planes"
plane = 3
)",
     "s.toml:3: region.plane: must be an array of tables; write [[region.plane]]", ""},
    {R"([region]
kind = "shell"
radius = 0
)",
     "s.toml:3: region.radius: must be > 0", ""},
    {R"([region]
kind = "open"
max = [0, 0, 0]
)",
     "s.toml:3: region.max: unknown key", "allowed here: kind"},
    {R"([[material]]
restitution = 1
)",
     "s.toml:1: material[0].name: is missing", ""},
    {R"([[material]]
name = "a"
[[material]]
name = "a"
)",
     "s.toml:4: material[1].name: is the name of an earlier material", ""},
    {R"([[material]]
name = "ice"
[[material_rule]]
between = ["ice", "ise"]
restitution = 1
)",
     "s.toml:4: material_rule[0].between[1]: must be one of ice, got 'ise'; did you mean 'ice'?", ""},
    {R"([[material]]
name = "ice"
[[material_rule]]
between = ["ice"]
)",
     "s.toml:4: material_rule[0].between: must be the names of two materials, got an array of 1", ""},
    {R"([[material]]
name = "ice"
[[material_rule]]
between = ["ice", "ice"]
)",
     "s.toml:3: material_rule[0].restitution: is missing", ""},
    {R"([bodies]
position = [0, 0, 0]
)",
     "s.toml:1: bodies: must be an array of tables; write [[bodies]]", ""},
    {R"([[bodies]]
)",
     "s.toml:1: bodies[0].position: is missing", ""},
    {R"([[bodies]]
position = [0, 0, 0]
radius = -1
)",
     "s.toml:3: bodies[0].radius: must be >= 0", "got -1"},
    {R"([[bodies]]
position = [0, 0, 0]
radius = "big"
)",
     "s.toml:3: bodies[0].radius: must be a number, or an array with one number per body", ""},
    {R"([[bodies]]
position = [0, 0, 0]
mass = 0
)",
     "s.toml:3: bodies[0].mass: must be > 0; inf makes a body static, got 0", ""},
    {R"([[bodies]]
position = [0, 0, 0]
[[bodies]]
position = [9, 0, 0]
mass = -inf
)",
     "s.toml:5: bodies[1].mass: must be > 0", "got -inf"},
    {R"([[bodies]]
position = [0, 0, 0]
restitution = 1.01
)",
     "s.toml:3: bodies[0].restitution: must be in [0, 1], got 1.01", ""},
    {R"([[bodies]]
position = [0, 0, 0]
friction = nan
)",
     "s.toml:3: bodies[0].friction: must be >= 0 and finite, got nan", ""},
    {R"([[bodies]]
position = [0, 0, 1e40]
)",
     "s.toml:2: bodies[0].position[2]: must be in [-1e30, 1e30] m, got 1e+40", ""},
    {R"([[bodies]]
position = [[0, 0, 0], [1, 1]]
)",
     "s.toml:2: bodies[0].position[1]: must be three numbers [x, y, z], got an array of 2", ""},
    {R"([[bodies]]
position = []
)",
     "s.toml:2: bodies[0].position: must be three numbers", ""},
    {R"([[bodies]]
position = [[0, 0, 0], [9, 1, 1]]
radius = [1, 2, 3]
)",
     "s.toml:3: bodies[0].radius: must be one number or 2, one per body, got 3", ""},
    {R"([[bodies]]
position = [0, 0, 0]
mass = 1
density = 1
)",
     "s.toml:4: bodies[0].density: must not stand beside mass", ""},
    {R"([[bodies]]
position = [0, 0, 0]
radius = 0
density = 1
)",
     "s.toml:4: bodies[0].density: gives body 0 of the entry, radius 0 m, a mass of 0 kg", ""},
    {R"([[bodies]]
position = [0, 0, 0]
materiel = "x"
)",
     "s.toml:3: bodies[0].materiel: unknown key; did you mean 'material'?", ""},
    {R"([[bodies]]
position = [0, 0, 0]
material = "x"
)",
     "s.toml:3: bodies[0].material: must be the name of a [[material]], but the scene has none", ""},
    {R"([[bodies]]
position = [0, 0, 0]
mass = inf
velocity = [1, 0, 0]
)",
     "s.toml:4: bodies[0].velocity: must be 0 for a static body", ""},
    {R"([[bodies]]
position = [0, 0, 0]
velocity = 3
)",
     "s.toml:3: bodies[0].velocity: must be [vx, vy, vz]", ""},
    {R"([[bodies]]
position = [0, 0, 0]
velocity = [[1, 0, 0], [1, 0, 0]]
)",
     "s.toml:3: bodies[0].velocity: must be one velocity or 1, one per body, got 2", ""},
    {R"([[bodies]]
position = [0, 0, 0]
velocity = { distribution = "gauss" }
)",
     "s.toml:3: bodies[0].velocity.distribution: must be one of uniform, maxwell, radial, orbit, got 'gauss'", ""},
    {R"([[bodies]]
position = [0, 0, 0]
velocity = { min = 1 }
)",
     "s.toml:3: bodies[0].velocity.distribution: is missing", ""},
    {R"([[bodies]]
position = [0, 0, 0]
velocity = { distribution = "maxwell", kt = 1 }
)",
     "s.toml:3: bodies[0].velocity.kT: is missing", ""},
    {R"([[bodies]]
position = [0, 0, 0]
velocity = { distribution = "uniform", min = 1, max = 0 }
)",
     "s.toml:3: bodies[0].velocity.max: must be at least min, 1, got 0", ""},
    {R"([[bodies]]
position = [0, 0, 0]
velocity = { distribution = "orbit" }
)",
     "s.toml:1: bodies[0].around: is missing", ""},
    {R"([[bodies]]
position = [0, 0, 0]
velocity = { distribution = "radial", speed = 1 }
)",
     "s.toml:1: bodies[0].centre: is missing", ""},
    {R"([[bodies]]
name = "a"
position = [0, 0, 0]
[[bodies]]
name = "a"
position = [9, 0, 0]
)",
     "s.toml:5: bodies[1].name: is the name of an earlier entry", ""},
    {R"([[bodies]]
generator = "latice"
)",
     "s.toml:2: bodies[0].generator: must be one of listed, lattice, jittered_lattice, fcc, random, cloud, shell, "
     "disc, csv, got 'latice'; did you mean 'lattice'?",
     ""},
    {R"([[bodies]]
generator = "lattice"
count = 8
)",
     R"(s.toml:1: bodies[0].min: is missing: without a region of kind "box" it must be given)", ""},
    {R"([[bodies]]
generator = "lattice"
min = [0, 0, 0]
max = [9, 9, 9]
)",
     "s.toml:1: bodies[0].count: is missing", ""},
    {R"([[bodies]]
generator = "lattice"
count = 0
min = [0, 0, 0]
max = [9, 9, 9]
)",
     "s.toml:3: bodies[0].count: must be an integer in [1, ", ""},
    {R"([[bodies]]
generator = "lattice"
min = [0, 0, 0]
max = [9, 9, -9]
count = 5
)",
     "s.toml:4: bodies[0].max: must be greater than min", ""},
    {R"([[bodies]]
generator = "lattice"
min = [0, 0, 0]
max = [9, 9, 9]
sites = [2, 2, 2]
count = 8
)",
     "s.toml:5: bodies[0].sites: must not stand beside count", ""},
    {R"([[bodies]]
generator = "lattice"
min = [0, 0, 0]
max = [9, 9, 9]
sites = [2, 2]
)",
     "s.toml:5: bodies[0].sites: must be three integers [nx, ny, nz], got an array of 2", ""},
    {R"([[bodies]]
generator = "lattice"
min = [0, 0, 0]
max = [9, 9, 9]
count = 1000
)",
     "s.toml:1: bodies[0].radius: 10 x 10 x 10 sites leave 0.9 m per body", "fewer or smaller bodies"},
    {R"([[bodies]]
generator = "jittered_lattice"
min = [0, 0, 0]
max = [8, 8, 8]
count = 8
jitter = 2
)",
     "s.toml:6: bodies[0].jitter: must be at most [1.5, 1.5, 1.5] m", ""},
    {R"([[bodies]]
generator = "fcc"
min = [0, 0, 0]
max = [8, 8, 8]
count = 900
)",
     "s.toml:5: bodies[0].count: 900 bodies of radius 0.5 m do not fit", ""},
    {R"([[bodies]]
generator = "random"
min = [0, 0, 0]
max = [8, 8, 8]
count = 900
)",
     "s.toml:5: bodies[0].count: 900 bodies fill 471 m^3 of 512 m^3", "random places without overlap exist only up to"},
    {R"([[bodies]]
generator = "random"
min = [0, 0, 0]
max = [8, 8, 8]
count = 1
radius = 4.5
)",
     "s.toml:6: bodies[0].radius: must fit the box", ""},
    {R"([[bodies]]
generator = "random"
min = [0, 0, 0]
max = [8, 8, 8]
count = 9
outer = 3
)",
     "s.toml:6: bodies[0].outer: unknown key", ""},
    {R"([[bodies]]
generator = "random"
min = [0, 0, 0]
max = [8, 8, 8]
count = 9
radius = { distribution = "log_uniform", min = 0, max = 1 }
)",
     "s.toml:6: bodies[0].radius.min: must be > 0", ""},
    {R"([[bodies]]
generator = "random"
min = [0, 0, 0]
max = [8, 8, 8]
count = 9
radius = { distribution = "uniform", min = 2, max = 1 }
)",
     "s.toml:6: bodies[0].radius.max: must be at least min, 2, got 1", ""},
    {R"([[bodies]]
generator = "cloud"
count = 9
outer = 3
)",
     "s.toml:1: bodies[0].centre: is missing: give a centre, or around", ""},
    {R"([[bodies]]
generator = "shell"
count = 9
centre = [0, 0, 0]
inner = 4
outer = 3
)",
     "s.toml:5: bodies[0].inner: must be at most outer, 3, got 4", ""},
    {R"([[bodies]]
generator = "disc"
count = 9
centre = [0, 0, 0]
outer = 3
normal = [0, 0, 0]
)",
     "s.toml:6: bodies[0].normal: must have a direction", ""},
    {R"([region]
kind = "shell"
radius = 5
[[bodies]]
generator = "cloud"
count = 9
centre = [50, 0, 0]
outer = 3
)",
     "s.toml:6: bodies[0].count: found room for only 0 of 9 bodies", ""},
    {R"([[bodies]]
generator = "csv"
)",
     "s.toml:1: bodies[0].file: is missing", ""},
    {R"([[bodies]]
generator = "csv"
file = "no/such.csv"
)",
     "no/such.csv: cannot be opened", ""},
    {R"([[bodies]]
generator = "fcc"
min = [0, 0, 0]
max = [8, 8, 8]
count = 1000000000000000000
)",
     "s.toml:5: bodies[0].count: must be an integer in [1, 100000000], got 1000000000000000000", ""},
    {R"([[bodies]]
generator = "lattice"
min = [0, 0, 0]
max = [8, 8, 8]
sites = [1000000, 1000000, 1000000]
)",
     "s.toml:1: bodies[0]: makes 1000000000000000000 bodies; together with the entries before, a scene may have "
     "100000000",
     ""},
    {R"([[bodies]]
position = [0, 0, 0]
[[bodies]]
generator = "random"
count = 100000000
)",
     "s.toml:5: bodies[1].count: must be an integer in [1, 99999999]", ""},
    {R"([[bodies]]
generator = "random"
count = 99999999999999999999999
)",
     "s.toml:3: ", ""},
    {R"([[attractor]]
position = [0, 0, 0]
)",
     "s.toml:1: attractor[0].strength: is missing", ""},
    {R"([[attractor]]
strength = 1
)",
     "s.toml:1: attractor[0].position: is missing", ""},
    {R"([[attractor]]
strength = inf
position = [0, 0, 0]
)",
     "s.toml:2: attractor[0].strength: must be finite, got inf", ""},
    {R"([[attractor]]
strength = 1
body = "sun"
)",
     "s.toml:3: attractor[0].body: must be the name of an entry [[bodies]], but none has a name", ""},
    {R"([[bodies]]
name = "earth"
position = [0, 0, 0]
[[attractor]]
strength = 1
body = "sun"
)",
     "s.toml:6: attractor[0].body: must be one of earth, got 'sun'", ""},
    {R"([[bodies]]
name = "earth"
position = [[0, 0, 0], [5, 0, 0]]
[[attractor]]
strength = 1
body = "earth"
)",
     "s.toml:6: attractor[0].body: must name an entry with exactly one body", ""},
    {R"([[bodies]]
name = "earth"
position = [0, 0, 0]
[[attractor]]
strength = 1
body = "earth"
position = [0, 0, 0]
)",
     "s.toml:7: attractor[0].position: must not stand beside body", ""},
    {R"([[bodies]]
position = [5, 0, 0]
around = "earth"
velocity = { distribution = "orbit" }
[[bodies]]
name = "earth"
position = [0, 0, 0]
[[attractor]]
strength = 1
body = "earth"
)",
     "s.toml:1: bodies[0]: must stand after the entry 'earth' that it is around", ""},
    {R"([[bodies]]
position = [5, 0, 0]
velocity = { distribution = "orbit" }
[[attractor]]
strength = -1
position = [0, 0, 0]
)",
     "s.toml:1: bodies[0].around: must be an attractor with strength > 0", ""},
    {R"([[bodies]]
position = [5, 0, 0]
velocity = { distribution = "orbit", inclination = 0.1 }
[[attractor]]
strength = 1
position = [0, 0, 0]
)",
     "s.toml:3: bodies[0].velocity.inclination: needs the normal of the plane", ""},
    {R"([[bodies]]
position = [5, 0, 0]
around = "sun"
velocity = { distribution = "orbit" }
)",
     "s.toml:3: bodies[0].around: must be the name of an [[attractor]], but the scene has none", ""},
};
// clang-format on

TEST(SceneErrors, NameFileLineKeyAndWhatIsAllowed) {
    for (const Mistake& mistake : mistakes) {
        const std::string message = refusal([&] { parse_scene(mistake.text, "s.toml"); });
        EXPECT_EQ(message.substr(0, mistake.message.size()), mistake.message) << mistake.text << message;
        EXPECT_NE(message.find(mistake.also), std::string::npos) << mistake.text << message;
    }
}

TEST(SceneErrors, TellThePartsOfTheMessage) {
    try {
        parse_scene("\n[world]\nrest_time = 0\n", "a/b.toml");
        FAIL() << "nothing was refused";
    } catch (const SceneError& error) {
        EXPECT_EQ(error.file(), "a/b.toml");
        EXPECT_EQ(error.line(), 3);
        EXPECT_EQ(error.key(), "world.rest_time");
        EXPECT_EQ(error.reason(), "must be > 0 and finite, got 0");
    }
}

TEST(SceneErrors, LongTextsAreCutShort) {
    const std::string message =
        refusal([] { parse_scene("[run]\nprecision = \"" + std::string(100'000, 'x') + "\"", "s.toml"); });
    EXPECT_LT(message.size(), 300U);
}

TEST(SceneErrors, FilesThatCannotBeRead) {
    const TemporaryFolder folder;
    EXPECT_NE(refusal([&] { load_scene(folder.path() / "none.toml"); }).find("none.toml: cannot be opened"),
              std::string::npos);
    EXPECT_NE(refusal([&] { load_scene(folder.path()); }).find("is no regular file"), std::string::npos);
    EXPECT_NE(refusal([] { load_scene("/dev/zero"); }).find("is no regular file"), std::string::npos);
}

TEST(SceneErrors, ValuesOfTheCommandLine) {
    const auto with = [](const Overrides& overrides) { return refusal([&] { parse_scene("", "s.toml", overrides); }); };
    Overrides overrides;
    overrides.dt = 0;
    EXPECT_EQ(with(overrides), "--dt: must be > 0 and finite, got 0");
    overrides = {};
    overrides.time = -1;
    EXPECT_EQ(with(overrides), "--time: must be > 0 and finite, got -1");
    overrides.time = 1;
    overrides.steps = 1;
    EXPECT_EQ(with(overrides), "--steps: must not stand beside --time: give one of them");
    overrides = {};
    overrides.steps = 0;
    EXPECT_EQ(with(overrides), "--steps: must be at least 1");
    overrides = {};
    overrides.checkpoint_every = -1;
    EXPECT_EQ(with(overrides), "--checkpoint-every: must be >= 0 and finite, got -1");
}

/// The keys that a scene with an unknown key "q" is told to be allowed there.
std::vector<std::string> keys_allowed_in(std::string_view text) {
    std::string message = refusal([&] { parse_scene(text, "s.toml"); });
    constexpr std::string_view before = "allowed here: ";
    const std::size_t start = message.find(before);
    if (start == std::string::npos) return {};
    message.erase(0, start + before.size());
    std::vector<std::string> keys;
    while (!message.empty()) {
        const std::size_t end = std::min(message.find(", "), message.size());
        keys.push_back(message.substr(0, end));
        message.erase(0, end + 2);
    }
    return keys;
}

TEST(SceneErrors, EveryKeyIsDocumented) {
    const std::string documentation = read_text_file("docs/scenes.md");
    const std::string box = "min = [0, 0, 0]\nmax = [9, 9, 9]\n";
    const std::string body = "[[bodies]]\nposition = [0, 0, 0]\n";
    const std::string around = "[[attractor]]\nposition = [9, 9, 9]\nstrength = 1\n";
    const std::string round = "count = 1\ncentre = [0, 0, 0]\ninner = 1\nouter = 2\n";
    const std::vector<std::string> texts{
        "q = 1",
        "[world]\nq = 1",
        "[world]\ndrag = { q = 1 }",
        "[run]\nq = 1",
        "[output]\nq = 1",
        "[region]\nkind = \"box\"\n" + box + "q = 1",
        "[region]\nkind = \"box\"\n" + box + "faces = { q = 1 }",
        "[region]\nkind = \"box\"\n" + box + "faces = { x = { q = 1 } }",
        "[region]\nkind = \"planes\"\nplane = [{ q = 1 }]",
        "[region]\nkind = \"shell\"\nradius = 1\nq = 1",
        "[[material]]\nname = \"a\"\nq = 1",
        "[[material]]\nname = \"a\"\n[[material_rule]]\nbetween = [\"a\", \"a\"]\nrestitution = 1\nq = 1",
        around + "q = 1",
        body + "q = 1",
        body + "velocity = { distribution = \"uniform\", min = 0, max = 1, q = 1 }",
        body + "velocity = { distribution = \"maxwell\", kT = 1, q = 1 }",
        around + body + "velocity = { distribution = \"radial\", speed = 1, q = 1 }",
        around + body + "velocity = { distribution = \"orbit\", q = 1 }",
        around + body + "velocity = { distribution = \"orbit\" }\nq = 1",
        "[[bodies]]\ngenerator = \"lattice\"\ncount = 1\n" + box + "q = 1",
        "[[bodies]]\ngenerator = \"fcc\"\ncount = 1\n" + box + "q = 1",
        "[[bodies]]\ngenerator = \"random\"\ncount = 1\n" + box +
            "radius = { q = 1, distribution = \"uniform\", min = 0, max = 1 }",
        "[[bodies]]\ngenerator = \"shell\"\n" + round + "q = 1",
        "[[bodies]]\ngenerator = \"disc\"\n" + round + "q = 1",
    };
    for (const std::string& text : texts) {
        const std::vector<std::string> keys = keys_allowed_in(text);
        EXPECT_FALSE(keys.empty()) << text;
        for (const std::string& key : keys) {
            if (key == "x_max" || key == "y_max" || key == "z_min" || key == "plane") continue; // written in other ways
            const bool known = documentation.find("`" + key + "`") != std::string::npos ||
                               documentation.find("[" + key + "]") != std::string::npos;
            EXPECT_TRUE(known) << key;
        }
    }
}

struct CsvMistake {
    std::string_view text;
    std::string_view message;
};

const std::vector<CsvMistake> csv_mistakes{
    {"", "b.csv: the first line must name the columns, for example x,y,z,vx,vy,vz"},
    {"x,y,z\n", "b.csv:1: there are no bodies below the names of the columns"},
    {"x,y\n1,2\n", "b.csv:1: column 'z': is missing"},
    {"x,y,z,x\n", "b.csv:1: column 'x': is there twice"},
    {"x,y,z,speed\n",
     "b.csv:1: column 'speed': must be one of x, y, z, vx, vy, vz, mass, radius, restitution, friction, got 'speed'"},
    {"x,y,z,frictoin\n", "b.csv:1: column 'frictoin': must be one of x, y, z, vx, vy, vz, mass, radius, restitution, "
                         "friction, got 'frictoin'; did you mean 'friction'?"},
    {"# c\n\nx,y,z\n1,2,3\n1,2\n", "b.csv:5: must have 3 values, got 2"},
    {"x,y,z\n1,2,3,4\n", "b.csv:2: must have 3 values, got 4"},
    {"x,y,z\n1,2,\n", "b.csv:2: column 'z': must be a number, got ''"},
    {"x,y,z\n1,2,3m\n", "b.csv:2: column 'z': must be a number, got '3m'"},
    {"x,y,z\n1,nan,3\n", "b.csv:2: column 'y': must be in [-1e30, 1e30] m, got nan"},
    {"x,y,z,mass\n1,2,3,1\n\n1,2,3,0\n", "b.csv:4: column 'mass': must be > 0; inf makes a body static, got 0"},
    {"x,y,z,restitution\n1,2,3,2\n", "b.csv:2: column 'restitution': must be in [0, 1], got 2"},
    {"x;y;z\n1;2;3\n", "b.csv:1: column 'x;y;z': must be one of x, y, z, vx, vy, vz, mass, radius, restitution, "
                       "friction, got 'x;y;z'"},
    {"x,y,z\n1,2,3\n1,2,3\n1,2,3\n", "b.csv:4: has 3 bodies; at most 2 more are allowed"},
};

TEST(CsvErrors, NameFileLineAndColumn) {
    for (const CsvMistake& mistake : csv_mistakes) {
        EXPECT_EQ(refusal([&] { parse_csv(mistake.text, "b.csv", 2); }), mistake.message);
    }
}

TEST(Csv, ReadsWhatSpreadsheetsWrite) {
    const CsvBodies bodies = parse_csv("\xEF\xBB\xBFx, y ,z,radius\r\n1,2,3,4\r\n# c\r\n 5e0,-6,7.5,0", "b.csv", 9);
    ASSERT_EQ(bodies.table.size(), 2U);
    EXPECT_EQ(bodies.table.position[1], (Vec3{5, -6, 7.5}));
    EXPECT_EQ(bodies.table.radius, (std::vector<double>{4, 0}));
    EXPECT_EQ(bodies.given, (std::vector<std::string>{"x", "y", "z", "radius"}));
}

TEST(CsvErrors, WhatIsGivenTwice) {
    const TemporaryFolder folder;
    (void)folder.write("b.csv", "x,y,z,mass,vy\n1,2,3,4,5\n");
    const std::string entry = "[[bodies]]\ngenerator = \"csv\"\nfile = \"b.csv\"\n";
    const auto with = [&](const std::string& line) {
        const std::string message = refusal([&] { load_scene(folder.write("s.toml", entry + line)); });
        return message.substr(std::min(message.size(), folder.path().string().size() + 1));
    };
    EXPECT_EQ(with("mass = 1"), "s.toml:4: bodies[0].mass: is given twice: here and as column 'mass'");
    EXPECT_EQ(with("density = 1"), "s.toml:4: bodies[0].density: is given twice: here and as column 'mass'");
    EXPECT_EQ(with("velocity = [0, 0, 0]"), "s.toml:4: bodies[0].velocity: is given twice: here and as column 'vy'");
}

} // namespace
} // namespace carom::scene
