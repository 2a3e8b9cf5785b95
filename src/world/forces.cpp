#include "collision/portable_math.hpp"
#include "contact/rest.hpp"
#include "world/engine.hpp"

#include <algorithm>

namespace carom::core {

namespace {

/// Loops over bodies have parts of at least so many.
constexpr std::size_t kick_grain = 4096;

/// What is left of a speed (m/s) after `duration` s of dv/dt = -(linear + quadratic v) v: the exact solution
/// E / (1 + (quadratic / linear) v (1 - E)), E = exp(-linear duration). A negative duration undoes drag, at most to
/// twice the speed.
double drag_factor(const Drag& drag, double speed, double duration) {
    const double exponent = drag.linear * duration;
    const double decay = detail::exp(-exponent);
    // (1 - E) / linear, by its series where the difference would cancel.
    constexpr double small = 1e-5;
    const double stretch = std::abs(exponent) < small ? duration * (1 - exponent / 2 + exponent * exponent / 6)
                                                      : (1 - decay) / drag.linear;
    const double resistance = 1 + drag.quadratic * speed * stretch;
    return resistance > 0 ? std::min(decay / resistance, 2.0) : 2.0;
}

/// So many bodies in a row are attracted together.
constexpr std::size_t row = 32;

/// attraction() of `count` <= row bodies from the `first` on: one after another each would wait for the root and the
/// division of the one before.
template <class Real>
std::array<Vec3, row> attractions(const State<Real>& state, std::size_t first, std::size_t count) {
    std::array<Vec3, row> sums{};
    std::array<Vec3, row> d{};
    std::array<double, row> pulls{};
    for (const PointField& field : state.laws.fields) {
        for (std::size_t k = 0; k < count; ++k) {
            const bool carries = state.bodies.slot[first + k] == field.carrier;
            d[k] = carries ? Vec3{} : to_metres(field.x - state.bodies.motion[first + k].x, state.resolution);
        }
        for (std::size_t k = 0; k < count; ++k) pulls[k] = length_squared(d[k]);
        for (std::size_t k = 0; k < count; ++k) pulls[k] = pull_of(field, pulls[k]);
        for (std::size_t k = 0; k < count; ++k) sums[k] += d[k] * pulls[k];
    }
    return sums;
}

} // namespace

template <class Real>
std::vector<PointField> Engine<Real>::placed_fields() const {
    std::vector<PointField> fields;
    for (std::size_t i = 0; i < attractors_.size(); ++i) {
        const Attractor& attractor = attractors_[i];
        PointField field{.strength = attractor.strength, .softening = attractor.softening};
        if (attractor.body.is_set()) {
            field.carrier = attractor.body.slot;
            field.x = state_.bodies.motion[state_.bodies.slots[field.carrier]].x;
        } else {
            field.x = attractor_places_[i];
        }
        fields.push_back(field);
    }
    return fields;
}

template <class Real>
void Engine<Real>::first_kick(double duration) {
    attract(duration);
    drag(duration);
}

template <class Real>
void Engine<Real>::last_kick(double duration) {
    state_.laws.fields = placed_fields();
    drag(duration);
    attract(duration);
}

template <class Real>
void Engine<Real>::attract(double duration) {
    if (state_.laws.fields.empty()) return;
    Bodies<Real>& bodies = state_.bodies;
    std::array<ExactVectorSum, most_parts> impulses{};
    for_parts(*executor_, bodies.size(), kick_grain, [&](std::size_t part, std::size_t begin, std::size_t end) {
        for (std::size_t first = begin; first < end; first += row) {
            const std::size_t count = std::min(row, end - first);
            const std::array<Vec3, row> pulls = attractions(state_, first, count);
            for (std::size_t k = 0; k < count; ++k) {
                const auto i = static_cast<Index>(first + k);
                if (is_prescribed(bodies.kind[i])) continue;
                Vec3 change = pulls[k] * duration;
                if (bodies.kind[i] == Kind::held) change = kick_along_supports(state_, i, change);
                const Vec3 before = velocity_of(bodies.motion[i]);
                bodies.motion[i].v = rounded<Real>(before + change);
                impulses[part].add((velocity_of(bodies.motion[i]) - before) * static_cast<double>(bodies.mass[i]));
            }
        }
    });
    for (std::size_t part = 1; part < most_parts; ++part) impulses[0].add(impulses[part]);
    state_.books.outer_impulse.add(impulses[0].value());
}

template <class Real>
void Engine<Real>::drag(double duration) {
    const Drag& law = setting_.options.drag;
    if (law.linear == 0 && law.quadratic == 0) return;
    Bodies<Real>& bodies = state_.bodies;
    struct Loss {
        ExactVectorSum impulse;
        ExactSum energy;
    };
    std::array<Loss, most_parts> losses{};
    for_each_in_parts(*executor_, bodies.size(), kick_grain, [&](std::size_t part, std::size_t k) {
        const auto i = static_cast<Index>(k);
        if (is_prescribed(bodies.kind[i])) return;
        const Vec3 before = velocity_of(bodies.motion[i]);
        bodies.motion[i].v = rounded<Real>(before * drag_factor(law, length(before), duration));
        const Vec3 after = velocity_of(bodies.motion[i]);
        const auto mass = static_cast<double>(bodies.mass[i]);
        losses[part].impulse.add((after - before) * mass);
        losses[part].energy.add(0.5 * mass * dot(before - after, before + after));
    });
    for (std::size_t part = 1; part < most_parts; ++part) {
        losses[0].impulse.add(losses[part].impulse);
        losses[0].energy.add(losses[part].energy);
    }
    state_.books.outer_impulse.add(losses[0].impulse.value());
    state_.books.lost_to_drag.add(losses[0].energy.value());
}

#define CAROM_INSTANTIATE(Real)                                                                                        \
    template std::vector<PointField> Engine<Real>::placed_fields() const;                                              \
    template void Engine<Real>::first_kick(double);                                                                    \
    template void Engine<Real>::last_kick(double);
CAROM_INSTANTIATE(float)
CAROM_INSTANTIATE(double)
#undef CAROM_INSTANTIATE

} // namespace carom::core
