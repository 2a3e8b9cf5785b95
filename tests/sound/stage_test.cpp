#include "listening.hpp"
#include "scene/random.hpp"
#include "viewer/sound/modes.hpp"
#include "viewer/sound/sound_stage.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace carom::sound {

namespace {

using test::hear;
using test::Stereo;

/// In front of the default listener, at the reference distance.
const Strike ahead{.position = {0, 1, 0}};

TEST(Sound, HasThePitchOfTheMass) {
    for (const double mass : {1 / 27.0, 1 / 8.0, 1.0, 8.0, 64.0}) {
        Strike strike = ahead;
        strike.mass = mass;
        const double predicted = 880 / std::cbrt(mass);
        const Stereo heard = hear(strike, 0.3);
        EXPECT_NEAR(test::main_pitch(heard.left, 100, 5000) / predicted, 1, 0.005) << mass << " kg";
    }
}

TEST(Sound, StaysWithinTheRangeOfHearing) {
    Strike strike = ahead;
    strike.mass = 1e30;
    EXPECT_NEAR(test::main_pitch(hear(strike, 0.5).left, 60, 500) / lowest_pitch, 1, 0.01);
    strike.mass = 1e-30;
    EXPECT_NEAR(test::main_pitch(hear(strike, 0.1).left, 4000, 12000) / highest_pitch, 1, 0.01);
}

TEST(Sound, AmplitudeIsTheSquareRootOfTheImpulse) {
    Strike strike = ahead;
    const double one = test::root_mean_square(hear(strike, 0.2).left);
    for (const double impulse : {1e-6, 1e-3, 0.25, 2.0}) {
        strike.impulse = impulse;
        EXPECT_NEAR(test::root_mean_square(hear(strike, 0.2).left) / one / std::sqrt(impulse), 1, 0.005) << impulse;
    }
    // Beyond full scale it is no longer the law that holds, but it does not get quieter, nor leave the scale.
    double before = one;
    for (const double impulse : {4.0, 16.0, 1e3, 1e9}) {
        strike.impulse = impulse;
        const Stereo heard = hear(strike, 0.2);
        EXPECT_GE(test::root_mean_square(heard.left), 0.999 * before) << impulse;
        EXPECT_LE(test::largest(heard.left), 1);
        before = test::root_mean_square(heard.left);
    }
}

TEST(Sound, FallsWithTheDistance) {
    const SoundSettings settings{.reference_distance = 10};
    const auto at = [&](double distance) {
        return test::root_mean_square(hear({.position = {0, distance, 0}}, 0.2, settings).left);
    };
    EXPECT_NEAR(at(20) / at(10), 0.5, 0.005);
    EXPECT_NEAR(at(40) / at(20), 0.5, 0.005);
    EXPECT_NEAR(at(1000) / at(10), 0.01, 0.0001);
    EXPECT_NEAR(at(2) / at(10), 1, 0.005);
}

/// Factor by which the pitch of a strike 1000 m ahead is shifted.
double shift(const Vec3& velocity, const Vec3& of_listener = {}) {
    const SoundSettings settings{.reference_distance = 1000};
    const Strike strike{.position = {0, 1000, 0}, .velocity = velocity};
    return test::main_pitch(hear(strike, 0.3, settings, {.velocity = of_listener}).left, 300, 2500) / 880;
}

TEST(Sound, IsShiftedByMotion) {
    constexpr double c = 343.3;
    for (const double speed : {30.0, -30.0, 100.0, -100.0}) {
        EXPECT_NEAR(shift({0, -speed, 0}) / (c / (c - speed)), 1, 0.01) << "source " << speed;
        EXPECT_NEAR(shift({}, {0, speed, 0}) / ((c + speed) / c), 1, 0.01) << "listener " << speed;
    }
    EXPECT_NEAR(shift({100, 0, 0}), 1, 0.01);
    // Faster than half of sound counts as half of it.
    EXPECT_NEAR(shift({0, -1e6, 0}) / 2, 1, 0.01);
    EXPECT_NEAR(shift({0, 1e6, 0}) * 1.5, 1, 0.01);
}

TEST(Sound, ComesFromWhereItIs) {
    const auto from = [](const Vec3& position, const Listener& listener = {}) {
        return test::balance(hear({.position = position}, 0.2, {}, listener));
    };
    EXPECT_NEAR(from({0, 5, 0}), 1, 1e-4);
    EXPECT_GT(from({2, 5, 0}), 1.5);
    EXPECT_GT(from({4, 5, 0}), from({2, 5, 0}));
    for (const double x : {0.5, 1.0, 2.0}) EXPECT_NEAR(from({x, 5, 0}) * from({-x, 5, 0}), 1, 1e-3) << x;
    // The same for one who looks back, and for one who hangs upside down: left is right.
    EXPECT_NEAR(from({2, -5, 0}, {.forward = {0, -1, 0}}) * from({2, 5, 0}), 1, 1e-3);
    EXPECT_NEAR(from({2, 5, 0}, {.up = {0, 0, -1}}) * from({2, 5, 0}), 1, 1e-3);
}

TEST(Sound, IsTheSameFarFromTheOrigin) {
    const Vec3 far{0x1p42, -0x1p41, 0x1p40};
    const Stereo here = hear({.position = {1, 5, 0}, .velocity = {0, -1, 0}}, 0.1);
    const Stereo there = hear({.position = far + Vec3{1, 5, 0}, .velocity = {0, -1, 0}}, 0.1, {}, {.position = far});
    // Positions there are multiples of 1 mm.
    for (std::size_t i = 0; i < here.left.size(); ++i) ASSERT_NEAR(here.left[i], there.left[i], 1e-4) << i;
}

TEST(Sound, BeginsWhenItIsDue) {
    for (const double delay : {0.0, 0.0101, 0.012345, 0.5}) {
        Strike strike = ahead;
        strike.delay = delay;
        const Stereo heard = hear(strike, 0.6);
        const auto first =
            std::find_if(heard.left.begin(), heard.left.end(), [](double x) { return std::abs(x) > 1e-3; });
        const double time = static_cast<double>(first - heard.left.begin()) / 48000;
        // The limiter takes 1 ms, and the ring a few samples to rise.
        EXPECT_NEAR(time, delay + 0.001, 0.0003) << delay;
    }
}

TEST(Sound, OfNothingIsSilence) {
    SoundStage stage({});
    stage.listen({.position = {1, 2, 3}});
    stage.play({});
    for (const float sample : test::render(stage, 0.5)) ASSERT_EQ(sample, 0);
    EXPECT_EQ(stage.voices(), 0);
    const Strike weightless{.position = {0, 1, 0}, .impulse = 0};
    stage.play({&weightless, 1});
    for (const float sample : test::render(stage, 0.1)) ASSERT_EQ(sample, 0);
}

TEST(Sound, EndsAndGivesItsVoiceBack) {
    SoundStage stage({});
    stage.play({&ahead, 1});
    test::render(stage, 0.1);
    EXPECT_EQ(stage.voices(), 1);
    test::render(stage, 2);
    EXPECT_EQ(stage.voices(), 0);
    for (const float sample : test::render(stage, 0.1)) ASSERT_EQ(sample, 0);
}

/// Strikes all around that no ear takes for one.
std::vector<Strike> around(std::size_t count, double mass, double impulse, double within) {
    scene::Random random(5);
    std::vector<Strike> strikes(count);
    for (Strike& strike : strikes) {
        strike.position = 5 * random.on_sphere();
        strike.velocity = random.normal_vector();
        strike.delay = random.uniform(0, within);
        strike.mass = mass;
        strike.impulse = impulse;
    }
    return strikes;
}

/// The largest second difference of a ring of the lowest pitch once it rings, and at its very start.
struct Curvature {
    double ringing = 0;
    double onset = 0;
};
Curvature curvature() {
    const std::vector<float> samples = ring(lowest_pitch, quality(1), 48000);
    std::vector<double> whole{0, 0};
    whole.insert(whole.end(), samples.begin(), samples.end());
    return {test::roughness(std::span(whole).subspan(2)), test::roughness(whole)};
}

constexpr double heavy = 1e4; ///< kg: at the lowest pitch

/// Amplitude of one of the strikes of `around`, at 5 reference distances.
double amplitude(double impulse) { return 0.25 * std::sqrt(impulse) / 5; }

TEST(Voices, AreTakenAwayWithoutAClick) {
    SoundStage stage({});
    stage.play(around(32, heavy, 1, 0.009));
    test::render(stage, 0.05);
    ASSERT_EQ(stage.voices(), 32);
    // It takes a voice from the start of its piece of 10 ms on, and begins at its end.
    const Strike louder{.delay = 0.0099, .position = {0, 5, 0}, .mass = heavy, .impulse = 1.5};
    stage.play({&louder, 1});
    const Stereo heard = test::listen(stage, 0.01);
    ASSERT_EQ(stage.voices(), 32);
    // 32 rings, the start of one, and the two ends of a straight fade over 240 samples.
    const double bound =
        32 * amplitude(1) * curvature().ringing + amplitude(1.5) * curvature().onset + amplitude(1) / 240;
    EXPECT_LE(test::roughness(heard.left), bound);
    EXPECT_LE(test::roughness(heard.right), bound);
}

TEST(Voices, FollowACutBetweenCamerasWithoutAClick) {
    SoundStage stage({});
    stage.listen({});
    const Strike strike{.position = {5, 0, 0}, .mass = heavy};
    stage.play({&strike, 1});
    Stereo before = test::listen(stage, 0.052);
    ASSERT_GT(test::balance(before), 100);
    stage.listen({.position = {10, 0, 0}});
    const Stereo after = test::listen(stage, 0.1);
    before.left.insert(before.left.end(), after.left.begin(), after.left.end());
    before.right.insert(before.right.end(), after.right.begin(), after.right.end());
    EXPECT_LT(
        test::balance({{after.left.begin() + 2400, after.left.end()}, {after.right.begin() + 2400, after.right.end()}}),
        0.01);
    // On its way the ear passes the source, where the gain goes from side to side within a fifth of the way.
    const double bound = 0.25 * (curvature().onset + 5.0 / 480);
    EXPECT_LE(test::roughness(before.left), bound);
    EXPECT_LE(test::roughness(before.right), bound);
}

TEST(Voices, OfTenThousandImpactsAFrameAreSixtyFour) {
    SoundStage stage({});
    std::vector<double> left;
    std::size_t most = 0;
    for (int frame = 0; frame < 30; ++frame) {
        // So quiet that nothing is limited.
        stage.play(around(10000, heavy, 1e-5, 1.0 / 60));
        const Stereo heard = test::listen(stage, 1.0 / 60);
        left.insert(left.end(), heard.left.begin(), heard.left.end());
        most = std::max(most, stage.voices());
        ASSERT_LE(stage.voices(), most_voices);
    }
    EXPECT_GE(most, most_voices / 2);
    EXPECT_LT(test::largest(left), 1);
    // A sound is at most as loud as all of its piece (1/120 s) together, and the 32 of one piece have at most sqrt(32)
    // times that amplitude. So ring or fade up to 32, of as many pieces, and those that are new, of which each may
    // start.
    const double piece = amplitude(1e-5) * std::sqrt(10000 / 2.0);
    const double bound = piece * ((32 + std::sqrt(32)) * (curvature().ringing + 1.0 / 240) + curvature().onset);
    EXPECT_LE(test::roughness(left), bound);
}

TEST(Voices, OfAnyNumberStayOnTheScale) {
    SoundStage stage({});
    for (int frame = 0; frame < 20; ++frame) {
        stage.play(around(10000, 1, 100, 1.0 / 60));
        const std::vector<float> samples = test::render(stage, 1.0 / 60);
        for (const float sample : samples) ASSERT_LE(std::abs(sample), 1);
        EXPECT_GT(test::largest(test::split<float>(samples, 1).left), 0.2);
    }
}

TEST(Voices, AreFoundHoweverShortTheCallsAre) {
    for (const std::size_t frames : {1U, 7U, 100U, 5000U}) {
        SoundStage stage({});
        stage.play(around(1000, 1, 1, 0.1));
        std::vector<float> samples(2 * frames);
        double energy = 0;
        for (std::size_t done = 0; done < 9600; done += frames) {
            stage.render(samples);
            for (const float sample : samples) energy += static_cast<double>(sample) * static_cast<double>(sample);
            ASSERT_LE(stage.voices(), most_voices);
        }
        EXPECT_GT(energy, 1) << frames;
    }
}

TEST(Sound, IsTheSameEachTime) {
    const auto run = [] {
        SoundStage stage({});
        std::vector<float> samples;
        for (int frame = 0; frame < 20; ++frame) {
            stage.listen({.position = {0.1 * frame, -3, 0}});
            stage.play(around(500, 1 + frame, 1, 1.0 / 60));
            const std::vector<float> more = test::render(stage, 1.0 / 60);
            samples.insert(samples.end(), more.begin(), more.end());
        }
        return samples;
    };
    EXPECT_EQ(run(), run());
}

} // namespace

} // namespace carom::sound
