/// \file
/// Balls in ticks: where a body may be, and the quick test whether two of them meet.
#pragma once

#include "space/bodies.hpp"

#include <array>
#include <cmath>

namespace carom::core {

/// Lengths in *ticks*: every axis is cut into 2^32 of them and taken modulo 2^32, as a torus. A position is a 32-bit
/// number whose differences wrap correctly; what aliases is told apart by the exact tests that follow. Along a periodic
/// axis the period is the torus, so that images need no care.
using Tick = std::uint32_t;

struct Ball {
    std::array<Tick, 3> centre{};
    float radius = 0; ///< m; not a number for a ball that meets none
};

/// From one place in an array to before another.
struct Run {
    std::uint32_t from = 0;
    std::uint32_t to = 0;
};

/// m per tick along each axis.
using TickScale = std::array<float, 3>;

/// m from one place to another; wraps as the torus does.
inline float tick_distance(Tick from, Tick to, float scale) {
    return static_cast<float>(static_cast<std::int32_t>(to - from)) * scale;
}

inline float squared_distance(const std::array<Tick, 3>& a, const std::array<Tick, 3>& b, const TickScale& scale) {
    const float x = tick_distance(a[0], b[0], scale[0]);
    const float y = tick_distance(a[1], b[1], scale[1]);
    const float z = tick_distance(a[2], b[2], scale[2]);
    return x * x + y * y + z * z;
}

inline bool balls_meet(const Ball& a, const Ball& b, const TickScale& scale) {
    const float reach = a.radius + b.radius;
    return squared_distance(a.centre, b.centre, scale) <= reach * reach;
}

/// Whether all of `inner` lies in `outer`, even with roundings.
inline bool ball_holds(const Ball& outer, const Ball& inner, const TickScale& scale) {
    constexpr float rounding = 1 + 1e-5F;
    return std::sqrt(squared_distance(outer.centre, inner.centre, scale)) * rounding + inner.radius * rounding <=
           outer.radius;
}

} // namespace carom::core
