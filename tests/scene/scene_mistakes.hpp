/// \file
/// Scenes that are refused: each kind of mistake, with the line and the key that the message must name.
#pragma once

#include <string_view>
#include <vector>

namespace carom::scene {

/// A scene with a mistake, how the message must begin and what else it must contain.
struct Mistake {
    std::string_view text;
    std::string_view message;
    std::string_view also;
};

// clang-format off: one mistake after the other, its text as it stands in the file
inline const std::vector<Mistake> mistakes{
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
     "attractor, bodies, camera, material, material_rule, observe, obstacle, output, picture, region, run, seed, title, world"},
    {R"(
[wrold]
)",
     "s.toml:2: wrold: unknown key; did you mean 'world'?", ""},
    {R"(title = 3
)",
     "s.toml:1: title: must be a text in quotes, got an integer", ""},
    {R"([region]
kind = "box"
min = [0, 0, 0]
max = [1, 1, 1]
faces = { x = { kind = "periodic", motion = { velocity = 1 } } }
)",
     "s.toml:5: region.faces.x.motion: is for reflecting faces only", ""},
    {R"([region]
kind = "planes"
plane = [{ motion = { amplitude = -1 } }]
)",
     "s.toml:3: region.plane[0].motion.amplitude: must be >= 0", "got -1"},
    {R"([region]
kind = "planes"
plane = [{ motion = { speed = 1 } }]
)",
     "s.toml:3: region.plane[0].motion.speed: unknown key", "surface_velocity"},
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
    {R"([[obstacle]]
radius = 1
)",
     "s.toml:1: obstacle[0].kind: is missing", ""},
    {R"([[obstacle]]
kind = "ball"
)",
     "s.toml:2: obstacle[0].kind: must be one of cylinder, cone, frustum, disc, mesh, got 'ball'", ""},
    {R"([[obstacle]]
kind = "cylinder"
height = 1
)",
     "s.toml:1: obstacle[0].radius: is missing", ""},
    {R"([[obstacle]]
kind = "cone"
height = 1
radius = -1
)",
     "s.toml:4: obstacle[0].radius: must be > 0", ""},
    {R"([[obstacle]]
kind = "cylinder"
height = 1
radius = 1
axis = [0, 0, 0]
)",
     "s.toml:5: obstacle[0].axis: must have a direction", ""},
    {R"([[obstacle]]
kind = "frustum"
height = 0
base_radius = 1
top_radius = 1
)",
     "s.toml:5: obstacle[0].top_radius: must differ from base_radius where the height is 0", ""},
    {R"([[obstacle]]
kind = "frustum"
height = 1
base_radius = 0
top_radius = 0
)",
     "s.toml:5: obstacle[0].top_radius: must be > 0 where base_radius is 0", ""},
    {R"([[obstacle]]
kind = "disc"
radius = 1
angular_velocity = nan
)",
     "s.toml:4: obstacle[0].angular_velocity: must be in [-1e30, 1e30] rad/s", ""},
    {R"([[obstacle]]
kind = "disc"
radius = 1
hole_radius = 1
)",
     "s.toml:3: obstacle[0].radius: must be greater than hole_radius", ""},
    {R"([[obstacle]]
kind = "disc"
radius = 1
height = 1
)",
     "s.toml:4: obstacle[0].height: unknown key", "angular_velocity, axis, base, friction, hole_radius, kind, radius, restitution"},
    {R"([[obstacle]]
kind = "mesh"
)",
     "s.toml:1: obstacle[0].file: is missing", ""},
    {R"([[obstacle]]
kind = "mesh"
file = "no_such.obj"
)",
     "no_such.obj: ", ""},
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
    {R"([[material]]
name = "ice"
restitution = { law = "powr" }
)",
     "s.toml:3: material[0].restitution.law: must be one of power, viscoelastic, got 'powr'; did you mean 'power'?", ""},
    {R"([[material]]
name = "ice"
restitution = { law = "power", restitution = 0, speed = 1, exponent = 1 }
)",
     "s.toml:3: material[0].restitution.restitution: must be in (0, 1], got 0", ""},
    {R"([[material]]
name = "ice"
restitution = { law = "power", restitution = 1, speed = 0, exponent = 1 }
)",
     "s.toml:3: material[0].restitution.speed: must be > 0 and finite, got 0", ""},
    {R"([[material]]
name = "ice"
restitution = { law = "power", restitution = 1, speed = 1, exponent = -1 }
)",
     "s.toml:3: material[0].restitution.exponent: must be >= 0 and finite, got -1", ""},
    {R"([[material]]
name = "steel"
restitution = { law = "viscoelastic", dissipation = -1, modulus = 1 }
)",
     "s.toml:3: material[0].restitution.dissipation: must be >= 0 and finite, got -1", ""},
    {R"([[material]]
name = "steel"
restitution = { law = "viscoelastic", dissipation = 1 }
)",
     "s.toml:3: material[0].restitution.modulus: is missing", ""},
    {R"([[material]]
name = "steel"
restitution = { law = "viscoelastic", dissipation = 1, modulus = 1, speed = 1 }
)",
     "s.toml:3: material[0].restitution.speed: unknown key", "dissipation, law, modulus"},
    {R"([[material]]
name = "ice"
[[material_rule]]
between = ["ice", "ice"]
restitution = { law = "viscoelastic", dissipation = 1, modulus = -1 }
)",
     "s.toml:5: material_rule[0].restitution.modulus: must be >= 0", "got -1"},
    {R"([[material]]
name = "ice"
restitution = { law = "power", restitution = 1, speed = 1, exponent = 1 }
[[bodies]]
position = [0, 0, 0]
material = "ice"
restitution = 0.5
)",
     "s.toml:6: bodies[0].material: has a law of restitution: its bodies must have no restitution of their own", ""},
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
    {R"([[observe]]
every = 1
)",
     "s.toml:1: observe[0].kind: is missing", ""},
    {R"([[observe]]
kind = "pressure"
)",
     "s.toml:2: observe[0].kind: must be one of energies, impacts, speeds, profile, radial_distribution, coordination, "
     "slab_packing, correlations, got 'pressure'", ""},
    {R"([[observe]]
kind = "energies"
every = -1
)",
     "s.toml:3: observe[0].every: must be >= 0", "got -1"},
    {R"([[observe]]
kind = "energies"
every = 1e300
)",
     "s.toml:3: observe[0].every: must be at most 2^53 steps", ""},
    {R"([[observe]]
kind = "energies"
from = nan
)",
     "s.toml:3: observe[0].from: must be >= 0", "got nan"},
    {R"([[observe]]
kind = "energies"
most = 1
)",
     "s.toml:3: observe[0].most: unknown key", "every, from, kind, name"},
    {R"([[observe]]
kind = "energies"
[[observe]]
kind = "energies"
)",
     "s.toml:3: observe[1].name: must differ from those of earlier observers, got 'energies'", ""},
    {R"([[observe]]
kind = "energies"
name = "a,b"
)",
     "s.toml:3: observe[0].name: must be of letters, digits, _ and -", ""},
    {R"([output]
least_recorded_impulse = 1
[[observe]]
kind = "impacts"
)",
     "s.toml:4: observe[0].kind: needs all impacts, and output.least_recorded_impulse leaves out weak ones", ""},
    {R"([[bodies]]
position = [0, 0, 0]
growth = 1
[[observe]]
kind = "impacts"
)",
     "s.toml:5: observe[0].kind: must not be impacts where bodies grow", ""},
    {R"([[observe]]
kind = "speeds"
)",
     "s.toml:1: observe[0].most: is missing", ""},
    {R"([[observe]]
kind = "speeds"
most = 0
)",
     "s.toml:3: observe[0].most: must be > 0", ""},
    {R"([[observe]]
kind = "speeds"
most = 1
bins = 0
)",
     "s.toml:4: observe[0].bins: must be an integer in [1, 1000000], got 0", ""},
    {R"([[observe]]
kind = "profile"
axis = "w"
)",
     "s.toml:3: observe[0].axis: must be one of x, y, z, got 'w'", ""},
    {R"([[observe]]
kind = "profile"
axis = "x"
low = 0
)",
     R"(s.toml:1: observe[0].high: is missing: without a region of kind "box" it must be given)", ""},
    {R"([[observe]]
kind = "profile"
axis = "x"
low = 0
high = 1
)",
     R"(s.toml:1: observe[0].area: is missing: without a region of kind "box" it must be given)", ""},
    {R"([[observe]]
kind = "slab_packing"
axis = "x"
low = 2
high = 1
area = 1
)",
     "s.toml:5: observe[0].high: low must be less than high, got 2 and 1", ""},
    {R"([[observe]]
kind = "slab_packing"
axis = "x"
low = 0
high = 1
area = -1
)",
     "s.toml:6: observe[0].area: must be > 0", ""},
    {R"([[observe]]
kind = "profile"
axis = "x"
low = 0
high = 1
area = 1
slices = 0
)",
     "s.toml:7: observe[0].slices: must be an integer in [1, ", ""},
    {R"([[observe]]
kind = "radial_distribution"
most = 1
)",
     R"(s.toml:2: observe[0].kind: needs a region of kind "box")", ""},
    {R"([region]
kind = "box"
min = [0, 0, 0]
max = [4, 8, 8]
faces = { x = "periodic" }
[[observe]]
kind = "radial_distribution"
most = 3
)",
     "s.toml:8: observe[0].most: must be at most half of a periodic side, 2, got 3", ""},
    {R"([[observe]]
kind = "coordination"
gap = -1
)",
     "s.toml:3: observe[0].gap: must be >= 0", ""},
    {R"([[observe]]
kind = "correlations"
lags = 0
)",
     "s.toml:3: observe[0].lags: must be an integer in [1, ", ""},
    {R"([[observe]]
kind = "correlations"
origin_every = 0
)",
     "s.toml:3: observe[0].origin_every: must be an integer in [1, ", ""},
    {R"([camera]
position = [1, 2, 3]
target = [1, 2, 3]
)",
     "s.toml:3: camera.target: must differ from position", ""},
    {R"([camera]
field_of_view = 180
)",
     "s.toml:2: camera.field_of_view: must be in [1, 170] degrees, got 180", ""},
    {R"([camera]
up = [0, 0, 0]
)",
     "s.toml:2: camera.up: must have a direction", ""},
    {R"([[camera.path]]
time = 0
target = [0, 0, 0]
)",
     "s.toml:1: camera.path[0].position: is missing", ""},
    {R"([[camera.path]]
time = 1
position = [1, 0, 0]
target = [0, 0, 0]
[[camera.path]]
time = 1
position = [2, 0, 0]
target = [0, 0, 0]
)",
     "s.toml:6: camera.path[1].time: must be later than that of the key before, 1 s, got 1", ""},
    {R"([picture]
colour_by = "sped"
)",
     "s.toml:2: picture.colour_by: must be one of material, speed, mass, impact_rate, temperature, got 'sped'", "did you mean 'speed'?"},
    {R"([picture]
time_scale = 0
)",
     "s.toml:2: picture.time_scale: must be in [1e-12, 1e12], got 0", ""},
    {R"([picture]
trail = 3
)",
     "s.toml:2: picture.trail: unknown key; did you mean 'trails'?", "colour_by, forces, moment, time_scale, trails"},
};
// clang-format on

} // namespace carom::scene
