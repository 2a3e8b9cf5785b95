#include "listening.hpp"
#include "scene/atomic_file.hpp"
#include "scene/temporary_folder.hpp"
#include "viewer/sound/sound_track.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

namespace carom::sound {

namespace {

std::uint32_t number_at(std::span<const std::byte> bytes, std::size_t place, std::size_t size) {
    std::uint32_t value = 0;
    for (std::size_t i = size; i-- > 0;) value = value << 8U | std::to_integer<std::uint32_t>(bytes[place + i]);
    return value;
}

std::string text_at(std::span<const std::byte> bytes, std::size_t place) {
    std::string text(4, ' ');
    std::memcpy(text.data(), bytes.data() + place, 4);
    return text;
}

TEST(WavFile, IsAsTheFormatSays) {
    const std::vector<std::int16_t> samples{0, 1, -1, 32767, -32767, 258};
    const std::vector<std::byte> file = wav_file(samples, 44100);
    ASSERT_EQ(file.size(), 44 + 12);
    EXPECT_EQ(text_at(file, 0), "RIFF");
    EXPECT_EQ(number_at(file, 4, 4), file.size() - 8);
    EXPECT_EQ(text_at(file, 8), "WAVE");
    EXPECT_EQ(text_at(file, 12), "fmt ");
    EXPECT_EQ(number_at(file, 16, 4), 16);
    EXPECT_EQ(number_at(file, 20, 2), 1);
    EXPECT_EQ(number_at(file, 22, 2), 2);
    EXPECT_EQ(number_at(file, 24, 4), 44100);
    EXPECT_EQ(number_at(file, 28, 4), 4 * 44100);
    EXPECT_EQ(number_at(file, 32, 2), 4);
    EXPECT_EQ(number_at(file, 34, 2), 16);
    EXPECT_EQ(text_at(file, 36), "data");
    EXPECT_EQ(number_at(file, 40, 4), 12);
    for (std::size_t i = 0; i < samples.size(); ++i) {
        EXPECT_EQ(static_cast<std::int16_t>(number_at(file, 44 + 2 * i, 2)), samples[i]);
    }
}

/// A ball that bounces between two walls.
World bouncing() {
    World world({.region = Box{{0, 0, 0}, {3, 3, 3}}});
    world.add({.position = {1, 1.5, 1.5}, .velocity = {2, 0, 0}});
    return world;
}

TEST(SoundTrack, IsAsLongAsTheWorldHasRun) {
    World world = bouncing();
    world.step(0.7); // what was before is not heard
    SoundTrack track(world, settings_for(world));
    for (const double dt : {1.0 / 60, 0.00001, 0.123456, 1.0}) {
        world.step(dt);
        track.record(world);
        EXPECT_EQ(track.samples().size(), 2 * static_cast<std::size_t>(std::lround((world.time() - 0.7) * 48000)));
    }
}

TEST(SoundTrack, IsNearlyTheSameForAnySteps) {
    const auto run = [](int steps) {
        World world = bouncing();
        SoundTrack track(world, settings_for(world));
        track.listen(overview(world));
        for (int i = 0; i < steps; ++i) {
            world.step(2.0 / steps);
            track.record(world);
        }
        return track.samples();
    };
    const std::vector<std::int16_t> coarse = run(1);
    const std::vector<std::int16_t> fine = run(97);
    ASSERT_EQ(coarse.size(), fine.size());
    // Velocities are those at the ends of steps: the ball has turned, or turns back, and with it pitch and place.
    const auto first = [](const std::vector<std::int16_t>& samples) {
        return std::find_if(samples.begin(), samples.end(), [](int x) { return std::abs(x) > 200; }) - samples.begin();
    };
    EXPECT_NEAR(static_cast<double>(first(coarse)), static_cast<double>(first(fine)), 4);
}

TEST(SoundTrack, InSlowMotionIsLongerAndOfTheSamePitch) {
    World world = bouncing();
    SoundTrack track(world, settings_for(world), 0.25);
    world.step(1); // it strikes the wall at 0.75 s
    track.record(world);
    const test::Stereo heard = test::split<std::int16_t>(track.samples(), 32767);
    constexpr std::size_t second = 48000;
    EXPECT_EQ(heard.left.size(), 4 * second);
    const std::span<const double> left(heard.left);
    EXPECT_LT(test::largest(left.first(3 * second)), 0.001);
    EXPECT_NEAR(test::main_pitch(left.subspan(3 * second, 14400), 400, 2000) / 880, 1, 0.01);
    EXPECT_THROW(SoundTrack(world, {}, 0), Error);
}

TEST(SoundTrack, ExcerptsAreAsLongAsAskedForAndFade) {
    World world = bouncing();
    SoundTrack track(world, settings_for(world));
    world.step(1);
    track.record(world);
    const std::vector<std::int16_t> half = track.excerpt(0.77);
    ASSERT_EQ(half.size(), 2 * 36960U);
    EXPECT_TRUE(std::equal(half.begin(), half.end() - 480, track.samples().begin()));
    EXPECT_EQ(half.back(), 0);
    const std::vector<std::int16_t> twice = track.excerpt(2);
    ASSERT_EQ(twice.size(), 2 * 96000U);
    EXPECT_TRUE(std::equal(track.samples().begin(), track.samples().end(), twice.begin()));
    EXPECT_TRUE(track.excerpt(0).empty());
}

TEST(SoundTrack, WritesItsFileWithAnEndThatFades) {
    const scene::TemporaryFolder folder;
    World world = bouncing();
    SoundTrack track(world, settings_for(world));
    world.step(0.76); // it strikes the wall at 0.75 s
    track.record(world);
    const auto rings = [](std::int16_t sample) { return std::abs(sample) > 100; };
    ASSERT_TRUE(std::any_of(track.samples().end() - 100, track.samples().end(), rings));
    const std::filesystem::path file = folder.path() / "ball.wav";
    track.write_wav(file);
    const std::vector<std::byte> bytes = scene::read_file(file);
    ASSERT_EQ(bytes.size(), 44 + 2 * track.samples().size());
    EXPECT_EQ(number_at(bytes, bytes.size() - 4, 4), 0);
    EXPECT_THROW(track.write_wav(folder.path() / "missing" / "ball.wav"), Error);
}

TEST(Settings, SuitTheScene) {
    World world({.gravity = {0, 0, -10}});
    world.add({.position = {-19, 0, 0}, .mass = 1, .radius = 1});
    world.add({.position = {19, 0, 0}, .mass = 100, .radius = 1});
    world.add({.position = {0, 0, 5}, .mass = infinite_mass, .radius = 1});
    const SoundSettings settings = settings_for(world);
    EXPECT_NEAR(settings.reference_mass, 10, 1e-12);        // the geometric mean of those that move
    EXPECT_NEAR(settings.reference_distance, 20, 1e-12);    // half the extent
    EXPECT_NEAR(settings.reference_impulse, 10 * 20, 1e-9); // at the speed of a fall through half of it
    const Listener listener = overview(world);
    EXPECT_NEAR(listener.position.x, 0, 1e-12);
    EXPECT_LT(listener.position.y, -40 + 1e-9);
    EXPECT_GT(listener.position.z, 5);
}

TEST(Settings, SuitWorldsWithoutAnythingToHear) {
    const World empty;
    EXPECT_NO_THROW(SoundStage{settings_for(empty)});
    World fixed;
    fixed.add({.mass = infinite_mass, .radius = 0});
    SoundTrack track(fixed, settings_for(fixed));
    track.listen(overview(fixed));
    fixed.step(0.1);
    track.record(fixed);
    for (const std::int16_t sample : track.samples()) ASSERT_EQ(sample, 0);
}

TEST(Strikes, AreOneForEachBodyThatMoves) {
    World world({.region = Box{{-10, -10, -10}, {10, 10, 10}}});
    const BodyId one = world.add({.position = {0, 0, 0}, .velocity = {1, 0, 0}, .mass = 2, .restitution = 0.5});
    world.add({.position = {2, 0, 0}, .mass = 3, .restitution = 0.25}); // meets the first at 1 s
    world.add({.position = {0, 5, 0}, .velocity = {0, -3, 0}, .mass = 5});
    world.add({.position = {0, 2, 0}, .mass = infinite_mass});            // meets the third at 2/3 s
    world.add({.position = {5, 0, 9}, .velocity = {0, 0, 1}, .mass = 7}); // meets the wall at 1/2 s
    world.step(1.25);
    const std::vector<Strike> strikes = strikes_of(world);
    ASSERT_EQ(strikes.size(), 4);
    EXPECT_NEAR(strikes[0].delay, 0.5, 1e-9);
    EXPECT_EQ(strikes[0].mass, 7);
    EXPECT_NEAR(strikes[0].impulse, 14, 1e-9);
    EXPECT_NEAR(length(strikes[0].position - Vec3{5, 0, 10}), 0, 1e-9);
    EXPECT_NEAR(strikes[1].delay, 2.0 / 3, 1e-9);
    EXPECT_EQ(strikes[1].mass, 5);
    EXPECT_EQ(strikes[2].mass, 2);
    EXPECT_EQ(strikes[2].restitution, 0.5);
    EXPECT_EQ(strikes[2].velocity, world.get(one).velocity);
    EXPECT_EQ(strikes[3].mass, 3);
    EXPECT_EQ(strikes[3].restitution, 0.25);
    EXPECT_EQ(strikes[2].impulse, strikes[3].impulse);
}

} // namespace

} // namespace carom::sound
