/// \file
/// How a scene is heard by who looks at it.
#pragma once

#include "viewer/render/drawing.hpp"
#include "viewer/sound/sound_stage.hpp"

#include <carom/world.hpp>

namespace carom::viewer {

/// Ears at the camera, which moves with `velocity` (m/s).
sound::Listener listener_at(const Camera& camera, const Vec3& velocity = {});

/// Settings that suit the world as it stands; what is at the camera's target is half as loud as it can be.
sound::SoundSettings sound_settings(const World& world, const Camera& camera);

} // namespace carom::viewer
