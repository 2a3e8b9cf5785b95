#include "viewer/stage/camera_path.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <vector>

namespace carom::viewer {

namespace {

using Keys = std::vector<scene::CameraKey>;

/// Cubic Hermite interpolation between key `i` and the next. The slope at a key is that of the line from the key
/// before to the one after (Catmull and Rom); at the ends of the path that to its only neighbour.
template <class T>
T between(const Keys& keys, std::size_t i, double time, T scene::CameraKey::* member) {
    const auto slope = [&](std::size_t key) {
        const scene::CameraKey& before = keys[key > 0 ? key - 1 : key];
        const scene::CameraKey& after = keys[std::min(key + 1, keys.size() - 1)];
        return (after.*member - before.*member) / (after.time - before.time);
    };
    const scene::CameraKey& a = keys[i];
    const scene::CameraKey& b = keys[i + 1];
    const double span = b.time - a.time;
    const double s = (time - a.time) / span;
    const double rest = 1 - s;
    return a.*member * ((1 + 2 * s) * rest * rest) + slope(i) * (span * s * rest * rest) +
           b.*member * (s * s * (3 - 2 * s)) - slope(i + 1) * (span * s * s * rest);
}

Camera on_path(const Keys& keys, double time, const Vec3& up) {
    const auto camera = [&](const scene::CameraKey& key) {
        return Camera{key.position, key.target, up, key.field_of_view};
    };
    if (!(time > keys.front().time)) return camera(keys.front());
    if (time >= keys.back().time) return camera(keys.back());
    const auto after = std::find_if(keys.begin(), keys.end(), [&](const auto& key) { return key.time > time; });
    const auto i = static_cast<std::size_t>(after - keys.begin()) - 1;
    return {between(keys, i, time, &scene::CameraKey::position), between(keys, i, time, &scene::CameraKey::target), up,
            std::clamp(between(keys, i, time, &scene::CameraKey::field_of_view), 1.0, 170.0)};
}

/// From the front, a little from the right and from above.
Vec3 usual_direction(const Vec3& up) {
    const Vec3 aside = std::abs(up.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    const Vec3 right = unit(aside - up * dot(aside, up));
    const Vec3 front = cross(right, up);
    return unit(right * 0.45 + front * 0.85 + up * 0.38);
}

} // namespace

Vec3 up_of(const scene::CameraSpec& spec, const Vec3& gravity) {
    if (spec.up) return *spec.up;
    return unit(-gravity);
}

Camera camera_at(const scene::CameraSpec& spec, double time, const Ball& to_see, const Vec3& up) {
    if (!spec.path.empty()) return on_path(spec.path, time, up);
    Camera camera{{}, spec.target.value_or(to_see.centre), up, spec.field_of_view};
    if (spec.position) {
        camera.position = *spec.position;
        if (camera.position == camera.target) camera.target = camera.position - usual_direction(up) * to_see.radius;
        return camera;
    }
    const double half_angle = camera.field_of_view * std::numbers::pi / 360;
    const double away = to_see.radius / std::sin(half_angle);
    camera.position = camera.target + usual_direction(up) * away;
    return camera;
}

CameraAxes axes_of(const Camera& camera) {
    const Vec3 forward = unit(camera.target - camera.position, {0, 1, 0});
    Vec3 right = cross(forward, camera.up);
    if (!(length(right) > 0)) right = cross(forward, Vec3{forward.y, forward.z, forward.x});
    right = unit(right);
    return {forward, right, cross(right, forward)};
}

} // namespace carom::viewer
