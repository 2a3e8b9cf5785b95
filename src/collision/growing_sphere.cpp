#include "collision/growing_sphere.hpp"

#include "collision/safe_steps.hpp"

#include <carom/time_of_impact.hpp>

namespace carom::detail {

namespace {

constexpr double some_roundings = 0x1p-50;
/// A step at rest, as a part of the horizon: with accelerations that are not far larger than others, it skips nothing.
constexpr double least_part = 0x1p-40;

/// The gap between two spheres: |p| - (R + G t).
class SphereGap {
public:
    SphereGap(const Parabola& path, double contact_distance, double growth, double horizon)
        : path_(path), contact_distance_(contact_distance), growth_(growth), horizon_(horizon),
          least_curvature_(-length(path.acceleration)) {}

    [[nodiscard]] double value(double t) const {
        return length(path_.position_at(t)) - (contact_distance_ + growth_ * t);
    }
    [[nodiscard]] double slope(double t) const {
        return dot(direction(path_.position_at(t)), path_.velocity_at(t)) - growth_;
    }
    [[nodiscard]] bool begins_to_fall() const {
        const Vec3 n = direction(path_.position);
        const double across_squared = length_squared(path_.velocity) - dot(path_.velocity, n) * dot(path_.velocity, n);
        return across_squared + dot(path_.acceleration, path_.position) < 0;
    }
    [[nodiscard]] double safe_step(double /*t*/, double height, double slope) const {
        return time_to_fall(height, slope, least_curvature_);
    }
    [[nodiscard]] double least_step() const { return least_part * horizon_; }
    [[nodiscard]] double rounding(double t) const {
        const double way = (length(path_.velocity) + length(path_.acceleration) * t + std::abs(growth_)) * t;
        return some_roundings * (contact_distance_ + length(path_.position) + way);
    }

private:
    Parabola path_;
    double contact_distance_;
    double growth_;
    double horizon_;
    double least_curvature_;
};

/// The gap to a shell, in squares, which are smooth in its middle: (C - G t)^2 - |p|^2.
class ShellGap {
public:
    ShellGap(const Parabola& path, double clearance, double growth, double horizon)
        : path_(path), clearance_(clearance), growth_(growth), horizon_(horizon) {
        const double top_speed = length(path.velocity) + length(path.acceleration) * horizon;
        const double farthest = length(path.position) + top_speed * horizon;
        least_curvature_ = -2 * (top_speed * top_speed + farthest * length(path.acceleration));
    }

    [[nodiscard]] double value(double t) const {
        const double distance = length(path_.position_at(t));
        const double room = clearance_ - growth_ * t;
        return (room - distance) * (room + distance);
    }
    [[nodiscard]] double slope(double t) const {
        return -2 * (growth_ * (clearance_ - growth_ * t) + dot(path_.position_at(t), path_.velocity_at(t)));
    }
    [[nodiscard]] bool begins_to_fall() const {
        return growth_ * growth_ - length_squared(path_.velocity) - dot(path_.position, path_.acceleration) < 0;
    }
    [[nodiscard]] double safe_step(double /*t*/, double height, double slope) const {
        return time_to_fall(height, slope, least_curvature_);
    }
    [[nodiscard]] double least_step() const { return least_part * horizon_; }
    [[nodiscard]] double rounding(double /*t*/) const { return some_roundings * clearance_ * clearance_; }

private:
    Parabola path_;
    double clearance_;
    double growth_;
    double horizon_;
    double least_curvature_ = 0;
};

/// With the distance growing by v and the contact distance by G, the squares of both are those of one quadratic.
double growing_straight(const Vec3& delta, const Vec3& velocity, double contact_distance, double growth,
                        double horizon) {
    const double distance_squared = length_squared(delta);
    const double excess = distance_squared - contact_distance * contact_distance;
    const double parting = dot(delta, velocity);
    if (excess <= 0) {
        // The gap is convex: once it grows, it does so for good.
        return parting < growth * std::sqrt(distance_squared) && horizon >= 0 ? 0 : no_impact;
    }
    const double half_slope = parting - contact_distance * growth;
    const double square = length_squared(velocity) - growth * growth;
    if (square > 0 && half_slope >= 0) return no_impact;
    const double discriminant = half_slope * half_slope - square * excess;
    if (!(discriminant > 0)) return no_impact;
    const double spread = std::sqrt(discriminant);
    if (half_slope < 0) return within(excess / (spread - half_slope), horizon);
    return square < 0 ? within((spread + half_slope) / -square, horizon) : no_impact;
}

} // namespace

double time_to_growing_spheres(const Vec3& delta, const Vec3& velocity, const Vec3& acceleration,
                               double contact_distance, double growth, double horizon) {
    if (acceleration == Vec3{}) return growing_straight(delta, velocity, contact_distance, growth, horizon);
    return first_descent(SphereGap({delta, velocity, acceleration}, contact_distance, growth, horizon), horizon);
}

double time_to_shell_growing(const Vec3& from_centre, const Vec3& velocity, const Vec3& acceleration, double clearance,
                             double growth, double horizon) {
    return first_descent(ShellGap({from_centre, velocity, acceleration}, clearance, growth, horizon), horizon);
}

} // namespace carom::detail
