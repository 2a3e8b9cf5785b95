#include "space/ticks.hpp"

#include <algorithm>

namespace carom::core {

void CensusTaker::add(const CensusTaker& other) {
    const Int3& low = other.low_;
    const Int3& high = other.high_;
    low_ = {std::min(low_.x, low.x), std::min(low_.y, low.y), std::min(low_.z, low.z)};
    high_ = {std::max(high_.x, high.x), std::max(high_.y, high.y), std::max(high_.z, high.z)};
    radii_ += other.radii_;
    speeds_ += other.speeds_;
    top_squared_ = std::max(top_squared_, other.top_squared_);
    moving_ += other.moving_;
}

Census CensusTaker::census() const {
    Census census;
    if (low_.x > high_.x) return census;
    census.low = low_;
    census.high = high_;
    census.top_speed = std::sqrt(top_squared_);
    census.moving = moving_;
    if (moving_ > 0) {
        census.mean_radius = radii_ / static_cast<double>(moving_);
        // Over all directions the sum of the components' sizes is 3/2 of the length.
        census.typical_speed = speeds_ / 1.5 / static_cast<double>(moving_);
    }
    return census;
}

template <class Real>
Census take_census(const Bodies<Real>& bodies) {
    CensusTaker taker;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        prefetch_ahead(bodies.motion.data() + i);
        taker.count(bodies.motion[i], bodies.kind[i]);
    }
    return taker.census();
}

template Census take_census(const Bodies<float>&);
template Census take_census(const Bodies<double>&);

Ticks::Ticks(const Bounds& bounds, const Resolution& resolution, double scale) {
    constexpr double ticks_per_scale = 32768;
    const double units_per_tick = scale * resolution.per_metre / ticks_per_scale;
    int shift = 0;
    std::frexp(units_per_tick, &shift);
    shift = std::clamp(shift - 1, 0, 62);
    for (int k = 0; k < 3; ++k) {
        Axis& axis = axes_[static_cast<std::size_t>(k)];
        if (bounds.period(k) != 0) {
            axis.start = bounds.period_start(k);
            axis.per_unit = 4294967296.0 / static_cast<double>(bounds.period(k));
            axis.per_metre = axis.per_unit * resolution.per_metre;
        } else {
            axis.shift = shift;
            axis.per_metre = std::ldexp(resolution.per_metre, -shift);
        }
    }
    longest_tick_ = 1 / std::min({axes_[0].per_metre, axes_[1].per_metre, axes_[2].per_metre});
}

Cells::Axes Ticks::axes(const Census& census) const {
    Cells::Axes axes{};
    for (std::size_t k = 0; k < 3; ++k) {
        const Axis& axis = axes_[k];
        const double units = static_cast<double>(component(census.high, static_cast<int>(k))) -
                             static_cast<double>(component(census.low, static_cast<int>(k)));
        axes.metres_per_tick[k] = 1 / axis.per_metre;
        axes.extent[k] = axis.per_unit != 0 ? 4294967296.0 : std::ldexp(units, -axis.shift);
    }
    return axes;
}

} // namespace carom::core
