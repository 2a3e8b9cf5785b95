// Generators: where bodies are put, without overlap, in a fixed order and with fixed bits; how fast they are.
#include "scene/generators.hpp"

#include "bits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace carom::scene {
namespace {

/// m: the smallest gap between any two surfaces, by looking at all pairs. `length` as in Periods.
double smallest_gap(std::span<const Vec3> positions, std::span<const double> radii, const Vec3& length_of_space = {}) {
    const auto nearest = [](double d, double period) {
        return period > 0 ? d - period * std::nearbyint(d / period) : d;
    };
    double smallest = 1e300;
    for (std::size_t i = 0; i < positions.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j) {
            const Vec3 d = positions[i] - positions[j];
            const Vec3 image{nearest(d.x, length_of_space.x), nearest(d.y, length_of_space.y),
                             nearest(d.z, length_of_space.z)};
            smallest = std::min(smallest, length(image) - radii[i] - radii[j]);
        }
    }
    return smallest;
}

/// m: how near any surface comes to a side of the box; negative if it is through.
double smallest_margin(std::span<const Vec3> positions, double radius, const Cuboid& box) {
    double smallest = 1e300;
    for (const Vec3& p : positions) {
        smallest = std::min({smallest, p.x - box.min.x, p.y - box.min.y, p.z - box.min.z, box.max.x - p.x,
                             box.max.y - p.y, box.max.z - p.z});
    }
    return smallest - radius;
}

std::string refusal(const std::function<void()>& call) {
    try {
        call();
    } catch (const GeneratorError& error) {
        return error.what();
    }
    return "nothing was refused";
}

constexpr Cuboid cube10{{0, 0, 0}, {10, 10, 10}};
constexpr Cuboid flat{{-3, 2, 100}, {37, 12, 104}};

Room box_room(const Cuboid& box) {
    return {[box](double r, Random& random) { return in_cuboid(box, r, {1, 1, 1}, random); }, box.volume()};
}

// Lattices -----------------------------------------------------------------------------------------------------------

TEST(Lattice, SitesAreAsCubicAsTheBoxAllows) {
    const Sites cubic = lattice_sites(cube10, 1000);
    EXPECT_EQ(cubic.x * cubic.y * cubic.z, 1000U);
    const Sites one_more = lattice_sites(cube10, 1001);
    EXPECT_EQ(one_more.x, 11U);
    const Sites slab = lattice_sites(flat, 1600); // 40 x 10 x 4 m: cells of 1 m
    EXPECT_EQ(slab.x, 40U);
    EXPECT_EQ(slab.y, 10U);
    EXPECT_EQ(slab.z, 4U);
    for (const std::size_t count : {1U, 2U, 3U, 7U, 999U, 12345U}) {
        const Sites sites = lattice_sites(flat, count);
        EXPECT_GE(sites.x * sites.y * sites.z, count);
    }
}

TEST(Lattice, ExtremeBoxesAreNoTrap) {
    const Cuboid needle{{0, 0, 0}, {1e30, 1, 1e-30}};
    const Sites sites = lattice_sites(needle, 10);
    EXPECT_EQ(sites.x, 10U);
    EXPECT_EQ(sites.y, 1U);
    EXPECT_EQ(sites.z, 1U);
}

TEST(Lattice, FillsSitesInOrderAndEvenly) {
    const std::vector<Vec3> all = lattice(cube10, {10, 10, 10}, 1000);
    ASSERT_EQ(all.size(), 1000U);
    EXPECT_EQ(all[0], (Vec3{0.5, 0.5, 0.5}));
    EXPECT_EQ(all[1], (Vec3{1.5, 0.5, 0.5}));
    EXPECT_EQ(all[10], (Vec3{0.5, 1.5, 0.5}));
    EXPECT_EQ(all[999], (Vec3{9.5, 9.5, 9.5}));
    const std::vector<Vec3> some = lattice(cube10, {10, 10, 10}, 900);
    double z = 0;
    for (const Vec3& position : some) z += position.z / 900;
    EXPECT_NEAR(z, 5, 0.1); // no layer stays empty
}

