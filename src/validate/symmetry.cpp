// What must not matter: the length of steps, mirrors, a quarter turn, any other turn, the direction of time.

#include "collision/portable_math.hpp"
#include "scene/random.hpp"
#include "validate/cases.hpp"
#include "validate/gas.hpp"

#include <carom/world.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

namespace carom::validate {

namespace {

using Turn = std::function<Vec3(const Vec3&)>;

Vec3 same(const Vec3& v) { return v; }

/// Bodies of several sizes, masses and materials in a box with rough, inelastic walls, under gravity aslant.
World make_heap(const Turn& turned) {
    WorldOptions options;
    options.gravity = turned({1, -2, -9.81});
    options.threads = 1;
    Box box{{-4, -4, -4}, {4, 4, 4}};
    for (Face& face : box.faces) face.surface = {.restitution = 0.8, .friction = 0.1};
    options.region = box;
    World world(options);
    scene::Random random(61);
    for (int i = 0; i < 216; ++i) {
        const int layer = i / 36;
        const Vec3 place{(i % 6) * 1.25 - 3.1, ((i / 6) % 6) * 1.25 - 3.2, layer * 1.25 - 3.15};
        const Vec3 velocity = 3 * random.normal_vector();
        world.add({.position = turned(place),
                   .velocity = turned(velocity),
                   .mass = 1.0 + i % 7,
                   .radius = 0.3 + 0.03 * (i % 9),
                   .restitution = 0.7 + 0.05 * (i % 7),
                   .friction = 0.02 * (i % 3)});
    }
    return world;
}

/// How many bodies of two worlds are not, bit for bit, where the turn would have them.
Row turned_row(const char* how, const Turn& turned) {
    World one = make_heap(same);
    World other = make_heap(turned);
    for (int i = 0; i < 60; ++i) {
        one.step(1.0 / 60);
        other.step(1.0 / 60);
    }
    Sample a;
    Sample b;
    a.read(one);
    b.read(other);
    double different = 0;
    for (std::size_t i = 0; i < a.position.size(); ++i) {
        if (turned(a.position[i]) != b.position[i] || turned(a.velocity[i]) != b.velocity[i]) ++different;
    }
    return exact_row(
        {"symmetry: bodies with other bits",
         fmt::format("216 bodies of many kinds in a box under gravity, {} impacts; {}", one.ledger().impacts, how),
         "symmetry of the laws"},
        0, different, 0);
}

Findings run_turns() {
    Findings findings;
    findings.rows = {turned_row("mirrored in x", [](const Vec3& v) { return Vec3{-v.x, v.y, v.z}; }),
                     turned_row("mirrored in y", [](const Vec3& v) { return Vec3{v.x, -v.y, v.z}; }),
                     turned_row("mirrored in z", [](const Vec3& v) { return Vec3{v.x, v.y, -v.z}; }),
                     turned_row("turned by 90 degrees about z", [](const Vec3& v) { return Vec3{-v.y, v.x, v.z}; })};
    return findings;
}

// -- A gas, compared with itself --------------------------------------------------------------------------------------

constexpr double small_error = 1e-7; // m

/// An expanding cluster without walls, so that it can be turned by any angle; positions are fine.
World make_cluster(const Turn& turned) {
    World world({.resolution = 0x1p-50, .threads = 1});
    scene::Random random(62);
    for (int i = 0; i < 512; ++i) {
        const int layer = i / 64;
        const Vec3 place{1.1 * (i % 8), 1.1 * ((i / 8) % 8), 1.1 * layer};
        world.add({.position = turned(place), .velocity = turned(random.normal_vector())});
    }
    return world;
}

double largest_distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, length(a[i] - b[i]));
    return largest;
}

