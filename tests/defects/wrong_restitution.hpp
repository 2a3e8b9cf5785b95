/// \file
/// A response whose restitution has the wrong sign: bodies do not part, they go on with e times their approach.
#pragma once

#include <carom/collision.hpp>

namespace carom::core {

inline Response<double> respond(const Vec3& n, double m_a, Vec3& v_a, double m_b, Vec3& v_b, double e, double mu) {
    return detail::respond(n, m_a, v_a, m_b, v_b, -e, mu);
}

} // namespace carom::core