TEST(Lattice, LargestJitterLeavesNoOverlap) {
    const Sites sites = lattice_sites(cube10, 1000);
    const Vec3 amount = largest_jitter(cube10, sites, 0.3);
    EXPECT_NEAR(amount.x, 0.2, 1e-12);
    EXPECT_NEAR(largest_jitter(cube10, {10, 10, 1}, 0.3).z, 4.7, 1e-12);
    std::vector<Vec3> positions = lattice(cube10, sites, 1000);
    Random random(1);
    jitter(positions, amount, random);
    EXPECT_GE(smallest_gap(positions, std::vector<double>(1000, 0.3)), 0);
    EXPECT_GE(smallest_margin(positions, 0.3, cube10), 0);
    EXPECT_LT(smallest_margin(positions, 0.3, cube10), 0.01); // and it is used
}

TEST(Lattice, RefusesWhatDoesNotFit) {
    EXPECT_NE(refusal([] { largest_jitter(cube10, {10, 10, 10}, 0.51); }).find("leave 1 m per body"),
              std::string::npos);
}

TEST(Lattice, HasFixedBits) {
    std::vector<Vec3> positions = lattice(flat, lattice_sites(flat, 500), 500);
    Random random(7);
    jitter(positions, {0.1, 0.1, 0.1}, random);
    EXPECT_EQ(hash_of<Vec3>(positions), 3672226788914731004U);
}

TEST(Fcc, HasTheSpacingThatFits) {
    // 4 layers of half the lattice constant, (10 - 2 r) / 4 apart: (5^3 + 1) / 2 = 63 sites.
    const double r = 0.5;
    const std::vector<Vec3> positions = fcc(cube10, 63, r);
    ASSERT_EQ(positions.size(), 63U);
    EXPECT_NEAR(smallest_gap(positions, std::vector<double>(63, r)), 9.0 / 4 * std::numbers::sqrt2 - 1, 1e-12);
    EXPECT_NEAR(smallest_margin(positions, r, cube10), 0, 1e-12);
    EXPECT_GE(smallest_margin(positions, r, cube10), 0);
    const std::vector<Vec3> more = fcc(cube10, 64, r); // needs a fifth layer
    EXPECT_NEAR(smallest_gap(more, std::vector<double>(64, r)), 9.0 / 5 * std::numbers::sqrt2 - 1, 1e-12);
}

TEST(Fcc, IsFilledInOrder) {
    const std::vector<Vec3> positions = fcc(cube10, 50, 0.5);
    const auto before = [](const Vec3& a, const Vec3& b) {
        return std::array{a.z, a.y, a.x} < std::array{b.z, b.y, b.x};
    };
    EXPECT_TRUE(std::is_sorted(positions.begin(), positions.end(), before));
}

TEST(Fcc, ReachesHighPackings) {
    const double side = std::cbrt(4000 * std::numbers::pi / 6 / 0.6);
    const Cuboid box{{0, 0, 0}, {side, side, side}};
    const std::vector<Vec3> positions = fcc(box, 4000, 0.5);
    EXPECT_GE(smallest_gap(positions, std::vector<double>(4000, 0.5)), 0);
    EXPECT_GE(smallest_margin(positions, 0.5, box), -1e-12);
}

TEST(Fcc, RefusesWhatDoesNotFit) {
    EXPECT_NE(refusal([] { fcc(cube10, 2000, 0.5); }).find("do not fit"), std::string::npos);
    EXPECT_NE(refusal([] { fcc(cube10, 1, 5.1); }).find("do not fit"), std::string::npos);
    EXPECT_NE(refusal([] { fcc(cube10, 2, 5); }).find("do not fit"), std::string::npos);
    EXPECT_EQ(fcc(cube10, 1, 5).size(), 1U);
}

TEST(Fcc, HasFixedBits) { EXPECT_EQ(hash_of<Vec3>(fcc(flat, 700, 0.4)), 15199697205874889140U); }

// Random places ------------------------------------------------------------------------------------------------------

TEST(RandomPlaces, NeverOverlap) {
    const std::vector<double> radii(500, 0.5); // packing 0.26
    Occupancy occupancy;
    Random random(1);
    const std::vector<Vec3> positions = place_randomly(radii, box_room(cube10), occupancy, random);
    EXPECT_GE(smallest_gap(positions, radii), 0);
    EXPECT_GE(smallest_margin(positions, 0.5, cube10), 0);
}

TEST(RandomPlaces, NeverOverlapWithRadiiOneToAThousand) {
    Random random(2);
    std::vector<double> radii(4000);
    for (double& radius : radii) radius = random.log_uniform(0.0006, 0.6);
    radii[17] = 0; // a point
    Occupancy occupancy;
    const std::vector<Vec3> positions = place_randomly(radii, box_room(cube10), occupancy, random);
    EXPECT_GE(smallest_gap(positions, radii), 0);
}

