/// \file
/// The sound of what the window shows, together with the picture.
#pragma once

#include "viewer/sound/sound_stage.hpp"

#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace carom::viewer {

/// What a body that was struck sounds like, and when (s of the world).
struct TimedStrike {
    double time = 0;
    sound::Strike strike{};
};

/// What the last step of a world sounds like: the strongest strikes, if there are very many. The world must record
/// impacts.
std::vector<TimedStrike> timed_strikes_of(const World& world);

/// Keeps strikes until the picture has come to their time. The simulation may be ahead of it.
class Ears {
public:
    explicit Ears(sound::OpenSpeaker open = sound::open_default_speaker);

    /// Another scene, or another time of the same one.
    void begin_scene(const sound::SoundSettings& settings);
    void add(std::span<const TimedStrike> strikes);
    /// What is shown went from `before` to `now` (s of the world) in `seconds` of the wall clock. What lies between
    /// them is heard, and what lies after `now` is not if time went back.
    void hear(double before, double now, double seconds, const sound::Listener& listener);
    void set_volume(double volume) { sound_.set_volume(volume); } ///< 0 to 1

    [[nodiscard]] bool audible() const { return sound_.audible(); }
    /// Why there is no sound; empty while there is.
    [[nodiscard]] const std::string& problem();
    void try_again();
    /// Strikes that were played.
    [[nodiscard]] std::uint64_t heard() const { return heard_; }

private:
    sound::LiveSound sound_;
    std::deque<TimedStrike> strikes_; ///< in the order of their steps
    std::vector<sound::Strike> due_;
    std::string problem_;
    std::uint64_t heard_ = 0;
};

} // namespace carom::viewer
