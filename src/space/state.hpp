/// \file
/// Everything that a step reads and writes: the bodies, what surrounds them, and the books.
#pragma once

#include "collision/restitution.hpp"
#include "space/bodies.hpp"
#include "space/bounds.hpp"
#include "space/sum.hpp"

#include <carom/events.hpp>

#include <algorithm>
#include <span>
#include <vector>

namespace carom::core {

/// An attractor where it is during one kick.
struct PointField {
    Int3 x{};                            ///< units
    double strength = 0;                 ///< m^3/s^2
    double softening = 0;                ///< m
    std::uint32_t carrier = 0xffffffffU; ///< slot of the body that carries it and feels nothing of it
};

/// The parameters of the motion.
struct Laws {
    Vec3 gravity{};           ///< m/s^2
    double rest_time = 0;     ///< s
    double quick_time = 0;    ///< s, of the TC rule: shorter flights are quick
    double contact_time = 0;  ///< s, how long bodies that lean on each other touch; 0 without gravity
    double collapse_time = 0; ///< s, how long an impact is remembered
    bool sleeping = true;     ///< islands that lie still fall asleep
    double kick_interval = 0; ///< s between two kicks of attractors: the length of the step
    bool wears = false;       ///< something takes energy, e < 1 or mu > 0 anywhere: elastic bounces die out, too
    std::vector<Material> materials{};
    std::vector<MaterialRule> rules{};
    std::vector<PointField> fields{};
};

/// What one event writes into the books.
struct Entry {
    double lost_to_restitution = 0; ///< J
    double lost_to_friction = 0;    ///< J
    double prescribed_work = 0;     ///< J, done by what moves as prescribed
    double held_mass_time = 0;      ///< kg s held against uniform gravity
    Vec3 outer_impulse{};           ///< N s, without uniform gravity's
};

/// The ledger while it is written: sums with their carries.
struct Books {
    Sum lost_to_restitution;
    Sum lost_to_friction;
    Sum lost_to_drag;
    Sum prescribed_work;
    Sum held_mass_time;      ///< kg s of the present step, held against uniform gravity
    VectorSum outer_impulse; ///< N s, without uniform gravity's of the present step

