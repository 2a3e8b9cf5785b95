/// \file
/// Times of impact from the states of bodies: pure functions, the same bits whoever asks and in whichever window.
#pragma once

#include "contact/rest.hpp"
#include "space/state.hpp"

#include <carom/time_of_impact.hpp>

namespace carom::core {

/// Two bodies seen at one time.
struct Meeting {
    Vec3 d_a{};   ///< m, how far a has come since its own time
    Vec3 d_b{};   ///< m
    Vec3 v_a{};   ///< m/s
    Vec3 v_b{};   ///< m/s
    Vec3 delta{}; ///< m, from a to b, the nearest image
};

template <class Real>
Meeting meeting_at(const State<Real>& state, Index a, Index b, double time) {
    const Motion<Real>& m_a = state.bodies.motion[a];
    const Motion<Real>& m_b = state.bodies.motion[b];
    const Vec3 a_a = acceleration_of(state, a);
    const Vec3 a_b = acceleration_of(state, b);
    Meeting m;
    m.d_a = displacement(velocity_of(m_a), a_a, time - m_a.t);
    m.d_b = displacement(velocity_of(m_b), a_b, time - m_b.t);
    m.v_a = velocity_of(m_a) + a_a * (time - m_a.t);
    m.v_b = velocity_of(m_b) + a_b * (time - m_b.t);
    m.delta = separation(state, a, b, m.d_a, m.d_b);
    return m;
}

/// When two bodies meet next, s since the start of the step, or no_impact if not before `until`. `now`: what has
/// happened before does not count; only used to tell periodic images apart.
template <class Real>
double predict_pair(const State<Real>& state, Index i, Index j, double now, double until);

/// When a body meets one wall of the region next, s since the start of the step, or no_impact if not before `until`.
template <class Real>
double predict_wall(const State<Real>& state, Index body, std::uint32_t wall, double until);

/// Whether a body already rests against a support.
template <class Real>
bool rests_on(const Bodies<Real>& bodies, Index body, std::uint32_t code) {
    if (bodies.kind[body] != Kind::held) return false;
    const auto& supports = hold_of(bodies, body).supports;
    return std::any_of(supports.begin(), supports.end(), [code](const Support& s) { return s.code == code; });
}

} // namespace carom::core
