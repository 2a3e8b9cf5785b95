/// \file
/// A search for the first root that can skip none.
#pragma once

#include <carom/time_of_impact.hpp>

#include <algorithm>
#include <cmath>

namespace carom::detail {

/// s until `height + slope t + curvature t^2 / 2` comes down to zero, from height >= 0; infinite if it does not.
inline double time_to_fall(double height, double slope, double curvature) {
    const double discriminant = slope * slope - 2 * curvature * height;
    if (slope >= 0 && !(curvature < 0)) return no_impact;
    if (slope < 0) return discriminant >= 0 ? 2 * height / (std::sqrt(discriminant) - slope) : no_impact;
    return (slope + std::sqrt(discriminant)) / -curvature;
}

/// The touch rule of time_of_impact.hpp for a gap along a curve: the first time in [0, horizon] at which it comes down
/// to zero, or to what it is now if that is less and it never gets clear; no_impact if it does not.
///
/// The curve has value(t) and slope(t), and begins_to_fall() where it is at rest now. Of safe_step(t, height, slope) it
/// promises that it does not fall by `height` in less; where it does not fall, steps are least_step() at least, in
/// which it can fall by no more than rounding(t), the error of its values.
template <class Curve>
double first_descent(const Curve& curve, double horizon) {
    constexpr int most_steps = 1'000'000;
    constexpr double converged = 0x1p-52;
    double level = std::min(curve.value(0), 0.0);
    const double first_slope = curve.slope(0);
    if (curve.value(0) <= 0 && (first_slope < 0 || (first_slope == 0 && curve.begins_to_fall()))) return 0;
    double t = 0;
    for (int k = 0; k < most_steps && t <= horizon; ++k) {
        const double value = curve.value(t);
        const double slope = curve.slope(t);
        if (value > 0) level = 0;
        const double height = std::max(0.0, value - level);
        double step = curve.safe_step(t, height, slope);
        if (slope < 0) {
            if (height <= curve.rounding(t) || step <= converged * t) return t;
        } else {
            step = std::max(step, curve.least_step());
        }
        t += step;
    }
    return no_impact;
}

} // namespace carom::detail
