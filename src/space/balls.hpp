/// \file
/// Balls around paths: the quick test that tells most pairs of neighbours apart.
#pragma once

#include "space/ticks.hpp"

#include <bit>

namespace carom::core {

/// A ball that a body stays in, surface included.
struct alignas(16) Ball {
    std::array<Tick, 3> centre{};
    float radius = 0; ///< m
};

/// Makes balls and tests them against each other, conservatively.
class Balls {
public:
    Balls() = default;
    explicit Balls(const Ticks& ticks) : ticks_(ticks) {
        const auto [x, y, z] = ticks.metres_per_tick();
        metres_per_tick_ = Floats{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z), 0};
        // The centres' truncation: one tick along each axis.
        margin_ = 2 * std::max({x, y, z});
    }

    /// `radius` in m, at least 0.
    [[nodiscard]] Ball ball(const Int3& x, double radius) const { return {ticks_.of(x), this->radius(radius)}; }
    /// What stands for a radius (m) in a ball.
    [[nodiscard]] float radius(double radius) const {
        // More than the roundings of the test: a few half units in the last place of a float.
        constexpr double rounding = 1e-6;
        constexpr double most = 1e30;
        return static_cast<float>(std::min(radius * (1 + rounding) + margin_, most));
    }

    /// False only if the balls do not meet.
    [[nodiscard]] bool may_meet(const Ball& a, const Ball& b) const {
        // The differences wrap as the torus does; the fourth lane is multiplied by zero.
        const auto ticks = std::bit_cast<SignedLanes>(std::bit_cast<Lanes>(b) - std::bit_cast<Lanes>(a));
        const Floats d = __builtin_convertvector(ticks, Floats) * metres_per_tick_;
        const Floats squares = d * d;
        const float reach = a.radius + b.radius;
        return squares[0] + squares[1] + squares[2] <= reach * reach;
    }

private:
    using Lanes [[gnu::vector_size(16)]] = std::uint32_t;
    using SignedLanes [[gnu::vector_size(16)]] = std::int32_t;
    using Floats [[gnu::vector_size(16)]] = float;

    Ticks ticks_;
    Floats metres_per_tick_{};
    double margin_ = 0; ///< m
};

} // namespace carom::core
