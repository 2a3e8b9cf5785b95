/// \file
/// Scenes with a mistake in the file itself, in the world and its region, in the run and its output.
#pragma once

#include "mistake.hpp"

#include <vector>

namespace carom::scene {

// clang-format off: one mistake after the other, its text as it stands in the file
inline const std::vector<Mistake> world_mistakes{
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
    {R"([[body]]
position = [0, 0, 0]
)",
     "s.toml:1: body: unknown key; did you mean 'bodies'?; allowed here: ", ""},
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
bodies_every = 0
)",
     "s.toml:2: output.bodies_every: must be > 0 and finite, got 0", ""},
    {R"([output]
bodies_every = inf
)",
     "s.toml:2: output.bodies_every: must be > 0 and finite, got inf", ""},
    {R"([output]
plot = true
)",
     "s.toml:2: output.plot: unknown key", "energy_plot"},
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
};
// clang-format on

} // namespace carom::scene
