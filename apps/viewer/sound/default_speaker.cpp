#include "viewer/sound/openal.hpp"
#include "viewer/sound/sound_stage.hpp"

#include <array>
#include <cstddef>
#include <cstdlib>
#include <string_view>

namespace carom::sound {

namespace {

/// OpenAL's stand-in for a device: it takes samples in real time, and nobody hears them.
constexpr std::string_view nobody_hears = "No Output";

/// Blocks that wait in OpenAL: as much as a slow moment of the feeding thread may last.
constexpr std::size_t most_blocks = 4;

Device open_device() {
    Device device(alcOpenDevice(nullptr));
    if (!device) throw Error(ErrorCode::not_available, "sound", "there is no sound device");
    // Whoever names the drivers in the environment may have asked for it.
    const bool chosen = std::getenv("ALSOFT_DRIVERS") != nullptr;
    if (!chosen && alcGetString(device.get(), ALC_DEVICE_SPECIFIER) == nobody_hears) {
        throw Error(ErrorCode::not_available, "sound", "there is no sound device");
    }
    return device;
}

/// The default device, fed through one source that streams.
class DefaultSpeaker : public Speaker {
public:
    explicit DefaultSpeaker(int rate) : rate_(rate), device_(open_device()) {
        const std::array<ALCint, 3> attributes{ALC_FREQUENCY, rate, 0};
        context_.reset(alcCreateContext(device_.get(), attributes.data()));
        if (!context_) throw Error(ErrorCode::not_available, "sound", "the sound device cannot be used");
        const Current current(context_);
        alGenSources(1, &source_);
        alSourcei(source_, AL_DIRECT_CHANNELS_SOFT, AL_TRUE); // it is mixed for two ears already
        alGenBuffers(most_blocks, buffers_.data());
        if (alGetError() != AL_NO_ERROR) throw Error(ErrorCode::not_available, "sound", "OpenAL has no source left");
    }

    ~DefaultSpeaker() override {
        const Current current(context_);
        alDeleteSources(1, &source_);
        alDeleteBuffers(most_blocks, buffers_.data());
    }

    bool has_room() override {
        const Current current(context_);
        ALint processed = 0;
        alGetSourcei(source_, AL_BUFFERS_PROCESSED, &processed);
        return used_ < most_blocks || processed > 0;
    }

    void take(std::span<const float> samples) override {
        const Current current(context_);
        ALuint buffer = 0;
        if (used_ < most_blocks) {
            buffer = buffers_[used_++];
        } else {
            alSourceUnqueueBuffers(source_, 1, &buffer);
        }
        alBufferData(buffer, AL_FORMAT_STEREO_FLOAT32, samples.data(), static_cast<ALsizei>(samples.size_bytes()),
                     rate_);
        alSourceQueueBuffers(source_, 1, &buffer);
        ALint state = AL_PLAYING;
        alGetSourcei(source_, AL_SOURCE_STATE, &state);
        // It stops where all that it had was played. It begins with a full queue, or it would stop again at once.
        if (state != AL_PLAYING && used_ == most_blocks) alSourcePlay(source_);
    }

    bool connected() override {
        ALCint connected = ALC_TRUE;
        alcGetIntegerv(device_.get(), ALC_CONNECTED, 1, &connected);
        return connected == ALC_TRUE;
    }

private:
    int rate_;
    Device device_;
    Context context_;
    ALuint source_ = 0;
    std::array<ALuint, most_blocks> buffers_{};
    std::size_t used_ = 0; ///< buffers that were ever queued
};

} // namespace

std::unique_ptr<Speaker> open_default_speaker(int rate) { return std::make_unique<DefaultSpeaker>(rate); }

} // namespace carom::sound
