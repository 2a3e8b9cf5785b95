// A gas under gravity: hydrostatic balance, equal temperature at all heights, and the barometric law.

#include "collision/portable_math.hpp"
#include "scene/generators.hpp"
#include "validate/cases.hpp"
#include "validate/gas.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace carom::validate {

namespace {

constexpr double radius = 0.5;      // m
constexpr double side = 30;         // m, periodic along x and y
constexpr double scale_height = 10; // m: kT / (m g)
constexpr double gravity = 1 / scale_height;
constexpr std::size_t bodies = 800;
constexpr double column = bodies / (side * side); // 1/m^2
constexpr double dt = 0.5;                        // s

World make_column(std::uint64_t seed) {
    scene::Random random(seed);
    scene::Occupancy occupancy({.min = {0, 0, 0}, .length = {side, side, 0}});
    const std::vector<double> radii(bodies, radius);
    const auto sample = [](double r, scene::Random& source) {
        const double x = source.uniform(0, side);
        const double y = source.uniform(0, side);
        return std::optional(Vec3{x, y, r - scale_height * detail::log(1 - source.unit())});
    };
    constexpr double ample = side * side * 10 * scale_height;
    std::vector<Vec3> positions = scene::place_randomly(radii, {sample, ample}, occupancy, random);
    std::vector<Vec3> velocities(bodies);
    Vec3 mean{};
    for (Vec3& v : velocities) {
        v = random.normal_vector();
        mean += v / double{bodies};
    }
    for (Vec3& v : velocities) v -= mean;
    Box box{.min = {0, 0, 0}, .max = {side, side, 1}};
    for (std::size_t face : {0U, 1U, 2U, 3U}) box.faces[face].kind = FaceKind::periodic;
    box.faces[5].kind = FaceKind::open;
    // One queue has the same bits, and is faster for so few bodies.
    World world({.gravity = {0, 0, -gravity}, .region = box, .serial_reference = true, .threads = 1});
    world.add({.position = positions, .velocity = velocities, .radius = radii});
    return world;
}

/// What the third and fourth virial coefficients add to the chemical potential, by kT, in a uniform fluid.
double higher_potential(double density) {
    const double packing = density * std::numbers::pi / 6;
    return packing * packing * (15 + packing * (24.4867 + packing * 35.2806));
}

/// A profile of density (1/m^3) over height above the floor's plane of contact.
struct Layers {
    static constexpr double width = 0.05; // m
    static constexpr int reach = 20;      // layers in a diameter
    std::vector<double> density;

