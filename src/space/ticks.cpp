#include "space/ticks.hpp"

#include <algorithm>

namespace carom::core {

template <class Real>
Census take_census(const Bodies<Real>& bodies) {
    Census census;
    if (bodies.size() == 0) return census;
    census.low = census.high = bodies.motion.front().x;
    double radii = 0;
    double speeds = 0;
    double top_squared = 0;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        prefetch_ahead(bodies.motion.data() + i);
        const Motion<Real>& m = bodies.motion[i];
        census.low = {std::min(census.low.x, m.x.x), std::min(census.low.y, m.x.y), std::min(census.low.z, m.x.z)};
        census.high = {std::max(census.high.x, m.x.x), std::max(census.high.y, m.x.y), std::max(census.high.z, m.x.z)};
        if (bodies.kind[i] == Kind::fixed) continue;
        const Vec3 v = velocity_of(m);
        radii += static_cast<double>(m.radius);
        speeds += std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
        top_squared = std::max(top_squared, length_squared(v));
        ++census.moving;
    }
    census.top_speed = std::sqrt(top_squared);
    if (census.moving > 0) {
        census.mean_radius = radii / static_cast<double>(census.moving);
        // Over all directions the sum of the components' sizes is 3/2 of the length.
        census.typical_speed = speeds / 1.5 / static_cast<double>(census.moving);
    }
    return census;
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
    constexpr double short_ticks = 1.0e9;
    surely_short_ = short_ticks / std::max({axes_[0].per_metre, axes_[1].per_metre, axes_[2].per_metre});
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
