#include "viewer/sound/sound_stage.hpp"

#include "collision/portable_math.hpp"
#include "viewer/sound/checks.hpp"
#include "viewer/sound/clusters.hpp"
#include "viewer/sound/kernel_bank.hpp"
#include "viewer/sound/openal.hpp"
#include "viewer/sound/voice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace carom::sound {

namespace {

/// Of all voices these many may go on ringing; the others are there for new strikes, so that none waits for a fade.
constexpr std::size_t most_lasting = most_voices / 2;

constexpr double piece_time = 0.01;      ///< s, the longest for which strikes are joined and voices are given at once
constexpr double glide_time = 0.01;      ///< s in which the listener's moves are followed
constexpr double reference_level = 0.25; ///< amplitude of the reference impulse at the reference distance
constexpr double largest_energy = 1e12;  ///< a louder strike is far beyond full scale anyway

double pitch_of(double mass, const SoundSettings& settings) {
    const double pitch = settings.reference_pitch * detail::pow(mass / settings.reference_mass, -1.0 / 3);
    return std::clamp(pitch, lowest_pitch, highest_pitch);
}

Vec3 between(const Vec3& a, const Vec3& b, double part) { return a + part * (b - a); }

Vec3 unit(const Vec3& v) { return v / length(v); }

/// With directions of length 1, so that two of them can be mixed, at right angles: OpenAL takes them for axes as they
/// are.
Listener normalised(Listener listener) {
    listener.forward = unit(listener.forward);
    listener.up = unit(cross(cross(listener.forward, unit(listener.up)), listener.forward));
    return listener;
}

/// Turns OpenAL's ear. It stays at the origin, and voices lie relative to it: so places keep their precision far away.
void aim(const Listener& listener, double speed_of_sound) {
    const auto number = [](double x) { return static_cast<float>(x); };
    const Vec3 velocity = subsonic(listener.velocity, speed_of_sound);
    const std::array<float, 6> orientation{number(listener.forward.x), number(listener.forward.y),
                                           number(listener.forward.z), number(listener.up.x),
                                           number(listener.up.y),      number(listener.up.z)};
    alListenerfv(AL_ORIENTATION, orientation.data());
    alListener3f(AL_VELOCITY, number(velocity.x), number(velocity.y), number(velocity.z));
}

/// The listener on the way to where it was last put.
class Glide {
public:
    explicit Glide(double rate) : samples_(glide_time * rate) {}

    /// The first time there is no way.
    void to(const Listener& target, std::int64_t now) {
        from_ = started_ ? at(now) : target;
        to_ = target;
        start_ = now;
        started_ = true;
    }
    [[nodiscard]] std::int64_t end() const { return start_ + std::lround(samples_); }
    [[nodiscard]] Listener at(std::int64_t sample) const {
        const double part = std::clamp(static_cast<double>(sample - start_) / samples_, 0.0, 1.0);
        return {.position = between(from_.position, to_.position, part),
                .forward = between(from_.forward, to_.forward, part),
                .up = between(from_.up, to_.up, part),
                .velocity = between(from_.velocity, to_.velocity, part)};
    }

private:
    double samples_;
    Listener from_;
    Listener to_;
    std::int64_t start_ = 0;
    bool started_ = false;
};

} // namespace

class SoundStage::Impl {
public:
    explicit Impl(const SoundSettings& settings);
    ~Impl();
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    void listen(const Listener& listener) { glide_.to(normalised(listener), clock_); }
    void play(std::span<const Strike> strikes);
    void render(std::span<float> samples);
    [[nodiscard]] std::size_t voices() const;

private:
    [[nodiscard]] Ear ear_at(std::int64_t sample) const;
    std::vector<Sound> take_due(std::int64_t end);
    std::vector<Sound> assign_voices(std::int64_t end);
    void start(const Sound& sound);
    void render_piece(std::span<float> samples);
    [[nodiscard]] std::int64_t stretch_end(std::int64_t end) const;
    void render_stretch(std::span<float> samples);

    SoundSettings settings_;
    Loopback device_;
    std::optional<KernelBank> kernels_;
    std::vector<Voice> all_voices_;
    std::vector<Sound> pending_;
    Glide glide_;
    std::int64_t clock_ = 0; ///< samples rendered
};

SoundStage::Impl::Impl(const SoundSettings& settings)
    : settings_(settings), device_(settings.rate, most_voices), glide_(settings.rate) {
    const Current current(device_.context());
    alDistanceModel(AL_INVERSE_DISTANCE_CLAMPED);
    alSpeedOfSound(static_cast<float>(settings.speed_of_sound));
    kernels_.emplace(settings.rate);
    all_voices_.reserve(most_voices);
    for (std::size_t i = 0; i < most_voices; ++i) all_voices_.emplace_back(settings.rate);
}

SoundStage::Impl::~Impl() {
    const Current current(device_.context());
    all_voices_.clear(); // before the buffers that they play
    kernels_.reset();
}

void SoundStage::Impl::play(std::span<const Strike> strikes) {
    check(strikes);
    for (const Strike& strike : strikes) {
        const double loudness = strike.impulse / settings_.reference_impulse;
        pending_.push_back({.start = clock_ + std::llround(strike.delay * settings_.rate),
                            .position = strike.position,
                            .velocity = strike.velocity,
                            .pitch = pitch_of(strike.mass, settings_),
                            .restitution = strike.restitution,
                            .energy = std::min(reference_level * reference_level * loudness, largest_energy)});
    }
}

