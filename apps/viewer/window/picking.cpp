#include "viewer/window/picking.hpp"

#include "viewer/stage/camera_path.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace carom::viewer {

namespace {

double half_height_of(const Camera& camera) { return std::tan(camera.field_of_view * std::numbers::pi / 360); }

} // namespace

Vec3 direction_through(const Camera& camera, const Place& place) {
    const CameraAxes axes = axes_of(camera);
    const double half = half_height_of(camera);
    const double across = (2 * place.x / place.width - 1) * half * place.width / place.height;
    const double along = (1 - 2 * place.y / place.height) * half;
    return unit(axes.forward + axes.right * across + axes.up * along);
}

std::optional<BodyId> body_at(const Moment& moment, double time, const Camera& camera, const Place& place) {
    constexpr double missed_by = 2;                                             // pixels
    const double slack = missed_by * 2 * half_height_of(camera) / place.height; // at distance 1
    const Vec3 ray = direction_through(camera, place);
    double nearest = std::numeric_limits<double>::infinity();
    std::optional<BodyId> found;
    for (std::size_t i = 0; i < moment.position.size(); ++i) {
        const Vec3 way = moment.position_at(i, time) - camera.position;
        const double middle = dot(way, ray);
        const double radius = std::max(static_cast<double>((*moment.radii)[i]), slack * middle);
        const double half_chord2 = radius * radius - length_squared(way - ray * middle);
        if (half_chord2 < 0) continue;
        const double half_chord = std::sqrt(half_chord2);
        const double travel = middle > half_chord ? middle - half_chord : middle + half_chord;
        if (travel > 0 && travel < nearest) {
            nearest = travel;
            found = (*moment.ids)[i];
        }
    }
    return found;
}

} // namespace carom::viewer
