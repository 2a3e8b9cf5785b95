/// \file
/// How a scene is heard by who looks at it.
#pragma once

#include "viewer/render/drawing.hpp"
#include "viewer/sound/sound_stage.hpp"

namespace carom::viewer {

/// Ears at the camera, which moves with `velocity` (m/s).
sound::Listener listener_at(const Camera& camera, const Vec3& velocity = {});

/// With `camera` at its place what is at its target is half as loud as it can be.
sound::SoundSettings heard_from(const Camera& camera, sound::SoundSettings settings);

} // namespace carom::viewer
