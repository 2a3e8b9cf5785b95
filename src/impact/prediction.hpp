/// \file
/// Times of impact from the states of bodies: pure functions, the same bits whoever asks and in whichever window.
#pragma once

#include "contact/rest.hpp"
#include "impact/events.hpp"
#include "space/state.hpp"

#include <carom/time_of_impact.hpp>

namespace carom::core {

/// A body's motion as others see it.
template <class Real>
struct Path {
    const Motion<Real>* motion = nullptr;
    Vec3 acceleration{}; ///< m/s^2
    Kind kind = Kind::free;
    std::uint32_t slot = 0;
    const Bodies<Real>* bodies = nullptr; ///< the list that has the body's properties,
    Index index = no_index;               ///< and where
};

template <class Real>
Path<Real> path_of(const State<Real>& state, Index i) {
    const Bodies<Real>& bodies = state.bodies;
    return {&bodies.motion[i], acceleration_of(state, i), bodies.kind[i], bodies.slot[i], &bodies, i};
}

/// m, at a time since the start of the step.
template <class Real>
double contact_distance(const Path<Real>& a, const Path<Real>& b, double time) {
    return radius_at(*a.bodies, a.index, time) + radius_at(*b.bodies, b.index, time);
}

/// m/s, by which the contact distance grows.
template <class Real>
double growth_of(const Path<Real>& a, const Path<Real>& b) {
    return growth_of(*a.bodies, a.index) + growth_of(*b.bodies, b.index);
}

/// Two bodies seen at one time.
struct Meeting {
    Vec3 d_a{};   ///< m, how far a has come since its own time
    Vec3 d_b{};   ///< m
    Vec3 v_a{};   ///< m/s
    Vec3 v_b{};   ///< m/s
    Vec3 delta{}; ///< m, from a to b, the nearest image
};

template <class Real>
Meeting meeting_at(const State<Real>& state, const Path<Real>& a, const Path<Real>& b, double time) {
    const Motion<Real>& m_a = *a.motion;
    const Motion<Real>& m_b = *b.motion;
    Meeting m;
    m.d_a = displacement(velocity_of(m_a), a.acceleration, time - m_a.t);
    m.d_b = displacement(velocity_of(m_b), b.acceleration, time - m_b.t);
    m.v_a = velocity_of(m_a) + a.acceleration * (time - m_a.t);
    m.v_b = velocity_of(m_b) + b.acceleration * (time - m_b.t);
    m.delta = separation(state, m_a, m_b, m.d_a, m.d_b);
    return m;
}

/// m/s^2 with which two bodies that touch are pressed together along n, from a to b: what accelerates them, less what
/// their sliding round each other takes. `velocity` and `pull` are of b relative to a.
inline double pressing_along(const Vec3& n, double distance, const Vec3& velocity, const Vec3& pull) {
    const double across = dot(velocity, n);
    const double sliding_squared = std::max(0.0, length_squared(velocity) - across * across);
    return -dot(pull, n) - (distance > 0 ? sliding_squared / distance : 0);
}

/// When two bodies meet next, s since the start of the step, or no_impact if not before `until`. `now`: what has
/// happened before does not count; only used to tell periodic images apart.
template <class Real>
double predict_pair(const State<Real>& state, Index i, Index j, double now, double until);

/// The same for the paths of two bodies of which neither rests on the other.
template <class Real>
double predict_paths(const State<Real>& state, const Path<Real>& i, const Path<Real>& j, double now, double until);

/// When a body meets one wall of the region or facet of an obstacle next, s since the start of the step, or no_impact
/// if not in this step.
template <class Real>
double predict_wall(const State<Real>& state, Index body, std::uint32_t wall);

/// Calls f(time, wall) for every wall and facet that a body meets until `until`.
template <class Real, class F>
void for_each_wall_event(const State<Real>& state, Index body, double until, F&& f) {
    if (is_prescribed(state.bodies.kind[body])) return;
    const Motion<Real>& m = state.bodies.motion[body];
    const double reach = reach_of(m, acceleration_of(state, body), until) + state.bodies.top_growth * until;
    const auto look = [&](std::uint32_t wall) {
        const double time = predict_wall(state, body, wall);
        if (time <= until) f(time, Event::wall_bit | wall);
    };
    const std::uint32_t first_facet = state.bounds.first_facet();
    if (state.bounds.may_touch_wall(m.x, reach, state.resolution)) {
        for (std::uint32_t wall = 0; wall < first_facet; ++wall) look(wall);
    }
    if (const Obstacles* obstacles = state.bounds.obstacles()) {
        obstacles->for_each_near(m.x, reach, [&](std::uint32_t facet) { look(first_facet + facet); });
    }
}

/// Whether a body stays within the world for `duration` s unless something strikes it.
template <class Real>
bool stays_in_world(const State<Real>& state, Index body, double duration);

/// Whether a body already rests against a support.
template <class Real>
bool rests_on(const Bodies<Real>& bodies, Index body, std::uint32_t code) {
    if (bodies.kind[body] != Kind::held) return false;
    const auto& supports = hold_of(bodies, body).supports;
    return std::any_of(supports.begin(), supports.end(), [code](const Support& s) { return s.code == code; });
}

} // namespace carom::core
