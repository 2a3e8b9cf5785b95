#include "viewer/stage/obstacle_shapes.hpp"

#include "viewer/stage/palette.hpp"
#include "viewer/stage/version.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <variant>

namespace carom::viewer {

namespace {

constexpr int segments = 96;            ///< of a circle
constexpr int meridians_of_frustum = 8; ///< that are drawn as lines

/// The box around points and circles.
class Extent {
public:
    void add(const Vec3& point, const Vec3& reach = {}) {
        const Vec3 low = point - reach;
        const Vec3 high = point + reach;
        if (!low_) {
            low_ = low;
            high_ = high;
        }
        low_ = {std::min(low_->x, low.x), std::min(low_->y, low.y), std::min(low_->z, low.z)};
        high_ = {std::max(high_.x, high.x), std::max(high_.y, high.y), std::max(high_.z, high.z)};
    }

    [[nodiscard]] std::optional<Ball> ball() const {
        if (!low_) return std::nullopt;
        return Ball{(*low_ + high_) / 2, length(high_ - *low_) / 2};
    }

private:
    std::optional<Vec3> low_;
    Vec3 high_{};
};

/// A frustum's axis and two directions across it.
struct Axes {
    Vec3 along;
    Vec3 u;
    Vec3 v;

    explicit Axes(const Frustum& frustum)
        : along(unit(frustum.axis)), u(unit(cross(along, std::abs(along.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}))),
          v(cross(along, u)) {}

    [[nodiscard]] Vec3 radial(double turns) const {
        const double angle = 2 * std::numbers::pi * turns;
        return u * std::cos(angle) + v * std::sin(angle);
    }
};

std::optional<Ball> ball_around(std::span<const Obstacle> obstacles) {
    Extent extent;
    for (const Obstacle& obstacle : obstacles) {
        if (const auto* mesh = std::get_if<Mesh>(&obstacle)) {
            for (const Vec3& vertex : mesh->vertices) extent.add(vertex);
            continue;
        }
        const auto& frustum = std::get<Frustum>(obstacle);
        const Vec3 along = unit(frustum.axis);
        const auto across = [](double part) { return std::sqrt(std::max(0.0, 1 - part * part)); };
        const Vec3 circle{across(along.x), across(along.y), across(along.z)};
        extent.add(frustum.base, circle * frustum.base_radius);
        extent.add(frustum.base + along * frustum.height, circle * frustum.top_radius);
    }
    return extent.ball();
}

using Triangle = std::array<Vec3, 3>;

/// Across the triangle, twice as long as it is large.
Vec3 across(const Triangle& t) { return cross(t[1] - t[0], t[2] - t[0]); }

std::vector<Triangle> triangles_of(const Mesh& mesh) {
    std::vector<Triangle> triangles;
    triangles.reserve(mesh.triangles.size());
    for (const auto& [a, b, c] : mesh.triangles) {
        triangles.push_back({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]});
    }
    return triangles;
}

struct BeforeInSpace {
    bool operator()(const Vec3& a, const Vec3& b) const {
        return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
    }
    bool operator()(const std::pair<Vec3, Vec3>& a, const std::pair<Vec3, Vec3>& b) const {
        return a.first != b.first ? (*this)(a.first, b.first) : (*this)(a.second, b.second);
    }
};

/// What is on the two sides of an edge: normals of triangles that have it from its first end to its second, or back.
struct Sides {
    std::vector<Vec3> forward;
    std::vector<Vec3> back;
};
using Edges = std::map<std::pair<Vec3, Vec3>, Sides, BeforeInSpace>;

Edges edges_of(const std::vector<Triangle>& triangles) {
    Edges edges;
    for (const Triangle& triangle : triangles) {
        const Vec3 normal = unit(across(triangle));
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3& from = triangle[i];
            const Vec3& to = triangle[(i + 1) % 3];
            const bool forward = BeforeInSpace{}(from, to);
            Sides& sides = edges[forward ? std::pair{from, to} : std::pair{to, from}];
            (forward ? sides.forward : sides.back).push_back(normal);
        }
    }
    return edges;
}

/// Each edge has one triangle on either side, and they agree about what is outside.
bool closed(const Edges& edges) {
    return std::all_of(edges.begin(), edges.end(), [](const auto& edge) {
        return edge.second.forward.size() == 1 && edge.second.back.size() == 1;
    });
}

