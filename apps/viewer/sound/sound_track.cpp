#include "viewer/sound/sound_track.hpp"

#include "scene/atomic_file.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

namespace carom::sound {

namespace {

constexpr double end_fade = 0.005; ///< s

std::int16_t to_16_bits(float sample) { return static_cast<std::int16_t>(std::lround(sample * 32767.0F)); }

class LittleEndian {
public:
    explicit LittleEndian(std::size_t size) { bytes_.reserve(size); }

    void text(std::string_view letters) {
        for (const char letter : letters) bytes_.push_back(static_cast<std::byte>(letter));
    }
    void number(std::uint32_t value, int bytes) {
        for (int i = 0; i < bytes; ++i)
            bytes_.push_back(static_cast<std::byte>(value >> (8U * static_cast<unsigned>(i))));
    }
    std::vector<std::byte> take() { return std::move(bytes_); }

private:
    std::vector<std::byte> bytes_;
};

} // namespace

SoundTrack::SoundTrack(const World& world, const SoundSettings& settings, double pace)
    : rate_(settings.rate), pace_(pace), stage_(settings), begin_(world.time()), now_(world.time()) {
    if (!(pace > 0 && std::isfinite(pace))) throw Error(ErrorCode::out_of_range, "pace", "must be finite and > 0");
}

void SoundTrack::record(const World& world) {
    const std::size_t rendered = samples_.size() / 2;
    const double seconds = static_cast<double>(rendered) / rate_;
    std::vector<Strike> strikes = strikes_of(world);
    for (Strike& strike : strikes) strike.delay = std::max(0.0, heard_at(now_ + strike.delay) - seconds);
    stage_.play(strikes);
    now_ = world.time();
    const auto end = static_cast<std::size_t>(std::llround(heard_at(now_) * rate_));
    block_.resize(2 * (end - rendered));
    stage_.render(block_);
    std::transform(block_.begin(), block_.end(), std::back_inserter(samples_), to_16_bits);
}

std::vector<std::int16_t> SoundTrack::excerpt(double seconds) const {
    const auto frames = static_cast<std::size_t>(std::llround(seconds * rate_));
    std::vector<std::int16_t> samples = samples_;
    samples.resize(2 * frames);
    const std::size_t fade = std::min(samples.size(), 2 * static_cast<std::size_t>(end_fade * rate_));
    for (std::size_t left = 0; left < fade; ++left) {
        std::int16_t& sample = samples[samples.size() - 1 - left];
        sample = static_cast<std::int16_t>(std::lround(sample * static_cast<double>(left) / static_cast<double>(fade)));
    }
    return samples;
}

void SoundTrack::write_wav(const std::filesystem::path& file) const {
    const std::size_t frames = samples_.size() / 2;
    const double seconds = static_cast<double>(frames) / rate_;
    try {
        scene::write_file(file, wav_file(excerpt(seconds), rate_));
    } catch (const Error& error) {
        if (error.code() != ErrorCode::out_of_range) throw;
        throw Error(ErrorCode::input_output, file.string(), "a WAV file holds at most 4 GiB");
    }
}

std::vector<std::byte> wav_file(std::span<const std::int16_t> samples, int rate) {
    constexpr std::uint32_t head = 44; // bytes
    if (samples.size_bytes() > std::numeric_limits<std::uint32_t>::max() - head) {
        throw Error(ErrorCode::out_of_range, "samples", "a WAV file holds at most 4 GiB");
    }
    const auto size = static_cast<std::uint32_t>(samples.size_bytes());
    constexpr std::uint32_t frame = 4; // bytes of both channels
    LittleEndian file(head + size);
    file.text("RIFF");
    file.number(head - 8 + size, 4);
    file.text("WAVEfmt ");
    file.number(16, 4); // bytes of the format
    file.number(1, 2);  // PCM
    file.number(2, 2);  // channels
    file.number(static_cast<std::uint32_t>(rate), 4);
    file.number(static_cast<std::uint32_t>(rate) * frame, 4);
    file.number(frame, 2);
    file.number(16, 2); // bits
    file.text("data");
    file.number(size, 4);
    for (const std::int16_t sample : samples) file.number(static_cast<std::uint16_t>(sample), 2);
    return file.take();
}

} // namespace carom::sound
