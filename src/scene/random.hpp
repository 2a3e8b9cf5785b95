/// \file
/// Random numbers that are the same on every machine: own generator and own distributions, because the standard
/// library leaves its distributions to each implementation. Used for initial states; nothing in a step is random.
#pragma once

#include "collision/portable_math.hpp"

#include <carom/base.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <optional>

namespace carom::scene {

/// The next number of splitmix64 (Steele, Lea & Flood 2014); turns any seed into well mixed state.
inline std::uint64_t splitmix64(std::uint64_t& state) {
    state += 0x9e3779b97f4a7c15U;
    std::uint64_t z = state;
    z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31U);
}

/// Generator xoshiro256** (Blackman & Vigna 2018) with distributions. The same seed gives the same bits everywhere.
class Random {
public:
    /// Any seed will do, 0 included.
    explicit Random(std::uint64_t seed) {
        for (std::uint64_t& word : state_) word = splitmix64(seed);
    }
    /// Goes on from a state that is not all zeros.
    explicit Random(const std::array<std::uint64_t, 4>& state) : state_(state) {}

    /// One of several independent generators of the same seed.
    static Random stream(std::uint64_t seed, std::uint64_t number) { return Random(splitmix64(seed) + number); }

    /// 64 random bits.
    std::uint64_t bits() {
        const std::uint64_t result = std::rotl(state_[1] * 5U, 7) * 9U;
        const std::uint64_t shifted = state_[1] << 17U;
        state_[2] ^= state_[0];
        state_[3] ^= state_[1];
        state_[1] ^= state_[2];
        state_[0] ^= state_[3];
        state_[2] ^= shifted;
        state_[3] = std::rotl(state_[3], 45);
        return result;
    }

    /// Uniform in [0, 1): a multiple of 2^-53.
    double unit() { return static_cast<double>(bits() >> 11U) * 0x1p-53; }

    /// Uniform in [low, high); `low` if they are equal. `high - low` must not overflow.
    double uniform(double low, double high) {
        const double value = low + (high - low) * unit();
        return value < high ? value : low; // rounding may reach the upper end
    }

    /// Uniform in its logarithm, in [low, high] with 0 < low <= high.
    double log_uniform(double low, double high) {
        const double value = detail::exp(uniform(detail::log(low), detail::log(high)));
        if (value < low) return low;
        return value > high ? high : value;
    }

    /// Normal with mean 0 and standard deviation 1, by Marsaglia's polar method.
    double normal() {
        if (spare_) {
            const double value = *spare_;
            spare_.reset();
            return value;
        }
        const PointInDisc point = in_disc();
        const double scale = std::sqrt(-2 * detail::log(point.square) / point.square);
        spare_ = point.y * scale;
        return point.x * scale;
    }

    /// Three independent normal components.
    Vec3 normal_vector() {
        const double x = normal();
        const double y = normal();
        return {x, y, normal()};
    }

    /// Rayleigh-distributed with the given root mean square: the length of a normal vector in a plane.
    double rayleigh(double root_mean_square) { return root_mean_square * std::sqrt(-detail::log(1 - unit())); }

    /// A point on the unit circle in the plane z = 0.
    Vec3 on_circle() {
        const PointInDisc point = in_disc();
        const double length = std::sqrt(point.square);
        return {point.x / length, point.y / length, 0};
    }

    /// A point on the unit sphere, by Marsaglia's method.
    Vec3 on_sphere() {
        const PointInDisc point = in_disc();
        const double scale = 2 * std::sqrt(1 - point.square);
        return {point.x * scale, point.y * scale, 1 - 2 * point.square};
    }

private:
    struct PointInDisc {
        double x;
        double y;
        double square; ///< x^2 + y^2, in (0, 1)
    };

    /// Uniform in the open unit disc without its very centre.
    PointInDisc in_disc() {
        for (;;) {
            const double x = uniform(-1, 1);
            const double y = uniform(-1, 1);
            const double square = x * x + y * y;
            if (square < 1 && square > 0) return {x, y, square};
        }
    }

    std::array<std::uint64_t, 4> state_{};
    std::optional<double> spare_;
};

} // namespace carom::scene
