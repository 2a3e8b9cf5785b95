#include "impact/response.hpp"

#include <carom/collision.hpp>

namespace carom::core {

namespace {

/// TC rule: after this many impacts in quick succession further ones are elastic. Luding & McNamara, Granular Matter 1,
/// 113 (1998), make every impact elastic that follows a contact of less than t_c; the count spares ordinary cascades.
constexpr std::uint32_t quick_impacts_allowed = 8;

/// Jam rule: bodies that fill the room between faces or static bodies have impacts without end at one and the same
/// place. After so many of them they stop. What ends on its own takes fewer: a body that touches a wall and is struck
/// by one of k times its mass has about 0.8 sqrt(k) impacts with the wall, and a wedge of angle w at most pi / w.
constexpr std::uint16_t still_bounces_allowed = 64;
constexpr std::uint16_t still_impacts_allowed = 10000;

/// What a body's impacts in quick succession come to.
struct Haste {
    bool collapses = false; ///< too many: the TC rule makes further ones elastic
    bool jams = false;      ///< too many at one place: the jam rule makes further ones inelastic
};

/// Counts an impact of a body.
template <class Real>
Haste count_impact(State<Real>& state, Index body, double time, double approach, bool at_support) {
    Flight& flight = state.bodies.course[body].flight;
    const double duration = time - flight.last_impact;
    if (duration > state.laws.collapse_time) flight.quick_impacts = 0;
    const bool still = flight.quick_impacts > 0 && approach * duration <= 2 * state.resolution.metres;
    const auto counted = [](bool goes_on, std::uint32_t count, std::uint32_t allowed) {
        return goes_on ? std::min(count + 1, allowed + 1) : 0;
    };
    flight.quick_impacts = counted(true, flight.quick_impacts, quick_impacts_allowed);
    flight.still_impacts = static_cast<std::uint16_t>(counted(still, flight.still_impacts, still_impacts_allowed));
    flight.still_bounces =
        static_cast<std::uint16_t>(counted(still && at_support, flight.still_bounces, still_bounces_allowed));
    flight.last_impact = time;
    return {.collapses = flight.quick_impacts > quick_impacts_allowed,
            .jams = flight.still_impacts > still_impacts_allowed || flight.still_bounces > still_bounces_allowed};
}

/// Brings a body to the time of its event and outdates its other events.
template <class Real>
void take_part(State<Real>& state, Index body, double time, Entry& entry) {
    if (state.bodies.kind[body] == Kind::fixed) return;
    advance(state, body, time, entry);
    ++state.bodies.course[body].version;
}

template <class Real>
void set_velocity(State<Real>& state, Index body, const Vec3& v) {
    if (state.bodies.kind[body] != Kind::fixed) state.bodies.motion[body].v = rounded<Real>(v);
}

template <class Real>
double mass_of(const State<Real>& state, Index body) {
    return static_cast<double>(state.bodies.trait[body].mass);
}

void apply_haste(const Haste& haste, Encounter& encounter, Occurrence& occurrence) {
    if (haste.jams) {
        encounter.restitution = 0;
    } else if (haste.collapses && encounter.restitution != 1) {
        encounter.restitution = 1;
        occurrence.is_converted = true;
    }
}

void write_down(const Response<double>& response, Occurrence& occurrence) {
    occurrence.is_impact = true;
    occurrence.entry.lost_to_restitution += response.restitution_loss;
    occurrence.entry.lost_to_friction += response.friction_loss;
    occurrence.impact.impulse = response.impulse;
    occurrence.impact.approach_speed = response.approach_speed;
    occurrence.impact.energy_lost = response.energy_lost();
}

/// A support that a body touches at `time`: whether the body comes to rest there.
template <class Real>
bool rests(const State<Real>& state, Index body, const Support& support, const Vec3& v, double approach, double e) {
    const Pressure pressure = pressure_on(state, state.bodies.motion[body], state.bodies.trait[body].slot, support, v);
    if (approach <= approach_rounding<Real>(v, {}, support.normal)) return pressure.acceleration > 0;
    return comes_to_rest(e, std::max(0.0, approach - pressure.kick), pressure.acceleration, state.laws.rest_time);
}

/// A body, already at its time, against something that does not move: a face or a static body. An approach that is
/// mere rounding is no impact: the body only finds one more support, beside those it may have.
template <class Real>
void meet_support(State<Real>& state, Index body, const Support& support, Encounter encounter, Occurrence& occurrence) {
    const double time = occurrence.impact.offset;
    Vec3 v = velocity_of(state.bodies.motion[body]);
    const double approach = dot(v, support.normal);
    const bool come_to_rest = rests(state, body, support, v, approach, encounter.restitution);
    if (approach > approach_rounding<Real>(v, {}, support.normal)) {
        release(state.bodies, body);
        const Haste haste = count_impact(state, body, time, approach, true);
        if (come_to_rest) {
            encounter.restitution = 0;
        } else {
            apply_haste(haste, encounter, occurrence);
        }
        Vec3 support_velocity{};
        const Response<double> response = respond(support.normal, mass_of(state, body), v, infinite_mass,
                                                  support_velocity, encounter.restitution, encounter.friction);
        set_velocity(state, body, v);
        occurrence.entry.outer_impulse += -(support.normal * response.impulse) - response.friction_impulse;
        write_down(response, occurrence);
    }
    if (come_to_rest) hold_against(state, body, support, state.laws.kick_interval - time, occurrence.entry);
}

template <class Real>
void execute_wall(State<Real>& state, const Event& event, Occurrence& occurrence) {
    const Bounds::Wall& wall = state.bounds.walls()[event.wall()];
    const Motion<Real>& m = state.bodies.motion[event.a];
    const Vec3 d = displacement(velocity_of(m), acceleration_of(state, event.a), event.time - m.t);
    const Encounter encounter = encounter_of(state, event.a, wall);
    Support support = support_by_wall(state, event.wall(), state.bounds.normal(wall, m.x, d, state.resolution), m);
    support.friction = encounter.friction;
    take_part(state, event.a, event.time, occurrence.entry);
    occurrence.impact = {.offset = event.time,
                         .a = state.bodies.trait[event.a].slot,
                         .face = wall.face,
                         .x = m.x,
                         .arm = support.normal * static_cast<double>(m.radius),
                         .normal = support.normal};
    meet_support(state, event.a, support, encounter, occurrence);
}

/// Two bodies that both move.
template <class Real>
void meet_body(State<Real>& state, Index a, Index b, const Meeting& meeting, Occurrence& occurrence) {
    const ImpactRecord& impact = occurrence.impact;
    release(state.bodies, a);
    release(state.bodies, b);
    Encounter encounter = encounter_of(state, a, b);
    Vec3 v_a = meeting.v_a;
    Vec3 v_b = meeting.v_b;
    const double approach = dot(v_a - v_b, impact.normal);
    const Haste haste_a = count_impact(state, a, impact.offset, approach, false);
    const Haste haste_b = count_impact(state, b, impact.offset, approach, false);
    apply_haste({haste_a.collapses || haste_b.collapses, haste_a.jams || haste_b.jams}, encounter, occurrence);
    const Response<double> response = respond(impact.normal, mass_of(state, a), v_a, mass_of(state, b), v_b,
                                              encounter.restitution, encounter.friction);
    set_velocity(state, a, v_a);
    set_velocity(state, b, v_b);
    write_down(response, occurrence);
}

/// A body, already at its time, against a static one.
template <class Real>
void meet_static(State<Real>& state, Index body, Index fixed, const Vec3& n, Occurrence& occurrence) {
    const Bodies<Real>& bodies = state.bodies;
    const Encounter encounter = encounter_of(state, body, fixed);
    Support support = support_by_body(bodies.trait[fixed].slot, n, bodies.motion[body], bodies.motion[fixed]);
    support.friction = encounter.friction;
    meet_support(state, body, support, encounter, occurrence);
}

template <class Real>
void execute_pair(State<Real>& state, const Event& event, Occurrence& occurrence) {
    const Bodies<Real>& bodies = state.bodies;
    const bool in_order = bodies.trait[event.a].slot < bodies.trait[event.b].slot;
    const Index a = in_order ? event.a : event.b;
    const Index b = in_order ? event.b : event.a;
    const Meeting meeting = meeting_at(state, path_of(state, a), path_of(state, b), event.time);
    const Vec3 n = contact_normal(meeting.delta, meeting.v_b - meeting.v_a);
    take_part(state, a, event.time, occurrence.entry);
    take_part(state, b, event.time, occurrence.entry);
    occurrence.impact = {.offset = event.time,
                         .a = bodies.trait[a].slot,
                         .b = bodies.trait[b].slot,
                         .x = bodies.motion[a].x,
                         .arm = n * static_cast<double>(bodies.motion[a].radius),
                         .normal = n};
    if (bodies.kind[a] == Kind::fixed) {
        meet_static(state, b, a, -n, occurrence);
    } else if (bodies.kind[b] == Kind::fixed) {
        meet_static(state, a, b, n, occurrence);
    } else {
        meet_body(state, a, b, meeting, occurrence);
    }
}

} // namespace

template <class Real>
void execute(State<Real>& state, const Event& event, Occurrence& occurrence) {
    if (event.at_wall()) {
        execute_wall(state, event, occurrence);
    } else {
        execute_pair(state, event, occurrence);
    }
}

void Outcome::add(const Occurrence& occurrence) {
    if (!occurrence.is_impact) return;
    ++(occurrence.impact.face >= 0 ? face_impacts : impacts);
    tc_conversions += occurrence.is_converted ? 1 : 0;
    if (record && occurrence.impact.impulse >= least_impulse) records.push_back(occurrence.impact);
}

template void execute(State<float>&, const Event&, Occurrence&);
template void execute(State<double>&, const Event&, Occurrence&);

} // namespace carom::core