    void add(const Entry& entry) {
        lost_to_restitution.add(entry.lost_to_restitution);
        lost_to_friction.add(entry.lost_to_friction);
        prescribed_work.add(entry.prescribed_work);
        held_mass_time.add(entry.held_mass_time);
        outer_impulse.add(entry.outer_impulse);
    }
};

template <class Real>
struct State {
    Bodies<Real> bodies;
    Bounds bounds;
    Resolution resolution;
    Laws laws;
    Books books;
};

/// e and mu of an encounter.
struct Encounter {
    double restitution = 0;         ///< at the speed of the approach
    double friction = 0;            ///< mu
    double resting_restitution = 0; ///< what the rest rule takes
};

/// The most that the rest rule takes for e where bounces lose energy even at e = 1: where it rubs, on a slope or
/// between two, and in a pile. They would get lower without end, and each the more often: those no higher than g
/// t_rest^2 / 80 000 are a contact.
inline constexpr double most_wearing_restitution = 0.99;

/// The e that the rest rule takes on a support, of an encounter's e and mu.
inline double resting_restitution(double e, double mu) { return mu > 0 ? std::min(e, most_wearing_restitution) : e; }

/// An encounter with one e for all speeds.
inline Encounter plain_encounter(double e, double mu) { return {e, mu, resting_restitution(e, mu)}; }

/// An encounter with e by speed (m/s), at `approach`. The rest rule takes e at the speed that gravity gives in the rest
/// time, so that the limit between a contact and an impact does not depend on the approach; without it there are no
/// piles, and e at the approach speed will do.
template <class RestitutionAt>
Encounter encounter_by_speed(const Laws& laws, double approach, double mu, const RestitutionAt& restitution_at) {
    const double e = restitution_at(approach);
    const double fallen = length(laws.gravity) * laws.rest_time;
    return {e, mu, resting_restitution(fallen > 0 ? restitution_at(fallen) : e, mu)};
}

/// e of a body that meets something: by the law of its material where that has one.
template <class Real>
double restitution_of(const Laws& laws, const Bodies<Real>& bodies, Index i, const Yielder& yielder, double speed) {
    for (const Material& material : laws.materials) {
        if (material.key == bodies.material[i]) return restitution_by(material.restitution, yielder, speed);
    }
    return static_cast<double>(bodies.restitution[i]);
}

/// How two bodies, of one list or of two, meet at an approach speed (m/s): the larger e, the geometric mean of mu,
/// unless a rule says otherwise.
template <class Real>
Encounter encounter_of(const Laws& laws, const Bodies<Real>& of_a, Index a, const Bodies<Real>& of_b, Index b,
                       double approach) {
    const auto yielder = [&] {
        return reduced({static_cast<double>(of_a.mass[a]), static_cast<double>(of_a.motion[a].radius)},
                       {static_cast<double>(of_b.mass[b]), static_cast<double>(of_b.motion[b].radius)});
    };
    for (const MaterialRule& rule : laws.rules) {
        const bool straight = rule.a == of_a.material[a] && rule.b == of_b.material[b];
        const bool crossed = rule.a == of_b.material[b] && rule.b == of_a.material[a];
        if (!straight && !crossed) continue;
        if (!rule.law) return plain_encounter(rule.restitution, rule.friction);
        return encounter_by_speed(laws, approach, rule.friction, [&, pair = yielder()](double speed) {
            return restitution_by(*rule.law, pair, speed);
        });
    }
    const auto mu_a = static_cast<double>(of_a.friction[a]);
    const auto mu_b = static_cast<double>(of_b.friction[b]);
    const double mu = std::sqrt(mu_a * mu_b);
    if (laws.materials.empty())
        return plain_encounter(static_cast<double>(std::max(of_a.restitution[a], of_b.restitution[b])), mu);
    return encounter_by_speed(laws, approach, mu, [&, pair = yielder()](double speed) {
        return std::max(restitution_of(laws, of_a, a, pair, speed), restitution_of(laws, of_b, b, pair, speed));
    });
}

template <class Real>
Encounter encounter_of(const State<Real>& state, Index a, Index b, double approach) {
    return encounter_of(state.laws, state.bodies, a, state.bodies, b, approach);
}

/// How a body meets a face or an obstacle at an approach speed (m/s): the surface's e and mu where it has them, else
/// the body's.
template <class Real>
Encounter encounter_of(const State<Real>& state, Index body, const Surface& surface, double approach) {
    const Bodies<Real>& bodies = state.bodies;
    const double mu = surface.friction.value_or(static_cast<double>(bodies.friction[body]));
    if (surface.restitution) return plain_encounter(*surface.restitution, mu);
    if (state.laws.materials.empty()) return plain_encounter(static_cast<double>(bodies.restitution[body]), mu);
    const Yielder alone{static_cast<double>(bodies.mass[body]), static_cast<double>(bodies.motion[body].radius)};
    return encounter_by_speed(state.laws, approach, mu,
                              [&](double speed) { return restitution_of(state.laws, bodies, body, alone, speed); });
}

/// Whether anything takes energy.
template <class Real>
bool wears(const State<Real>& state) {
    const auto takes = [](double e, double mu) { return e < 1 || mu > 0; };
    for (const MaterialRule& rule : state.laws.rules) {
        if (rule.law || takes(rule.restitution, rule.friction)) return true;
    }
    const Bodies<Real>& bodies = state.bodies;
    if (!state.laws.materials.empty()) return true;
    for (Index i = 0; i < bodies.size(); ++i) {
        if (takes(static_cast<double>(bodies.restitution[i]), static_cast<double>(bodies.friction[i]))) return true;
    }
    for (std::uint32_t wall = 0; wall < state.bounds.size(); ++wall) {
        const Surface& surface = state.bounds.surface(wall);
        if (takes(surface.restitution.value_or(1), surface.friction.value_or(0))) return true;
    }
    return false;
}

/// What accelerates a body between impacts, m/s^2.
template <class Real>
Vec3 acceleration_of(const State<Real>& state, Index i) {
    switch (state.bodies.kind[i]) {
    case Kind::free:
        return state.laws.gravity;
    case Kind::held:
        return hold_of(state.bodies, i).acceleration;
    case Kind::fixed:
    case Kind::piled:
    case Kind::asleep:
    case Kind::kinematic:
        break;
    }
    return {};
}

/// m/s^2, what accelerates a body as far as it presses on others.
template <class Real>
Vec3 pull_on(const State<Real>& state, Index i) {
    if (state.bodies.kind[i] != Kind::piled || i >= state.bodies.loads.size()) return acceleration_of(state, i);
    return detail::wide(state.bodies.loads[i].pull);
}

/// 1/s^2: acceleration by an attractor, per metre of the way to it, whose square is `distance_squared`, m^2. Anything
/// finite where there is no way.
inline double pull_of(const PointField& field, double distance_squared) {
    const double softened = distance_squared + field.softening * field.softening;
    const double divisible = softened > 0 ? softened : 1; // chosen before the division, or loops are not vectorised
    return field.strength / (divisible * std::sqrt(divisible));
}

/// Acceleration by some attractors at the place x (units) of the body in `slot`, m/s^2.
inline Vec3 attraction(std::span<const PointField> fields, const Resolution& resolution, const Int3& x,
                       std::uint32_t slot) {
    Vec3 sum{};
    for (const PointField& field : fields) {
        if (field.carrier == slot) continue;
        const Vec3 d = to_metres(field.x - x, resolution);
        sum += d * pull_of(field, length_squared(d));
    }
    return sum;
}

/// By those of the present step.
template <class Real>
Vec3 attraction(const State<Real>& state, const Int3& x, std::uint32_t slot) {
    return attraction(state.laws.fields, state.resolution, x, slot);
}

template <class Real>
Vec3 attraction(const State<Real>& state, Index i) {
    return attraction(state, state.bodies.motion[i].x, state.bodies.slot[i]);
}

/// Shortest way along periodic axes: subtracts whole periods from a difference of positions (units) such that
/// `difference` + `d` (m) comes closest to zero, shifted by `images` periods more.
inline Int3 nearest_image(const Bounds& bounds, const Resolution& resolution, Int3 difference, const Vec3& d,
                          const Int3& images = {}) {
    for (int axis = 0; axis < 3; ++axis) {
        const std::int64_t period = bounds.period(axis);
        if (period == 0) continue;
        const double full =
            static_cast<double>(component(difference, axis)) + component(d, axis) * resolution.per_metre;
        const auto turns = static_cast<std::int64_t>(std::rint(full / static_cast<double>(period)));
        component(difference, axis) -= (turns - component(images, axis)) * period;
    }
    return difference;
}

/// m from body a to body b when they have moved by `d_a` and `d_b` (m) since their own times.
template <class Real>
Vec3 separation(const State<Real>& state, const Motion<Real>& a, const Motion<Real>& b, const Vec3& d_a,
                const Vec3& d_b) {
    Int3 difference = b.x - a.x;
    if (state.bounds.any_periodic()) {
        difference = nearest_image(state.bounds, state.resolution, difference, d_b - d_a);
    }
    return to_metres(difference, state.resolution) + (d_b - d_a);
}

/// Enters what gravity, supports and friction did to a held body on its way `d` (m) over `duration` (s). Of free bodies
/// the books know that uniform gravity acts on them all the time.
template <class Real>
void book_held_way(const State<Real>& state, Index i, const Vec3& a, const Vec3& d, double duration, Entry& entry) {
    const auto mass = static_cast<double>(state.bodies.mass[i]);
    entry.held_mass_time += mass * duration;
    entry.outer_impulse += a * (mass * duration);
    entry.lost_to_friction -= mass * dot(hold_of(state.bodies, i).friction, d);
}

/// The same of a piled body, which moves straight: what gravity did to it was or will be entered with its contacts, but
/// not the work on its way.
template <class Real>
void book_piled_way(const State<Real>& state, Index i, const Vec3& d, double duration, Entry& entry) {
    const auto mass = static_cast<double>(state.bodies.mass[i]);
    entry.held_mass_time += mass * duration;
    entry.lost_to_restitution += mass * dot(state.laws.gravity, d);
}

/// Brings a motion with constant acceleration to time `s`, and returns its way, m: the one place that rounds a
/// position.
template <class Real>
Vec3 move_on(Motion<Real>& m, const Vec3& acceleration, double s, const Resolution& resolution) {
    const double duration = s - m.t;
    const Vec3 v = velocity_of(m);
    const bool is_straight = acceleration == Vec3{};
    const Vec3 d = is_straight ? v * duration : displacement(v, acceleration, duration);
    m.t = s;
    m.x = m.x + round_to_units(d, resolution);
    if (!is_straight) m.v = rounded<Real>(v + acceleration * duration);
    return d;
}

/// Brings a body to time `s`.
template <class Real>
void advance(State<Real>& state, Index i, double s, Entry& entry) {
    Motion<Real>& m = state.bodies.motion[i];
    const double duration = s - m.t;
    const Vec3 a = acceleration_of(state, i);
    const Int3 start = m.x;
    const Vec3 d = move_on(m, a, s, state.resolution);
    if (!state.bodies.growth.empty()) m.radius = static_cast<Real>(radius_at(state.bodies, i, s));
    if (state.bodies.kind[i] == Kind::held) book_held_way(state, i, a, d, duration, entry);
    if (leans(state.bodies.kind[i])) {
        // What creeps by less than the resolution stays, and gravity does no work on it.
        book_piled_way(state, i, to_metres(m.x - start, state.resolution), duration, entry);
    }
}

} // namespace carom::core
