#include "scene/workloads.hpp"

#include "collision/portable_math.hpp"
#include "scene/generators.hpp"
#include "scene/reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <new>
#include <numbers>
#include <vector>

namespace carom::scene {

namespace {

constexpr std::uint64_t seed = 20101127;
constexpr double radius = 0.5; // m, of every body unless a workload says otherwise
constexpr double speed = 5;    // m/s, bound of each velocity component
constexpr double gas_packing = 0.10;
constexpr double dense_packing = 0.45;

/// What each workload draws its random numbers for.
enum class Purpose : std::uint8_t { positions, velocities, radii, clumps };

Random random_for(Purpose purpose) { return Random::stream(seed, static_cast<std::uint64_t>(purpose)); }

/// m: side of the cube in which so many spheres of radius 0.5 m have this packing.
double cube_side(std::uint64_t bodies, double packing) {
    return detail::pow(static_cast<double>(bodies) * std::numbers::pi / 6 / packing, 1.0 / 3);
}

Cuboid cube(double side) { return {{0, 0, 0}, {side, side, side}}; }

/// A closed cube with elastic walls.
Box elastic_walls(const Cuboid& cube) {
    Box box{.min = cube.min, .max = cube.max};
    for (Face& face : box.faces) face.surface.restitution = 1;
    return box;
}

std::vector<Vec3> jittered_lattice(const Cuboid& box, std::uint64_t bodies, Random& random) {
    const Sites sites = lattice_sites(box, bodies);
    std::vector<Vec3> positions = lattice(box, sites, bodies);
    jitter(positions, largest_jitter(box, sites, radius), random);
    return positions;
}

BodyTable gas_bodies(std::vector<Vec3> positions) {
    BodyTable bodies = BodyTable::of(positions.size());
    bodies.position = std::move(positions);
    bodies.radius.assign(bodies.size(), radius);
    Random random = random_for(Purpose::velocities);
    bodies.velocity = uniform_velocities(bodies.size(), -speed, speed, random);
    return bodies;
}

void gas(std::uint64_t bodies, Scene& scene) {
    const Cuboid box = cube(cube_side(bodies, gas_packing));
    Random random = random_for(Purpose::positions);
    scene.options.region = elastic_walls(box);
    scene.bodies = gas_bodies(jittered_lattice(box, bodies, random));
    // Collisions multiply the rounding of positions by up to a million within a second. The cube is small: it can
    // afford positions so fine that runs with different steps stay together all the while.
    if (scene.options.precision == Precision::double_precision) scene.options.resolution = 0x1p-46;
}

void dense_gas(std::uint64_t bodies, Scene& scene) {
    const Cuboid box = cube(cube_side(bodies, dense_packing));
    scene.options.region = elastic_walls(box);
    scene.bodies = gas_bodies(fcc(box, bodies, radius));
    scene.run.dt = 1.0 / 240;
}

void cooling(std::uint64_t bodies, Scene& scene) {
    constexpr double restitution = 0.9;
    gas(bodies, scene);
    std::fill(scene.bodies.restitution.begin(), scene.bodies.restitution.end(), restitution);
}

void polydisperse(std::uint64_t bodies, Scene& scene) {
    constexpr double smallest_radius = 0.0005;
    // The default of single precision is 1/500 of the smallest radius: too coarse.
    if (scene.options.precision == Precision::single_precision) scene.options.resolution = 0x1p-30;
    const Cuboid box = cube(cube_side(bodies, gas_packing));
    scene.options.region = elastic_walls(box);

    Random random_radii = random_for(Purpose::radii);
    std::vector<double> radii(bodies);
    for (double& r : radii) r = random_radii.log_uniform(smallest_radius, radius);

    Random random = random_for(Purpose::positions);
    Occupancy occupancy;
    const auto sample = [&](double r, Random& source) { return in_cuboid(box, r, {1, 1, 1}, source); };
    scene.bodies = gas_bodies(place_randomly(radii, {sample, box.volume()}, occupancy, random));
    for (std::size_t i = 0; i < radii.size(); ++i) {
        const double scale = radii[i] / radius;
        scene.bodies.mass[i] = scale * scale * scale;
    }
    scene.bodies.radius = std::move(radii);
}

/// One body in ten thousand is a bullet, at least one, spread evenly over the gas.
void bullets(std::uint64_t bodies, Scene& scene) {
    constexpr std::uint64_t one_in = 10'000;
    constexpr double bullet_radius = 0.05;
    constexpr double bullet_mass = 1e-9;
    constexpr double times_faster = 1000;
    gas(bodies, scene);
    const std::uint64_t count = std::max<std::uint64_t>(1, bodies / one_in);
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::size_t body = i * bodies / count;
        scene.bodies.radius[body] = bullet_radius;
        scene.bodies.mass[body] = bullet_mass;
        scene.bodies.velocity[body] *= times_faster;
    }
}

/// Clumps of gas, far apart and far from the origin, each flying apart.
void open_space(std::uint64_t bodies, Scene& scene) {
    constexpr std::uint64_t clump_size = 1000;
    constexpr double expansion = 0.1; // 1/s
    constexpr double stretched = 100; // in each direction: 10^6 times the volume
    constexpr std::int64_t away = 1'000'000'000;
    scene.options.origin = {away, 0, 0};
    scene.options.resolution = scene.options.precision == Precision::single_precision ? 0x1p-20 : 0x1p-30;

    const std::uint64_t clumps = (bodies + clump_size - 1) / clump_size;
    const Cuboid space = cube(stretched * cube_side(bodies, gas_packing));
    const Cuboid clump = cube(cube_side(std::min(bodies, clump_size), gas_packing));
    const Cuboid corner_space{space.min, space.max - clump.size()};
    const Sites sites = lattice_sites(corner_space, clumps);
    std::vector<Vec3> corners = lattice(corner_space, sites, clumps);
    Random random_clumps = random_for(Purpose::clumps);
    jitter(corners, largest_jitter(corner_space, sites, clump.size().x), random_clumps);

    Random random = random_for(Purpose::positions);
    std::vector<Vec3> positions;
    std::vector<Vec3> outward;
    for (const Vec3& corner : corners) {
        const std::uint64_t here = std::min<std::uint64_t>(clump_size, bodies - positions.size());
        for (const Vec3& place : jittered_lattice(clump, here, random)) {
            positions.push_back(corner + place);
            outward.push_back(expansion * (place - clump.centre()));
        }
    }
    scene.bodies = gas_bodies(std::move(positions));
    for (std::size_t i = 0; i < outward.size(); ++i) scene.bodies.velocity[i] += outward[i];
}

/// A loose lattice of spheres that falls into an open box.
void pile(std::uint64_t bodies, Scene& scene) {
    constexpr double spacing = 1.1;     // m
    constexpr double unevenness = 0.02; // m, each coordinate is moved by up to so much
    constexpr double gravity = 9.81;    // m/s^2
    constexpr double restitution = 0.3;
    const double wanted = detail::pow(static_cast<double>(bodies) / 4, 1.0 / 3);
    const auto side = std::max<std::uint64_t>(1, static_cast<std::uint64_t>(wanted * (1 + 1e-12)));
    const std::uint64_t layer = side * side;
    const double width = spacing * static_cast<double>(side);
    const std::uint64_t layers = bodies / layer + 1;
    const double height = spacing * static_cast<double>(layers);
    Box box{.min = {0, 0, 0}, .max = {width, width, height}};
    for (Face& face : box.faces) face.surface.restitution = 0;
    box.faces.back() = {.kind = FaceKind::open};
    scene.options.region = box;
    scene.options.gravity = {0, 0, -gravity};
    scene.options.sleeping = false; // what is measured is the work of those who are awake
    Random random = random_for(Purpose::positions);
    const auto place = [&](std::uint64_t n) { return spacing * (static_cast<double>(n) + 0.5); };
    std::vector<Vec3> positions(bodies);
    for (std::uint64_t i = 0; i < bodies; ++i) {
        positions[i] = {place(i % side), place(i / side % side), place(i / layer)};
    }
    jitter(positions, {unevenness, unevenness, unevenness}, random);
    scene.bodies = BodyTable::of(bodies);
    scene.bodies.position = std::move(positions);
    scene.bodies.radius.assign(bodies, radius);
    scene.bodies.restitution.assign(bodies, restitution);
}

constexpr std::array<WorkloadInfo, 7> infos{{
    {"gas", "elastic spheres in a cube, packing 0.10"},
    {"dense_gas", "the same at packing 0.45, in steps of 1/240 s"},
    {"cooling", "gas with e = 0.9 between bodies"},
    {"polydisperse", "radii 1 : 1000 in the cube of gas"},
    {"bullets", "gas with a few tiny bodies a thousand times faster"},
    {"open_space", "expanding clumps without bounds, 1e9 m from the origin"},
    {"pile", "spheres of e = 0.3 dropped into a box: 600 steps to settle, 60 timed"},
}};

using Maker = void (*)(std::uint64_t bodies, Scene& scene);
constexpr std::array<Maker, infos.size()> makers{gas, dense_gas, cooling, polydisperse, bullets, open_space, pile};

/// The place of a workload in the lists.
std::size_t number_of(std::string_view name) {
    std::vector<std::string_view> names;
    names.reserve(infos.size());
    for (const WorkloadInfo& info : infos) names.push_back(info.name);
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end()) throw SceneError("", 0, "workload", not_one_of(name, names));
    return static_cast<std::size_t>(found - names.begin());
}

} // namespace

std::span<const WorkloadInfo> workload_list() { return infos; }

Workload workload(std::string_view name, std::uint64_t bodies, Precision precision) {
    const bool settles = name == "pile";
    const std::uint64_t steps = settles ? 60 : 120;
    const std::size_t number = number_of(name);
    if (bodies == 0 || bodies > default_max_bodies) {
        throw SceneError("", 0, "bodies", fmt::format("must be in [1, {}], got {}", default_max_bodies, bodies));
    }
    Workload made{.scene = {}, .warm_up = settles ? 600U : steps};
    Scene& scene = made.scene;
    scene.name = name;
    scene.title = infos[number].text;
    scene.seed = seed;
    scene.options.precision = precision;
    try {
        makers[number](bodies, scene);
    } catch (const GeneratorError& error) {
        throw SceneError("", 0, "bodies", error.what());
    } catch (const std::bad_alloc&) {
        throw SceneError("", 0, "bodies", fmt::format("there is not enough memory for {}", bodies));
    }
    scene.sources.push_back({.key = "bodies", .line = 0, .first = 0, .count = scene.bodies.size()});
    scene.run.steps = steps;
    scene.run.time = static_cast<double>(steps) * scene.run.dt;
    return made;
}

} // namespace carom::scene
