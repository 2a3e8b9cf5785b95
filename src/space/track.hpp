/// \file
/// Tracks: how bodies move between impacts, short and conservative, for the quick test that tells most pairs apart.
///
/// Tracks are seen from a frame that falls with uniform gravity, s seconds after the *epoch*'s start: there free flight
/// is straight and as fast as ever, so that a track is right until the body's next impact.
#pragma once

#include "space/ball.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom::core {

struct Track {
    std::array<Tick, 3> start{}; ///< where the body would have been at the start of the epoch
    /// m, its radius, and what keeps the test conservative; infinite: always may meet. Negative: the body is not in
    /// free flight, and anywhere so far from its track.
    float reach = 0;
    std::array<float, 3> speed{}; ///< m/s
    /// m that the body may still leave its track by: how much it had at the epoch's start, had it always been on it.
    float room = 0;
};

inline constexpr float never = std::numeric_limits<float>::infinity();

/// What tracks are measured in, and how wrong they may be.
struct TrackScale {
    TickScale metres{};    ///< per tick
    float tolerance = 0;   ///< m, more than the errors of two tracks' places
    float speed_error = 0; ///< m/s, more than the errors of two tracks' speeds
};

/// With u = 2^-24, |closing| and the parts of `outside` are wrong by up to 5 u |p| |w| and 5 u p^2, so the discriminant
/// below by less than 20 u p^2 w^2; and where it is not negative, p^2 w^2 <= closing^2 + w^2 reach^2. So much more than
/// that keeps the test conservative far away, where the discriminant cancels.
inline constexpr float discriminant_margin = 2e-6F;

/// A time in [from, to] (s) before which two bodies do not meet; `never` if they do not meet before `to`.
inline float first_meeting(const Track& a, const Track& b, float from, float to, const TrackScale& scale) {
    const std::array<float, 3> w{b.speed[0] - a.speed[0], b.speed[1] - a.speed[1], b.speed[2] - a.speed[2]};
    const std::array<float, 3> p{tick_distance(a.start[0], b.start[0], scale.metres[0]) + w[0] * from,
                                 tick_distance(a.start[1], b.start[1], scale.metres[1]) + w[1] * from,
                                 tick_distance(a.start[2], b.start[2], scale.metres[2]) + w[2] * from};
    const float reach = std::abs(a.reach) + std::abs(b.reach);
    const float reach_squared = reach * reach;
    const float outside = p[0] * p[0] + p[1] * p[1] + p[2] * p[2] - reach_squared;
    const float closing = -(p[0] * w[0] + p[1] * w[1] + p[2] * w[2]);
    const float speed = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
    if (outside <= 0) {
        // What has met and parts for good does not meet again.
        const float unsure =
            speed * (scale.tolerance * scale.tolerance) + reach_squared * (scale.speed_error * scale.speed_error);
        const bool parts = closing < 0 && std::min(a.reach, b.reach) > 0 && closing * closing > unsure;
        return parts ? never : from;
    }
    const float closing_squared = closing * closing;
    const float margin = discriminant_margin * (closing_squared + speed * reach_squared);
    const float discriminant = closing_squared - speed * outside + margin;
    if (closing <= 0 || discriminant < 0) return never;
    const float time = from + outside / (closing + std::sqrt(discriminant));
    if (time > to) return never;
    // Not a number where squares left the range of a float.
    return time >= from ? time : from;
}

inline float speed_of(const Track& track) {
    return std::sqrt(track.speed[0] * track.speed[0] + track.speed[1] * track.speed[1] +
                     track.speed[2] * track.speed[2]);
}

} // namespace carom::core
