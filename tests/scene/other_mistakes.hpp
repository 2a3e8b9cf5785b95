/// \file
/// Scenes with a mistake in obstacles, attractors, observers, camera and picture.
#pragma once

#include "mistake.hpp"

#include <vector>

namespace carom::scene {

// clang-format off: one mistake after the other, its text as it stands in the file
inline const std::vector<Mistake> other_mistakes{
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
