// Scene files damaged at random (fixed seed): whatever is in one, it becomes a scene or a SceneError, and soon.
#include "scene/csv.hpp"
#include "scene/random.hpp"
#include "scene/scene.hpp"
#include "scene/text_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace carom::scene {
namespace {

/// Values that somebody may write and nobody should.
constexpr std::array<std::string_view, 24> nasty{"0",
                                                 "-1",
                                                 "1e308",
                                                 "-1e308",
                                                 "1e-320",
                                                 "nan",
                                                 "inf",
                                                 "-inf",
                                                 "9223372036854775807",
                                                 "1e18",
                                                 "100000",
                                                 "0.001",
                                                 "true",
                                                 "\"\"",
                                                 "\"x\"",
                                                 "[]",
                                                 "{}",
                                                 "[1, 2]",
                                                 "[0, 0, 0]",
                                                 "[[0, 0, 0]]",
                                                 "1e30",
                                                 "-0.0",
                                                 "[1e30, -1e30, 1e30]",
                                                 "2020-01-01"};

std::size_t below(Random& random, std::size_t count) {
    return static_cast<std::size_t>(random.unit() * static_cast<double>(count));
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::size_t start = 0;
    while (start < text.size()) {
        const std::size_t end = std::min(text.find('\n', start), text.size());
        lines.push_back(text.substr(start, end - start));
        start = end + 1;
    }
    return lines;
}

/// Replaces what is right of the first "=" of a line, or one word of a list of values there.
void put_value(std::string& line, std::string_view value, Random& random) {
    const std::size_t equals = line.find('=');
    if (equals == std::string::npos) return;
    std::size_t start = equals + 1;
    if (random.unit() < 0.5) { // inside an array or a table
        const std::size_t inner = line.find_first_of("0123456789", start + below(random, line.size() - start));
        if (inner != std::string::npos) {
            const std::size_t end = std::min(line.find_first_of(",]} ", inner), line.size());
            line.replace(inner, end - inner, value);
            return;
        }
    }
    line.replace(start, line.size() - start, value);
}

std::string damaged(const std::string& text, Random& random) {
    std::vector<std::string> lines = lines_of(text);
    const std::size_t times = 1 + below(random, 3);
    for (std::size_t i = 0; i < times && !lines.empty(); ++i) {
        const std::size_t line = below(random, lines.size());
        switch (below(random, 7)) {
        case 0:
            lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(line));
            break;
        case 1:
            lines.push_back(lines[line]);
            break;
        case 2:
            std::swap(lines[line], lines[below(random, lines.size())]);
            break;
        case 3:
            if (!lines[line].empty()) {
                lines[line][below(random, lines[line].size())] = static_cast<char>(below(random, 256));
            }
            break;
        case 4:
            lines[line] = lines[line].substr(0, below(random, lines[line].size() + 1));
            break;
        default:
            put_value(lines[line], nasty[below(random, nasty.size())], random);
            break;
        }
    }
    std::string result;
    for (const std::string& line : lines) result += line + "\n";
    return result;
}

