#include "scene/metrics.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace carom::scene {

namespace {

/// A sum that carries its own rounding errors along (Neumaier 1974).
class CompensatedSum {
public:
    void add(double value) {
        const double sum = sum_ + value;
        rounding_ += std::abs(sum_) >= std::abs(value) ? (sum_ - sum) + value : (value - sum) + sum_;
        sum_ = sum;
    }
    [[nodiscard]] double value() const { return sum_ + rounding_; }

private:
    double sum_ = 0;
    double rounding_ = 0;
};

double sum_of_speeds_times_masses(const World& world) {
    const std::vector<BodyId> ids = world.ids();
    std::vector<Vec3> velocities(ids.size());
    std::vector<double> masses(ids.size());
    world.get(ids, {.velocity = velocities, .mass = masses});
    CompensatedSum sum;
    for (std::size_t i = 0; i < ids.size(); ++i) {
        if (masses[i] != infinite_mass) sum.add(masses[i] * length(velocities[i]));
    }
    return sum.value();
}

double dissipated(const Ledger& ledger) {
    return ledger.lost_to_restitution + ledger.lost_to_friction + ledger.lost_to_drag;
}

/// J that the books do not account for.
double imbalance(const Books& start, const Books& end) {
    CompensatedSum change;
    for (const double term : {end.kinetic, -start.kinetic, end.potential, -start.potential, end.dissipated,
                              -start.dissipated, start.work, -end.work}) {
        change.add(term);
    }
    return change.value();
}

} // namespace

double energy_lost(const Ledger& ledger) { return dissipated(ledger) - ledger.prescribed_work; }

Books read_books(const World& world) {
    const Energy energy = world.energy();
    return {.kinetic = energy.kinetic,
            .potential = energy.potential,
            .dissipated = dissipated(world.ledger()),
            .work = world.ledger().prescribed_work,
            .momentum = world.momentum(),
            .outer_impulse = world.ledger().outer_impulse,
            .momentum_scale = sum_of_speeds_times_masses(world)};
}

double energy_balance(const Books& start, const Books& end) {
    const double scale = std::max({start.kinetic, end.kinetic, std::abs(start.potential), std::abs(end.potential),
                                   std::abs(end.dissipated - start.dissipated), std::abs(end.work - start.work)});
    return scale == 0 ? 0 : imbalance(start, end) / scale;
}

double energy_drift(const Books& start, const Books& end) {
    const double scale = std::max(start.kinetic, end.kinetic);
    return scale == 0 ? 0 : imbalance(start, end) / scale;
}

double momentum_drift(const Books& start, const Books& end) {
    const double scale = std::max(start.momentum_scale, end.momentum_scale);
    if (scale == 0) return 0;
    const Vec3 change = end.momentum - start.momentum;
    const Vec3 given = end.outer_impulse - start.outer_impulse;
    return length(change - given) / scale;
}

} // namespace carom::scene
