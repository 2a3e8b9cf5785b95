/// \file
/// Input at the door of the sound.
#pragma once

#include "viewer/sound/sound_stage.hpp"

#include <span>

namespace carom::sound {

/// \name Throw Error{not_finite|out_of_range} naming the field
/// @{
void check(const SoundSettings& settings);
void check(const Listener& listener);
void check(std::span<const Strike> strikes);
/// @}

} // namespace carom::sound
