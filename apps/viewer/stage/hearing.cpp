#include "viewer/stage/hearing.hpp"

#include "viewer/stage/camera_path.hpp"

namespace carom::viewer {

sound::Listener listener_at(const Camera& camera, const Vec3& velocity) {
    const CameraAxes axes = axes_of(camera);
    return {.position = camera.position, .forward = axes.forward, .up = axes.up, .velocity = velocity};
}

sound::SoundSettings heard_from(const Camera& camera, sound::SoundSettings settings) {
    settings.reference_distance = length(camera.target - camera.position) / 2;
    return settings;
}

} // namespace carom::viewer
