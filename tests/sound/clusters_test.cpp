#include "scene/random.hpp"
#include "viewer/sound/clusters.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace carom::sound {

namespace {

const std::vector<double> all_free(32);

std::vector<Sound> crowd(std::size_t count) {
    scene::Random random(11);
    std::vector<Sound> sounds(count);
    for (Sound& sound : sounds) {
        sound.start = static_cast<std::int64_t>(random.uniform(0, 480));
        sound.position = 5 * random.normal_vector();
        sound.velocity = random.normal_vector();
        sound.pitch = random.log_uniform(200, 4000);
        sound.energy = random.log_uniform(1e-8, 1);
    }
    return sounds;
}

double loudness(const Sound& sound, const Ear& ear) {
    const double gain = attenuation(ear, sound.position);
    return sound.energy * gain * gain;
}

double loudness(std::span<const Sound> sounds, const Ear& ear) {
    double sum = 0;
    for (const Sound& sound : sounds) sum += loudness(sound, ear);
    return sum;
}

TEST(Join, KeepsTheLoudnessAndTheMeanPlace) {
    const std::vector<Sound> sounds = crowd(10000);
    // In their midst, where the mean of sounds on all sides is next to the ear, and far away.
    for (const Ear& ear : {Ear{}, Ear{.position = {0, -100, 0}}}) {
        const std::vector<Sound> joined = join(sounds, ear, all_free, 48000);
        EXPECT_EQ(joined.size(), 32);
        EXPECT_NEAR(loudness(joined, ear) / loudness(sounds, ear), 1, 1e-12);
        const auto centre = [&](std::span<const Sound> all) {
            Vec3 sum{};
            for (const Sound& sound : all) sum += loudness(sound, ear) * sound.position;
            return sum / loudness(all, ear);
        };
        EXPECT_LT(length(centre(joined) - centre(sounds)), 1e-10);
    }
}

TEST(Join, GivesTheLoudestVoicesOfTheirOwn) {
    std::vector<Sound> sounds = crowd(1000);
    for (int i = 0; i < 5; ++i) {
        const auto place = static_cast<std::size_t>(100 * i + 7);
        sounds[place].energy = 100 + i;
        sounds[place].position = {3.0 * i - 6, 4, 0};
    }
    const std::vector<Sound> joined = join(sounds, {.position = {0, -10, 0}}, all_free, 48000);
    for (int i = 0; i < 5; ++i) {
        const Sound& loud = sounds[static_cast<std::size_t>(100 * i + 7)];
        const auto found = std::find_if(joined.begin(), joined.end(), [&](const Sound& sound) {
            return sound.start == loud.start && sound.pitch == loud.pitch && length(sound.position - loud.position) < 1;
        });
        EXPECT_NE(found, joined.end()) << i;
    }
}

TEST(Join, IsInTheOrderOfTimeAndTheSameEachTime) {
    const std::vector<Sound> sounds = crowd(3000);
    const std::vector<Sound> one = join(sounds, {}, all_free, 48000);
    const std::vector<Sound> other = join(sounds, {}, all_free, 48000);
    ASSERT_EQ(one.size(), other.size());
    for (std::size_t i = 0; i < one.size(); ++i) {
        EXPECT_EQ(one[i].start, other[i].start);
        EXPECT_EQ(one[i].position, other[i].position);
        EXPECT_EQ(one[i].energy, other[i].energy);
        EXPECT_LE(one[i > 0 ? i - 1 : 0].start, one[i].start);
    }
}

/// How many clusters two sounds make that differ in one thing, seen from 10 m.
std::size_t clusters_of(const Sound& a, const Sound& b) {
    const std::vector<Sound> both{a, b};
    return join(both, {.position = {0, -10, 0}}, all_free, 48000).size();
}

TEST(Join, TellsApartWhatAnEarTellsApart) {
    const Sound one{.pitch = 880, .energy = 1};
    Sound other = one;
    EXPECT_EQ(clusters_of(one, other), 1);
    const double degree = std::atan(1.0) / 45;
    for (const auto& [value, clusters] : {std::pair{0.9, 1U}, std::pair{1.1, 2U}}) {
        other = one;
        other.position.x = value * 10 * degree;
        EXPECT_EQ(clusters_of(one, other), clusters) << value << " degrees";
        other = one;
        other.start = std::lround(value * 96);
        EXPECT_EQ(clusters_of(one, other), clusters) << value << " times 2 ms";
        other = one;
        other.pitch *= std::exp2(value / 12);
        EXPECT_EQ(clusters_of(one, other), clusters) << value << " semitones";
        // That comes nearer so fast that it sounds so much higher.
        other = one;
        other.velocity.y = -343.3 * (1 - std::exp2(-value / 12));
        EXPECT_EQ(clusters_of(one, other), clusters) << value << " semitones of Doppler shift";
    }
}

TEST(Join, OpensNothingBelowItsBar) {
    std::vector<Sound> sounds(3);
    for (std::size_t i = 0; i < sounds.size(); ++i) {
        sounds[i] = {
            .position = {2.0 * static_cast<double>(i), 0, 0}, .pitch = 880, .energy = 3.0 - static_cast<double>(i)};
    }
    const Ear ear{.position = {2, -10, 0}, .reference_distance = 100};
    EXPECT_EQ(join(sounds, ear, std::vector<double>{0, 1.5, 1.5}, 48000).size(), 2);
    EXPECT_EQ(join(sounds, ear, std::vector<double>{0, 2.5, 2.5}, 48000).size(), 1);
    EXPECT_EQ(join(sounds, ear, std::vector<double>{0, 0, 0}, 48000).size(), 3);
}

TEST(Join, OfNothingIsNothing) {
    EXPECT_TRUE(join({}, {}, all_free, 48000).empty());
    const std::vector<Sound> silent(3, Sound{.pitch = 880, .energy = 0});
    EXPECT_TRUE(join(silent, {}, all_free, 48000).empty());
}

} // namespace

} // namespace carom::sound
