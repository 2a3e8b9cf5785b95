#include "validate/gas.hpp"

#include "collision/portable_math.hpp"
#include "scene/generators.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace carom::validate {

namespace {

using std::numbers::pi;

struct Term {
    int power;
    double coefficient;
};

/// Z(x), x = packing / (1 - packing).
constexpr std::array<Term, 12> equation{{{0, 1},
                                         {1, 4},
                                         {2, 6},
                                         {3, 2.3647684},
                                         {4, -0.8698551},
                                         {5, 1.1062803},
                                         {6, -1.1014221},
                                         {7, 0.66605866},
                                         {8, -0.03633431},
                                         {10, -0.20965164},
                                         {14, 0.10555569},
                                         {22, -0.00872380}}};

double power(double x, int n) { return n == 0 ? 1 : x * power(x, n - 1); }

/// d(packing Z) / d packing: inverse of the reduced compressibility of the infinite system.
double stiffness(double packing) {
    constexpr double h = 1e-5;
    const double above = (packing + h) * compressibility(packing + h);
    const double below = (packing - h) * compressibility(packing - h);
    return (above - below) / (2 * h);
}

/// Makes the total momentum zero and 2 K / (3 N - 3) one.
void normalise(std::vector<Vec3>& velocities) {
    const auto count = static_cast<double>(velocities.size());
    Vec3 mean{};
    for (const Vec3& v : velocities) mean += v / count;
    double squares = 0;
    for (Vec3& v : velocities) {
        v -= mean;
        squares += length_squared(v);
    }
    const double scale = std::sqrt((3 * count - 3) / squares);
    for (Vec3& v : velocities) v *= scale;
}

std::vector<Vec3> velocities_of(const GasSetup& setup, std::size_t count, scene::Random& random) {
    std::vector<Vec3> velocities(count);
    for (Vec3& v : velocities) v = setup.equal_speeds ? random.on_sphere() : random.normal_vector();
    normalise(velocities);
    return velocities;
}

} // namespace

double GasSetup::density() const { return 6 * packing / pi; }

double GasSetup::side() const { return detail::pow(bodies() / density(), 1.0 / 3); }

World make_gas(const GasSetup& setup) {
    const double side = setup.side();
    const scene::Cuboid cube{{0, 0, 0}, {side, side, side}};
    const scene::Sites sites{setup.per_axis, setup.per_axis, setup.per_axis};
    const auto count = static_cast<std::size_t>(setup.bodies());
    constexpr double radius = 0.5;
    scene::Random random(setup.seed);
    std::vector<Vec3> positions = scene::lattice(cube, sites, count);
    scene::jitter(positions, scene::largest_jitter(cube, sites, radius), random);
    const std::vector<Vec3> velocities = velocities_of(setup, count, random);
    const std::vector<double> radii(count, radius);
    const std::vector<double> restitutions(count, setup.restitution);
    Box box{.min = cube.min, .max = cube.max};
    for (Face& face : box.faces) {
        face.kind = setup.periodic ? FaceKind::periodic : FaceKind::reflecting;
        face.surface.restitution = 1;
    }
    World world({.region = box, .precision = setup.precision, .threads = 1});
    world.add({.position = positions, .velocity = velocities, .radius = radii, .restitution = restitutions});
    return world;
}

double temperature(const World& world) {
    return 2 * world.energy().kinetic / (3 * static_cast<double>(world.size()) - 3);
}

double collisions_per_body(const World& world) {
    return 2 * static_cast<double>(world.ledger().impacts) / static_cast<double>(world.size());
}

double compressibility(double packing) {
    const double x = packing / (1 - packing);
    double sum = 0;
    for (const Term& term : equation) sum += term.coefficient * power(x, term.power);
    return sum;
}

/// From the saddle point of the grand partition function: F_N / kT = F / kT + ln(2 pi N S) / 2 with S the reduced
/// compressibility; the derivative by the volume gives Z_N = Z + (packing / 2 N) d ln S / d packing.
double compressibility(double packing, double bodies) {
    constexpr double h = 1e-3;
    const double slope = (detail::log(stiffness(packing + h)) - detail::log(stiffness(packing - h))) / (2 * h);
    return compressibility(packing) - packing / (2 * bodies) * slope;
}

double contact_value(double packing) { return (compressibility(packing) - 1) / (4 * packing); }

double collision_rate(double packing) { return 4 * std::sqrt(pi) * (6 * packing / pi) * contact_value(packing); }

/// At given energy, relative speeds are those of a sphere in f = 3 N - 3 dimensions: 1 + 1 / (4 f) times Maxwell's.
double collision_rate(double packing, double bodies) {
    const double pairs = (compressibility(packing, bodies) - 1) / (compressibility(packing) - 1);
    return collision_rate(packing) * pairs * (1 + 1 / (4 * (3 * bodies - 3)));
}

} // namespace carom::validate
