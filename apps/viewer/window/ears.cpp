#include "viewer/window/ears.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace carom::viewer {

namespace {

/// Of a step, and waiting: what is weaker would not be heard beside these.
constexpr std::size_t most_of_a_step = 4096;
constexpr std::size_t most_waiting = 65536;

} // namespace

std::vector<TimedStrike> timed_strikes_of(const World& world) {
    std::vector<sound::Strike> strikes = sound::strikes_of(world);
    if (strikes.size() > most_of_a_step) {
        const auto end = strikes.begin() + static_cast<std::ptrdiff_t>(most_of_a_step);
        std::nth_element(strikes.begin(), end, strikes.end(),
                         [](const sound::Strike& a, const sound::Strike& b) { return a.impulse > b.impulse; });
        strikes.erase(end, strikes.end());
    }
    const double begin = world.time() - world.report().advanced;
    std::vector<TimedStrike> timed;
    timed.reserve(strikes.size());
    for (const sound::Strike& strike : strikes) timed.push_back({begin + strike.delay, strike});
    return timed;
}

Ears::Ears(sound::OpenSpeaker open) : sound_({}, std::move(open)) {}

void Ears::begin_scene(const sound::SoundSettings& settings) {
    sound_.begin_scene(settings);
    strikes_.clear();
}

void Ears::add(std::span<const TimedStrike> strikes) {
    strikes_.insert(strikes_.end(), strikes.begin(), strikes.end());
    if (strikes_.size() > most_waiting) {
        strikes_.erase(strikes_.begin(), strikes_.end() - static_cast<std::ptrdiff_t>(most_waiting));
    }
}

void Ears::hear(double before, double now, double seconds, const sound::Listener& listener) {
    sound_.listen(listener);
    if (now < before) std::erase_if(strikes_, [&](const TimedStrike& strike) { return strike.time > now; });
    if (!(seconds > 0)) return;
    due_.clear();
    std::erase_if(strikes_, [&](const TimedStrike& timed) {
        if (timed.time > now) return false;
        due_.push_back(timed.strike);
        const double part = now > before ? (timed.time - before) / (now - before) : 0;
        due_.back().delay = std::clamp(part, 0.0, 1.0) * seconds;
        return true;
    });
    sound_.play(due_, seconds);
    if (audible()) heard_ += due_.size();
}

const std::string& Ears::problem() {
    if (auto problem = sound_.take_problem()) problem_ = std::move(*problem);
    if (audible()) problem_.clear();
    return problem_;
}

void Ears::try_again() {
    problem_.clear();
    sound_.reopen();
}

} // namespace carom::viewer
