/// \file
/// Coming to rest against a face or a static body, until struck or let go.
#pragma once

#include "space/state.hpp"

namespace carom::core {

/// The rest rule. A body that meets a support with `approach` (m/s) while `pressing` (m/s^2) pushes it there bounces
/// at intervals 2 e v / a, 2 e^2 v / a, ...: for another 2 e v / ((1 - e) a) seconds in all. It comes to rest if that
/// is less than `rest_time`. e = 1 never rests.
inline bool comes_to_rest(double e, double approach, double pressing, double rest_time) {
    return pressing > 0 && e < 1 && 2 * e * approach < (1 - e) * pressing * rest_time;
}

/// m/s, the fastest approach that the rest rule lets become a contact where an acceleration (m/s^2) presses two bodies
/// together. What bounces little, or not at all, may bounce as fast as what bounces at e = 1/3: faster is an impact.
inline double resting_speed(double e, double pressing, double rest_time) {
    return e < 1 && pressing > 0 ? pressing * rest_time * std::min(1.0, (1 - e) / (2 * e)) : 0;
}

/// m/s, the approach above which what touches in a pile is struck. What presses bodies on each other there are their
/// neighbours: with the load that both carry (m/s^2), and never less than the weight of a body.
inline double striking_speed(double e, double load, const Laws& laws) {
    const double pressing = std::max(load, length(laws.gravity));
    return 2 * resting_speed(std::min(e, most_wearing_restitution), pressing, laws.rest_time);
}
template <class Real>
double load_on(const Bodies<Real>& bodies, Index i) {
    return i < bodies.loads.size() ? static_cast<double>(bodies.loads[i].pressing) : 0;
}

/// Derives the times of Laws. A contact between bodies takes quick_time, in which gravity gives a speed of
/// g quick_time and presses them g quick_time^2 / 2 into each other; more where the resolution would round that away.
void set_contact_time(Laws& laws, const Resolution& resolution);

/// The contact rule. Bodies that lean on each other have no rest: their bounces would get lower without end, each the
/// more often. But impacts slower than this (m/s) that follow on others, within collapse_time, belong to a contact,
/// and lose nothing. So what is left of the bounces, or what gravity gives in the contacts, goes on and keeps the
/// bodies apart: k layers of them have k g / 2 v impacts each a second, with v from g contact_time to this.
inline double contact_speed(const Laws& laws) { return 8 * length(laws.gravity) * laws.contact_time; }

/// e of an impact that follows on another, of bodies that approach with more or less than the contact speed.
inline double lasting_restitution(double e, double approach, const Laws& laws) {
    const double speed = contact_speed(laws);
    return approach > speed ? std::max(e, speed / approach) : 1;
}

/// Approach speed below which rounding of the velocities alone can make bodies seem to approach, m/s: half a unit in
/// the last place of each component, of both bodies, along the normal. Below the normal range of Real an impact could
/// leave the velocities as they are, and so happen again and again.
template <class Real>
double approach_rounding(const Vec3& v_a, const Vec3& v_b, const Vec3& n) {
    const auto weight = [](double a, double b) { return std::abs(a) + std::abs(b); };
    return static_cast<double>(std::numeric_limits<Real>::min()) +
           static_cast<double>(std::numeric_limits<Real>::epsilon()) *
               (weight(v_a.x, v_b.x) * std::abs(n.x) + weight(v_a.y, v_b.y) * std::abs(n.y) +
                weight(v_a.z, v_b.z) * std::abs(n.z));
}

/// Speed (m/s) and acceleration (m/s^2) with which a body is pressed into a support.
struct Pressure {
    double acceleration = 0; ///< by gravity, attractors, and the bend of a curved support
    double kick = 0;         ///< m/s, what the attractors' kicks add between two impacts: no real approach speed
};

/// On a body at motion.x in `slot` that passes there with `velocity` (m/s) relative to the support.
template <class Real>
Pressure pressure_on(const State<Real>& state, const Motion<Real>& motion, std::uint32_t slot, const Support& support,
                     const Vec3& velocity);

/// The part of its radius at which the centre of a body that has sunk into a surface is stopped: a surface has no
/// thickness, and contacts give way.
inline constexpr double deepest_in_surface = 0.5;

/// s, into which the step of a pile is cut at least.
inline constexpr double longest_piece = 1.0 / 480;

/// Whether a body that moves with `velocity` (m/s) may come to lie on an obstacle. It is piled there, not held, so
/// gravity has to press it on; and it goes straight for a piece, in which a curved surface must not bend towards it by
/// more than this part of its radius: contacts undo a fourteenth of an overlap in a piece.
template <class Real>
bool may_lie_on_obstacle(const State<Real>& state, const Support& support, double radius, const Vec3& velocity) {
    constexpr double most = 0.01;
    const double way = length(velocity) * longest_piece;
    const double contact = state.bounds.obstacles()->contact_distance(radius);
    return state.laws.gravity != Vec3{} && 0.5 * std::abs(support.bend) * way * way <= most * contact;
}

/// m/s, the approach above which a piled body strikes a wall or facet.
template <class Real>
double striking_speed_at(const State<Real>& state, Index body, std::uint32_t wall) {
    const double e = encounter_of(state, body, state.bounds.surface(wall), 0).resting_restitution;
    return striking_speed(e, load_on(state.bodies, body), state.laws);
}

/// A wall, a facet of an obstacle (where a body at motion.x + d moves with `velocity`), or a static or kinematic body,
/// as what a body may rest against at its own time; without friction. What grows (m/s, the two together) drives the
/// surface on.
template <class Real>
Support support_by_wall(const State<Real>& state, std::uint32_t wall, const Vec3& normal, const Motion<Real>& motion,
                        double growth);
template <class Real>
Support support_by_facet(const State<Real>& state, std::uint32_t wall, const Touch& touch, const Motion<Real>& motion,
                         const Vec3& d, const Vec3& velocity, double growth);
template <class Real>
Support support_by_body(std::uint32_t slot, const Vec3& normal, const Motion<Real>& motion, const Motion<Real>& fixed,
                        double growth);

/// Puts a body, standing where it touches the support, to rest against it. `remaining`: s to the end of the step.
template <class Real>
void hold_against(State<Real>& state, Index body, const Support& support, double remaining, Entry& entry);

/// What a blow does to a body that stays on its supports.
struct Yielding {
    Vec3 change{};   ///< m/s, of its velocity, friction included
    Vec3 friction{}; ///< m/s, the part of it that is friction at the supports
};

/// How a body that moves with `velocity` yields to a blow (m/s, impulse / mass): a held one only along its supports,
/// and where it does not move against the blow, only as far as friction lets it. Linear in the size of the blow.
template <class Real>
Yielding yield_to(const State<Real>& state, Index body, const Vec3& velocity, const Vec3& blow);

/// Whether a blow along a direction leaves a held body on its supports.
template <class Real>
bool stays_on_supports(const State<Real>& state, Index body, const Vec3& direction);

/// Whether a held body moves along all its supports when it moves along a direction.
template <class Real>
bool moves_along_supports(const State<Real>& state, Index body, const Vec3& direction);

/// Derives anew how a held body moves after its velocity has changed. `remaining`: s to the end of the step.
template <class Real>
void refresh_hold(State<Real>& state, Index body, double remaining, Entry& entry);

/// Start of a step: drops supports that no longer press and derives how the held bodies move in the next `duration`.
/// Appends the bodies that are let go to `released`.
template <class Real>
void refresh_holds(State<Real>& state, double duration, std::vector<Index>& released);

/// End of a step: puts bodies that slid along a curved or slanted support back onto it.
template <class Real>
void settle_holds(State<Real>& state);

/// Changes a held body's velocity by an attractor's kick (m/s): only along its supports, and not if friction holds it.
template <class Real>
Vec3 kick_along_supports(const State<Real>& state, Index body, Vec3 kick);

/// Lets go whatever rests on the static body in `slot`.
template <class Real>
void release_from(Bodies<Real>& bodies, std::uint32_t slot);

} // namespace carom::core
