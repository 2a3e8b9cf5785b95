/// Whether a time of impact keeps what the header promises, judged by the gap itself: sampled densely in long double,
/// with every turning point between the samples searched out. Nothing here knows how the time was found.
#pragma once

#include "random_input.hpp"

#include <carom/collision.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <sstream>
#include <string>

namespace carom::test {

/// Unit of all errors of a gap, and what is allowed.
inline const std::string unit_of_gap = "error of the gap in eps (path length + contact distance)";
constexpr Real tolerance = 16;

/// A path in long double.
struct Motion {
    Wide p, v, a;

    Motion(const Vec3& position, const Vec3& velocity, const Vec3& acceleration)
        : p(widened(position)), v(widened(velocity)), a(widened(acceleration)) {}

    [[nodiscard]] Wide at(Real t) const { return p + v * t + a * (t * t / 2); }
    [[nodiscard]] Wide velocity_at(Real t) const { return v + a * t; }
    /// At least the length of the path up to t, and as much as all its terms in the sum above.
    [[nodiscard]] Real path_length(Real t) const { return length(v) * t + length(a) * t * t / 2; }
};

/// The gap of a pair along a path, its rate of change, and the length that its rounding is measured by.
struct Gap {
    Motion motion;
    Real contact;
    std::function<Real(const Wide&)> of;
    std::function<Wide(const Wide&)> gradient;
    Real growth = 0; ///< m/s, of the contact distance

    [[nodiscard]] Real at(Real t) const { return of(motion.at(t)) - growth * t; }
    [[nodiscard]] Real rate(Real t) const { return dot(gradient(motion.at(t)), motion.velocity_at(t)) - growth; }
    [[nodiscard]] Real unit(Real t) const {
        return eps<double> * (motion.path_length(t) + contact + std::abs(growth) * t);
    }
};

/// The most extreme value of the gap between two samples on either side of an extreme one: ternary search.
inline Real extreme_gap(const Gap& gap, Real low, Real high, Real sign) {
    for (int i = 0; i < 120; ++i) {
        const Real left = low + (high - low) / 3;
        const Real right = high - (high - low) / 3;
        (sign * gap.at(left) < sign * gap.at(right) ? low : high) =
            sign * gap.at(left) < sign * gap.at(right) ? left : right;
    }
    return gap.at(low + (high - low) / 2);
}

/// What a checked time was worth: empty without a fault, and the error of its gap in units of eps (path + contact).
struct Verdict {
    std::string fault;
    double error = 0;
};

/// Checks a time of impact.
class Judge {
public:
    explicit Judge(const Gap& gap) : gap_(gap), start_(gap.at(0)) {}

    Verdict check(Real time, Real horizon) {
        const bool hit = time != static_cast<Real>(no_impact);
        if (hit && (time < 0 || time > horizon)) {
            return {"outside [0, horizon]"};
        }
        const Real noise = tolerance * gap_.unit(0);
        const bool approaching = gap_.rate(0) < 0;
        if (time == 0) {
            return {start_ <= noise && approaching ? "" : "now, but not touching and approaching"};
        }
        if (start_ <= 0 && approaching) {
            if (start_ < -noise) {
                return {"touching and approaching, but not now"};
            }
            start_ = std::numeric_limits<Real>::min(); // within rounding of just before the contact
        }
        if (!follow(hit ? time : horizon)) {
            return {hit ? "an impact before the one that was found" : "an impact that was not found"};
        }
        return hit ? check_hit(time) : Verdict{};
    }

private:
    /// Follows the gap up to the given time; false if it falls through what counts as contact on the way.
    bool follow(Real end) {
        constexpr int samples = 500;
        Real before = start_;
        Real here = gap_.at(end / samples);
        for (int i = 1; i < samples; ++i) {
            const Real after = gap_.at(end * (i + 1) / samples);
            Real reached = here;
            if ((here <= before && here <= after) || (here >= before && here >= after)) {
                reached = extreme_gap(gap_, end * (i - 1) / samples, end * (i + 1) / samples, here >= after ? 1 : -1);
            }
            highest_ = std::max({highest_, here, reached});
            const Real noise = tolerance * gap_.unit(end * (i + 1) / samples);
            if (std::min(here, reached) < level(noise) - noise) {
                return false;
            }
            before = here;
            here = after;
        }
        return true;
    }

