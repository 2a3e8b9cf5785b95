/// \file
/// Where the camera is: chosen by the scene, along its path, or so that all is seen.
#pragma once

#include "scene/view.hpp"
#include "viewer/render/drawing.hpp"
#include "viewer/stage/bounds.hpp"

namespace carom::viewer {

/// The direction that is up in pictures: that of the scene, or else against gravity, or else z.
Vec3 up_of(const scene::CameraSpec& spec, const Vec3& gravity);

/// The camera of a scene at `time` (s of the world); what the scene leaves open shows all of `to_see`.
Camera camera_at(const scene::CameraSpec& spec, double time, const Ball& to_see, const Vec3& up);

/// The unit vectors of a camera.
struct CameraAxes {
    Vec3 forward;
    Vec3 right;
    Vec3 up;
};
CameraAxes axes_of(const Camera& camera);

} // namespace carom::viewer
