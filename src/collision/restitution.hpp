/// \file
/// Restitution that depends on the approach speed.
#pragma once

#include <carom/body.hpp>

namespace carom::core {

/// What yields in an encounter, as seen from its middle.
struct Yielder {
    double mass = 0;   ///< kg, of two bodies the reduced mass; a body's own against what does not yield
    double radius = 0; ///< m, of two bodies the reduced radius; a body's own against a plane
};

/// `m_a m_b / (m_a + m_b)`, and the radii likewise.
Yielder reduced(const Yielder& a, const Yielder& b);

/// e at an approach speed (m/s), in [0, 1]; 1 where nothing approaches.
double restitution_by(const RestitutionLaw& law, const Yielder& yielder, double speed);

} // namespace carom::core
