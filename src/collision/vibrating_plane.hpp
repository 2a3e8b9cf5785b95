/// \file
/// Time of impact with a plane that vibrates.
#pragma once

namespace carom::detail {

/// A plane's way along its normal, from where it is now: amplitude (sin(frequency t + phase) - sin(phase)).
struct Vibration {
    double amplitude = 0; ///< m, >= 0
    double frequency = 0; ///< rad/s, >= 0
    double phase = 0;     ///< rad, now
};

/// When a body on a parabola meets a vibrating plane, s, or no_impact if not in [0, horizon]; the touch rule of
/// time_of_impact.hpp holds.
///
/// `gap` (m) is of now; `velocity` (m/s) and `acceleration` (m/s^2) are along the normal and relative to the place
/// around which the plane vibrates, which may itself move.
///
/// The search goes in steps in which no impact can be: the gap is never less than with the least curvature that it may
/// have, acceleration - amplitude frequency^2, nor than with the plane at its highest all the time. Near the impact the
/// steps are Newton's, from the safe side. Flights that never part from the plane by more than amplitude 2^-60 are
/// none.
double time_to_vibrating_plane(double gap, double velocity, double acceleration, const Vibration& vibration,
                               double horizon);

} // namespace carom::detail
