#include "viewer/sound/sound_stage.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace carom::sound {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// What is refused about a call, as "field: reason".
template <class Call>
std::string refused(const Call& call) {
    try {
        call();
    } catch (const Error& error) {
        return error.what();
    }
    return "nothing";
}

TEST(Refusals, OfSettingsNameThem) {
    const auto refuse = [](const SoundSettings& settings) { return refused([&] { SoundStage stage(settings); }); };
    EXPECT_EQ(refuse({.rate = 7999}), "rate: must be from 8000 to 192000 samples a second");
    EXPECT_EQ(refuse({.reference_mass = 0}), "reference_mass: must be > 0");
    EXPECT_EQ(refuse({.reference_pitch = 50}), "reference_pitch: must be from 110 to 7040 Hz");
    EXPECT_EQ(refuse({.reference_impulse = -1}), "reference_impulse: must be > 0");
    EXPECT_EQ(refuse({.reference_distance = infinite}), "reference_distance: must be finite");
    EXPECT_EQ(refuse({.speed_of_sound = not_a_number}), "speed_of_sound: must be finite");
}

TEST(Refusals, OfListenersNameTheField) {
    SoundStage stage({});
    const auto refuse = [&](const Listener& listener) { return refused([&] { stage.listen(listener); }); };
    EXPECT_EQ(refuse({.position = {0, not_a_number, 0}}), "position: must be finite");
    EXPECT_EQ(refuse({.position = {0, 0, 1e16}}), "position: must be within 1e15 m");
    EXPECT_EQ(refuse({.forward = {0, 0, 0}}), "forward: must not be zero");
    EXPECT_EQ(refuse({.up = {0, 3, 0}}), "up: must not be zero or along forward");
    EXPECT_EQ(refuse({.velocity = {infinite, 0, 0}}), "velocity: must be finite");
}

TEST(Refusals, OfStrikesNameFieldAndIndexAndPlayNothing) {
    SoundStage stage({});
    const auto refuse = [&](const Strike& strike) {
        const std::vector<Strike> strikes{{.position = {0, 1, 0}}, strike};
        return refused([&] { stage.play(strikes); });
    };
    EXPECT_EQ(refuse({.delay = -1}), "delay[1]: must be >= 0");
    EXPECT_EQ(refuse({.delay = 1e9}), "delay[1]: must be at most 1e6 s");
    EXPECT_EQ(refuse({.position = {not_a_number, 0, 0}}), "position[1]: must be finite");
    EXPECT_EQ(refuse({.velocity = {0, 0, infinite}}), "velocity[1]: must be finite");
    EXPECT_EQ(refuse({.mass = infinite_mass}), "mass[1]: must be finite");
    EXPECT_EQ(refuse({.restitution = 1.5}), "restitution[1]: must be at most 1");
    EXPECT_EQ(refuse({.impulse = -1e-9}), "impulse[1]: must be >= 0");
    std::vector<float> samples(4800);
    stage.render(samples);
    for (const float sample : samples) ASSERT_EQ(sample, 0);
}

TEST(Refusals, OfHalfAFrame) {
    SoundStage stage({});
    std::vector<float> samples(3);
    EXPECT_EQ(refused([&] { stage.render(samples); }), "samples: must be pairs of left and right");
}

} // namespace

} // namespace carom::sound
