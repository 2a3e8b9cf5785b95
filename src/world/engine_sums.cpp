#include "space/checks.hpp"
#include "world/engine.hpp"

namespace carom::core {

namespace {

/// Calls f(index) for every body that is not static, in the order of ids: sums must not depend on places in memory.
template <class Real, class F>
void for_each_mover(const Bodies<Real>& bodies, F&& f) {
    for (const Index i : bodies.slots) {
        if (i != no_index && !is_prescribed(bodies.kind[i])) f(i);
    }
}

} // namespace

template <class Real>
Energy Engine<Real>::energy() const {
    Sum kinetic;
    Sum potential;
    const std::vector<PointField> fields = placed_fields();
    for_each_mover(state_.bodies, [&](Index i) {
        const Motion<Real>& m = state_.bodies.motion[i];
        const auto mass = static_cast<double>(state_.bodies.mass[i]);
        kinetic.add(0.5 * mass * length_squared(velocity_of(m)));
        const Vec3 from_origin = metres_from(setting_.first_origin, m.x);
        if (state_.laws.gravity != Vec3{}) potential.add(-mass * dot(state_.laws.gravity, from_origin));
        for (const PointField& field : fields) {
            if (field.carrier == state_.bodies.slot[i]) continue;
            const double distance_squared =
                length_squared(to_metres(field.x - m.x, setting_.resolution)) + field.softening * field.softening;
            if (distance_squared > 0) potential.add(-mass * field.strength / std::sqrt(distance_squared));
        }
    });
    return {kinetic.value(), potential.value()};
}

template <class Real>
Vec3 Engine<Real>::momentum() const {
    VectorSum sum;
    for_each_mover(state_.bodies, [&](Index i) {
        sum.add(velocity_of(state_.bodies.motion[i]) * static_cast<double>(state_.bodies.mass[i]));
    });
    return sum.value();
}

template <class Real>
Vec3 Engine<Real>::angular_momentum(const Vec3& about) const {
    check_finite(about, "about");
    VectorSum sum;
    for_each_mover(state_.bodies, [&](Index i) {
        const Motion<Real>& m = state_.bodies.motion[i];
        sum.add(cross(api_position(m.x) - about, velocity_of(m) * static_cast<double>(state_.bodies.mass[i])));
    });
    return sum.value();
}

template <class Real>
Vec3 Engine<Real>::centre_of_mass() const {
    VectorSum moment;
    Sum mass;
    for_each_mover(state_.bodies, [&](Index i) {
        const auto m = static_cast<double>(state_.bodies.mass[i]);
        moment.add(api_position(state_.bodies.motion[i].x) * m);
        mass.add(m);
    });
    return mass.value() > 0 ? moment.value() / mass.value() : Vec3{};
}

template Energy Engine<float>::energy() const;
template Energy Engine<double>::energy() const;
template Vec3 Engine<float>::momentum() const;
template Vec3 Engine<double>::momentum() const;
template Vec3 Engine<float>::angular_momentum(const Vec3&) const;
template Vec3 Engine<double>::angular_momentum(const Vec3&) const;
template Vec3 Engine<float>::centre_of_mass() const;
template Vec3 Engine<double>::centre_of_mass() const;

} // namespace carom::core
