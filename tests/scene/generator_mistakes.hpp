/// \file
/// Scenes with a mistake in places, sizes and velocities that are generated.
#pragma once

#include "mistake.hpp"

#include <vector>

namespace carom::scene {

// clang-format off: one mistake after the other, its text as it stands in the file
inline const std::vector<Mistake> generator_mistakes{
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

} // namespace carom::scene
