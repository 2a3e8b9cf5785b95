// What stands in for OpenAL in a build without it.
#include "viewer/sound/checks.hpp"

#include <string>

namespace carom::sound {

namespace {

[[noreturn]] void refuse() {
    throw Error(ErrorCode::not_available, "sound",
                "this build of carom has none; install OpenAL Soft (libopenal-dev) and build again");
}

} // namespace

class SoundStage::Impl {};

SoundStage::SoundStage(const SoundSettings& settings) {
    check(settings);
    refuse();
}
SoundStage::~SoundStage() = default;
SoundStage::SoundStage(SoundStage&&) noexcept = default;
SoundStage& SoundStage::operator=(SoundStage&&) noexcept = default;
void SoundStage::listen(const Listener& /*listener*/) { refuse(); }
void SoundStage::play(std::span<const Strike> /*strikes*/) { refuse(); }
void SoundStage::render(std::span<float> /*samples*/) { refuse(); }
std::size_t SoundStage::voices() const { refuse(); }

std::unique_ptr<Speaker> open_default_speaker(int /*rate*/) { refuse(); }

} // namespace carom::sound
