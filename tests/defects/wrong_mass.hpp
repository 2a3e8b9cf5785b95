/// \file
/// A response whose reduced mass, and with it the impulse, is 1 % too large.
#pragma once

#include <carom/collision.hpp>

namespace carom::core {

inline Response<double> respond(const Vec3& n, double m_a, Vec3& v_a, double m_b, Vec3& v_b, double e, double mu) {
    const Vec3 before_a = v_a;
    const Vec3 before_b = v_b;
    Response<double> response = detail::respond(n, m_a, v_a, m_b, v_b, e, mu);
    v_a += (v_a - before_a) * 0.01;
    v_b += (v_b - before_b) * 0.01;
    response.impulse *= 1.01;
    return response;
}

} // namespace carom::core
