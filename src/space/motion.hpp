/// \file
/// How a body's motion is kept: an integer position, a velocity, and the time at which both hold.
#pragma once

#include "collision/component.hpp"

#include <carom/time_of_impact.hpp>

#include <cmath>
#include <cstdint>
#include <limits>

namespace carom::core {

/// A position in units of the world's resolution. Arithmetic wraps; world_edge says why that is harmless.
struct Int3 {
    std::int64_t x = 0;
    std::int64_t y = 0;
    std::int64_t z = 0;

    friend constexpr bool operator==(const Int3&, const Int3&) = default;
    friend constexpr Int3 operator+(const Int3& a, const Int3& b) {
        return {wrapped_sum(a.x, b.x), wrapped_sum(a.y, b.y), wrapped_sum(a.z, b.z)};
    }
    friend constexpr Int3 operator-(const Int3& a, const Int3& b) {
        return {wrapped_difference(a.x, b.x), wrapped_difference(a.y, b.y), wrapped_difference(a.z, b.z)};
    }

    static constexpr std::int64_t wrapped_sum(std::int64_t a, std::int64_t b) {
        return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
    }
    static constexpr std::int64_t wrapped_difference(std::int64_t a, std::int64_t b) {
        return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
    }
};

using detail::component;
constexpr std::int64_t component(const Int3& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }
constexpr std::int64_t& component(Int3& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

/// Largest coordinate, in units of the resolution, that a body may have at the ends of a step: 2^63 - 2^59, which is
/// 8.2e12 m at 2^-20 m and 7.9e6 m at 2^-40 m.
inline constexpr std::int64_t world_edge = std::numeric_limits<std::int64_t>::max() - (std::int64_t{1} << 59) + 1;
/// Largest coordinate inside a step, 2^63 - 2^58. Wrapped differences of such coordinates are right up to 2^63; two
/// bodies further apart than that look at least 2^59 units apart, too far to meet within a step.
inline constexpr std::int64_t flight_edge = std::numeric_limits<std::int64_t>::max() - (std::int64_t{1} << 58) + 1;

/// Resolutions lie between 2^-100 m and 2^40 m, which makes a world of 1e31 m: all lengths fit a float.
inline constexpr int smallest_resolution_exponent = -100;
inline constexpr int largest_resolution_exponent = 40;

/// The world's unit of length.
struct Resolution {
    double metres = 0;    ///< m per unit, a power of two
    double per_metre = 0; ///< its exact inverse
};

/// Rounds to the nearest integers, ties to even: symmetric, so that mirrored worlds keep mirrored bits.
/// Domain: |value| < 2^63 units, default rounding mode.
inline Int3 round_to_units(const Vec3& metres, const Resolution& resolution) {
    const Vec3 units = metres * resolution.per_metre;
    // Adding 1.5 * 2^52 leaves no room for a fraction: the addition itself rounds. Beyond 2^51 the library has to.
    constexpr double shifter = 6755399441055744.0;
    constexpr double shifter_limit = 2251799813685248.0;
    if (std::abs(units.x) + std::abs(units.y) + std::abs(units.z) < shifter_limit) {
        const auto quick = [](double value) { return static_cast<std::int64_t>((value + shifter) - shifter); };
        return {quick(units.x), quick(units.y), quick(units.z)};
    }
    const auto slow = [](double value) { return static_cast<std::int64_t>(std::rint(value)); };
    return {slow(units.x), slow(units.y), slow(units.z)};
}

/// Units to metres; exact as long as the coordinates stay below 2^53 units.
inline Vec3 to_metres(const Int3& units, const Resolution& resolution) {
    return {static_cast<double>(units.x) * resolution.metres, static_cast<double>(units.y) * resolution.metres,
            static_cast<double>(units.z) * resolution.metres};
}

/// m from `from` to `to`, exact below 2^53 units; right at any distance, unlike the wrapped difference.
inline double metres_between(std::int64_t from, std::int64_t to, const Resolution& resolution) {
    std::int64_t units = 0;
    if (!__builtin_sub_overflow(to, from, &units)) return static_cast<double>(units) * resolution.metres;
    return (static_cast<double>(to) - static_cast<double>(from)) * resolution.metres;
}

/// One body's motion: x + v (s - t) + a (s - t)^2 / 2 at time s. Written only by the body's own impacts and at the
/// end of a step. One cache line in double precision.
template <class Real>
struct Motion {
    Int3 x{};          ///< units of the resolution, at time t
    double t = 0;      ///< s since the start of the step
    Vector3<Real> v{}; ///< m/s, at time t
    Real radius = 0;   ///< m
};

template <class Real>
Vec3 velocity_of(const Motion<Real>& m) {
    return detail::wide(m.v);
}

template <class Real>
Vector3<Real> rounded(const Vec3& v) {
    return {static_cast<Real>(v.x), static_cast<Real>(v.y), static_cast<Real>(v.z)};
}

/// How far a body gets in `duration` seconds, m.
inline Vec3 displacement(const Vec3& velocity, const Vec3& acceleration, double duration) {
    return velocity * duration + acceleration * (0.5 * duration * duration);
}

/// m, how far from its place a body and its surface may get along any axis until `until`.
template <class Real>
double reach_of(const Motion<Real>& m, const Vec3& acceleration, double until) {
    const auto sum = [](const Vec3& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); };
    const double duration = until - m.t;
    return (sum(velocity_of(m)) + sum(acceleration) * duration) * duration + static_cast<double>(m.radius);
}

} // namespace carom::core
