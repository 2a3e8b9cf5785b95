#include "viewer/sound/openal.hpp"

#include <carom/base.hpp>

#include <array>
#include <string>

namespace carom::sound {

namespace {

/// A function of an extension; the default device of all is asked where there is none yet.
template <class Function>
Function extension(const char* name) {
    // OpenAL hands out functions as pointers to void.
    if (const auto function = reinterpret_cast<Function>(alcGetProcAddress(nullptr, name))) return function;
    throw Error(ErrorCode::not_available, "sound", std::string("this OpenAL has no ") + name);
}

} // namespace

Current::Current(const Context& context) : before_(extension<PFNALCGETTHREADCONTEXTPROC>("alcGetThreadContext")()) {
    extension<PFNALCSETTHREADCONTEXTPROC>("alcSetThreadContext")(context.get());
}

Current::~Current() { extension<PFNALCSETTHREADCONTEXTPROC>("alcSetThreadContext")(before_); }

Loopback::Loopback(int rate, int sources)
    : device_(extension<LPALCLOOPBACKOPENDEVICESOFT>("alcLoopbackOpenDeviceSOFT")(nullptr)),
      render_(extension<LPALCRENDERSAMPLESSOFT>("alcRenderSamplesSOFT")) {
    const std::array<ALCint, 13> attributes{ALC_FREQUENCY,
                                            rate,
                                            ALC_FORMAT_CHANNELS_SOFT,
                                            ALC_STEREO_SOFT,
                                            ALC_FORMAT_TYPE_SOFT,
                                            ALC_FLOAT_SOFT,
                                            ALC_MONO_SOURCES,
                                            sources,
                                            ALC_HRTF_SOFT,
                                            ALC_FALSE,
                                            ALC_OUTPUT_LIMITER_SOFT,
                                            ALC_TRUE,
                                            0};
    if (device_) context_.reset(alcCreateContext(device_.get(), attributes.data()));
    if (!context_) throw Error(ErrorCode::not_available, "sound", "OpenAL cannot render to memory");
}

void Loopback::render(std::span<float> samples) {
    render_(device_.get(), samples.data(), static_cast<ALCsizei>(samples.size() / 2));
}

} // namespace carom::sound
