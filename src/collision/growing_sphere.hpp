/// \file
/// Times of impact of spheres whose radii grow at constant rates.
#pragma once

#include <carom/base.hpp>

namespace carom::detail {

/// When two spheres meet, s, or no_impact if not in [0, horizon], by the touch rule of time_of_impact.hpp.
///
/// `delta` (m), `velocity` (m/s) and `acceleration` (m/s^2) are of b relative to a, `contact_distance` (m) is the sum
/// of the radii now and `growth` (m/s), of any sign, what it grows by; it stays positive up to the horizon.
///
/// Without acceleration a quadratic: |d + v t| = R + G t, by the root that does not cancel. Else a search in safe
/// steps: the distance has a curvature of -|a| at least.
double time_to_growing_spheres(const Vec3& delta, const Vec3& velocity, const Vec3& acceleration,
                               double contact_distance, double growth, double horizon);

/// The same for a sphere inside a shell, with the `clearance` (m) between them now; the horizon is finite.
double time_to_shell_growing(const Vec3& from_centre, const Vec3& velocity, const Vec3& acceleration, double clearance,
                             double growth, double horizon);

} // namespace carom::detail