    /// Chemical potential by kT: exact in second order of the density; in higher ones that of a uniform fluid of the
    /// mean density within a diameter.
    [[nodiscard]] double excess_potential(std::size_t layer) const {
        double sum = 0;
        for (int k = -reach; k <= reach; ++k) {
            const auto other = static_cast<std::ptrdiff_t>(layer) + k;
            if (other < 0 || other >= std::ssize(density)) continue;
            const double u = k * width;
            sum += density[static_cast<std::size_t>(other)] * std::numbers::pi * (1 - u * u) * width;
        }
        return sum + higher_potential(sum / (4 * std::numbers::pi / 3));
    }
    void normalise() {
        double sum = 0;
        for (const double n : density) sum += n * width;
        for (double& n : density) n *= column / sum;
    }
};

/// m above the floor's plane of contact, the middle of a layer.
double height_of(std::size_t layer) { return (static_cast<double>(layer) + 0.5) * Layers::width; }

/// Where chemical potential and weight balance at every height; kT in J.
Layers balanced_layers(double kt) {
    Layers layers{std::vector<double>(static_cast<std::size_t>(15 * scale_height / Layers::width))};
    std::vector<double> potential(layers.density.size(), 0);
    for (int iteration = 0; iteration < 60; ++iteration) {
        for (std::size_t i = 0; i < potential.size(); ++i) {
            layers.density[i] = detail::exp(-gravity * height_of(i) / kt - potential[i]);
        }
        layers.normalise();
        for (std::size_t i = 0; i < potential.size(); ++i) {
            potential[i] = 0.5 * (potential[i] + layers.excess_potential(i));
        }
    }
    return layers;
}

/// m
double mean_height(const Layers& layers) {
    double mean = 0;
    for (std::size_t i = 0; i < layers.density.size(); ++i) {
        mean += layers.density[i] * height_of(i) * Layers::width / column;
    }
    return mean;
}

/// The curves of the plot: packing over height, in balance, without the size of the bodies, and measured.
std::vector<Curve> height_curves(const Layers& layers, double kt, const Profile& measured) {
    constexpr double packing = std::numbers::pi / 6; // of one body in a cubic metre
    Curve balance{"heights", "hard spheres", Mark::line, {}};
    Curve points{"heights", "points: n exp(-m g z / kT)", Mark::line, {}};
    Curve carom{"heights", "carom", Mark::points, {}};
    for (std::size_t i = 0; i < layers.density.size() && height_of(i) < 4 * scale_height; i += 4) {
        const double z = height_of(i);
        balance.points.push_back({z, packing * layers.density[i]});
        points.points.push_back({z, packing * column * gravity / kt * detail::exp(-gravity * z / kt)});
    }
    for (std::size_t slice = 0; slice < measured.slices(); ++slice) {
        const Estimate density = measured.density(slice);
        carom.points.push_back(
            {measured.position(slice) - radius, packing * density.value, packing * density.standard_error});
    }
    return {std::move(balance), std::move(points), std::move(carom)};
}

struct Column {
    Estimate height;            ///< mean height above contact with the floor, m
    Estimate kinetic;           ///< J, per body and degree of freedom, twice
    double vertical = 0;        ///< J, mean m v_z^2
    double floor_force = 0;     ///< N
    double virial = 0;          ///< J, per body, along z
    Estimate upper_temperature; ///< J, of bodies above one scale height
    Profile profile;            ///< from the floor up
    double impacts = 0;
};

Column measure(double duration) {
    World world = make_column(41);
    while (world.time() < 1000) world.step(dt);
    ImpactStatistics impacts(world);
    BlockAverage height;
    BlockAverage kinetic;
    BlockAverage vertical;
    Profile profile(2, radius, radius + 4 * scale_height, 40, side * side);
    Profile upper(2, scale_height, 100 * scale_height, 1, side * side);
    Sample sample;
    const double begin = world.time();
    while (world.time() < begin + duration) {
        world.step(dt);
        impacts.observe(world);
        sample.read(world);
        upper.observe(sample);
        profile.observe(sample);
        double z = 0;
        double squares = 0;
        for (std::size_t i = 0; i < bodies; ++i) {
            z += sample.position[i].z - radius;
            squares += sample.velocity[i].z * sample.velocity[i].z;
        }
        height.add(z / bodies);
        vertical.add(squares / bodies);
        // Momentum along x and y is fixed: 3 N - 2 degrees of freedom.
        kinetic.add(2 * world.energy().kinetic / (3.0 * bodies - 2));
    }
    return {.height = height.estimate(),
            .kinetic = kinetic.estimate(),
            .vertical = vertical.estimate().value,
            .floor_force = impacts.face_force(4).value,
            .virial = impacts.virial_rate(2).value / bodies,
            .upper_temperature = upper.temperature(0),
            .profile = std::move(profile),
            .impacts = static_cast<double>(impacts.count())};
}

Findings run(double duration, double admitted) {
    const Column c = measure(duration);
    const std::string setup =
        fmt::format("{} elastic spheres on a floor, periodic {} m x {} m, scale height {} m, {:.2g} impacts", bodies,
                    side, side, scale_height, c.impacts);
    const double weight = bodies * gravity;
    const double kt = c.kinetic.value;
    const double ratio = gravity * c.height.value / kt;
    // Energy is fixed: where the gas is high it is cold. So the ratio's error is 1 + 2/3 ratio times that of the
    // height.
    const double ratio_error = gravity * c.height.standard_error / kt * (1 + 2.0 / 3 * ratio);
    const double balance = gravity * c.height.value;
    const Layers layers = balanced_layers(kt);
    Findings findings;
    findings.rows = {
        exact_row({"force on the floor, N", setup, "weight: N m g"}, weight, c.floor_force, 1e-3 * weight),
        exact_row({"m g <z>, J", setup, "virial theorem along z: <m v_z^2> + virial of the impacts, in the same run"},
                  c.vertical + c.virial, balance, 2e-3 * balance),
        statistical_row({"mean height by kT / (m g)", setup,
                         "balance of weight and chemical potential, second virial term exact, two more by the "
                         "mean density around, 0.05 % for those (barometric law: 1)"},
                        {gravity * mean_height(layers) / kt, 5e-4}, {ratio, ratio_error}, admitted),
        statistical_row({"kT above one scale height, by kT", setup,
                         "equal temperature at all heights; 1 - 16 / (15 N) at given "
                         "energy"},
                        {1 - 16.0 / (15 * bodies), 0},
                        {c.upper_temperature.value / kt, c.upper_temperature.standard_error / kt}, admitted)};
    findings.curves = height_curves(layers, kt, c.profile);
    return findings;
}

} // namespace

std::vector<Task> gravity_tasks(Extent extent) {
    const bool full = extent == Extent::full;
    const double duration = full ? 100'000 : 10'000;
    const double admitted = full ? 5e-3 : 2e-2;
    return {{full ? 60.0 : 6.0, [duration, admitted] { return run(duration, admitted); }}};
}

} // namespace carom::validate
