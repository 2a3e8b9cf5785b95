#include "impact/prediction.hpp"

#include "collision/growing_sphere.hpp"
#include "collision/portable_math.hpp"
#include "collision/vibrating_plane.hpp"

#include <carom/collision.hpp>

namespace carom::core {

namespace {

/// Whether a body that touches a static or kinematic one is pressed to it: gravity may be outweighed by the speed along
/// its curve.
template <class Real>
bool presses_on(const State<Real>& state, const Path<Real>& body, const Path<Real>& fixed, const Vec3& n,
                const Vec3& velocity) {
    const Support support = support_by_body(fixed.slot, n, *body.motion, *fixed.motion, growth_of(body, fixed));
    return pressure_on(state, *body.motion, body.slot, support, velocity).acceleration > 0;
}

/// As the response has it: the approach speed that is mere rounding, of surfaces that growth drives on.
template <class Real>
double surface_rounding(const Path<Real>& a, const Path<Real>& b, const Meeting& m, const Vec3& n) {
    const Vec3 own = n * growth_of(a, b);
    if (is_prescribed(a.kind)) return approach_rounding<Real>(m.v_a + own, m.v_b, n);
    return approach_rounding<Real>(m.v_a, m.v_b - own, n);
}

/// An impact that the times of impact put at once, between bodies that touch: whether there is one, and when.
template <class Real>
double immediate(const State<Real>& state, const Path<Real>& a, const Path<Real>& b, const Meeting& m,
                 const Vec3& delta, const Vec3& pull) {
    const Vec3 n = contact_normal(delta, Vec3{});
    const double approach = dot(m.v_a - m.v_b, n) + growth_of(a, b);
    if (approach > surface_rounding(a, b, m, n)) return 0;
    if (is_prescribed(b.kind)) return presses_on(state, a, b, n, m.v_a - m.v_b) ? 0 : no_impact;
    if (is_prescribed(a.kind)) return presses_on(state, b, a, -n, m.v_b - m.v_a) ? 0 : no_impact;
    return pressing_along(n, length(delta), m.v_b - m.v_a, pull) > 0 ? 0 : no_impact;
}

/// When two bodies that touch after `time` (s) strike each other. A pair of moving bodies has no rest: where one lies
/// and gravity presses the other on it, bounces would follow each other ever faster, without end. So the contact lasts
/// until the approach is what the pressure gives in a contact time. That depends on the motion alone, so other impacts
/// in between put nothing off, and bounds both the number of bounces (dt / 2 t per contact) and how deep a contact lets
/// the bodies get into each other: a t^2 / 2, 5e-10 m under the earth's gravity in double precision.
template <class Real>
double end_of_contact(const State<Real>& state, const Meeting& m, const Vec3& delta, const Vec3& pull, double growth,
                      double time) {
    const Vec3 apart = delta + displacement(m.v_b - m.v_a, pull, time);
    const Vec3 velocity = m.v_b - m.v_a + pull * time;
    const Vec3 n = contact_normal(apart, Vec3{});
    const double pressing = pressing_along(n, length(apart), velocity, pull);
    return pressing > 0 ? time + std::max(0.0, state.laws.contact_time + (dot(velocity, n) - growth) / pressing) : time;
}

/// The same for two bodies in free flight, which nothing presses together.
template <class Real>
double immediate(const Meeting& m) {
    const Vec3 n = contact_normal(m.delta, Vec3{});
    return dot(m.v_a - m.v_b, n) > approach_rounding<Real>(m.v_a, m.v_b, n) ? 0 : no_impact;
}

/// How far ahead of `start` to look, s: everything that counts up to `end` once added to `start` and rounded.
double horizon_of(double start, double end) {
#ifdef CAROM_DEFECT_SECOND_IMPACT_DROPPED // only in tests/defects
    if (start > 0) return 0;
#endif
    return (end - start) + 4 * std::numeric_limits<double>::epsilon() * end;
}

/// The pair's next impact for one periodic image, s after `start`.
template <class Real>
double time_to_image(const State<Real>& state, const Path<Real>& a, const Path<Real>& b, const Meeting& m,
                     const Vec3& delta, double start, double until) {
    const double contact = contact_distance(a, b, start);
    const double growth = growth_of(a, b);
    const Vec3 pull = a.kind == b.kind && a.kind != Kind::held ? Vec3{} : b.acceleration - a.acceleration;
    // Along curved paths to the end of the step: the search for their roots starts from there, and its bits must not
    // depend on windows.
    const double horizon = horizon_of(start, pull != Vec3{} ? state.laws.kick_interval : until);
    double time = growth == 0 ? time_to_spheres(delta, m.v_b - m.v_a, pull, contact, horizon)
                              : detail::time_to_growing_spheres(delta, m.v_b - m.v_a, pull, contact, growth, horizon);
    if (time == 0) time = immediate(state, a, b, m, delta, pull);
    const bool two_move = !is_prescribed(a.kind) && !is_prescribed(b.kind);
    return two_move && pull != Vec3{} && time < no_impact ? end_of_contact(state, m, delta, pull, growth, time) : time;
}

/// The bodies' next impact over all periodic images that they may come to within the horizon.
template <class Real>
double time_over_images(const State<Real>& state, const Path<Real>& a, const Path<Real>& b, double start, double now,
                        double until) {
    const Bounds& bounds = state.bounds;
    const Meeting at_start = meeting_at(state, a, b, start);
    const Meeting at_now = now > start ? meeting_at(state, a, b, now) : at_start;
    const Meeting at_end = meeting_at(state, a, b, until);
    const double contact = std::max(contact_distance(a, b, start), contact_distance(a, b, until));
    Int3 most{};
    for (int axis = 0; axis < 3; ++axis) {
        if (bounds.period(axis) == 0) continue;
        const double period = static_cast<double>(bounds.period(axis)) * state.resolution.metres;
        const auto travel = [&](const Meeting& m) {
            return std::abs(component(m.v_b, axis) - component(m.v_a, axis)) * (until - now);
        };
        const double reach = std::max(travel(at_now), travel(at_end)) + contact;
        component(most, axis) = static_cast<std::int64_t>(std::min(reach / period + 0.5, 1e6));
    }
    const Int3 raw = b.motion->x - a.motion->x;
    double first = no_impact;
    for (Int3 image{-most.x}; image.x <= most.x; ++image.x) {
        for (image.y = -most.y; image.y <= most.y; ++image.y) {
            for (image.z = -most.z; image.z <= most.z; ++image.z) {
                const Int3 difference = nearest_image(bounds, state.resolution, raw, at_now.d_b - at_now.d_a, image);
                const Vec3 delta = to_metres(difference, state.resolution) + (at_start.d_b - at_start.d_a);
                first = std::min(first, time_to_image(state, a, b, at_start, delta, start, until));
            }
        }
    }
    return first;
}

/// Two bodies in free flight, which see no acceleration in each other: the usual case, without detours. Swapping them
/// only turns signs round: no bit depends on their order.
template <class Real>
double predict_free_pair(const State<Real>& state, const Motion<Real>& m_a, const Motion<Real>& m_b, double until) {
    const double start = std::max(m_a.t, m_b.t);
    Meeting m;
    m.v_a = velocity_of(m_a);
    m.v_b = velocity_of(m_b);
    m.delta = to_metres(m_b.x - m_a.x, state.resolution);
    if (m_a.t != m_b.t) {
        const Vec3& g = state.laws.gravity;
        m.d_a = displacement(m.v_a, g, start - m_a.t);
        m.d_b = displacement(m.v_b, g, start - m_b.t);
        m.v_a += g * (start - m_a.t);
        m.v_b += g * (start - m_b.t);
        m.delta += m.d_b - m.d_a;
    }
    const double contact = static_cast<double>(m_a.radius) + static_cast<double>(m_b.radius);
    const double time = time_to_spheres(m.delta, m.v_b - m.v_a, contact, horizon_of(start, until));
    return start + (time == 0 ? immediate<Real>(m) : time);
}

template <class Real>
double predict_in_order(const State<Real>& state, const Path<Real>& a, const Path<Real>& b, double now, double until) {
    const double start = std::max(a.motion->t, b.motion->t);
    if (state.bounds.any_periodic()) return start + time_over_images(state, a, b, start, now, until);
    const Meeting m = meeting_at(state, a, b, start);
    return start + time_to_image(state, a, b, m, m.delta, start, until);
}

/// Whether contacts keep two bodies apart, unless one strikes the other.
template <class Real>
bool is_in_pile(const Path<Real>& a, const Path<Real>& b) {
    const auto can_be = [](Kind kind) { return leans(kind) || is_prescribed(kind); };
    return (a.kind == Kind::piled && can_be(b.kind)) || (b.kind == Kind::piled && can_be(a.kind));
}

/// Two bodies of a pile, which move straight: only what is faster than a contact allows is an impact.
template <class Real>
double predict_in_pile(const State<Real>& state, const Path<Real>& a, const Path<Real>& b, double now, double until) {
    const Encounter encounter = encounter_of(state.laws, *a.bodies, a.index, *b.bodies, b.index, 0);
    double load = std::numeric_limits<double>::infinity();
    if (a.kind == Kind::piled) load = load_on(*a.bodies, a.index);
    if (b.kind == Kind::piled) load = std::min(load, load_on(*b.bodies, b.index));
    const double strike = striking_speed(encounter.resting_restitution, load, state.laws);
    const double growth = growth_of(a, b);
    const double slow = strike - growth;
    if (growth <= strike && length_squared(velocity_of(*a.motion) - velocity_of(*b.motion)) <= slow * slow)
        return no_impact;
    const double time = predict_in_order(state, a, b, now, until);
    if (time > until) return no_impact;
    const Meeting m = meeting_at(state, a, b, time);
    const Vec3 n = contact_normal(m.delta, Vec3{});
    const double approach = dot(m.v_a - m.v_b, n) + growth;
    return approach > std::max(strike, surface_rounding(a, b, m, n)) ? time : no_impact;
}

/// The same at a wall or facet, for a time of impact `time` s after the body's own.
template <class Real>
bool strikes_wall(const State<Real>& state, Index body, std::uint32_t wall, double time) {
    const Motion<Real>& m = state.bodies.motion[body];
    const Vec3 v = velocity_of(m);
    const double then = m.t + time;
    const Touch touch =
        state.bounds.impact(wall, m.x, v * time, radius_at(state.bodies, body, then), then, state.resolution);
    Vec3 u = touch.normal * -growth_of(state.bodies, body);
    if (!state.bounds.is_facet(wall)) u += Bounds::velocity(state.bounds.walls()[wall], m.x, v * time, then);
    const double strike = striking_speed_at(state, body, wall);
    return dot(v - u, touch.normal) > std::max(strike, approach_rounding<Real>(v, u, touch.normal));
}

/// When a piled body meets a facet: where it strikes, or has sunk in so far that it could come out on the other side.
template <class Real>
double predict_piled_at_facet(const State<Real>& state, Index body, std::uint32_t wall, double horizon) {
    const Motion<Real>& m = state.bodies.motion[body];
    const Vec3 v = velocity_of(m);
    const Obstacles& obstacles = *state.bounds.obstacles();
    const std::uint32_t facet = wall - state.bounds.first_facet();
    const double growth = growth_of(state.bodies, body);
    const double radius = radius_at(state.bodies, body, m.t);
    const double contact = obstacles.contact_distance(radius);
    const double touch =
        obstacles.time_to(facet, m.x, v, {}, contact, obstacles.contact_growth(radius, growth, horizon), horizon);
    if (touch <= horizon && strikes_wall(state, body, wall, touch)) return m.t + touch;
    // One that was stopped already, and goes along a surface that bends towards it, is so again halfway to it.
    const double distance = obstacles.impact(facet, m.x, {}, radius).gap + contact;
    for (const double depth : {deepest_in_surface * contact, 0.5 * std::min(distance, deepest_in_surface * contact)}) {
        const double stop = obstacles.time_to(facet, m.x, v, {}, depth, 0, horizon);
        if (stop == no_impact) return no_impact;
        const Vec3 n = obstacles.impact(facet, m.x, v * stop, radius).normal;
        const Vec3 u = obstacles.surface_velocity(facet, m.x, v * stop, radius, n) - n * growth;
        if (dot(v - u, n) > approach_rounding<Real>(v, u, n)) return m.t + stop;
    }
    return no_impact;
}

/// When a body meets a facet of an obstacle.
template <class Real>
double predict_facet(const State<Real>& state, Index body, std::uint32_t wall) {
    const Motion<Real>& m = state.bodies.motion[body];
    const double horizon = horizon_of(m.t, state.laws.kick_interval);
    if (state.bodies.kind[body] == Kind::piled) return predict_piled_at_facet(state, body, wall, horizon);
    const Obstacles& obstacles = *state.bounds.obstacles();
    const std::uint32_t facet = wall - state.bounds.first_facet();
    const Vec3 a = acceleration_of(state, body);
    const Vec3 v = velocity_of(m);
    const double growth = growth_of(state.bodies, body);
    const double radius = radius_at(state.bodies, body, m.t);
    const double contact = obstacles.contact_distance(radius);
    const double contact_growth = obstacles.contact_growth(radius, growth, horizon);
    const double time = obstacles.time_to(facet, m.x, v, a, contact, contact_growth, horizon);
    if (time == no_impact) return no_impact;
    const Touch touch = obstacles.impact(facet, m.x, {}, radius);
    const bool touches = touch.gap <= state.resolution.metres;
    const Vec3 u = obstacles.surface_velocity(facet, m.x, {}, radius, touch.normal) - touch.normal * growth;
    if (!touches || std::abs(dot(v - u, touch.normal)) > approach_rounding<Real>(v, u, touch.normal)) return m.t + time;
    // An approach that is mere rounding is none. Whatever presses the body comes to lie; what may not do that strikes
    // as soon as it is a little deeper.
    const Support support = support_by_facet(state, wall, touch, m, {}, v, growth);
    if (may_lie_on_obstacle(state, support, radius, v)) {
        const double pressing = pressure_on(state, m, state.bodies.slot[body], support, v).acceleration;
        if (std::max(pressing, dot(a, touch.normal)) > 0) return m.t;
    }
    const double deeper = contact + std::min(touch.gap, 0.0) - 2 * state.resolution.metres;
    return m.t + obstacles.time_to(facet, m.x, v, a, deeper, contact_growth, horizon);
}

} // namespace

template <class Real>
double predict_paths(const State<Real>& state, const Path<Real>& i, const Path<Real>& j, double now, double until) {
    const bool both_free = i.kind == Kind::free && j.kind == Kind::free;
    if (both_free && !state.bounds.any_periodic() && i.bodies->growth.empty())
        return predict_free_pair(state, *i.motion, *j.motion, until);
    const bool in_order = i.slot < j.slot;
    const Path<Real>& a = in_order ? i : j;
    const Path<Real>& b = in_order ? j : i;
    if (is_in_pile(a, b)) return predict_in_pile(state, a, b, now, until);
    return predict_in_order(state, a, b, now, until);
}

template <class Real>
double predict_pair(const State<Real>& state, Index i, Index j, double now, double until) {
    const Bodies<Real>& bodies = state.bodies;
    const bool both_free = bodies.kind[i] == Kind::free && bodies.kind[j] == Kind::free;
    if (both_free && !state.bounds.any_periodic() && bodies.growth.empty()) {
        return predict_free_pair(state, bodies.motion[i], bodies.motion[j], until);
    }
    const bool both_prescribed = is_prescribed(bodies.kind[i]) && is_prescribed(bodies.kind[j]);
    if (both_prescribed || (is_still(bodies.kind[i]) && is_still(bodies.kind[j]))) return no_impact;
    if (rests_on(bodies, i, bodies.slot[j]) || rests_on(bodies, j, bodies.slot[i])) return no_impact;
    return predict_paths(state, path_of(state, i), path_of(state, j), now, until);
}

/// s from `time` (since the start of the step) until a gap (m) to a flat wall that moves is closed, by a body that has
/// `velocity` and `acceleration` away from it, the velocity relative to the wall's now.
double time_to_driven_wall(const Bounds::Wall& wall, double gap, double velocity, double acceleration, double time,
                           double horizon) {
    const FaceMotion& motion = wall.motion;
    if (motion.amplitude == 0) return time_to_plane(gap, velocity, acceleration, horizon);
    const double phase = wall.phase.value() + motion.angular_frequency * time;
    const double swing = motion.amplitude * motion.angular_frequency * detail::cos(phase);
    return detail::time_to_vibrating_plane(gap, velocity + swing, acceleration,
                                           {motion.amplitude, motion.angular_frequency, phase}, horizon);
}

template <class Real>
double predict_wall(const State<Real>& state, Index body, std::uint32_t wall) {
    if (state.bounds.is_facet(wall)) return predict_facet(state, body, wall);
    const Bodies<Real>& bodies = state.bodies;
    if (bodies.kind[body] == Kind::asleep || rests_on(bodies, body, Support::wall_bit | wall)) return no_impact;
    const Motion<Real>& m = bodies.motion[body];
    const Bounds::Wall& face = state.bounds.walls()[wall];
    const Vec3 a = acceleration_of(state, body);
    const Vec3 v = velocity_of(m);
    const Vec3 u = Bounds::velocity(face, m.x, {}, m.t);
    const Vec3 relative = v - u;
    const double growth = growth_of(bodies, body);
    const double radius = radius_at(bodies, body, m.t);
    const double gap = state.bounds.gap(face, m.x, {}, radius, m.t, state.resolution);
    // To the end of the step, never of a window: a body that touches the face and meets it before the horizon comes to
    // rest at its own time, and in a later window that would be past.
    const double horizon = horizon_of(m.t, state.laws.kick_interval);
    double time = no_impact;
    if (state.bounds.shape() == Bounds::Shape::shell) {
        const Vec3 from_centre = Bounds::from_centre(face, m.x, {}, state.resolution);
        const double clearance = state.bounds.shell_radius() - radius;
        time = growth == 0 ? time_to_shell_inside(from_centre, v, a, clearance, horizon)
                           : detail::time_to_shell_growing(from_centre, v, a, clearance, growth, horizon);
    } else {
        const double parting = -dot(relative, face.normal) - growth;
        const double lift = -dot(a, face.normal);
        time = face.is_driven ? time_to_driven_wall(face, gap, parting, lift, m.t, horizon)
                              : time_to_plane(gap, parting, lift, horizon);
    }
    if (bodies.kind[body] == Kind::piled) {
        return time <= horizon && strikes_wall(state, body, wall, time) ? m.t + time : no_impact;
    }
    if (gap > state.resolution.metres || time > horizon) return m.t + time;
    // The body touches: an approach that is mere rounding is none, but whatever presses it brings it to rest.
    const Vec3 n = state.bounds.normal(face, m.x, {}, state.resolution);
    if (std::abs(dot(relative, n) + growth) > approach_rounding<Real>(v, u - n * growth, n)) return m.t + time;
    const Support support = support_by_wall(state, wall, n, m, growth);
    const double pressing = pressure_on(state, m, bodies.slot[body], support, relative).acceleration;
    if (std::max(pressing, dot(a - support.acceleration, n)) > 0) return m.t;
    // A wall that vibrates turns back.
    if (!face.is_driven || face.motion.amplitude == 0) return no_impact;
    const double back = time_to_driven_wall(face, gap, 0, -dot(a, face.normal), m.t, horizon);
    return back > 0 ? m.t + back : no_impact;
}

template <class Real>
bool stays_in_world(const State<Real>& state, Index body, double duration) {
    const Motion<Real>& m = state.bodies.motion[body];
    const Vec3 v = velocity_of(m);
    const Vec3 acceleration = acceleration_of(state, body);
    for (int axis = 0; axis < 3; ++axis) {
        const double path = (std::abs(component(v, axis)) + std::abs(component(acceleration, axis)) * duration) *
                            duration * state.resolution.per_metre;
        const double end = std::abs(static_cast<double>(component(m.x, axis))) + path;
        if (!(end < static_cast<double>(flight_edge))) return false;
    }
    return true;
}

#define CAROM_INSTANTIATE(Real)                                                                                        \
    template double predict_pair(const State<Real>&, Index, Index, double, double);                                    \
    template double predict_paths(const State<Real>&, const Path<Real>&, const Path<Real>&, double, double);           \
    template double predict_wall(const State<Real>&, Index, std::uint32_t);                                            \
    template bool stays_in_world(const State<Real>&, Index, double);
CAROM_INSTANTIATE(float)
CAROM_INSTANTIATE(double)
#undef CAROM_INSTANTIATE

} // namespace carom::core
