/// \file
/// Rings by pitch and damping, as OpenAL's buffers.
#pragma once

#include "viewer/sound/openal.hpp"

#include <map>

namespace carom::sound {

/// A ring that voices play.
struct Kernel {
    ALuint buffer = 0;
    double pitch = 0;     ///< Hz, of its lowest mode
    double ring_time = 0; ///< s in which that falls to 1/e
};

/// Makes each ring when it is first asked for: six pitches an octave, which voices tune by at most a quarter tone, and
/// five degrees of damping. Its OpenAL context must be current wherever it is used.
class KernelBank {
public:
    explicit KernelBank(int rate) : rate_(rate) {}
    ~KernelBank();
    KernelBank(const KernelBank&) = delete;
    KernelBank& operator=(const KernelBank&) = delete;

    /// The ring nearest to a body of `pitch` (Hz, lowest_pitch to highest_pitch) and `restitution` (0 to 1). Throws
    /// std::bad_alloc if OpenAL has no memory for it.
    const Kernel& nearest(double pitch, double restitution);

private:
    int rate_;
    std::map<std::pair<int, int>, Kernel> kernels_; ///< by classes of pitch and of damping
};

} // namespace carom::sound