/// A border, or one where surfaces meet at more than 15 degrees.
bool tells_the_form(const Sides& sides) {
    constexpr double least_cosine = 0.966;
    std::vector<Vec3> normals = sides.forward;
    // Neighbours that run round the same way are on one side of the surface; others are turned over.
    for (const Vec3& normal : sides.back) normals.push_back(normal);
    if (normals.size() != 2) return true;
    const double cosine = dot(normals[0], normals[1]);
    return (sides.forward.size() == 1 ? cosine : -cosine) < least_cosine;
}

/// Six times the volume that a closed mesh holds; negative if its triangles run round the other way.
double volume(const std::vector<Triangle>& triangles) {
    double sum = 0;
    for (const Triangle& t : triangles) {
        const Vec3& origin = triangles.front()[0];
        sum += dot(t[0] - origin, cross(t[1] - origin, t[2] - origin));
    }
    return sum;
}

} // namespace

ObstacleShapes::ObstacleShapes(std::span<const Obstacle> obstacles)
    : ball_(ball_around(obstacles)), version_(next_version()) {
    for (const Obstacle& obstacle : obstacles) {
        std::visit([this](const auto& solid) { add(solid); }, obstacle);
    }
}

Corner ObstacleShapes::corner(const Vec3& place, const Vec3& normal) const {
    return {narrow(place - ball_->centre), narrow(normal)};
}

void ObstacleShapes::add(const Frustum& frustum) {
    const Axes axes(frustum);
    const Vec3 top = frustum.base + axes.along * frustum.height;
    const double slope = frustum.base_radius - frustum.top_radius;
    const bool flat = frustum.height == 0; // a disc or a ring
    std::vector<Corner>& corners = flat ? plain_ : glass_;
    for (int i = 0; i < segments; ++i) {
        const std::array radials{axes.radial(1.0 * i / segments), axes.radial((i + 1.0) / segments)};
        std::array<Vec3, 2> low;
        std::array<Vec3, 2> high;
        std::array<Vec3, 2> normal;
        for (std::size_t k = 0; k < 2; ++k) {
            low[k] = frustum.base + radials[k] * frustum.base_radius;
            high[k] = top + radials[k] * frustum.top_radius;
            normal[k] = unit(radials[k] * frustum.height + axes.along * slope);
        }
        for (const auto& [place, k] : {std::pair{low[0], 0U},
                                       {low[1], 1U},
                                       {high[1], 1U}, //
                                       {low[0], 0U},
                                       {high[1], 1U},
                                       {high[0], 0U}}) {
            corners.push_back(corner(place, normal[k]));
        }
        edges_.emplace_back(low[0], low[1]);
        edges_.emplace_back(high[0], high[1]);
    }
    // Those of a disc would say nothing unless it turns.
    if (!flat || frustum.angular_velocity != 0) frustums_.push_back(frustum);
}

void ObstacleShapes::add(const Mesh& mesh) {
    const std::vector<Triangle> triangles = triangles_of(mesh);
    const Edges edges = edges_of(triangles);
    const bool glass = closed(edges);
    const bool inside_out = glass && volume(triangles) < 0;
    std::vector<Corner>& corners = glass ? glass_ : plain_;
    for (Triangle triangle : triangles) {
        if (inside_out) std::swap(triangle[1], triangle[2]);
        const Vec3 normal = unit(across(triangle));
        for (const Vec3& place : triangle) corners.push_back(corner(place, normal));
    }
    for (const auto& [ends, sides] : edges) {
        if (tells_the_form(sides)) edges_.push_back(ends);
    }
}

ObstacleShapes::Segments ObstacleShapes::meridians(double time) const {
    Segments lines;
    for (const Frustum& frustum : frustums_) {
        const Axes axes(frustum);
        const Vec3 top = frustum.base + axes.along * frustum.height;
        const double turns = std::fmod(frustum.angular_velocity * time / (2 * std::numbers::pi), 1.0);
        for (int i = 0; i < meridians_of_frustum; ++i) {
            const Vec3 radial = axes.radial(turns + 1.0 * i / meridians_of_frustum);
            lines.emplace_back(frustum.base + radial * frustum.base_radius, top + radial * frustum.top_radius);
        }
    }
    return lines;
}

Shapes ObstacleShapes::shapes(const Vec3& origin) const {
    if (!ball_) return {};
    return {narrow(ball_->centre - origin), plain_, glass_, version_, obstacle_colour};
}

} // namespace carom::viewer
