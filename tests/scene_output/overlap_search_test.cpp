#include "scene/overlap_search.hpp"
#include "scene/random.hpp"

#include <carom/body.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace carom::test {
namespace {

using scene::OverlapReport;
using scene::OverlapSearch;
using scene::Random;

struct Bodies {
    std::vector<Vec3> position;
    std::vector<double> radius;
    std::vector<double> mass;

    void add(const Vec3& x, double r, double m = 1) {
        position.push_back(x);
        radius.push_back(r);
        mass.push_back(m);
    }
};

OverlapReport search(const Region& region, const Bodies& bodies) {
    return OverlapSearch(region, bodies.radius, bodies.mass).find(bodies.position);
}

double nearest(double offset, double period) {
    return period > 0 ? offset - period * std::round(offset / period) : offset;
}

/// Every pair, without a grid; walls are not looked at. A period of 0 is none.
OverlapReport brute_force(const Bodies& bodies, const Vec3& periods) {
    OverlapReport report;
    double sum = 0;
    for (std::size_t a = 0; a < bodies.radius.size(); ++a) {
        for (std::size_t b = a + 1; b < bodies.radius.size(); ++b) {
            const Vec3 offset = bodies.position[b] - bodies.position[a];
            const double distance =
                length(Vec3{nearest(offset.x, periods.x), nearest(offset.y, periods.y), nearest(offset.z, periods.z)});
            const double depth = bodies.radius[a] + bodies.radius[b] - distance;
            const auto [small, large] = std::minmax(bodies.radius[a], bodies.radius[b]);
            const bool both_static = std::isinf(bodies.mass[a]) && std::isinf(bodies.mass[b]);
            if (depth < 0 || large == 0 || both_static) continue;
            const double overlap = depth / (2 * (small > 0 ? small : large));
            report.largest = std::max(report.largest, overlap);
            sum += overlap;
            ++report.touching;
        }
    }
    report.mean = report.touching > 0 ? sum / static_cast<double>(report.touching) : 0;
    return report;
}

void expect_equal(const OverlapReport& found, const OverlapReport& expected) {
    EXPECT_EQ(found.touching, expected.touching);
    EXPECT_NEAR(found.largest, expected.largest, 1e-12 * (1 + expected.largest));
    EXPECT_NEAR(found.mean, expected.mean, 1e-12 * (1 + expected.mean));
}

Bodies random_bodies(Random& random, std::size_t count, const Vec3& low, const Vec3& high, double least_radius,
                     double largest_radius) {
    Bodies bodies;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3 x{random.uniform(low.x, high.x), random.uniform(low.y, high.y), random.uniform(low.z, high.z)};
        const double r = random.unit() < 0.02 ? 0 : random.log_uniform(least_radius, largest_radius);
        bodies.add(x, r, random.unit() < 0.1 ? infinite_mass : 1);
    }
    return bodies;
}

TEST(OverlapSearch, FindsWhatBruteForceFindsInOpenSpace) {
    Random random(1);
    std::uint64_t touching = 0;
    for (const double spread : {1.0, 3.0, 1000.0}) {
        for (const double size : {3.0, 8.0, 25.0}) {
            const Bodies bodies = random_bodies(random, 700, {-size, -size, -size}, {size, size, size}, 1 / spread, 1);
            const OverlapReport expected = brute_force(bodies, {});
            touching += expected.touching;
            expect_equal(search(OpenSpace{}, bodies), expected);
        }
    }
    EXPECT_GT(touching, 10'000U) << "too few to be a test";
}

TEST(OverlapSearch, FindsWhatBruteForceFindsAcrossPeriodicFaces) {
    Random random(2);
    for (int axes = 1; axes < 8; ++axes) {
        Box box{.min = {-3, 5, 0}, .max = {3, 12, 4.5}};
        Vec3 periods = box.max - box.min;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const bool periodic = ((axes >> axis) & 1) != 0;
            box.faces.at(2 * axis).kind = box.faces.at(2 * axis + 1).kind =
                periodic ? FaceKind::periodic : FaceKind::open;
            if (!periodic) (axis == 0 ? periods.x : axis == 1 ? periods.y : periods.z) = 0;
        }
        const Bodies bodies = random_bodies(random, 500, box.min, box.max, 0.01, 1);
        expect_equal(search(box, bodies), brute_force(bodies, periods));
    }
}

TEST(OverlapSearch, IsNotMisledByShapesOfWorlds) {
    Random random(3);
    for (const Vec3& size : {Vec3{1000, 0.1, 0.1}, Vec3{0.1, 1000, 0.1}, Vec3{0.1, 0.1, 1000}, Vec3{40, 40, 0.1}}) {
        const Bodies bodies = random_bodies(random, 1000, -size, size, 0.2, 0.5);
        expect_equal(search(OpenSpace{}, bodies), brute_force(bodies, {}));
    }
    Bodies far = random_bodies(random, 300, {0, 0, 0}, {5, 5, 5}, 0.2, 0.5);
    for (Vec3& x : far.position) x += Vec3{1e9, -1e9, 1e9};
    far.add({-1e12, 0, 0}, 1);
    expect_equal(search(OpenSpace{}, far), brute_force(far, {}));
}

