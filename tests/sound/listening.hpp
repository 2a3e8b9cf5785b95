/// \file
/// What the tests of sound do with samples.
#pragma once

#include "viewer/sound/sound_stage.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <utility>
#include <vector>

namespace carom::test {

/// Both channels.
struct Stereo {
    std::vector<double> left;
    std::vector<double> right;
};

template <class T>
Stereo split(std::span<const T> samples, double full_scale) {
    Stereo stereo;
    for (std::size_t i = 0; i + 1 < samples.size(); i += 2) {
        stereo.left.push_back(static_cast<double>(samples[i]) / full_scale);
        stereo.right.push_back(static_cast<double>(samples[i + 1]) / full_scale);
    }
    return stereo;
}

inline std::vector<float> render(sound::SoundStage& stage, double seconds, int rate = 48000) {
    std::vector<float> samples(2 * static_cast<std::size_t>(std::lround(seconds * rate)));
    stage.render(samples);
    return samples;
}

inline Stereo listen(sound::SoundStage& stage, double seconds) { return split<float>(render(stage, seconds), 1); }

/// One strike alone, from the start.
inline Stereo hear(const sound::Strike& strike, double seconds, const sound::SoundSettings& settings = {},
                   const sound::Listener& listener = {}) {
    sound::SoundStage stage(settings);
    stage.listen(listener);
    stage.play({&strike, 1});
    return listen(stage, seconds);
}

inline double root_mean_square(std::span<const double> samples) {
    double sum = 0;
    for (const double sample : samples) sum += sample * sample;
    return std::sqrt(sum / static_cast<double>(samples.size()));
}

/// By how much the right channel is louder, as a factor.
inline double balance(const Stereo& stereo) { return root_mean_square(stereo.right) / root_mean_square(stereo.left); }

inline double largest(std::span<const double> samples) {
    double result = 0;
    for (const double sample : samples) result = std::max(result, std::abs(sample));
    return result;
}

/// The largest second difference: what a jump is, and a ring of low pitch has little of.
inline double roughness(std::span<const double> samples) {
    double result = 0;
    for (std::size_t i = 2; i < samples.size(); ++i) {
        result = std::max(result, std::abs(samples[i] - 2 * samples[i - 1] + samples[i - 2]));
    }
    return result;
}

/// Amplitude of `frequency` (Hz) in samples, by Goertzel's recurrence.
inline double line_at(std::span<const double> samples, double frequency, double rate) {
    const double turn = 2 * std::cos(2 * std::numbers::pi * frequency / rate);
    double now = 0;
    double before = 0;
    for (const double sample : samples) before = std::exchange(now, sample + turn * now - before);
    return std::sqrt(std::max(0.0, now * now + before * before - turn * now * before));
}

/// Under Hann's window, which keeps lines narrow.
inline std::vector<double> windowed(std::span<const double> samples) {
    std::vector<double> result;
    const double step = 2 * std::numbers::pi / static_cast<double>(samples.size());
    for (const double sample : samples) {
        result.push_back(sample * (1 - std::cos(step * static_cast<double>(result.size()))));
    }
    return result;
}

/// Amplitude of `frequency` (Hz) in samples under the window.
inline double spectrum_at(std::span<const double> samples, double frequency, double rate) {
    return line_at(windowed(samples), frequency, rate);
}

/// Hz of the strongest line between `low` and `high`, to 1 / 1000 of it.
inline double main_pitch(std::span<const double> samples, double low, double high, double rate = 48000) {
    const std::vector<double> window = windowed(samples);
    double best = low;
    double most = 0;
    const auto steps = static_cast<int>(std::log(high / low) / std::log(1.001));
    for (int i = 0; i <= steps; ++i) {
        const double frequency = low * std::pow(1.001, i);
        const double amplitude = line_at(window, frequency, rate);
        if (amplitude <= most) continue;
        most = amplitude;
        best = frequency;
    }
    return best;
}

} // namespace carom::test
