// Standard errors of series whose true error is known.

#include "scene/random.hpp"

#include <carom/observers.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace carom {
namespace {

using scene::Random;

/// The mean square of (mean / standard error) over many series with mean 0: 1 if the errors are right.
template <class Series>
double mean_square_of_sigmas(Series series) {
    constexpr int trials = 400;
    double sum = 0;
    for (int trial = 0; trial < trials; ++trial) {
        Random random = Random::stream(7, static_cast<std::uint64_t>(trial));
        BlockAverage average;
        series(random, average);
        const Estimate estimate = average.estimate();
        sum += estimate.value * estimate.value / (estimate.standard_error * estimate.standard_error);
    }
    return sum / trials;
}

TEST(BlockAverage, ErrorsOfIndependentSamplesAreRight) {
    const double square = mean_square_of_sigmas([](Random& random, BlockAverage& average) {
        for (int i = 0; i < 777; ++i) average.add(random.normal());
    });
    std::printf("figure: block averages of independent samples: rms deviation %.3f standard errors (1 +- 0.1)\n",
                std::sqrt(square));
    EXPECT_NEAR(std::sqrt(square), 1, 0.1);
}

// x' = 0.9 x + noise: neighbours depend on each other over about ten samples; taken as independent, the error would be
// sqrt(19) too small.
TEST(BlockAverage, ErrorsOfCorrelatedSamplesAreRight) {
    const double square = mean_square_of_sigmas([](Random& random, BlockAverage& average) {
        double x = random.normal();
        for (int i = 0; i < 8000; ++i) {
            average.add(x);
            x = 0.9 * x + std::sqrt(1 - 0.81) * random.normal();
        }
    });
    std::printf("figure: block averages of correlated samples: rms deviation %.3f standard errors (1 +- 0.15)\n",
                std::sqrt(square));
    EXPECT_NEAR(std::sqrt(square), 1, 0.15);
}

TEST(BlockAverage, ErrorsOfWeightedSamplesAreRight) {
    const double square = mean_square_of_sigmas([](Random& random, BlockAverage& average) {
        for (int i = 0; i < 2000; ++i) {
            const double weight = random.uniform(0.1, 2);
            average.add(random.normal() / std::sqrt(weight), weight);
        }
    });
    EXPECT_NEAR(std::sqrt(square), 1, 0.1);
}

TEST(BlockAverage, MeanIsThatOfAllSamples) {
    BlockAverage average;
    for (int i = 1; i <= 1000; ++i) average.add(i);
    EXPECT_DOUBLE_EQ(average.estimate().value, 500.5);
    EXPECT_EQ(average.samples(), 1000U);
    BlockAverage weighted;
    weighted.add(1, 3);
    weighted.add(5, 1);
    weighted.add(1000, 0);
    EXPECT_DOUBLE_EQ(weighted.estimate().value, 2);
}

TEST(BlockAverage, SaysWhereItKnowsNoError) {
    BlockAverage average;
    EXPECT_TRUE(std::isinf(average.estimate().standard_error));
    average.add(3);
    EXPECT_DOUBLE_EQ(average.estimate().value, 3);
    EXPECT_TRUE(std::isinf(average.estimate().standard_error));
    average.add(5);
    EXPECT_DOUBLE_EQ(average.estimate().standard_error, 1);
}

} // namespace
} // namespace carom