TEST(OverlapSearch, CountsInSmallerDiameters) {
    Bodies bodies;
    bodies.add({0, 0, 0}, 0.5);
    bodies.add({0, 0, 2.4}, 2); // 0.1 m deep, and the smaller diameter is 1 m
    OverlapReport report = search(OpenSpace{}, bodies);
    EXPECT_EQ(report.touching, 1U);
    EXPECT_NEAR(report.largest, 0.1, 1e-15);
    bodies.add({0, 0, 4.3}, 0); // a point 0.1 m deep in the larger body: the unit is its diameter
    report = search(OpenSpace{}, bodies);
    EXPECT_EQ(report.touching, 2U);
    EXPECT_NEAR(report.mean, (0.1 + 0.1 / 4) / 2, 1e-15);
}

TEST(OverlapSearch, TouchingIsAnOverlapOfZero) {
    Bodies bodies;
    bodies.add({0, 0, 0}, 0.5);
    bodies.add({1, 0, 0}, 0.5);
    const OverlapReport report = search(OpenSpace{}, bodies);
    EXPECT_EQ(report.touching, 1U);
    EXPECT_EQ(report.largest, 0);
    EXPECT_EQ(report.mean, 0);
}

TEST(OverlapSearch, LeavesOutWhatCannotOverlap) {
    Bodies bodies;
    bodies.add({0, 0, 0}, 1, infinite_mass);
    bodies.add({0.5, 0, 0}, 1, infinite_mass);
    bodies.add({9, 0, 0}, 0);
    bodies.add({9, 0, 0}, 0);
    const OverlapReport report = search(std::vector<Plane>{{.point = {0, 0, 0}}}, bodies);
    EXPECT_EQ(report.touching, 0U);
    EXPECT_EQ(report.largest, 0);
    EXPECT_EQ(report.mean, 0);
    EXPECT_EQ(report.bodies_outside, 0U);
    EXPECT_EQ(search(OpenSpace{}, {}).touching, 0U);
}

TEST(OverlapSearch, LooksAtTheFacesOfABox) {
    Box box{.min = {0, 0, 0}, .max = {10, 10, 10}};
    box.faces[5].kind = FaceKind::open;
    Bodies bodies;
    bodies.add({0.4, 5, 5}, 0.5);   // 0.1 m into a wall: a tenth of its diameter
    bodies.add({5, 10.25, 5}, 0.5); // outside, 0.75 m deep
    bodies.add({5, 5, 12}, 0.5);    // above the open top
    bodies.add({5, 5, 9.9}, 0.5);
    bodies.add({8, 8, -1}, 0); // a point that fell through
    const OverlapReport report = search(box, bodies);
    EXPECT_EQ(report.touching, 2U);
    EXPECT_EQ(report.bodies_outside, 2U);
    EXPECT_NEAR(report.largest, 0.75, 1e-15);
    EXPECT_NEAR(report.mean, (0.1 + 0.75) / 2, 1e-15);
}

TEST(OverlapSearch, LooksAtPlanesAndShells) {
    Bodies bodies;
    bodies.add({3, 0, 1.8}, 1);
    const Region floor = std::vector<Plane>{{.point = {7, 7, 1}, .normal = {0, 0, 0.5}}};
    EXPECT_NEAR(search(floor, bodies).largest, 0.1, 1e-15);
    const OverlapReport in_shell = search(Shell{.centre = {3, 0, 0}, .radius = 2.5}, bodies);
    EXPECT_NEAR(in_shell.largest, 0.15, 1e-15);
    EXPECT_EQ(in_shell.bodies_outside, 0U);
    EXPECT_EQ(search(Shell{.centre = {3, 0, 0}, .radius = 1.5}, bodies).bodies_outside, 1U);
}

TEST(OverlapSearch, GivesTheSameAgain) {
    Random random(4);
    const Bodies bodies = random_bodies(random, 500, {0, 0, 0}, {6, 6, 6}, 0.05, 1);
    OverlapSearch search(OpenSpace{}, bodies.radius, bodies.mass);
    const OverlapReport first = search.find(bodies.position);
    std::vector<Vec3> elsewhere(bodies.position.size());
    for (std::size_t i = 0; i < elsewhere.size(); ++i) elsewhere[i] = {10.0 * static_cast<double>(i), 0, 0};
    EXPECT_EQ(search.find(elsewhere).touching, 0U);
    const OverlapReport again = search.find(bodies.position);
    EXPECT_EQ(again.largest, first.largest);
    EXPECT_EQ(again.mean, first.mean);
    EXPECT_EQ(again.touching, first.touching);
}

} // namespace
} // namespace carom::test
