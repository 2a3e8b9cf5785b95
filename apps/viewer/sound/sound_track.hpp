/// \file
/// The sound of a whole run, for films and as a file.
#pragma once

#include "viewer/sound/sound_stage.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace carom::sound {

/// Records what a world sounds like, step by step.
class SoundTrack {
public:
    /// Begins at the world's time. `pace` seconds of the world (> 0) are a second of sound; pitches are the same for
    /// any. Throws what SoundStage throws.
    SoundTrack(const World& world, const SoundSettings& settings, double pace = 1);

    /// From where the next steps are heard.
    void listen(const Listener& listener) { stage_.listen(listener); }
    /// The step that the world has just done. The world must record its impacts.
    void record(const World& world);

    [[nodiscard]] int rate() const { return rate_; } ///< samples a second
    /// Samples so far, left and right in turn, as 16-bit integers.
    [[nodiscard]] const std::vector<std::int16_t>& samples() const { return samples_; }
    /// The first `seconds` (>= 0), silence where it is shorter; the last 5 ms fade.
    [[nodiscard]] std::vector<std::int16_t> excerpt(double seconds) const;
    /// Writes a WAV file, whole or not at all; its last 5 ms fade. Throws Error{input_output} naming the file, also
    /// where it would exceed the format's 4 GiB.
    void write_wav(const std::filesystem::path& file) const;

private:
    /// s of sound from the beginning to a time of the world.
    [[nodiscard]] double heard_at(double time) const { return (time - begin_) / pace_; }

    int rate_;
    double pace_;
    SoundStage stage_;
    double begin_; ///< s of the world
    double now_;   ///< s of the world: the end of the last step recorded
    std::vector<float> block_;
    std::vector<std::int16_t> samples_;
};

/// A WAV file (RIFF, PCM, 16 bits, stereo) of samples that stand left and right in turn. Throws Error{out_of_range}
/// above 4 GiB.
std::vector<std::byte> wav_file(std::span<const std::int16_t> samples, int rate);

} // namespace carom::sound