/// A scene that uses what the files in scenes/ do not.
constexpr const char* everything = R"(
title = "everything"
seed = 3
[world]
gravity = [0, 0, -9.81]
drag = { linear = 0.1, quadratic = 0.1 }
resolution = "2^-30"
origin = [1, 2, 3]
rest_time = 0.01
collapse_time = 1e-5
work_cap = 100
interpolation = true
overlap = "accept"
[run]
steps = 3
dt = "1/60"
precision = "single"
threads = 1
[output]
timeline_every = 1
checkpoint_every = 1
least_recorded_impulse = 1
[camera]
up = [0, 0, 1]
field_of_view = 30
[[camera.path]]
time = 0
position = [100, 0, 30]
target = [25, 25, 25]
[[camera.path]]
time = 10
position = [0, 100, 30]
target = [25, 25, 25]
field_of_view = 50
[picture]
colour_by = "speed"
time_scale = 2
moment = 0.01
trails = 3
forces = true
[region]
kind = "box"
min = [0, 0, 0]
max = [50, 50, 50]
restitution = 0.5
friction = 0.1
[region.faces]
x = "periodic"
y_min = { kind = "reflecting", friction = 0.1 }
z_min = { motion = { velocity = 0.1, amplitude = 0.1, angular_frequency = 20, phase = 1, surface_velocity = [1, 0, 0] } }
z_max = "open"
[[attractor]]
body = "sun"
strength = 100
softening = 1
[[attractor]]
name = "far"
position = [100, 100, 100]
strength = 3
[[bodies]]
name = "sun"
position = [25, 25, 25]
velocity = [0, 0, 1]
growth = 0.1
[[bodies]]
generator = "disc"
count = 50
around = "sun"
inner = 2
outer = 20
thickness = 2
normal = [1, 1, 1]
radius = { distribution = "log_uniform", min = 0.01, max = 0.5 }
density = 10
velocity = { distribution = "orbit", eccentricity = 0.1, inclination = 0.1, drift = [0, 0, 1] }
[[bodies]]
generator = "shell"
count = 50
centre = [25, 25, 25]
inner = 10
outer = 12
radius = 0.1
velocity = { distribution = "radial", speed = 3, spread = 0.5 }
[[bodies]]
generator = "cloud"
count = 30
around = "sun"
outer = 24
velocity = { distribution = "maxwell", kT = 2 }
[[bodies]]
generator = "fcc"
count = 30
min = [0, 0, 40]
max = [10, 10, 50]
[[bodies]]
generator = "jittered_lattice"
sites = [2, 3, 4]
min = [30, 30, 40]
max = [40, 40, 50]
jitter = 0.1
velocity = { distribution = "uniform", min = -1, max = 1 }
material = "steel"
[[material]]
name = "ice"
restitution = { law = "power", restitution = 0.3, speed = 0.01, exponent = 0.2 }
[[material]]
name = "steel"
restitution = { law = "viscoelastic", dissipation = 1e-5, modulus = 1e9 }
friction = 0.1
[[material_rule]]
between = ["ice", "steel"]
restitution = { law = "power", restitution = 0.5, speed = 1, exponent = 0.1 }
[[observe]]
name = "all"
kind = "energies"
from = 0.01
every = 0.02
[[observe]]
kind = "speeds"
most = 5
bins = 20
[[observe]]
kind = "profile"
axis = "z"
slices = 4
[[observe]]
kind = "radial_distribution"
most = 20
shells = 10
[[observe]]
kind = "coordination"
gap = 0.1
[[observe]]
kind = "slab_packing"
axis = "y"
low = 1
high = 9
area = 100
[[observe]]
kind = "correlations"
lags = 5
origin_every = 2
)";

std::vector<std::string> originals() {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator("scenes")) {
        if (entry.path().extension() == ".toml") files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    std::vector<std::string> texts{everything};
    for (const auto& file : files) texts.push_back(read_text_file(file));
    return texts;
}

TEST(FuzzedScenes, BecomeASceneOrASceneError) {
    constexpr int rounds = 6000;
    Random random(20101127);
    const std::vector<std::string> texts = originals();
    ASSERT_GT(texts.size(), 1U);
    Overrides overrides;
    overrides.max_bodies = 300;
    EXPECT_NO_THROW(parse_scene(everything, "s.toml", overrides)) << "whose parts are never reached otherwise";
    int accepted = 0;
    for (int i = 0; i < rounds; ++i) {
        const std::string text = damaged(texts[below(random, texts.size())], random);
        try {
            const Scene scene = parse_scene(text, "s.toml", overrides);
            EXPECT_LE(scene.bodies.size(), 300U);
            ++accepted;
        } catch (const SceneError& error) {
            EXPECT_FALSE(error.reason().empty()) << text;
        } catch (const std::exception& error) {
            FAIL() << error.what() << " from\n" << text;
        }
    }
    EXPECT_GT(accepted, rounds / 20);
    EXPECT_LT(accepted, rounds);
}

TEST(FuzzedScenes, CsvFilesToo) {
    constexpr int rounds = 3000;
    Random random(20101128);
    const std::string text = "# bodies\nx,y,z,vx,vy,vz,mass,radius\n1,2,3,4,5,6,7,8\n\n-1e5,0.5,inf,0,0,0,1,1\n";
    for (int i = 0; i < rounds; ++i) {
        std::string bad = damaged(text, random);
        if (random.unit() < 0.5) bad[below(random, bad.size())] = ",\n1e-."[below(random, 6)];
        try {
            (void)parse_csv(bad, "b.csv", 100);
        } catch (const SceneError&) {
            continue;
        } catch (const std::exception& error) {
            FAIL() << error.what() << " from\n" << bad;
        }
    }
}

} // namespace
} // namespace carom::scene
