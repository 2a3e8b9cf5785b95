// Spheres poured onto a floor: how dense they lie, how many others each touches, and what the floor bears.

#include "scene/generators.hpp"
#include "validate/cases.hpp"

#include <carom/observers.hpp>
#include <carom/world.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace carom::validate {

namespace {

constexpr double radius = 0.5;        // m
constexpr double gravity = 9.81;      // m/s^2
constexpr double start_packing = 0.3; // of the spheres in the air
constexpr double dt = 1.0 / 60;       // s
constexpr double watched = 2;         // s at the end
constexpr double slab = 0.1;          // m, thickness of the slabs of the profile
constexpr double reach_of_edges = 3;  // m, within which floor and surface order the spheres

struct Pour {
    std::size_t bodies = 0;
    double side = 0;   ///< m, periodic along x and y
    double settle = 0; ///< s
    std::uint64_t seed = 0;
};

World make_world(const Pour& pour) {
    const double volume = 4 * std::numbers::pi / 3 * radius * radius * radius;
    const double height = static_cast<double>(pour.bodies) * volume / (start_packing * pour.side * pour.side);
    scene::Random random(pour.seed);
    scene::Occupancy occupancy({.min = {0, 0, 0}, .length = {pour.side, pour.side, 0}});
    const std::vector<double> radii(pour.bodies, radius);
    const auto sample = [&](double r, scene::Random& source) {
        const double x = source.uniform(0, pour.side);
        const double y = source.uniform(0, pour.side);
        return std::optional(Vec3{x, y, source.uniform(r, r + height)});
    };
    const std::vector<Vec3> positions =
        scene::place_randomly(radii, {sample, pour.side * pour.side * height}, occupancy, random);
    Box box{.min = {0, 0, 0}, .max = {pour.side, pour.side, 1}};
    for (const std::size_t face : {0U, 1U, 2U, 3U}) box.faces[face].kind = FaceKind::periodic;
    box.faces[5].kind = FaceKind::open;
    World world({.gravity = {0, 0, -gravity}, .region = box, .threads = 1});
    world.set_recording(false);
    const std::vector<double> restitutions(pour.bodies, 0.3);
    world.add({.position = positions, .radius = radii, .restitution = restitutions});
    return world;
}

/// m, below which nearly all spheres are.
double surface_of(const Sample& sample) {
    std::vector<double> heights;
    heights.reserve(sample.position.size());
    for (const Vec3& x : sample.position) heights.push_back(x.z);
    const auto place = heights.begin() + static_cast<std::ptrdiff_t>(heights.size() * 19 / 20);
    std::nth_element(heights.begin(), place, heights.end());
    return *place;
}

struct Settled {
    double packing = 0;      ///< in the bulk
    double coordination = 0; ///< without rattlers
    double contacts = 0;     ///< per body, those with the floor included
    double load = 0;         ///< force on the floor by weight
    std::vector<Point> profile;
};

std::vector<SlabPacking> make_slabs(double top, double area) {
    std::vector<SlabPacking> slabs;
    for (int k = 0; k * slab < top + 1; ++k) slabs.emplace_back(2, k * slab, (k + 1) * slab, area);
    return slabs;
}

Settled watch(const Pour& pour) {
    World world = make_world(pour);
    while (world.time() < pour.settle - watched) world.step(dt);
    Sample sample;
    sample.read(world);
    const double top = surface_of(sample);
    const double area = pour.side * pour.side;
    SlabPacking bulk(2, reach_of_edges, top - reach_of_edges, area);
    std::vector<SlabPacking> slabs = make_slabs(top, area);
    Coordination coordination(1e-4);
    BlockAverage contacts;
    BlockAverage load;
    const auto bodies = static_cast<double>(pour.bodies);
    while (world.time() < pour.settle) {
        world.step(dt);
        sample.read(world);
        bulk.observe(sample);
        for (SlabPacking& packing : slabs) packing.observe(sample);
        coordination.observe(sample);
        const std::vector<Contact> now = world.contacts();
        double force = 0;
        for (const Contact& contact : now) force += contact.face >= 0 ? contact.force : 0;
        contacts.add(static_cast<double>(now.size()) / bodies);
        load.add(force / (bodies * gravity));
    }
    Settled settled{.packing = bulk.fraction().value,
                    .coordination = coordination.mean_without_rattlers().value,
                    .contacts = contacts.estimate().value,
                    .load = load.estimate().value,
                    .profile = {}};
    for (std::size_t k = 0; k < slabs.size(); ++k) {
        settled.profile.push_back({slab * (static_cast<double>(k) + 0.5), slabs[k].fraction().value});
    }
    return settled;
}

Findings run(const Pour& pour) {
    constexpr double loose = 0.63;
    constexpr double dense = 0.645;
    const Settled settled = watch(pour);
    const std::string setup = fmt::format("{} spheres without friction, e = 0.3, fall from random places onto a floor, "
                                          "periodic {} m x {} m; the last {} of {} s",
                                          pour.bodies, pour.side, pour.side, watched, pour.settle);
    Findings findings;
    findings.rows = {
        exact_row({"packing of poured spheres", setup + "; 3 diameters or more from floor and surface",
                   "random close packing of spheres without friction: 0.63 to 0.645"},
                  (loose + dense) / 2, settled.packing, (dense - loose) / 2),
        // Overlaps of 2e-4 diameters make contacts (O'Hern et al., Phys. Rev. E 68, 011306 (2003): z - 6 grows with
        // 8 sqrt(packing above jamming), here 0.2); spheres on the floor and at the surface lack some.
        exact_row(
            {"coordination number without rattlers", setup, "isostatic: 6; about 0.2 for the softness of contacts"}, 6,
            settled.coordination, 0.3),
        exact_row({"contacts per body, floor included", setup,
                   "isostatic: 3, also where a rattler lies on three others; 3 % for the softness of contacts"},
                  3, settled.contacts, 0.1),
        exact_row({"force on the floor by weight", setup, "weight: N m g"}, 1, settled.load, 1e-3)};
    const double top = settled.profile.back().x;
    findings.curves = {{"packing", "carom", Mark::line, settled.profile},
                       {"packing", "0.63 and 0.645", Mark::line, {{0, loose}, {top, loose}}},
                       {"packing", "0.63 and 0.645", Mark::line, {{0, dense}, {top, dense}}}};
    return findings;
}

} // namespace

std::vector<Task> packing_tasks(Extent extent) {
    if (extent == Extent::quick) return {{12, [] { return run({1000, 8, 12, 81}); }}};
    return {{150, [] { return run({4000, 12, 20, 81}); }}};
}

} // namespace carom::validate
