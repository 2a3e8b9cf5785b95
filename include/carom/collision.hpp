/// \file
/// What an impact does to the velocities of the two bodies that meet, and the classical pair function around it.
///
/// Source of the classical part: the article "Spielephysik: Kollisionen von Massenpunkten im 3D-Raum"
/// (spieleprogrammierung.net, 2010): only the velocities along the axis between the two centres change, by the laws of
/// the collision in one dimension. carom writes these laws with impulses, so that masses of 1 : 10^12 cancel nothing,
/// and lets an infinite mass (a static body) be exactly that.
///
/// SI units. The domain of every function: masses > 0 or infinite, speeds finite, restitution e in [0, 1] (World
/// refuses any other), friction mu >= 0. All arithmetic is done in double, in an order in which mirrored input gives
/// mirrored bits. Momentum, energy (e = 1) and the restitution of the result are right to 16 eps of T, relative to the
/// largest speed.
#pragma once

#include <carom/base.hpp>
#include <carom/time_of_impact.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace carom {

namespace detail {

constexpr bool is_static(double mass) { return mass == std::numeric_limits<double>::infinity(); }

/// `m_other / (m_self + m_other)`: the share of a change of the relative velocity that falls to the body itself.
/// Exactly 0 for a static body and exactly 1 against one; no sum that could overflow.
constexpr double share(double m_self, double m_other) { return is_static(m_self) ? 0.0 : 1 / (1 + m_self / m_other); }

/// Takes off a vector of about unit length what rounding has left of the difference. Square roots of what lies just
/// above 1 round down, so that a direction is too long on average if the length is near a power of two: contact
/// distances often are, and each elastic impact would gain energy.
constexpr Vec3 renormalised(const Vec3& n) {
    const double excess = ((n.x * n.x + n.y * n.y) - 0.5) + (n.z * n.z - 0.5); // without rounding a number near 1
    return n - n * (0.5 * excess);
}

constexpr double reduced_mass(double m_a, double m_b) {
    const double lighter = std::min(m_a, m_b);
    return is_static(lighter) ? lighter : lighter * share(lighter, std::max(m_a, m_b));
}

} // namespace detail

// ---------------------------------------------------------------------------------------------------------------------
// Materials
// ---------------------------------------------------------------------------------------------------------------------

/// Restitution of two materials that meet: the larger one.
template <class T>
constexpr T combined_restitution(T e_a, T e_b) {
    return std::max(e_a, e_b);
}

/// Friction of two materials that meet: the geometric mean `sqrt(mu_a mu_b)`.
template <class T>
T combined_friction(T mu_a, T mu_b) {
    return std::sqrt(mu_a * mu_b);
}

// ---------------------------------------------------------------------------------------------------------------------
// One dimension
// ---------------------------------------------------------------------------------------------------------------------

/// Reduced mass `m_a m_b / (m_a + m_b)`, kg. Against a static body it is the other mass exactly; of two static bodies
/// it is infinite, and such a pair never gets an impulse.
template <class T>
constexpr T reduced_mass(T m_a, T m_b) {
    return static_cast<T>(detail::reduced_mass(static_cast<double>(m_a), static_cast<double>(m_b)));
}

/// The velocities of two bodies on a line, m/s.
template <class T>
struct Velocities1d {
    T v_a;
    T v_b;
};

/// Velocities after an impact in one dimension with restitution e.
///
/// `v_a' = v_a - (1+e) (v_a - v_b) m_b/(m_a+m_b)`, `v_b' = v_b + (1+e) (v_a - v_b) m_a/(m_a+m_b)`: the same numbers as
/// `((1+e) m_b v_b + v_a (m_a - e m_b)) / (m_a + m_b)` and its mirror image. Masses in kg, velocities in m/s. A static
/// body keeps its velocity, two static bodies keep both. The law knows no positions: it is the caller who knows that
/// the two meet and do not part.
template <class T>
constexpr Velocities1d<T> collide_1d(T m_a, T v_a, T m_b, T v_b, T e) {
    const auto mass_a = static_cast<double>(m_a);
    const auto mass_b = static_cast<double>(m_b);
    const double change = (1 + static_cast<double>(e)) * (static_cast<double>(v_a) - static_cast<double>(v_b));
    return {static_cast<T>(static_cast<double>(v_a) - change * detail::share(mass_a, mass_b)),
            static_cast<T>(static_cast<double>(v_b) + change * detail::share(mass_b, mass_a))};
}

/// Velocities after an elastic impact in one dimension: collide_1d() with e = 1.
template <class T>
constexpr Velocities1d<T> collide_elastic_1d(T m_a, T v_a, T m_b, T v_b) {
    return collide_1d(m_a, v_a, m_b, v_b, T{1});
}

// ---------------------------------------------------------------------------------------------------------------------
// Three dimensions
// ---------------------------------------------------------------------------------------------------------------------

/// The unit vector from a to b along which an impact acts.
///
/// \param delta           centre of b minus centre of a, m
/// \param delta_velocity  velocity of b minus velocity of a, m/s
///
/// `delta / |delta|`; for coincident centres the direction of `v_a - v_b`, along which the two meet head-on; if that is
/// zero as well, (1, 0, 0). Lengths from 1e-300 to 1e300 neither overflow nor underflow.
template <class T>
Vector3<T> contact_normal(const Vector3<T>& delta, const Vector3<T>& delta_velocity) {
    if (delta != Vector3<T>{}) {
        return detail::narrow<T>(detail::renormalised(detail::direction(detail::wide(delta))));
    }
    if (delta_velocity != Vector3<T>{}) {
        return detail::narrow<T>(detail::direction(-detail::wide(delta_velocity)));
    }
    return {1, 0, 0};
}