    /// The gap that counts as contact, after the highest gap so far, if that is above the noise.
    [[nodiscard]] Real level(Real noise) const { return start_ > 0 || highest_ > noise ? 0 : start_; }

    [[nodiscard]] Verdict check_hit(Real time) const {
        const Real unit = gap_.unit(time);
        const Real noise = tolerance * unit;
        const Real gap = gap_.at(time);
        Real error = std::abs(gap - level(noise));
        if (start_ <= 0 && std::abs(std::max(highest_, gap)) <= noise) {
            // Whether it got clear is below the rounding: either rule may hold.
            error = std::min(std::abs(gap), std::abs(gap - start_));
        }
        if (error > noise) {
            return {"the gap is not closed", static_cast<double>(error / unit)};
        }
        // Within rounding of a turning point the rate is below this; anything above is a gap that opens.
        const Real speed = length(gap_.motion.velocity_at(time)) + std::abs(gap_.growth);
        const Real bending = speed * speed / std::max(gap_.contact, unit) + length(gap_.motion.a);
        if (gap_.rate(time) > 2 * std::sqrt(noise * bending)) {
            return {"the gap opens"};
        }
        return {"", static_cast<double>(error / unit)};
    }

    const Gap& gap_;
    Real start_;
    Real highest_ = -1e300L;
};

/// A path to try, in units in which the contact distance is about 1.
struct Trial {
    Vec3 p, v, a;
    double horizon;

    /// The same in other units of length and time.
    [[nodiscard]] Trial in_units(double metre, double second) const {
        return {p * metre, v * (metre / second), a * (metre / (second * second)), horizon * second};
    }
};

/// The bits of a trial and what became of it, for the report of a failure.
inline std::string describe(const Trial& trial, double time, const Verdict& verdict) {
    std::ostringstream text;
    text << verdict.fault << " (time " << time << ", error " << verdict.error << "):" << std::hexfloat;
    for (const Vec3& part : {trial.p, trial.v, trial.a}) {
        text << " {" << part.x << ", " << part.y << ", " << part.z << "}";
    }
    text << ", horizon " << trial.horizon;
    return text.str();
}

/// A path that is at `target` at some time, with a velocity there along `heading` (of any length).
inline Trial path_through(const Vec3& target, const Vec3& heading) {
    const double time = decades(-1, chance(0.2) ? 4 : 1);
    const Vec3 velocity = heading * decades(-1, 1);
    const Vec3 acceleration = direction() * (chance(0.2) ? 0 : decades(-2, 1) / (chance(0.5) ? 1 : time));
    return {target - velocity * time + acceleration * (time * time / 2), velocity - acceleration * time, acceleration,
            time * between(0.5, 4)};
}

/// A heading against the normal: anything, or within 10^-8 of tangential.
inline Vec3 heading_against(const Vec3& normal) {
    const Vec3 tangent = contact_normal(cross(normal, direction()), Vec3{});
    return chance(0.5) ? tangent - normal * decades(-2, 1) : tangent + normal * (between(-1, 1) * decades(-8, 0));
}

/// A body that touches or overlaps by `depth` in the direction of -normal, and parts to come back or not.
inline Trial parting_from(const Vec3& position, const Vec3& normal) {
    const Vec3 velocity = normal * decades(-3, 0) + direction() * (chance(0.5) ? decades(-3, 0) : 0);
    const Vec3 acceleration = chance(0.8) ? direction() * 0.3 - normal * decades(-2, 1) : direction();
    return {position, velocity, acceleration, decades(-1, 2)};
}

} // namespace carom::test
