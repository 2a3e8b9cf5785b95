#include "viewer/sound/kernel_bank.hpp"

#include "collision/portable_math.hpp"
#include "viewer/sound/modes.hpp"
#include "viewer/sound/sound_stage.hpp"

#include <cmath>
#include <new>
#include <numbers>
#include <vector>

namespace carom::sound {

namespace {

constexpr double pitches_per_octave = 6;
constexpr double dampings = 4; ///< intervals of restitution between two rings

Kernel make_kernel(double pitch, double restitution, int rate) {
    const std::vector<float> samples = ring(pitch, quality(restitution), rate);
    Kernel kernel{.pitch = pitch, .ring_time = ring_time(pitch, quality(restitution))};
    alGenBuffers(1, &kernel.buffer);
    alBufferData(kernel.buffer, AL_FORMAT_MONO_FLOAT32, samples.data(),
                 static_cast<ALsizei>(samples.size() * sizeof(float)), rate);
    if (alGetError() != AL_NO_ERROR) throw std::bad_alloc();
    return kernel;
}

} // namespace

KernelBank::~KernelBank() {
    for (const auto& [key, kernel] : kernels_) alDeleteBuffers(1, &kernel.buffer);
}

const Kernel& KernelBank::nearest(double pitch, double restitution) {
    const double octaves = detail::log(pitch / lowest_pitch) / std::numbers::ln2;
    const auto pitch_class = static_cast<int>(std::lround(octaves * pitches_per_octave));
    const auto damping_class = static_cast<int>(std::lround(restitution * dampings));
    const auto [place, is_new] = kernels_.try_emplace({pitch_class, damping_class});
    if (is_new) {
        place->second = make_kernel(lowest_pitch * detail::pow(2, pitch_class / pitches_per_octave),
                                    damping_class / dampings, rate_);
    }
    return place->second;
}

} // namespace carom::sound
