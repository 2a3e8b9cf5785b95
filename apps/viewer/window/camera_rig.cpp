#include "viewer/window/camera_rig.hpp"

#include "viewer/stage/camera_path.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace carom::viewer {

namespace {

/// `v` turned by `angle` about the unit vector `axis` (Rodrigues).
Vec3 turned(const Vec3& v, const Vec3& axis, double angle) {
    return v * std::cos(angle) + cross(axis, v) * std::sin(angle) + axis * (dot(axis, v) * (1 - std::cos(angle)));
}

/// `way` turned to the right about `up`, and upwards, but never over the pole.
Vec3 turned(const Vec3& way, const Vec3& up, double right, double upwards) {
    constexpr double nearest_to_pole = 0.02; // radians
    const Vec3 unit_up = unit(up);
    const double height = std::acos(std::clamp(dot(unit(way), unit_up), -1.0, 1.0)); // from the pole
    const double wanted = std::clamp(height - upwards, nearest_to_pole, std::numbers::pi - nearest_to_pole);
    const Vec3 around = turned(way, unit_up, -right);
    Vec3 side = cross(around, unit_up);
    if (!(length(side) > 0)) side = cross(around, Vec3{around.y, around.z, around.x});
    return turned(around, unit(side), height - wanted);
}

constexpr double orbit_speed = 0.008; ///< radians a pixel
constexpr double head_speed = 0.004;  ///< radians a pixel
constexpr double wheel_step = 0.88;   ///< of the distance, for a notch of the wheel
constexpr double fly_speed = 0.7;     ///< sizes of the scene in a second

} // namespace

void CameraRig::turn_around(double right, double up) {
    camera_.position = camera_.target + turned(camera_.position - camera_.target, camera_.up, right, up);
}

void CameraRig::turn_head(double right, double up) {
    camera_.target = camera_.position + turned(camera_.target - camera_.position, camera_.up, right, up);
}

void CameraRig::shift(const Vec3& way) {
    camera_.position += way;
    camera_.target += way;
}

void CameraRig::zoom(double factor) {
    const Vec3 way = (camera_.position - camera_.target) * factor;
    if (length(way) > 0 && std::isfinite(length(way))) camera_.position = camera_.target + way;
}

void CameraRig::fly(const Input& input, double way) {
    const CameraAxes axes = axes_of(camera_);
    const auto pressed = [&](Key key) { return input.is_down(key) ? way : 0.0; };
    shift(axes.forward * (pressed(Key::w) - pressed(Key::s)) + axes.right * (pressed(Key::d) - pressed(Key::a)) +
          axes.up * (pressed(Key::e) - pressed(Key::q)));
}

void CameraRig::move(const Input& input, double seconds, double scale, double pixels) {
    const double distance = length(camera_.target - camera_.position);
    const double x = input.dragged_x();
    const double y = input.dragged_y();
    if (input.is_down(MouseButton::left)) {
        if (mode_ == CameraMode::fly) {
            turn_head(x * head_speed, -y * head_speed);
        } else {
            turn_around(x * orbit_speed, y * orbit_speed);
        }
    } else if (input.is_down(MouseButton::right) || input.is_down(MouseButton::middle)) {
        // What is at the target stays under the mouse.
        const double per_pixel = 2 * distance * std::tan(camera_.field_of_view * std::numbers::pi / 360) / pixels;
        const CameraAxes axes = axes_of(camera_);
        shift(axes.right * (-x * per_pixel) + axes.up * (y * per_pixel));
    }
    if (input.wheel() != 0) {
        if (mode_ == CameraMode::fly) {
            shift(axes_of(camera_).forward * (0.1 * scale * input.wheel()));
        } else {
            zoom(std::pow(wheel_step, input.wheel()));
        }
    }
    const double faster = input.is_down(Key::shift) ? 4 : 1;
    if (mode_ == CameraMode::fly) fly(input, fly_speed * scale * faster * seconds);
}

void CameraRig::follow(const Vec3& place) {
    if (mode_ == CameraMode::follow) shift(place - camera_.target);
}

} // namespace carom::viewer