Findings run_any_turn() {
    const double c = detail::cos(1);
    const double s = detail::sin(1);
    const Turn turned = [c, s](const Vec3& v) {
        const Vec3 about_z{c * v.x - s * v.y, s * v.x + c * v.y, v.z};
        return Vec3{about_z.x, c * about_z.y - s * about_z.z, s * about_z.y + c * about_z.z};
    };
    World one = make_cluster(same);
    World other = make_cluster(turned);
    one.step_until(0.5);
    other.step_until(0.5);
    Sample a;
    Sample b;
    a.read(one);
    b.read(other);
    for (Vec3& x : a.position) x = turned(x);
    Findings findings;
    findings.rows.push_back(exact_row({"symmetry: largest distance, m",
                                       fmt::format("512 spheres in open space, {:.2g} collisions per body; turned by 1 "
                                                   "rad about z and x",
                                                   collisions_per_body(one)),
                                       "symmetry of the laws, to rounding times chaos"},
                                      0, largest_distance(a.position, b.position), small_error));
    return findings;
}

World fine_gas(double packing) {
    const World coarse = make_gas({.packing = packing, .per_axis = 10, .seed = 63});
    WorldOptions options = coarse.options();
    options.resolution = 0x1p-50;
    Sample sample;
    sample.read(coarse);
    World world(options);
    world.add({.position = sample.position, .velocity = sample.velocity, .radius = sample.radius});
    return world;
}

std::vector<Vec3> positions_after(double packing, double dt, int steps) {
    World world = fine_gas(packing);
    for (int i = 0; i < steps; ++i) world.step(dt);
    Sample sample;
    sample.read(world);
    return std::move(sample.position);
}

Findings run_steps() {
    constexpr double packing = 0.1;
    const double time = 4 / collision_rate(packing);
    const std::vector<Vec3> reference = positions_after(packing, time / 64, 64);
    Findings findings;
    for (const int steps : {1, 7, 1000}) {
        const std::vector<Vec3> other = positions_after(packing, time / steps, steps);
        findings.rows.push_back(exact_row({"independence of dt: largest distance, m",
                                           fmt::format("1000 elastic spheres, packing 0.1, 4 collisions per body; {} "
                                                       "steps against 64",
                                                       steps),
                                           "results do not depend on dt, to rounding times chaos"},
                                          0, largest_distance(reference, other), small_error));
    }
    return findings;
}

/// Largest distance from the start after going so far and back.
double distance_back(double packing, double time) {
    World world = fine_gas(packing);
    Sample start;
    start.read(world);
    world.step(time);
    Sample turning;
    turning.read(world);
    for (Vec3& v : turning.velocity) v = -v;
    world.set(world.ids(), {.velocity = turning.velocity}, Overlap::accept);
    world.step(time);
    Sample end;
    end.read(world);
    // Whole periods are no distance.
    const double side = start.box->max.x;
    for (std::size_t i = 0; i < end.position.size(); ++i) {
        Vec3& d = end.position[i];
        d -= start.position[i];
        d -= side * Vec3{std::round(d.x / side), std::round(d.y / side), std::round(d.z / side)};
    }
    return largest_distance(end.position, std::vector<Vec3>(end.position.size()));
}

/// There and back over so many collisions per body; the set-up says how many it could have been.
Findings run_reversal(double packing, double collisions) {
    const double free_time = 1 / collision_rate(packing);
    double reached = 0;
    while (distance_back(packing, (reached + 0.5) * free_time) <= small_error) reached += 0.5;
    Findings findings;
    findings.rows.push_back(exact_row(
        {"time reversal: largest distance from the start, m",
         fmt::format("1000 elastic spheres, packing {}; {} collisions per body there, and as many back; the limit "
                     "of 1e-7 m was kept up to {}",
                     packing, collisions, reached),
         "mechanics runs backward, to rounding times chaos"},
        0, distance_back(packing, collisions * free_time), small_error));
    return findings;
}

} // namespace

std::vector<Task> symmetry_tasks(Extent /*extent*/) {
    return {{0.5, run_turns},
            {0.1, run_any_turn},
            {0.3, run_steps},
            {0.5, [] { return run_reversal(0.05, 3); }},
            {0.5, [] { return run_reversal(0.2, 10); }}};
}

} // namespace carom::validate
