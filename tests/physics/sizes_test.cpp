// Radii of 1 to 1000 in single precision: no pair overlaps by more than a ten-thousandth of the smaller diameter.

#include "scene/generators.hpp"
#include "scene/occupancy.hpp"
#include "scene/overlap_search.hpp"
#include "scene/random.hpp"

#include <carom/carom.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <vector>

namespace {

using carom::Impact;
using carom::Vec3;
using carom::World;
using carom::scene::Random;

constexpr double large_radius = 0.5;
constexpr double small_radius = 0.0005;
constexpr std::size_t large_count = 12;
constexpr std::size_t small_count = 3000;
constexpr carom::scene::Cuboid space{{0, 0, 0}, {3.5, 3.5, 3.5}};

std::vector<Vec3> places(const std::vector<double>& radii, Random& random) {
    carom::scene::Occupancy occupancy;
    const auto sample = [](double radius, Random& source) {
        return carom::scene::in_cuboid(space, radius, {1, 1, 1}, source);
    };
    return carom::scene::place_randomly(radii, {sample, space.volume()}, occupancy, random);
}

/// Large balls of 1 kg and small ones of the same density, in a closed box.
World mixture(double restitution) {
    World world({.region = carom::Box{space.min, space.max},
                 .precision = carom::Precision::single_precision,
                 .resolution = 0x1p-30});
    std::vector<double> radii(large_count + small_count, small_radius);
    std::fill_n(radii.begin(), large_count, large_radius);
    Random random(1000);
    const std::vector<Vec3> positions = places(radii, random);
    for (std::size_t k = 0; k < radii.size(); ++k) {
        const double size = radii[k] / large_radius;
        world.add({.position = positions[k],
                   .velocity = 3 * random.normal_vector(),
                   .mass = size * size * size,
                   .radius = radii[k],
                   .restitution = restitution});
    }
    return world;
}

/// The large balls have the lower ids.
bool is_unequal(const Impact& impact) {
    return impact.face < 0 && impact.a.slot < large_count && impact.b.slot >= large_count;
}

/// Ends a step of at most `dt` where an overlap would show: at the very moment when a small ball meets a large one.
void step_to_impact(World& world, double dt) {
    World ahead = world;
    ahead.step(dt);
    const auto impacts = ahead.impacts();
    const auto last = std::find_if(impacts.rbegin(), impacts.rend(), is_unequal);
    world.step(last != impacts.rend() && last->offset > 0 ? last->offset : dt);
}

void expect_gaps(double restitution) {
    constexpr double allowed = 1e-4;
    World world = mixture(restitution);
    carom::scene::OverlapSearch search(world);
    double largest = 0;
    std::uint64_t unequal = 0;
    std::uint64_t touching = 0;
    for (int i = 0; i < 600; ++i) {
        step_to_impact(world, 1.0 / 120);
        unequal += static_cast<std::uint64_t>(std::ranges::count_if(world.impacts(), is_unequal));
        const carom::scene::OverlapReport overlap = search.find(world);
        largest = std::max(largest, overlap.largest);
        touching += overlap.touching;
        ASSERT_EQ(overlap.bodies_outside, 0U) << "step " << i;
    }
    std::printf(
        "figure: radii 1:1000 in single, e = %g, %llu impacts of large with small: largest overlap %.3g smaller "
        "diameters (at most %g), %llu found touching\n",
        restitution, static_cast<unsigned long long>(unequal), largest, allowed,
        static_cast<unsigned long long>(touching));
    EXPECT_LE(largest, allowed);
    EXPECT_GT(unequal, 1000U);
    EXPECT_GT(touching, 50U) << "steps end elsewhere";
}

TEST(Sizes, ElasticMixtureKeepsGapsInSingle) { expect_gaps(1); }
TEST(Sizes, InelasticMixtureKeepsGapsInSingle) { expect_gaps(0.5); }

} // namespace
