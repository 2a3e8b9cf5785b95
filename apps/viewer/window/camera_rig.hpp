/// \file
/// Cameras that the user moves: around a point, freely, or around a body that flies.
#pragma once

#include "viewer/render/drawing.hpp"
#include "viewer/window/input.hpp"

#include <cstdint>

namespace carom::viewer {

enum class CameraMode : std::uint8_t { orbit, fly, follow };

class CameraRig {
public:
    void set_camera(const Camera& camera) { camera_ = camera; }
    [[nodiscard]] const Camera& camera() const { return camera_; }
    void set_mode(CameraMode mode) { mode_ = mode; }
    [[nodiscard]] CameraMode mode() const { return mode_; }

    /// Obeys mouse and keys; `seconds` of the wall clock since the last time. `scale`: m, the size of what is seen,
    /// which speeds go by. `pixels`: the picture's height.
    void move(const Input& input, double seconds, double scale, double pixels);
    /// The followed body is at `place`.
    void follow(const Vec3& place);

private:
    void turn_around(double right, double up); ///< the target, radians
    void turn_head(double right, double up);   ///< radians
    void shift(const Vec3& way);
    void zoom(double factor);
    void fly(const Input& input, double way);

    Camera camera_;
    CameraMode mode_ = CameraMode::orbit;
};

} // namespace carom::viewer
