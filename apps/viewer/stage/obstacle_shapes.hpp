/// \file
/// What obstacles look like: their surfaces as triangles, and the edges that tell their form.
#pragma once

#include "viewer/render/drawing.hpp"
#include "viewer/stage/bounds.hpp"

#include <carom/region.hpp>

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace carom::viewer {

/// Frustums and closed meshes are of glass, so that what is in them is seen; all other surfaces hide what is behind.
class ObstacleShapes {
public:
    ObstacleShapes() = default; ///< of no obstacles
    explicit ObstacleShapes(std::span<const Obstacle> obstacles);

    /// A ball around all of them; nothing without obstacles.
    [[nodiscard]] const std::optional<Ball>& ball() const { return ball_; }
    /// For a drawing with this origin (m); valid as long as this object.
    [[nodiscard]] Shapes shapes(const Vec3& origin) const;
    /// From and to (m).
    using Segments = std::vector<std::pair<Vec3, Vec3>>;
    /// Rims, borders and creases.
    [[nodiscard]] const Segments& edges() const { return edges_; }
    /// Lines from rim to rim of frustums, which turn with them, at `time` (s).
    [[nodiscard]] Segments meridians(double time) const;

private:
    void add(const Frustum& frustum);
    void add(const Mesh& mesh);
    [[nodiscard]] Corner corner(const Vec3& place, const Vec3& normal) const;

    std::optional<Ball> ball_;
    std::vector<Corner> plain_;
    std::vector<Corner> glass_;
    Segments edges_;
    std::vector<Frustum> frustums_; ///< with meridians
    std::uint64_t version_ = 0;
};

} // namespace carom::viewer