void SoundStage::Impl::render(std::span<float> samples) {
    const Current current(device_.context());
    const auto longest = static_cast<std::size_t>(piece_time * settings_.rate);
    std::size_t pieces = (samples.size() / 2 + longest - 1) / longest;
    for (; pieces > 0; --pieces) {
        const std::size_t count = samples.size() / 2 / pieces * 2;
        render_piece(samples.first(count));
        samples = samples.subspan(count);
    }
}

std::size_t SoundStage::Impl::voices() const {
    const auto is_free = [](const Voice& voice) { return voice.state() == Voice::State::free; };
    return most_voices - static_cast<std::size_t>(std::count_if(all_voices_.begin(), all_voices_.end(), is_free));
}

Ear SoundStage::Impl::ear_at(std::int64_t sample) const {
    const Listener listener = glide_.at(sample);
    return {.position = listener.position,
            .velocity = listener.velocity,
            .reference_distance = settings_.reference_distance,
            .speed_of_sound = settings_.speed_of_sound};
}

/// What is to be heard before sample `end`, and no sooner than now.
std::vector<Sound> SoundStage::Impl::take_due(std::int64_t end) {
    const auto due = std::stable_partition(pending_.begin(), pending_.end(),
                                           [end](const Sound& sound) { return sound.start >= end; });
    std::vector<Sound> sounds(due, pending_.end());
    pending_.erase(due, pending_.end());
    for (Sound& sound : sounds) sound.start = std::max(sound.start, clock_);
    return sounds;
}

/// Joins what is due to as many sounds as find a voice, and lets fade whom they replace: the quietest that ring, and
/// only for a louder one. Where no voice is free, after very short pieces, all waits until fades have ended.
std::vector<Sound> SoundStage::Impl::assign_voices(std::int64_t end) {
    const Ear ear = ear_at(clock_);
    std::vector<std::pair<double, Voice*>> ringing;
    for (Voice& voice : all_voices_) {
        if (voice.state() == Voice::State::ringing) ringing.emplace_back(voice.loudness(clock_, ear), &voice);
    }
    std::stable_sort(ringing.begin(), ringing.end(), [](const auto& a, const auto& b) { return a.first < b.first; });

    std::vector<double> bars(std::min(most_voices - voices(), most_voices - most_lasting));
    if (bars.empty()) return {};
    const auto replaced = [&ringing](std::size_t fresh) {
        return ringing.size() + fresh > most_lasting ? ringing.size() + fresh - most_lasting : 0;
    };
    for (std::size_t i = 1; i < bars.size(); ++i) {
        if (replaced(i + 1) > 0) bars[i] = ringing[replaced(i + 1) - 1].first;
    }

    // First as many as there may be, which then measure themselves against what rings, as loud as they have become.
    const std::vector<double> no_bars(bars.size());
    const std::vector<Sound> candidates = join(take_due(end), ear, no_bars, settings_.rate);
    std::vector<Sound> sounds = join(candidates, ear, bars, settings_.rate);
    for (std::size_t i = 0; i < replaced(sounds.size()); ++i) ringing[i].second->fade(clock_);
    return sounds;
}

void SoundStage::Impl::start(const Sound& sound) {
    const auto is_free = [](const Voice& voice) { return voice.state() == Voice::State::free; };
    const auto voice = std::find_if(all_voices_.begin(), all_voices_.end(), is_free);
    voice->start(sound, kernels_->nearest(sound.pitch, sound.restitution), ear_at(clock_));
}

void SoundStage::Impl::render_piece(std::span<float> samples) {
    const std::int64_t end = clock_ + static_cast<std::int64_t>(samples.size() / 2);
    const std::vector<Sound> sounds = assign_voices(end);
    std::size_t started = 0;
    while (clock_ < end) {
        while (started < sounds.size() && sounds[started].start == clock_) start(sounds[started++]);
        const std::int64_t next = stretch_end(started < sounds.size() ? sounds[started].start : end);
        const auto count = static_cast<std::size_t>(next - clock_) * 2;
        render_stretch(samples.first(count));
        samples = samples.subspan(count);
    }
}

/// Where the next straight stretch ends: at `end`, or before, where a fade or the listener's move does.
std::int64_t SoundStage::Impl::stretch_end(std::int64_t end) const {
    if (glide_.end() > clock_) end = std::min(end, glide_.end());
    for (const Voice& voice : all_voices_) {
        if (voice.state() == Voice::State::fading) end = std::min(end, voice.fade_end());
    }
    return end;
}

void SoundStage::Impl::render_stretch(std::span<float> samples) {
    const std::int64_t end = clock_ + static_cast<std::int64_t>(samples.size() / 2);
    const Listener listener = glide_.at(end);
    aim(listener, settings_.speed_of_sound);
    for (Voice& voice : all_voices_) voice.aim(end, ear_at(end));
    device_.render(samples);
    // The limiter may exceed full scale by a rounding.
    for (float& sample : samples) sample = std::clamp(sample, -1.0F, 1.0F);
    clock_ = end;
    for (Voice& voice : all_voices_) voice.collect(clock_);
}

SoundStage::SoundStage(const SoundSettings& settings) {
    check(settings);
    impl_ = std::make_unique<Impl>(settings);
}
SoundStage::~SoundStage() = default;
SoundStage::SoundStage(SoundStage&&) noexcept = default;
SoundStage& SoundStage::operator=(SoundStage&&) noexcept = default;

void SoundStage::listen(const Listener& listener) {
    check(listener);
    impl_->listen(listener);
}

void SoundStage::play(std::span<const Strike> strikes) { impl_->play(strikes); }

void SoundStage::render(std::span<float> samples) {
    if (samples.size() % 2 != 0) throw Error(ErrorCode::size_mismatch, "samples", "must be pairs of left and right");
    impl_->render(samples);
}

std::size_t SoundStage::voices() const { return impl_->voices(); }

} // namespace carom::sound
