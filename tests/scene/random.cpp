// Random numbers: the published values of the generators, the moments of the distributions (within 5 standard errors
// at a fixed seed), and their bits.
#include "scene/random.hpp"

#include "bits.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace carom::scene {
namespace {

constexpr int samples = 200'000;

/// Mean of a function of random numbers, and its standard error.
struct Mean {
    double value;
    double error;
};

template <class Draw>
Mean mean_of(const Draw& draw) {
    double sum = 0;
    double squares = 0;
    for (int i = 0; i < samples; ++i) {
        const double x = draw();
        sum += x;
        squares += x * x;
    }
    const double mean = sum / samples;
    return {mean, std::sqrt((squares / samples - mean * mean) / samples)};
}

template <class Draw>
void expect_mean(const char* what, double expected, const Draw& draw) {
    const Mean mean = mean_of(draw);
    EXPECT_NEAR(mean.value, expected, 5 * mean.error) << what;
}

TEST(Random, Splitmix64GivesThePublishedNumbers) {
    std::uint64_t state = 1234567;
    for (const std::uint64_t expected : {6457827717110365317U, 3203168211198807973U, 9817491932198370423U,
                                         4593380528125082431U, 16408922859458223821U}) {
        EXPECT_EQ(splitmix64(state), expected);
    }
}

TEST(Random, Xoshiro256StarStarGivesThePublishedNumbers) {
    Random random(std::array<std::uint64_t, 4>{1, 2, 3, 4});
    const std::array<std::uint64_t, 8> published{11520,
                                                 0,
                                                 1509978240,
                                                 1215971899390074240,
                                                 1216172134540287360,
                                                 607988272756665600,
                                                 16172922978634559625U,
                                                 8476171486693032832};
    for (const std::uint64_t expected : published) EXPECT_EQ(random.bits(), expected);
}

TEST(Random, UniformHasItsMomentsAndBounds) {
    Random random(1);
    expect_mean("mean", 1, [&] { return random.uniform(-2, 4); });
    expect_mean("variance", 3, [&] { return std::pow(random.uniform(-2, 4) - 1, 2); });
    for (int i = 0; i < samples; ++i) {
        const double x = random.uniform(-2, 4);
        ASSERT_TRUE(x >= -2 && x < 4);
    }
}

TEST(Random, UniformNeverReachesItsUpperEnd) {
    Random random(2);
    const double low = 1;
    const double high = std::nextafter(low, 2.0);
    for (int i = 0; i < 1000; ++i) ASSERT_EQ(random.uniform(low, high), low);
    EXPECT_EQ(random.uniform(3, 3), 3);
}

TEST(Random, NormalHasItsMoments) {
    Random random(3);
    expect_mean("mean", 0, [&] { return random.normal(); });
    expect_mean("variance", 1, [&] { return std::pow(random.normal(), 2); });
    expect_mean("third moment", 0, [&] { return std::pow(random.normal(), 3); });
    expect_mean("fourth moment", 3, [&] { return std::pow(random.normal(), 4); });
    expect_mean("neighbours", 0, [&] { return random.normal() * random.normal(); });
}

TEST(Random, PointsOnTheSphereAreEvenlySpread) {
    Random random(4);
    expect_mean("x", 0, [&] { return random.on_sphere().x; });
    expect_mean("y", 0, [&] { return random.on_sphere().y; });
    expect_mean("z", 0, [&] { return random.on_sphere().z; });
    expect_mean("x^2", 1.0 / 3, [&] { return std::pow(random.on_sphere().x, 2); });
    expect_mean("y^2", 1.0 / 3, [&] { return std::pow(random.on_sphere().y, 2); });
    expect_mean("z^4", 1.0 / 5, [&] { return std::pow(random.on_sphere().z, 4); });
    for (int i = 0; i < 1000; ++i) ASSERT_NEAR(length(random.on_sphere()), 1, 1e-15 * 4);
}

TEST(Random, PointsOnTheCircleAreEvenlySpread) {
    Random random(5);
    expect_mean("x", 0, [&] { return random.on_circle().x; });
    expect_mean("x y", 0, [&] {
        const Vec3 point = random.on_circle();
        return point.x * point.y;
    });
    expect_mean("x^4", 3.0 / 8, [&] { return std::pow(random.on_circle().x, 4); });
}

TEST(Random, LogUniformIsUniformInTheLogarithm) {
    Random random(6);
    expect_mean("mean", 0, [&] { return std::log10(random.log_uniform(1e-3, 1e3)); });
    expect_mean("variance", 3, [&] { return std::pow(std::log10(random.log_uniform(1e-3, 1e3)), 2); });
    for (int i = 0; i < samples; ++i) {
        const double x = random.log_uniform(0.1, 0.3);
        ASSERT_TRUE(x >= 0.1 && x <= 0.3);
    }
    EXPECT_EQ(random.log_uniform(0.7, 0.7), 0.7);
}

TEST(Random, RayleighHasItsMeanSquare) {
    Random random(7);
    expect_mean("mean square", 0.09, [&] { return std::pow(random.rayleigh(0.3), 2); });
    expect_mean("mean", 0.3 * std::sqrt(std::acos(-1.0)) / 2, [&] { return random.rayleigh(0.3); });
    EXPECT_EQ(random.rayleigh(0), 0);
}

TEST(Random, StreamsOfASeedDiffer) {
    std::vector<std::uint64_t> first(100);
    for (std::size_t i = 0; i < first.size(); ++i) first[i] = Random::stream(1, i).bits();
    std::sort(first.begin(), first.end());
    EXPECT_EQ(std::adjacent_find(first.begin(), first.end()), first.end());
    EXPECT_NE(Random::stream(1, 2).bits(), Random::stream(2, 1).bits());
}

TEST(Random, DistributionsHaveTheSameBitsEverywhere) {
    Random random(20101127);
    BitHash hash;
    for (int i = 0; i < 1000; ++i) {
        hash.add(random.uniform(-5, 5));
        hash.add(random.log_uniform(0.0005, 0.5));
        hash.add(random.normal());
        hash.add(random.rayleigh(0.1));
        hash.add(random.on_sphere());
        hash.add(random.on_circle());
    }
    EXPECT_EQ(hash.value(), 5401146144916776399U);
}

} // namespace
} // namespace carom::scene