TEST(RandomPlaces, KeepClearOfBodiesThatAreThere) {
    Occupancy occupancy;
    occupancy.add({5, 5, 5}, 4);
    const std::vector<double> radii(200, 0.1);
    Random random(3);
    for (const Vec3& position : place_randomly(radii, box_room(cube10), occupancy, random)) {
        EXPECT_GE(length(position - Vec3{5, 5, 5}), 4.1);
    }
}

TEST(RandomPlaces, KeepClearAcrossPeriodicFaces) {
    const std::vector<double> radii(400, 0.5);
    Occupancy occupancy({{0, 0, 0}, {10, 10, 10}});
    Random random(4);
    const Room room{[](double r, Random& source) { return in_cuboid(cube10, r, {0, 0, 0}, source); }, 1000};
    const std::vector<Vec3> positions = place_randomly(radii, room, occupancy, random);
    EXPECT_GE(smallest_gap(positions, radii, {10, 10, 10}), 0);
    EXPECT_LT(smallest_margin(positions, 0.5, cube10), -0.4); // centres up to the faces
}

TEST(RandomPlaces, RefuseImpossibleDensitiesAtOnce) {
    Occupancy occupancy;
    Random random(5);
    const std::vector<double> too_many(800, 0.5); // packing 0.42
    EXPECT_NE(refusal([&] { place_randomly(too_many, box_room(cube10), occupancy, random); }).find("packing of 0.419"),
              std::string::npos);
    std::vector<double> mixed(1600, 0.5);
    mixed[0] = 0.4;
    EXPECT_NE(refusal([&] { place_randomly(mixed, box_room(cube10), occupancy, random); }).find("up to about 0.74"),
              std::string::npos);
}

TEST(RandomPlaces, GiveUpWhereThereIsNoRoomLeft) {
    Occupancy occupancy;
    Random random(6);
    const std::vector<double> radii(730, 0.5); // packing 0.382 in a small box: walls leave less
    EXPECT_NE(refusal([&] { place_randomly(radii, box_room(cube10), occupancy, random); }).find("found room for only"),
              std::string::npos);
}

TEST(RandomPlaces, HaveFixedBits) {
    Random random(7);
    std::vector<double> radii(300);
    for (double& radius : radii) radius = random.log_uniform(0.01, 1);
    Occupancy occupancy;
    EXPECT_EQ(hash_of<Vec3>(place_randomly(radii, box_room(cube10), occupancy, random)), 786276296855160367U);
}

TEST(Occupancy, AgreesWithLookingAtAllBodies) {
    Random random(8);
    Occupancy occupancy;
    std::vector<Vec3> positions;
    std::vector<double> radii;
    for (int i = 0; i < 3000; ++i) {
        const Vec3 position{random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-20, 20)};
        const double radius = i % 50 == 0 ? 0 : random.log_uniform(1e-4, 3);
        bool expected = true;
        for (std::size_t j = 0; j < positions.size(); ++j) {
            const double reach = radius + radii[j];
            if (length_squared(position - positions[j]) < reach * reach) expected = false;
        }
        ASSERT_EQ(occupancy.is_free(position, radius), expected) << i;
        if (i % 2 == 0) {
            positions.push_back(position);
            radii.push_back(radius);
            occupancy.add(position, radius);
        }
    }
}

TEST(Occupancy, TouchingIsNoOverlap) {
    Occupancy occupancy;
    occupancy.add({0, 0, 0}, 1);
    EXPECT_TRUE(occupancy.is_free({2, 0, 0}, 1));
    EXPECT_FALSE(occupancy.is_free({std::nextafter(2.0, 0.0), 0, 0}, 1));
}

TEST(Occupancy, WorksFarOutAndForTinyBodies) {
    Occupancy occupancy;
    occupancy.add({1e25, -1e25, 1e25}, 1e-20);
    EXPECT_FALSE(occupancy.is_free({1e25, -1e25, 1e25}, 1e-20));
    EXPECT_TRUE(occupancy.is_free({-1e25, -1e25, 1e25}, 1e-20));
    EXPECT_FALSE(occupancy.is_free({0, 0, 0}, 1e26));
}

// Shapes -------------------------------------------------------------------------------------------------------------

