#include "viewer/stage/bounds.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <variant>
#include <vector>

namespace carom::viewer {

namespace {

/// So many bodies tell where all of them are.
constexpr std::size_t most_samples = 2048;
/// Where there are enough, one in fifty may be beyond, to either side.
constexpr std::size_t enough = 100;
constexpr std::size_t one_in = 50;

struct Extent {
    double low;
    double high;
};

Extent extent_of(std::vector<double>& values) {
    const std::size_t cut = values.size() < enough ? 0 : values.size() / one_in;
    const auto low = values.begin() + static_cast<std::ptrdiff_t>(cut);
    const auto high = values.end() - 1 - static_cast<std::ptrdiff_t>(cut);
    std::nth_element(values.begin(), low, values.end());
    const double lowest = *low;
    std::nth_element(values.begin(), high, values.end());
    return {lowest, *high};
}

double nearest_image(double way, double period) {
    return period > 0 ? way - period * std::nearbyint(way / period) : way;
}

/// A ball around those faces of a box that are not open; nothing if all are.
std::optional<Ball> ball_around_faces(const Box& box) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    std::array<double, 3> low{infinity, infinity, infinity};
    std::array<double, 3> high{-infinity, -infinity, -infinity};
    const std::array<double, 3> min{box.min.x, box.min.y, box.min.z};
    const std::array<double, 3> max{box.max.x, box.max.y, box.max.z};
    for (std::size_t face = 0; face < box.faces.size(); ++face) {
        if (box.faces[face].kind == FaceKind::open) continue;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const bool across = axis == face / 2;
            low[axis] = std::min(low[axis], across && face % 2 == 1 ? max[axis] : min[axis]);
            high[axis] = std::max(high[axis], across && face % 2 == 0 ? min[axis] : max[axis]);
        }
    }
    if (low[0] > high[0]) return std::nullopt;
    const Vec3 from{low[0], low[1], low[2]};
    const Vec3 to{high[0], high[1], high[2]};
    return Ball{(from + to) / 2, length(to - from) / 2};
}

} // namespace

Ball ball_around(std::span<const Vec3> positions, std::span<const float> radii) {
    if (positions.empty()) return {};
    const std::size_t stride = (positions.size() + most_samples - 1) / most_samples;
    std::array<std::vector<double>, 3> values;
    float largest = 0;
    for (std::size_t i = 0; i < positions.size(); i += stride) {
        values[0].push_back(positions[i].x);
        values[1].push_back(positions[i].y);
        values[2].push_back(positions[i].z);
        largest = std::max(largest, radii[i]);
    }
    const std::array extents{extent_of(values[0]), extent_of(values[1]), extent_of(values[2])};
    const Vec3 low{extents[0].low, extents[1].low, extents[2].low};
    const Vec3 high{extents[0].high, extents[1].high, extents[2].high};
    const double radius = length(high - low) / 2 + static_cast<double>(largest);
    return {(low + high) / 2, radius > 0 ? radius : 1};
}

Ball joined(const Ball& a, const Ball& b) {
    const Vec3 way = b.centre - a.centre;
    const double distance = length(way);
    if (distance + b.radius <= a.radius) return a;
    if (distance + a.radius <= b.radius) return b;
    const double radius = (distance + a.radius + b.radius) / 2;
    return {a.centre + way * ((radius - a.radius) / distance), radius};
}

Ball ball_to_light(const Region& region, const Ball& bodies, const std::optional<Ball>& obstacles) {
    if (const auto* shell = std::get_if<Shell>(&region)) return {shell->centre, shell->radius};
    const auto* box = std::get_if<Box>(&region);
    const bool closed = box != nullptr && std::none_of(box->faces.begin(), box->faces.end(),
                                                       [](const Face& face) { return face.kind == FaceKind::open; });
    if (closed) return {(box->min + box->max) / 2, length(box->max - box->min) / 2};
    return obstacles ? joined(bodies, *obstacles) : bodies;
}

Ball ball_to_see(const Region& region, const Ball& bodies, const std::optional<Ball>& obstacles) {
    const Ball lit = ball_to_light(region, bodies, obstacles);
    const auto* box = std::get_if<Box>(&region);
    const auto faces = box != nullptr ? ball_around_faces(*box) : std::nullopt;
    return faces ? joined(lit, *faces) : lit;
}

Vec3 periods_of(const Region& region) {
    const auto* box = std::get_if<Box>(&region);
    if (box == nullptr) return {};
    const Vec3 size = box->max - box->min;
    const auto period = [&](std::size_t axis, double side) {
        return box->faces[2 * axis].kind == FaceKind::periodic ? side : 0.0;
    };
    return {period(0, size.x), period(1, size.y), period(2, size.z)};
}

Vec3 shortest(const Vec3& way, const Vec3& periods) {
    return {nearest_image(way.x, periods.x), nearest_image(way.y, periods.y), nearest_image(way.z, periods.z)};
}

} // namespace carom::viewer
