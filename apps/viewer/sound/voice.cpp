#include "viewer/sound/voice.hpp"

#include "collision/portable_math.hpp"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

namespace carom::sound {

namespace {

constexpr double fade_time = 0.005; ///< s

void set(ALuint source, ALenum property, const Vec3& value) {
    alSource3f(source, property, static_cast<float>(value.x), static_cast<float>(value.y), static_cast<float>(value.z));
}

/// OpenAL lists them from the quickest to the best.
ALint best_resampler() { return alGetInteger(AL_NUM_RESAMPLERS_SOFT) - 1; }

} // namespace

Voice::Voice(int rate) : rate_(rate) {
    alGenSources(1, &source_);
    if (alGetError() != AL_NO_ERROR) throw std::bad_alloc();
    alSourcei(source_, AL_SOURCE_RESAMPLER_SOFT, best_resampler());
}

Voice::Voice(Voice&& other) noexcept
    : rate_(other.rate_), source_(std::exchange(other.source_, 0)), state_(other.state_), sound_(other.sound_),
      ring_time_(other.ring_time_), fade_start_(other.fade_start_) {}

Voice::~Voice() {
    if (source_ != 0) alDeleteSources(1, &source_);
}

void Voice::start(const Sound& sound, const Kernel& kernel, const Ear& ear) {
    state_ = State::ringing;
    sound_ = sound;
    sound_.velocity = subsonic(sound.velocity, ear.speed_of_sound);
    ring_time_ = kernel.ring_time;
    alSourcei(source_, AL_BUFFER, static_cast<ALint>(kernel.buffer));
    alSourcef(source_, AL_PITCH, static_cast<float>(sound.pitch / kernel.pitch));
    alSourcef(source_, AL_GAIN, static_cast<float>(std::sqrt(sound.energy)));
    alSourcef(source_, AL_REFERENCE_DISTANCE, static_cast<float>(ear.reference_distance));
    set(source_, AL_VELOCITY, sound_.velocity);
    set(source_, AL_POSITION, sound_.position - ear.position);
    alSourcePlay(source_);
}

void Voice::fade(std::int64_t now) {
    state_ = State::fading;
    fade_start_ = now;
}

std::int64_t Voice::fade_end() const { return fade_start_ + std::lround(fade_time * rate_); }

void Voice::aim(std::int64_t end, const Ear& ear) {
    if (state_ == State::free) return;
    set(source_, AL_POSITION, position_at(end) - ear.position);
    if (state_ == State::ringing) return;
    const double length = static_cast<double>(fade_end() - fade_start_);
    const double left = std::max(0.0, static_cast<double>(fade_end() - end) / length);
    alSourcef(source_, AL_GAIN, static_cast<float>(left * std::sqrt(sound_.energy)));
}

void Voice::collect(std::int64_t now) {
    if (state_ == State::free) return;
    ALint playing = AL_STOPPED;
    alGetSourcei(source_, AL_SOURCE_STATE, &playing);
    if (playing == AL_PLAYING && (state_ == State::ringing || now < fade_end())) return;
    alSourceStop(source_);
    state_ = State::free;
}

double Voice::loudness(std::int64_t now, const Ear& ear) const {
    const double gain = attenuation(ear, position_at(now));
    const double age = static_cast<double>(now - sound_.start) / rate_;
    return sound_.energy * gain * gain * detail::exp(-2 * age / ring_time_);
}

Vec3 Voice::position_at(std::int64_t sample) const {
    return sound_.position + sound_.velocity * (static_cast<double>(sample - sound_.start) / rate_);
}

} // namespace carom::sound
