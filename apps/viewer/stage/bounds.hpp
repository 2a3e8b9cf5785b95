/// \file
/// Where the bodies of a scene are, as far as a picture goes by it.
#pragma once

#include <carom/base.hpp>
#include <carom/region.hpp>

#include <optional>
#include <span>

namespace carom::viewer {

struct Ball {
    Vec3 centre{};     ///< m
    double radius = 1; ///< m, > 0
};

/// A ball around the bodies. A few that are far from all others do not count.
Ball ball_around(std::span<const Vec3> positions, std::span<const float> radii);

/// The smallest ball around two.
Ball joined(const Ball& a, const Ball& b);

/// What throws shadows: all of a closed region, else the bodies and the obstacles, if there are any.
Ball ball_to_light(const Region& region, const Ball& bodies, const std::optional<Ball>& obstacles);

/// What a camera should see: that, and the faces that hold the bodies.
Ball ball_to_see(const Region& region, const Ball& bodies, const std::optional<Ball>& obstacles);

/// m: the sides along which the region repeats, 0 along the others.
Vec3 periods_of(const Region& region);

/// `way` by the shortest way across periodic faces.
Vec3 shortest(const Vec3& way, const Vec3& periods);

} // namespace carom::viewer
