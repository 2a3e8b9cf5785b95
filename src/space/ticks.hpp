/// \file
/// From motions to balls: the conversion of positions to ticks.
#pragma once

#include "space/bounds.hpp"
#include "space/cells.hpp"

#include <array>
#include <limits>

namespace carom::core {

/// What the choice of cells and windows needs to know of all bodies: it affects speed only.
struct Census {
    Int3 low{};               ///< units, of the bodies' positions
    Int3 high{};              ///< units
    double mean_radius = 0;   ///< m, of the bodies that are not static
    double typical_speed = 0; ///< m/s, the mean over the bodies that are not static: a few fast ones hardly count
    double top_speed = 0;     ///< m/s
    std::size_t moving = 0;   ///< bodies that are not static
};

/// Takes a census in parts, body by body.
class CensusTaker {
public:
    template <class Real>
    void count(const Motion<Real>& motion, Kind kind) {
        const Int3& x = motion.x;
        low_ = {std::min(low_.x, x.x), std::min(low_.y, x.y), std::min(low_.z, x.z)};
        high_ = {std::max(high_.x, x.x), std::max(high_.y, x.y), std::max(high_.z, x.z)};
        if (kind == Kind::fixed) return;
        const Vec3 v = velocity_of(motion);
        radii_ += static_cast<double>(motion.radius);
        speeds_ += std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
        top_squared_ = std::max(top_squared_, length_squared(v));
        ++moving_;
    }
    void add(const CensusTaker& other);
    [[nodiscard]] Census census() const;

private:
    static constexpr std::int64_t lowest = std::numeric_limits<std::int64_t>::min();
    static constexpr std::int64_t highest = std::numeric_limits<std::int64_t>::max();

    Int3 low_{highest, highest, highest};
    Int3 high_{lowest, lowest, lowest};
    double radii_ = 0;
    double speeds_ = 0;
    double top_squared_ = 0;
    std::size_t moving_ = 0;
};

template <class Real>
Census take_census(const Bodies<Real>& bodies);

/// Turns positions into ticks, conservatively: balls are a few ticks larger than the truth, never smaller.
class Ticks {
public:
    Ticks() = default;
    /// `scale` (m) is the length that is to be some 2^15 ticks where an axis is not periodic.
    Ticks(const Bounds& bounds, const Resolution& resolution, double scale);

    /// A ball around x (units) + d (m), a little larger than `radius` (m): conservative.
    [[nodiscard]] Ball ball(const Int3& x, const Vec3& d, double radius) const {
        constexpr double rounding = 1 + 2e-6;
        constexpr double ticks_off = 4;
        return {of(x, d), static_cast<float>(radius * rounding + ticks_off * longest_tick_)};
    }

    /// A position, to within a tick along each axis.
    [[nodiscard]] std::array<Tick, 3> of(const Int3& x) const {
        return {base(axes_[0], x.x), base(axes_[1], x.y), base(axes_[2], x.z)};
    }
    /// The same, moved on by `d` (m).
    [[nodiscard]] std::array<Tick, 3> of(const Int3& x, const Vec3& d) const {
        const auto moved = [](const Axis& axis, std::int64_t from, double metres) {
            constexpr double far = 4e18; // more is nonsense on any torus
            const double ticks = std::clamp(metres * axis.per_metre, -far, far);
            return base(axis, from) + static_cast<Tick>(static_cast<std::int64_t>(ticks));
        };
        return {moved(axes_[0], x.x, d.x), moved(axes_[1], x.y, d.y), moved(axes_[2], x.z, d.z)};
    }
    [[nodiscard]] std::array<double, 3> metres_per_tick() const {
        return {1 / axes_[0].per_metre, 1 / axes_[1].per_metre, 1 / axes_[2].per_metre};
    }

    /// The axes, and how far the bodies' positions extend along each.
    [[nodiscard]] Cells::Axes axes(const Census& census) const;

private:
    struct Axis {
        std::int64_t start = 0; ///< units
        int shift = 0;          ///< units to ticks where the axis is not periodic
        double per_unit = 0;    ///< ticks per unit where it is, else 0
        double per_metre = 0;   ///< ticks per m
    };

    static Tick base(const Axis& axis, std::int64_t x) {
        if (axis.per_unit == 0) return static_cast<Tick>(x >> axis.shift);
        return static_cast<Tick>(static_cast<std::int64_t>(static_cast<double>(x - axis.start) * axis.per_unit));
    }

    std::array<Axis, 3> axes_{};
    double longest_tick_ = 0; ///< m
};

/// Widens [low, high] by the apex of a parabola, if it has one between t0 and t1.
inline void include_apex(double speed, double acceleration, double t0, double t1, double& low, double& high) {
    if (acceleration == 0) return;
    const double apex = -speed / acceleration;
    if (apex <= t0 || apex >= t1) return;
    const double d = 0.5 * speed * apex;
    low = std::min(low, d);
    high = std::max(high, d);
}

/// A ball that holds a motion over [from, to] (s since the start of the step, not before motion.t), and `slack` (m)
/// more.
template <class Real>
Ball swept_ball(const Ticks& ticks, const Motion<Real>& motion, const Vec3& acceleration, double from, double to,
                double slack = 0) {
    const Vec3 v = velocity_of(motion);
    const double t0 = from - motion.t;
    const double t1 = to - motion.t;
    const bool curved = acceleration != Vec3{};
    const Vec3 a = curved ? displacement(v, acceleration, t0) : v * t0;
    const Vec3 b = curved ? displacement(v, acceleration, t1) : v * t1;
    Vec3 low{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
    Vec3 high{std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
    if (curved) {
        include_apex(v.x, acceleration.x, t0, t1, low.x, high.x);
        include_apex(v.y, acceleration.y, t0, t1, low.y, high.y);
        include_apex(v.z, acceleration.z, t0, t1, low.z, high.z);
    }
    return ticks.ball(motion.x, (low + high) * 0.5,
                      0.5 * length(high - low) + static_cast<double>(motion.radius) + slack);
}

} // namespace carom::core