/// What an impact did.
template <class T>
struct Response {
    T approach_speed{};            ///< (v_a - v_b).n before the impact, m/s; not positive: no impact
    T impulse{};                   ///< on b along n, N s, >= 0; a receives the opposite
    Vector3<T> friction_impulse{}; ///< on b across n, N s; a receives the opposite
    T restitution_loss{};          ///< kinetic energy that restitution took, J, >= 0
    T friction_loss{};             ///< kinetic energy that friction took, J, >= 0

    /// Kinetic energy lost in all, J. Of a pair with a static body it is measured in that body's frame.
    [[nodiscard]] constexpr T energy_lost() const { return restitution_loss + friction_loss; }
};

namespace detail {

/// Coulomb friction of an impact: how the tangential relative velocity u changes, and what happens to half its square.
struct Friction {
    Vec3 velocity_change{};
    double specific_loss = 0;
};

/// `limit` is the most by which friction can change u, m/s. It stops u and never turns it round.
inline Friction friction(const Vec3& tangential, double limit) {
    const double speed = length(tangential);
    if (!(speed > 0 && limit > 0)) {
        return {};
    }
    if (limit >= speed) {
        return {-tangential, speed * speed / 2};
    }
    return {tangential * (-limit / speed), limit * (2 * speed - limit) / 2};
}

inline Response<double> respond(const Vec3& n, double m_a, Vec3& v_a, double m_b, Vec3& v_b, double e, double mu) {
    const Vec3 relative = v_a - v_b;
    const double approach = dot(relative, n);
    const double mass = reduced_mass(m_a, m_b);
    if (!(approach > 0) || is_static(mass)) {
        return {.approach_speed = approach};
    }
    const double normal_change = (1 + e) * approach;
    Vec3 change = n * -normal_change;
    Friction rubbed;
    if (mu > 0) {
        rubbed = friction(relative - n * approach, mu * normal_change);
        change += rubbed.velocity_change;
    }
    v_a += change * share(m_a, m_b);
    v_b -= change * share(m_b, m_a);
    return {.approach_speed = approach,
            .impulse = mass * normal_change,
            .friction_impulse = rubbed.velocity_change * -mass,
            .restitution_loss = mass * (1 - e) * (1 + e) * approach * approach / 2,
            .friction_loss = mass * rubbed.specific_loss};
}

} // namespace detail

/// The impact of two bodies: changes their velocities and reports what it did.
///
/// \param n         unit vector from a to b, see contact_normal()
/// \param m_a,m_b   masses, kg; infinite: static, keeps its velocity exactly
/// \param v_a,v_b   velocities, m/s, in and out
/// \param e         restitution in [0, 1]
/// \param mu        friction, >= 0
///
/// With the reduced mass m: impulse `j = (1+e) m (v_a - v_b).n` along n, and against the tangential relative velocity u
/// Coulomb's `min(mu j, m |u|)`. Point masses carry no spin, so friction between two free ones keeps their momentum but
/// not their angular momentum. The energy lost is `m (1-e^2) approach^2 / 2` and `m (|u|^2 - |u'|^2) / 2`, both without
/// cancellation. A pair that does not approach, or of two static bodies, stays as it is: no response.
template <class T>
Response<T> respond(const Vector3<T>& n, T m_a, Vector3<T>& v_a, T m_b, Vector3<T>& v_b, T e, T mu = 0) {
    Vec3 wide_a = detail::wide(v_a);
    Vec3 wide_b = detail::wide(v_b);
    const Response<double> done =
        detail::respond(detail::wide(n), static_cast<double>(m_a), wide_a, static_cast<double>(m_b), wide_b,
                        static_cast<double>(e), static_cast<double>(mu));
    v_a = detail::narrow<T>(wide_a);
    v_b = detail::narrow<T>(wide_b);
    return {.approach_speed = static_cast<T>(done.approach_speed),
            .impulse = static_cast<T>(done.impulse),
            .friction_impulse = detail::narrow<T>(done.friction_impulse),
            .restitution_loss = static_cast<T>(done.restitution_loss),
            .friction_loss = static_cast<T>(done.friction_loss)};
}

/// The classical pair function, for those who port game code that tests for overlap once a frame.
///
/// \param pos_a,pos_b                 positions, m
/// \param v_a,v_b                     velocities, m/s, in and out
/// \param m_a,m_b                     masses, kg, or infinite
/// \param collision_distance_squared  square of the distance at which the two touch, m^2
/// \param e                           restitution in [0, 1]
///
/// Returns false, and changes nothing, where the two are farther apart than the collision distance. Otherwise returns
/// true and applies respond(); bodies that are within the distance but part (or do not approach) get no impulse, so
/// that calling it again while they still overlap does not glue them together. Coincident centres: contact_normal().
/// It sees only the moment it is called at; what flies through between two calls is what time_to_spheres() is for.
template <class T>
bool collide_point_masses(const Vector3<T>& pos_a, const Vector3<T>& pos_b, Vector3<T>& v_a, Vector3<T>& v_b, T m_a,
                          T m_b, T collision_distance_squared, T e = 1) {
    const Vector3<T> delta = pos_b - pos_a;
    if (length_squared(delta) > collision_distance_squared) {
        return false;
    }
    respond(contact_normal(delta, v_b - v_a), m_a, v_a, m_b, v_b, e);
    return true;
}

} // namespace carom
