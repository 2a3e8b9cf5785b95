#include "viewer/sound/modes.hpp"

#include "collision/portable_math.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace carom::sound {

namespace {

constexpr double longest_ring = 0.25; ///< s, see ring_time
constexpr double end_level = 1e-4;    ///< -80 dB
constexpr double end_fade = 0.005;    ///< s
constexpr double highest_pitch = 0.4; ///< in units of the rate

/// Adds amplitude * exp(-t / time) * sin(2 pi frequency t).
void add_mode(std::vector<double>& samples, double amplitude, double frequency, double time, double rate) {
    const double angle = 2 * std::numbers::pi * frequency / rate;
    const double decay = detail::exp(-1 / (time * rate));
    const double turn = 2 * decay * detail::cos(angle);
    double before = 0;
    double now = amplitude * decay * detail::sin(angle);
    for (std::size_t i = 1; i < samples.size(); ++i) {
        samples[i] += now;
        const double next = turn * now - decay * decay * before;
        before = now;
        now = next;
    }
}

/// Lets the last milliseconds end at 0, and scales the largest sample to 1.
std::vector<float> finished(const std::vector<double>& samples, double rate) {
    const double fade = std::min(end_fade * rate, static_cast<double>(samples.size()));
    double largest = 0;
    for (const double sample : samples) largest = std::max(largest, std::abs(sample));
    std::vector<float> result;
    result.reserve(samples.size());
    for (std::size_t i = 0; i < samples.size(); ++i) {
        const double left = static_cast<double>(samples.size() - 1 - i) / fade;
        result.push_back(static_cast<float>(samples[i] / largest * std::min(1.0, left)));
    }
    return result;
}

} // namespace

double quality(double restitution) { return 10 * detail::pow(30, restitution); }

double ring_time(double pitch, double quality) { return 1 / (std::numbers::pi * pitch / quality + 1 / longest_ring); }

std::vector<float> ring(double pitch, double quality, double rate) {
    const double seconds = -detail::log(end_level) * ring_time(pitch, quality) + end_fade;
    std::vector<double> samples(static_cast<std::size_t>(seconds * rate));
    for (const Mode& mode : modes) {
        const double ratio = mode.wave_number / modes[0].wave_number;
        const double frequency = pitch * ratio;
        if (frequency < highest_pitch * rate) {
            add_mode(samples, 1 / ratio, frequency, ring_time(frequency, quality), rate);
        }
    }
    return finished(samples, rate);
}

} // namespace carom::sound
