/// \file
/// What the snippets of README.md expect of the program around them.
#pragma once

#include <carom/base.hpp>

/// Stands for the reader's own game.
inline void play_sound(const carom::Vec3& /*position*/, double /*impulse*/) {}
