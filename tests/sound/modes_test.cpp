#include "listening.hpp"
#include "viewer/sound/modes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace carom::sound {

namespace {

double bessel_slope(unsigned degree, double x) {
    return degree / x * std::sph_bessel(degree, x) - std::sph_bessel(degree + 1, x);
}

/// Zero for a spheroidal mode of an elastic sphere with a free surface and Poisson's ratio 1/4: the determinant of its
/// two conditions, no stress along and across the normal. With u = grad(j_l(h r) Y) + curl curl(r j_l(k r) Y), radius
/// 1, k the wave number of shear waves, and h = k / sqrt(3) that of pressure waves. Lamb (1882).
double lamb(unsigned degree, double k) {
    const double h = k / std::sqrt(3.0);
    const double l = degree * (degree + 1.0);
    const double along_h = (2 * l - k * k) * std::sph_bessel(degree, h) - 4 * h * bessel_slope(degree, h);
    if (degree == 0) return along_h; // it only breathes
    const double along_k = 2 * l * (k * bessel_slope(degree, k) - std::sph_bessel(degree, k));
    const double across_h = 2 * (h * bessel_slope(degree, h) - std::sph_bessel(degree, h));
    const double across_k = (2 * l - 2 - k * k) * std::sph_bessel(degree, k) - 2 * k * bessel_slope(degree, k);
    return along_h * across_k - along_k * across_h;
}

TEST(Modes, SolveLambsEquation) {
    for (const Mode& mode : modes) {
        const double below = lamb(mode.degree, mode.wave_number - 1e-9);
        const double above = lamb(mode.degree, mode.wave_number + 1e-9);
        EXPECT_LT(below * above, 0) << "degree " << mode.degree;
    }
}

TEST(Modes, AreTheLowestOfTheirDegree) {
    for (const Mode& mode : modes) {
        // From 0.5 on: at 0 the determinant vanishes with the motion of a rigid body.
        for (int i = 50; i < static_cast<int>(100 * mode.wave_number) - 1; ++i) {
            const double k = i / 100.0;
            EXPECT_GT(lamb(mode.degree, k) * lamb(mode.degree, k + 0.01), 0) << "degree " << mode.degree << " at " << k;
        }
    }
}

/// A ring as doubles.
std::vector<double> ring_of(double pitch, double q, double rate = 48000) {
    const std::vector<float> samples = ring(pitch, q, rate);
    return {samples.begin(), samples.end()};
}

TEST(Ring, HasItsModesWhereTheyShouldBe) {
    const std::vector<double> samples = ring_of(880, quality(1));
    EXPECT_NEAR(test::main_pitch(samples, 500, 4000) / 880, 1, 0.002);
    for (const Mode& mode : modes) {
        const double frequency = 880 * mode.wave_number / modes[0].wave_number;
        const double found = test::main_pitch(samples, frequency * 0.97, frequency * 1.03);
        EXPECT_NEAR(found / frequency, 1, 0.002) << "degree " << mode.degree;
    }
}

TEST(Ring, BeginsAndEndsInSilence) {
    for (const double pitch : {110.0, 880.0, 7040.0}) {
        for (const double e : {0.0, 0.5, 1.0}) {
            const std::vector<double> samples = ring_of(pitch, quality(e));
            EXPECT_EQ(samples.front(), 0);
            EXPECT_EQ(samples.back(), 0);
            EXPECT_FLOAT_EQ(static_cast<float>(test::largest(samples)), 1);
        }
    }
}

TEST(Ring, FallsToOneInEInItsRingTime) {
    const double q = quality(1);
    const std::vector<double> samples = ring_of(880, q);
    const auto delay = static_cast<std::size_t>(48000 * ring_time(880, q));
    // Windows of 20 periods tell the lowest mode from the next.
    const auto window = static_cast<std::size_t>(48000 * 20 / 880.0);
    const std::span<const double> all(samples);
    const double ratio =
        test::spectrum_at(all.subspan(delay, window), 880, 48000) / test::spectrum_at(all.first(window), 880, 48000);
    EXPECT_NEAR(ratio, std::exp(-1.0), 0.01);
}

TEST(Ring, OfLivelierBodiesLastsLonger) {
    double before = 0;
    for (const double e : {0.0, 0.25, 0.5, 0.75, 1.0}) {
        const auto length = static_cast<double>(ring(440, quality(e), 48000).size());
        EXPECT_GT(length, before);
        before = length;
    }
}

TEST(Ring, LeavesOutWhatTheRateCannotHold) {
    // All modes but the lowest of 3 kHz lie above 0.4 * 8 kHz.
    const std::vector<double> samples = ring_of(3000, quality(1), 8000);
    EXPECT_NEAR(test::main_pitch(samples, 200, 4000, 8000) / 3000, 1, 0.002);
    EXPECT_LT(test::spectrum_at(samples, 4000 - 3000 * 0.297, 8000), 0.05 * test::spectrum_at(samples, 3000, 8000));
}

} // namespace

} // namespace carom::sound
