#include "collision/vibrating_plane.hpp"

#include "collision/portable_math.hpp"
#include "collision/safe_steps.hpp"

namespace carom::detail {

namespace {

class VibratingGap {
public:
    VibratingGap(double gap, double velocity, double acceleration, const Vibration& vibration)
        : gap_(gap), velocity_(velocity), acceleration_(acceleration), vibration_(vibration),
          start_(sin(vibration.phase)),
          least_curvature_(acceleration - vibration.amplitude * vibration.frequency * vibration.frequency) {}

    [[nodiscard]] double value(double t) const {
        return still(t) - vibration_.amplitude * (sin(vibration_.phase + vibration_.frequency * t) - start_);
    }
    [[nodiscard]] double slope(double t) const {
        const double swing = vibration_.amplitude * vibration_.frequency;
        return velocity_ + acceleration_ * t - swing * cos(vibration_.phase + vibration_.frequency * t);
    }
    [[nodiscard]] bool begins_to_fall() const {
        return acceleration_ + vibration_.amplitude * vibration_.frequency * vibration_.frequency * start_ < 0;
    }
    [[nodiscard]] double safe_step(double t, double height, double slope) const {
        const double above_highest = still(t) - vibration_.amplitude * (1 - start_);
        const double near = time_to_fall(height, slope, least_curvature_);
        if (!(above_highest > 0)) return near;
        return std::max(near, time_to_fall(above_highest, velocity_ + acceleration_ * t, acceleration_));
    }
    [[nodiscard]] double least_step() const {
        constexpr double part = 0x1p-30;
        return part / vibration_.frequency;
    }
    [[nodiscard]] double rounding(double t) const {
        constexpr double errors = 0x1p-51;
        const double way = (std::abs(velocity_) + 0.5 * std::abs(acceleration_) * t) * t;
        return errors * (std::abs(gap_) + way + 2 * vibration_.amplitude);
    }

private:
    /// The gap if the plane stood still.
    [[nodiscard]] double still(double t) const { return gap_ + (velocity_ + 0.5 * acceleration_ * t) * t; }

    double gap_;
    double velocity_;
    double acceleration_;
    Vibration vibration_;
    double start_;
    double least_curvature_;
};

} // namespace

double time_to_vibrating_plane(double gap, double velocity, double acceleration, const Vibration& vibration,
                               double horizon) {
    return first_descent(VibratingGap(gap, velocity, acceleration, vibration), horizon);
}

} // namespace carom::detail