TEST(Shapes, BallIsEvenlyFilled) {
    Random random(9);
    const Ball ball{{1, 2, 3}, 2, 4};
    double mean_cube = 0;
    constexpr int count = 20'000;
    for (int i = 0; i < count; ++i) {
        const double distance = length(in_ball(ball, random) - ball.centre);
        ASSERT_GE(distance, 2 - 1e-14);
        ASSERT_LE(distance, 4 + 1e-14);
        mean_cube += distance * distance * distance / count;
    }
    EXPECT_NEAR(mean_cube, (64 + 8) / 2.0, 5 * 56 / std::sqrt(12.0 * count)); // the cube of the distance is uniform
}

TEST(Shapes, DiscIsEvenlyFilled) {
    Random random(10);
    const Vec3 normal = Vec3{1, 2, 2} / 3.0;
    const Disc disc{{1, 2, 3}, normal, 1, 3, 0.5};
    double mean_square = 0;
    constexpr int count = 20'000;
    for (int i = 0; i < count; ++i) {
        const Vec3 offset = in_disc(disc, random) - disc.centre;
        const double height = dot(offset, normal);
        ASSERT_LE(std::abs(height), 0.25 + 1e-14);
        const double square = length_squared(offset) - height * height;
        mean_square += square / count;
    }
    EXPECT_NEAR(mean_square, 5, 5 * 8 / std::sqrt(12.0 * count)); // the square of the distance is uniform
}

TEST(Shapes, InsideOfRegions) {
    EXPECT_TRUE(is_inside(OpenSpace{}, {1e9, 0, 0}, 1));
    Box box{{0, 0, 0}, {10, 10, 10}, {}};
    EXPECT_TRUE(is_inside(box, {1, 5, 5}, 1));
    EXPECT_FALSE(is_inside(box, {0.9, 5, 5}, 1));
    EXPECT_FALSE(is_inside(box, {5, 5, 9.1}, 1));
    box.faces[5].kind = FaceKind::open;
    EXPECT_TRUE(is_inside(box, {5, 5, 20}, 1));
    box.faces[0].kind = box.faces[1].kind = FaceKind::periodic;
    EXPECT_TRUE(is_inside(box, {0.1, 5, 5}, 1));
    EXPECT_FALSE(is_inside(box, {-0.1, 5, 5}, 1));
    const std::vector<Plane> planes{{{0, 0, 0}, {0, 0, 2}, {}}, {{0, 0, 9}, {0, 0, -1}, {}}};
    EXPECT_TRUE(is_inside(planes, {50, 50, 1}, 1));
    EXPECT_FALSE(is_inside(planes, {50, 50, 0.9}, 1));
    EXPECT_FALSE(is_inside(planes, {50, 50, 8.1}, 1));
    const Shell shell{{0, 0, 0}, 5, {}};
    EXPECT_TRUE(is_inside(shell, {4, 0, 0}, 1));
    EXPECT_FALSE(is_inside(shell, {4.1, 0, 0}, 1));
}

// Velocities ---------------------------------------------------------------------------------------------------------

