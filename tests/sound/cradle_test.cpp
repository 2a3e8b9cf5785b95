// Newton's cradle, heard: each click at its time, and from its place.
#include "listening.hpp"
#include "scene/scene.hpp"
#include "viewer/sound/openal.hpp"
#include "viewer/sound/sound_track.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace carom::sound {

namespace {

constexpr int rate = 48000;

/// Impacts that sound as one click: those of one pass through the balls follow each other in microseconds.
struct Click {
    double time = 0; ///< s
    std::vector<Impact> impacts{};
};

struct Performance {
    std::vector<Click> clicks{};
    test::Stereo heard{};
    Listener listener;
    SoundSettings settings;
};

Performance perform() {
    scene::Scene scene = scene::load_scene("scenes/newtons_cradle.toml");
    scene.options.record_impacts = true;
    World world = scene::make_world(scene);
    Performance performance{.listener = overview(world), .settings = settings_for(world)};
    SoundTrack track(world, performance.settings);
    track.listen(performance.listener);
    while (world.time() < 59.99) {
        world.step(scene.run.dt);
        track.record(world);
        for (const Impact& impact : world.impacts()) {
            std::vector<Click>& clicks = performance.clicks;
            if (clicks.empty() || impact.time > clicks.back().time + 0.01) clicks.push_back({.time = impact.time});
            clicks.back().impacts.push_back(impact);
        }
    }
    performance.heard = test::split<std::int16_t>(track.samples(), 32767);
    return performance;
}

/// s: where a millisecond is ten times as loud as any of the 20 ms before it, and no whisper.
std::vector<double> onsets(const test::Stereo& heard) {
    constexpr std::size_t window = rate / 1000;
    std::vector<double> levels;
    for (std::size_t i = 0; i + window <= heard.left.size(); i += window) {
        levels.push_back(std::max(test::largest(std::span(heard.left).subspan(i, window)),
                                  test::largest(std::span(heard.right).subspan(i, window))));
    }
    std::vector<double> times;
    for (std::size_t i = 20; i < levels.size(); ++i) {
        const double before = test::largest(std::span(levels).subspan(i - 20, 20));
        if (levels[i] > 0.005 && levels[i] > 10 * before) times.push_back(static_cast<double>(i) / 1000);
    }
    return times;
}

TEST(NewtonsCradle, ClicksAtTheTimesOfItsImpacts) {
    const Performance performance = perform();
    const std::vector<double> times = onsets(performance.heard);
    // Four in 14 s: through the balls, at a wall, through the balls, at the other wall.
    ASSERT_EQ(performance.clicks.size(), 17);
    ASSERT_EQ(times.size(), performance.clicks.size());
    double worst = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
        EXPECT_NEAR(times[i], performance.clicks[i].time, 0.005);
        worst = std::max(worst, std::abs(times[i] - performance.clicks[i].time));
    }
    std::printf("figure: Newton's cradle, clicks heard at most %.1f ms from their impacts\n", 1000 * worst);
}

/// OpenAL's own gains of a source at a place (m, in front is -z), without anything of this project but the device.
std::pair<double, double> gains(const Vec3& place, double reference_distance) {
    Loopback device(rate, 1);
    const Current current(device.context());
    ALuint buffer = 0;
    ALuint source = 0;
    alGenBuffers(1, &buffer);
    alGenSources(1, &source);
    const std::vector<float> constant(4800, 0.1F);
    alBufferData(buffer, AL_FORMAT_MONO_FLOAT32, constant.data(), 4 * 4800, rate);
    alDistanceModel(AL_INVERSE_DISTANCE_CLAMPED);
    alSourcei(source, AL_BUFFER, static_cast<ALint>(buffer));
    alSourcef(source, AL_REFERENCE_DISTANCE, static_cast<float>(reference_distance));
    alSource3f(source, AL_POSITION, static_cast<float>(place.x), static_cast<float>(place.y),
               static_cast<float>(place.z));
    alSourcePlay(source);
    std::vector<float> samples(960);
    device.render(samples);
    alDeleteSources(1, &source);
    alDeleteBuffers(1, &buffer);
    const test::Stereo heard = test::split<float>(samples, 0.1);
    return {heard.left.back(), heard.right.back()};
}

/// By how much the right channel is to be louder: all balls have the same pitch, so their amplitudes add.
double predicted_balance(const Click& click, const Performance& performance) {
    const Vec3 forward = performance.listener.forward / length(performance.listener.forward);
    const Vec3 right{1, 0, 0};
    double left_sum = 0;
    double right_sum = 0;
    for (const Impact& impact : click.impacts) {
        const Vec3 way = impact.position - performance.listener.position;
        const Vec3 place{dot(way, right), dot(way, cross(right, forward)), -dot(way, forward)};
        const auto [left_gain, right_gain] = gains(place, performance.settings.reference_distance);
        // Both balls ring, of which the ear makes one; a wall does not.
        const double amplitude = std::sqrt(impact.impulse * (impact.b.is_set() ? 2 : 1));
        left_sum += amplitude * left_gain;
        right_sum += amplitude * right_gain;
    }
    return right_sum / left_sum;
}

TEST(NewtonsCradle, ClicksWhereItsImpactsAre) {
    const Performance performance = perform();
    double worst = 0;
    for (const Click& click : performance.clicks) {
        const auto from = static_cast<std::size_t>(click.time * rate);
        constexpr std::size_t window = rate / 100; // the balls go on by at most 1 cm
        const test::Stereo part{{performance.heard.left.begin() + static_cast<std::ptrdiff_t>(from),
                                 performance.heard.left.begin() + static_cast<std::ptrdiff_t>(from + window)},
                                {performance.heard.right.begin() + static_cast<std::ptrdiff_t>(from),
                                 performance.heard.right.begin() + static_cast<std::ptrdiff_t>(from + window)}};
        const double error = 20 * std::log10(test::balance(part) / predicted_balance(click, performance));
        // At the wall, where the left channel changes most with the place, 1 cm is 0.2 dB.
        EXPECT_NEAR(error, 0, 0.25) << "at " << click.time << " s";
        worst = std::max(worst, std::abs(error));
        const double x = click.impacts.front().position.x;
        if (click.impacts.size() == 1) {
            EXPECT_EQ(test::balance(part) > 1, x > performance.listener.position.x) << "at " << click.time << " s";
        }
    }
    std::printf("figure: Newton's cradle, balance of left and right within %.2f dB of OpenAL's for the places\n",
                worst);
}

} // namespace

} // namespace carom::sound
