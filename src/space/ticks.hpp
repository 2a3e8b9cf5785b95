/// \file
/// From motions to swept boxes: the conversion of positions to ticks.
#pragma once

#include "space/bounds.hpp"
#include "space/cells.hpp"

#include <array>

namespace carom::core {

/// What the choice of cells and windows needs to know of all bodies: it affects speed only.
struct Census {
    Int3 low{};               ///< units, of the bodies' positions
    Int3 high{};              ///< units
    double mean_radius = 0;   ///< m, of the bodies that are not static
    double rms_speed = 0;     ///< m/s, of the bodies that are not static
    double top_speed = 0;     ///< m/s
    std::size_t moving = 0;   ///< bodies that are not static
};

template <class Real>
Census take_census(const Bodies<Real>& bodies);

/// Turns positions into ticks, conservatively: boxes are a few ticks larger than the truth, never smaller.
class Ticks {
public:
    Ticks() = default;
    /// `scale` (m) is the length that is to be some 2^15 ticks where an axis is not periodic.
    Ticks(const Bounds& bounds, const Resolution& resolution, double scale);

    /// The box of a body at `x` (units) that moves from `low` to `high` (m, relative to x) and has a radius (m).
    [[nodiscard]] SweptBox box(const Int3& x, const Vec3& low, const Vec3& high, double radius) const {
        SweptBox box;
        set_axis<0>(box, x.x, low.x - radius, high.x + radius);
        set_axis<1>(box, x.y, low.y - radius, high.y + radius);
        set_axis<2>(box, x.z, low.z - radius, high.z + radius);
        return box;
    }

    /// The axes, and how far the bodies' positions extend along each.
    [[nodiscard]] Cells::Axes axes(const Census& census) const;

private:
    struct Axis {
        std::int64_t start = 0;   ///< units
        int shift = 0;            ///< units to ticks where the axis is not periodic
        double per_unit = 0;      ///< ticks per unit where it is, else 0
        double per_metre = 0;     ///< ticks per m
    };

    template <std::size_t K>
    void set_axis(SweptBox& box, std::int64_t x, double low, double high) const {
        const Axis& axis = axes_[K];
        // A tick of room on each side for the truncations, and one for the rounding of x.
        constexpr double most = 4.0e9;
        const double first = low * axis.per_metre;
        const double last = high * axis.per_metre;
        constexpr double far = 1.0e18;
        if (!(last - first < most && first > -far && last < far)) {
            box.length[K] = 0xffffffffU;
            return;
        }
        const std::int64_t from = static_cast<std::int64_t>(first) - 2;
        const std::int64_t to = static_cast<std::int64_t>(last) + 2;
        box.lo[K] = base(axis, x) + static_cast<Tick>(from);
        box.length[K] = static_cast<Tick>(to - from);
    }

    static Tick base(const Axis& axis, std::int64_t x) {
        if (axis.per_unit == 0) return static_cast<Tick>(x >> axis.shift);
        return static_cast<Tick>(static_cast<std::int64_t>(static_cast<double>(x - axis.start) * axis.per_unit));
    }

    std::array<Axis, 3> axes_{};
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

/// The box of a motion over [from, to] (s since the start of the step, not before motion.t), with `slack` (m) more on
/// each side.
template <class Real>
SweptBox swept_box(const Ticks& ticks, const Motion<Real>& motion, const Vec3& acceleration, double from, double to,
                   double slack = 0) {
    const Vec3 v = velocity_of(motion);
    const double t0 = from - motion.t;
    const double t1 = to - motion.t;
    const Vec3 a = displacement(v, acceleration, t0);
    const Vec3 b = displacement(v, acceleration, t1);
    Vec3 low{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)};
    Vec3 high{std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)};
    if (acceleration != Vec3{}) {
        include_apex(v.x, acceleration.x, t0, t1, low.x, high.x);
        include_apex(v.y, acceleration.y, t0, t1, low.y, high.y);
        include_apex(v.z, acceleration.z, t0, t1, low.z, high.z);
    }
    return ticks.box(motion.x, low, high, static_cast<double>(motion.radius) + slack);
}

} // namespace carom::core
