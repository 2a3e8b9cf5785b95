/// \file
/// Tracks: how bodies move between impacts, short and conservative, for the quick test that tells most pairs apart.
///
/// Tracks are seen from a frame that falls with uniform gravity, s seconds after the *epoch*'s start: there free flight
/// is straight and as fast as ever, so that a track is right until the body's next impact.
#pragma once

#include "space/cells.hpp"

#include <cmath>

namespace carom::core {

struct alignas(32) Track {
    std::array<Tick, 3> start{};  ///< where the body would have been at the start of the epoch
    float reach = 0;              ///< m, its radius, and what keeps the test conservative; infinite: always may meet
    std::array<float, 3> speed{}; ///< m/s
    float bend = 0;               ///< more than 0: not in free flight, and up to `reach` away from its track
};

inline constexpr float never = std::numeric_limits<float>::infinity();

/// Tests tracks against each other.
class TrackTest {
public:
    TrackTest() = default;
    explicit TrackTest(const std::array<double, 3>& metres_per_tick)
        : scale_{static_cast<float>(metres_per_tick[0]), static_cast<float>(metres_per_tick[1]),
                 static_cast<float>(metres_per_tick[2])} {}

    /// A time in [from, to] (s) before which two bodies do not meet; `never` if they do not meet before `to`.
    [[nodiscard]] float first_meeting(const Track& a, const Track& b, float from, float to) const {
        const std::array<float, 3> w{b.speed[0] - a.speed[0], b.speed[1] - a.speed[1], b.speed[2] - a.speed[2]};
        const std::array<float, 3> p{difference(a, b, 0) + w[0] * from, difference(a, b, 1) + w[1] * from,
                                     difference(a, b, 2) + w[2] * from};
        const float reach = a.reach + b.reach;
        const float outside = p[0] * p[0] + p[1] * p[1] + p[2] * p[2] - reach * reach;
        const float closing = -(p[0] * w[0] + p[1] * w[1] + p[2] * w[2]);
        const float speed = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
        if (outside <= 0) {
            // What has met and parts for good, by more than rounding, does not meet again.
            const bool parts = closing < 0 && a.bend + b.bend == 0 && closing * closing > tiny * speed * reach * reach;
            return parts ? never : from;
        }
        const float root = closing * closing - speed * outside;
        if (closing <= 0 || root < 0) return never;
        const float time = from + outside / (closing + std::sqrt(root));
        if (time > to) return never;
        // Not a number where squares left the range of a float.
        return time >= from ? time : from;
    }

    /// False only if two balls around the starts of tracks do not meet; radii in m, beyond the reaches.
    [[nodiscard]] bool balls_meet(const Track& a, float radius_a, const Track& b, float radius_b) const {
        const float x = difference(a, b, 0);
        const float y = difference(a, b, 1);
        const float z = difference(a, b, 2);
        const float reach = a.reach + radius_a + (b.reach + radius_b);
        return x * x + y * y + z * z <= reach * reach;
    }

    /// m between the places of two tracks of one body at one time.
    [[nodiscard]] float distance(const Track& a, float time_a, const Track& b, float time_b) const {
        float squares = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const float d = difference(a, b, k) + (b.speed[k] * time_b - a.speed[k] * time_a);
            squares += d * d;
        }
        return std::sqrt(squares);
    }

private:
    static constexpr float tiny = 1e-6F;

    /// m from a's start to b's: wraps as the torus does.
    [[nodiscard]] float difference(const Track& a, const Track& b, std::size_t k) const {
        return static_cast<float>(static_cast<std::int32_t>(b.start[k] - a.start[k])) * scale_[k];
    }

    std::array<float, 3> scale_{}; ///< m per tick
};

inline float speed_of(const Track& track) {
    return std::sqrt(track.speed[0] * track.speed[0] + track.speed[1] * track.speed[1] +
                     track.speed[2] * track.speed[2]);
}

} // namespace carom::core