TEST(Velocities, MaxwellHasItsTemperature) {
    Random random(11);
    const std::vector<double> masses(20'000, 4);
    double energy = 0;
    for (const Vec3& v : maxwell_velocities(masses, 9, random)) energy += 0.5 * 4 * length_squared(v) / 20'000;
    EXPECT_NEAR(energy, 1.5 * 9, 5 * 9 * std::sqrt(1.5 / 20'000)); // sd of the energy is sqrt(3/2) kT
}

TEST(Velocities, StaticBodiesStand) {
    Random random(12);
    const std::vector<double> masses{std::numeric_limits<double>::infinity()};
    EXPECT_EQ(maxwell_velocities(masses, 9, random)[0], Vec3{});
}

TEST(Velocities, RadialPointAwayWithinTheirSpread) {
    Random random(13);
    const std::vector<Vec3> positions{{5, 0, 0}, {0, -2, 0}, {1, 1, 1}, {0, 0, 0}};
    const std::vector<Vec3> straight = radial_velocities(positions, {0, 0, 0}, 3, 0, random);
    EXPECT_NEAR(length(straight[0] - Vec3{3, 0, 0}), 0, 1e-15);
    EXPECT_NEAR(length(straight[1] - Vec3{0, -3, 0}), 0, 1e-15);
    EXPECT_NEAR(length(straight[3]), 3, 1e-15);
    const std::vector<Vec3> many(1000, Vec3{0, 0, 7});
    for (const Vec3& v : radial_velocities(many, {0, 0, 0}, -2, 0.5, random)) {
        EXPECT_NEAR(length(v), 2, 1e-14);
        EXPECT_LE(v.z, -2 * std::cos(std::asin(0.5)) + 1e-12); // at most 30 degrees off
    }
}

/// The shape of the Kepler orbit that a body is on.
struct Elements {
    double eccentricity;
    double axis;        ///< m, semi-major
    double inclination; ///< rad, to the plane z = 0
};

Elements elements_of(const Vec3& position, const Vec3& velocity, double strength) {
    const double distance = length(position);
    const Vec3 momentum = cross(position, velocity);
    const Vec3 eccentricity = cross(velocity, momentum) / strength - position / distance;
    const double energy = 0.5 * length_squared(velocity) - strength / distance;
    return {length(eccentricity), -0.5 * strength / energy, std::acos(momentum.z / length(momentum))};
}

TEST(Velocities, CircularOrbitsAreCircles) {
    Random random(14);
    const Orbit orbit{.strength = 10, .normal = Vec3{0, 0, 1}};
    const Vec3 velocity = orbit_velocity({2, 0, 0}, orbit, random);
    EXPECT_NEAR(length(velocity - Vec3{0, std::sqrt(5.0), 0}), 0, 1e-14);
}

TEST(Velocities, OrbitsHaveTheSpreadAskedFor) {
    Random random(15);
    const Orbit orbit{.strength = 10, .eccentricity = 0.1, .inclination = 0.05, .normal = Vec3{0, 0, 1}};
    constexpr int count = 20'000;
    double eccentricity = 0;
    double inclination = 0;
    for (int i = 0; i < count; ++i) {
        const Vec3 position = 3 * random.on_circle();
        const Elements elements = elements_of(position, orbit_velocity(position, orbit, random), 10);
        eccentricity += elements.eccentricity * elements.eccentricity / count;
        inclination += elements.inclination * elements.inclination / count;
    }
    EXPECT_NEAR(eccentricity, 0.01, 5 * 0.01 / std::sqrt(count)); // the square is exponential: sd = mean
    EXPECT_NEAR(inclination, 0.0025, 5 * 0.0025 / std::sqrt(count));
}

TEST(Velocities, OrbitsWithoutANormalGoAllWays) {
    Random random(16);
    const Orbit orbit{.strength = 10};
    Vec3 sum;
    constexpr int count = 10'000;
    for (int i = 0; i < count; ++i) {
        const Vec3 position = 3 * random.on_sphere();
        const Vec3 velocity = orbit_velocity(position, orbit, random);
        EXPECT_NEAR(dot(position, velocity), 0, 1e-13);
        sum += cross(position, velocity) / (3 * std::sqrt(10.0 / 3) * count);
    }
    EXPECT_LE(length(sum), 5 / std::sqrt(count));
}

TEST(Velocities, SoftenedOrbitsAreCirclesToo) {
    Random random(17);
    const Orbit orbit{.centre = {1, 0, 0}, .drift = {0, 0, 7}, .strength = 10, .softening = 4, .normal = Vec3{0, 0, 1}};
    const Vec3 velocity = orbit_velocity({4, 0, 0}, orbit, random) - Vec3{0, 0, 7};
    const double acceleration = 10 * 3 / std::pow(25, 1.5);
    EXPECT_NEAR(length_squared(velocity) / 3, acceleration, 1e-14);
}

TEST(Velocities, HaveFixedBits) {
    Random random(18);
    BitHash hash;
    for (const Vec3& v : uniform_velocities(100, -5, 5, random)) hash.add(v);
    for (const Vec3& v : maxwell_velocities(std::vector<double>(100, 2), 3, random)) hash.add(v);
    const Orbit orbit{.strength = 10, .eccentricity = 0.1, .inclination = 0.05, .normal = Vec3{0, 0, 1}};
    for (int i = 0; i < 100; ++i) hash.add(orbit_velocity(in_ball({{}, 1, 3}, random), orbit, random));
    const std::vector<Vec3> positions(100, Vec3{1, 2, 3});
    for (const Vec3& v : radial_velocities(positions, {}, 1, 1, random)) hash.add(v);
    EXPECT_EQ(hash.value(), 4505070694917800806U);
}

} // namespace
} // namespace carom::scene
