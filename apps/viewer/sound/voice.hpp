/// \file
/// A voice: one source of OpenAL and what it plays.
#pragma once

#include "viewer/sound/clusters.hpp"
#include "viewer/sound/kernel_bank.hpp"
#include "viewer/sound/openal.hpp"

#include <cstdint>

namespace carom::sound {

/// Plays one sound at a time. OpenAL moves gains in a straight line over each stretch that is rendered, so a voice is
/// told where it will be at the end of each: then nothing jumps, however stretches are cut. Its OpenAL context must be
/// current wherever it is used.
class Voice {
public:
    enum class State : std::uint8_t { free, ringing, fading };

    /// With a source of its own. Throws std::bad_alloc if OpenAL has no more.
    explicit Voice(int rate);
    ~Voice();
    Voice(Voice&& other) noexcept;
    Voice& operator=(Voice&&) = delete;
    Voice(const Voice&) = delete;
    Voice& operator=(const Voice&) = delete;

    /// A free voice begins to play `sound` now; it is heard from the next sample on.
    void start(const Sound& sound, const Kernel& kernel, const Ear& ear);
    /// A ringing voice is to end within 5 ms from sample `now` on.
    void fade(std::int64_t now);
    /// The sample at which its fade ends; only while fading.
    [[nodiscard]] std::int64_t fade_end() const;
    /// What the next stretch leads to: sample `end`, and the ear that there will be.
    void aim(std::int64_t end, const Ear& ear);
    /// After a stretch that led to `now`: a voice that has ended is free again.
    void collect(std::int64_t now);

    [[nodiscard]] State state() const { return state_; }
    /// Energy at the ear at sample `now`.
    [[nodiscard]] double loudness(std::int64_t now, const Ear& ear) const;

private:
    [[nodiscard]] Vec3 position_at(std::int64_t sample) const;

    double rate_;
    ALuint source_ = 0;
    State state_ = State::free;
    Sound sound_;
    double ring_time_ = 1; ///< s
    std::int64_t fade_start_ = 0;
};

} // namespace carom::sound
