/// \file
/// The searches that are vectorised: the same answers from every instruction set.
#pragma once

#include "space/track.hpp"

#include <cstddef>

namespace carom::core {

/// Balls in arrays, which may be read up to simd_padding elements behind their ends.
struct BallArrays {
    const Tick* x = nullptr;
    const Tick* y = nullptr;
    const Tick* z = nullptr;
    const float* radius = nullptr;
    const Index* body = nullptr;
    TickScale scale{};
};

/// More elements than any vector has.
inline constexpr std::size_t simd_padding = 64;

/// Writes to `out` the bodies, other than `self`, whose balls in the runs meet `ball`, in order, and returns the end.
/// `out` has room for all of the runs and for simd_padding more.
using BallSearch = Index* (*)(const BallArrays& arrays, const Ball& ball, Index self, const Run* runs,
                              std::size_t run_count, Index* out);

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
BallSearch ball_search();
TrackSearch track_search();

} // namespace carom::core
