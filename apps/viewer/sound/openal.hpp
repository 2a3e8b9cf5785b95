/// \file
/// OpenAL's devices and contexts as objects. A context belongs to one thread at a time: who calls OpenAL holds a
/// Current.
#pragma once

#include <AL/al.h>
#include <AL/alc.h>
#include <AL/alext.h>

#include <memory>
#include <span>

namespace carom::sound {

struct CloseDevice {
    void operator()(ALCdevice* device) const { alcCloseDevice(device); }
};
struct DestroyContext {
    void operator()(ALCcontext* context) const { alcDestroyContext(context); }
};
using Device = std::unique_ptr<ALCdevice, CloseDevice>;
using Context = std::unique_ptr<ALCcontext, DestroyContext>;

/// Makes a context this thread's own, and at the end of its scope the one from before again.
class Current {
public:
    explicit Current(const Context& context);
    ~Current();
    Current(const Current&) = delete;
    Current& operator=(const Current&) = delete;

private:
    ALCcontext* before_;
};

/// A device that renders to memory, as 32-bit floats in stereo with a limiter.
class Loopback {
public:
    /// With room for `sources` sources. Throws Error{not_available}.
    Loopback(int rate, int sources);

    [[nodiscard]] const Context& context() const { return context_; }
    void render(std::span<float> samples);

private:
    Device device_;
    Context context_;
    LPALCRENDERSAMPLESSOFT render_;
};

} // namespace carom::sound
