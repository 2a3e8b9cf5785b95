/// \file
/// The searches that are vectorised: the same answers from every instruction set.
#pragma once

#include "space/track.hpp"

#include <cstddef>

namespace carom::core {

/// More elements than any vector has.
inline constexpr std::size_t simd_padding = 64;

/// Balls in arrays, which may be read up to simd_padding elements behind their ends.
struct BallArrays {
    const Tick* x = nullptr;
    const Tick* y = nullptr;
    const Tick* z = nullptr;
    const float* radius = nullptr;
    const Index* body = nullptr;
    TickScale scale{};
};

/// Balls seen from one place, m, and packed together. The arrays have room for simd_padding elements behind their ends.
struct PackedBalls {
    float* x = nullptr;
    float* y = nullptr;
    float* z = nullptr;
    float* radius = nullptr;
    Index* body = nullptr;
};

/// One such ball.
struct SeenBall {
    float x = 0;
    float y = 0;
    float z = 0;
    float radius = 0;
    Index body = no_index;
};

/// Packs the balls of some runs as they are seen from `origin`.
using BallPacking = void (*)(const BallArrays& balls, const std::array<Tick, 3>& origin, const Run* runs,
                             std::size_t run_count, const PackedBalls& out);

/// Writes to `out` the bodies of the first `count` packed balls that meet `ball`, in order and without its own body,
/// and returns the end. `out` has room for `count` and simd_padding more.
using BallSearch = Index* (*)(const PackedBalls& balls, std::size_t count, const SeenBall& ball, Index* out);

/// Bodies that may be met, and times (s since the epoch's start) before which they are not. Both arrays have room for
/// simd_padding elements more than are written.
struct TrackMeetings {
    Index* bodies = nullptr;
    float* times = nullptr;
};

/// first_meeting() of a track with those of `count` bodies: writes whom it may meet between `from` and `to`, in order,
/// and returns how many. The list may be read up to simd_padding elements behind its end.
using TrackSearch = std::size_t (*)(const Track* tracks, const TrackScale& scale, const Track& track,
                                    const Index* bodies, std::size_t count, float from, float to,
                                    const TrackMeetings& out);

/// The ones for the instruction set in use: see carom/executor.hpp.
BallPacking ball_packing();
BallSearch ball_search();
TrackSearch track_search();

} // namespace carom::core
