#include "observe/checks.hpp"

#include <carom/observers.hpp>

#include <algorithm>
#include <cmath>

namespace carom {

Profile::Profile(std::size_t axis, double low, double high, std::size_t slices, double area)
    : axis_(axis), low_(low), width_((high - low) / static_cast<double>(slices)), area_(area) {
    observe::check_axis(axis);
    observe::check_interval(low, high);
    observe::check_count("slices", slices);
    observe::check_positive("area", area);
    sums_.resize(slices);
    density_.resize(slices);
    energy_.resize(slices);
    mass_.resize(slices);
    for (auto& component : velocity_) component.resize(slices);
}

void Profile::observe(const Sample& sample) {
    std::fill(sums_.begin(), sums_.end(), Sums{});
    for (std::size_t i = 0; i < sample.position.size(); ++i) {
        const double slice = (observe::component(sample.position[i], axis_) - low_) / width_;
        const double mass = sample.mass[i];
        if (mass == infinite_mass || !(slice >= 0 && slice < static_cast<double>(sums_.size()))) continue;
        Sums& sums = sums_[static_cast<std::size_t>(slice)];
        ++sums.bodies;
        sums.mass += mass;
        sums.energy += mass * length_squared(sample.velocity[i]);
        sums.momentum += mass * sample.velocity[i];
    }
    for (std::size_t s = 0; s < sums_.size(); ++s) {
        const Sums& sums = sums_[s];
        density_[s].add(sums.bodies / (area_ * width_));
        // Bodies, not samples, have equal weight: an empty slice says nothing about its temperature.
        const double bodies = std::max(sums.bodies, 1.0);
        energy_[s].add(sums.energy / bodies, sums.bodies);
        mass_[s].add(sums.mass / bodies, sums.bodies);
        for (std::size_t k = 0; k < 3; ++k) {
            const double momentum = observe::component(sums.momentum, k);
            velocity_[k][s].add(sums.mass > 0 ? momentum / sums.mass : 0, sums.mass);
        }
    }
}

double Profile::position(std::size_t slice) const { return low_ + (static_cast<double>(slice) + 0.5) * width_; }

Estimate Profile::temperature(std::size_t slice) const {
    const Estimate energy = detail::element(energy_, slice, "slice").estimate();
    double flow = 0;
    for (const auto& component : velocity_) {
        const double u = component[slice].estimate().value;
        flow += u * u;
    }
    return {(energy.value - mass_[slice].estimate().value * flow) / 3, energy.standard_error / 3};
}

Estimate Profile::velocity(std::size_t slice, std::size_t component) const {
    observe::check_axis(component);
    return detail::element(velocity_[component], slice, "slice").estimate();
}

} // namespace carom
