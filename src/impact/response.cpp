#include "impact/response.hpp"

#include <carom/collision.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#ifdef CAROM_DEFECT_RESPONSE // only in tests/defects
#    include CAROM_DEFECT_RESPONSE
#endif

namespace carom::core {

namespace {

/// TC rule: after this many impacts in quick succession further ones are elastic. Luding & McNamara, Granular Matter 1,
/// 113 (1998), make every impact elastic that follows a contact of less than t_c; the count spares ordinary cascades.
constexpr std::uint32_t quick_impacts_allowed = 8;

/// Jam rule: bodies that fill the room between faces or static bodies have impacts without end at one and the same
/// place. After so many of them they stop. What ends on its own takes fewer: a body that touches a wall and is struck
/// by one of k times its mass has about 0.8 sqrt(k) impacts with the wall, and a wedge of angle w at most pi / w. An
/// elastic body does not rest: it gets the larger number at walls, too.
constexpr std::uint16_t still_bounces_allowed = 64;
constexpr std::uint16_t still_impacts_allowed = 10000;

/// What a body's impacts in quick succession come to.
struct Haste {
    bool lasts = false;     ///< the one before is remembered: slow ones belong to a contact
    bool collapses = false; ///< too many: the TC rule makes further ones elastic
    bool stands = false;    ///< too many, and no further on the way than a contact of finite duration gives way
    bool jams = false;      ///< too many at one place: the jam rule makes further ones inelastic
};

/// Counts an impact of a body; `wears_down`: with a support, which takes energy.
template <class Real>
Haste count_impact(State<Real>& state, Index body, double time, double approach, bool wears_down) {
    Flight& flight = state.bodies.course[body].flight;
    const double duration = time - flight.last_impact;
    const bool lasts = flight.quick_impacts > 0 && duration <= state.laws.collapse_time;
    if (duration > state.laws.quick_time) flight.quick_impacts = 0;
    const bool still = flight.quick_impacts > 0 && approach * duration <= 2 * state.resolution.metres;
    const double give = std::max(2 * state.resolution.metres, contact_speed(state.laws) * state.laws.contact_time);
    const auto counted = [](bool goes_on, std::uint32_t count, std::uint32_t allowed) {
        return goes_on ? std::min(count + 1, allowed + 1) : 0;
    };
    flight.quick_impacts = counted(true, flight.quick_impacts, quick_impacts_allowed);
    flight.still_impacts = static_cast<std::uint16_t>(counted(still, flight.still_impacts, still_impacts_allowed));
    flight.still_bounces =
        static_cast<std::uint16_t>(counted(still && wears_down, flight.still_bounces, still_bounces_allowed));
    flight.last_impact = time;
    return {.lasts = lasts,
            .collapses = flight.quick_impacts > quick_impacts_allowed,
            .stands = flight.quick_impacts > quick_impacts_allowed && approach * duration <= give,
            .jams = flight.still_impacts > still_impacts_allowed || flight.still_bounces > still_bounces_allowed};
}

/// Brings a body to the time of its event and outdates its other events.
template <class Real>
void take_part(State<Real>& state, Index body, double time, Entry& entry) {
    if (is_prescribed(state.bodies.kind[body])) return;
    advance(state, body, time, entry);
    ++state.bodies.course[body].version;
}

template <class Real>
void set_velocity(State<Real>& state, Index body, const Vec3& v) {
    if (!is_prescribed(state.bodies.kind[body])) state.bodies.motion[body].v = rounded<Real>(v);
}

/// The same in a jam, for a body that is pushed in a direction: by one unit in the last place at least. A heavy one
/// that pushes light ones on would else not be slowed at all, and have impacts without end.
template <class Real>
void set_velocity_in_jam(State<Real>& state, Index body, const Vec3& v, const Vec3& push) {
    if (is_prescribed(state.bodies.kind[body])) return;
    Vector3<Real>& velocity = state.bodies.motion[body].v;
    const Vector3<Real> before = std::exchange(velocity, rounded<Real>(v));
    if (velocity != before) return;
    const auto size = [&push](int axis) { return std::abs(component(push, axis)); };
    const int axis = size(0) >= std::max(size(1), size(2)) ? 0 : (size(1) >= size(2) ? 1 : 2);
    const auto limit = std::copysign(std::numeric_limits<Real>::max(), static_cast<Real>(component(push, axis)));
    Real& part = axis == 0 ? velocity.x : (axis == 1 ? velocity.y : velocity.z);
    part = std::nextafter(part, limit);
}

template <class Real>
double mass_of(const State<Real>& state, Index body) {
    return static_cast<double>(state.bodies.mass[body]);
}

/// Brings a body to a surface. Its position is rounded there, at one height always the same way, and what bounces would
/// gain or lose energy each time: so it takes the velocity that its fall has at the rounded place.
template <class Real>
void come_to_surface(State<Real>& state, Index body, double time, Entry& entry) {
    const Motion<Real> before = state.bodies.motion[body];
    const Vec3 d = displacement(velocity_of(before), acceleration_of(state, body), time - before.t);
    take_part(state, body, time, entry);
    const double g = length(state.laws.gravity);
    if (g == 0 || state.bodies.kind[body] != Kind::free) return;
    const Vec3 down = state.laws.gravity / g;
    const Vec3 off = to_metres(state.bodies.motion[body].x - before.x, state.resolution) - d;
    const Vec3 v = velocity_of(state.bodies.motion[body]);
    const double fall = dot(v, down);
    const double square = fall * fall + 2 * g * dot(off, down);
    // At the top of its path it is nowhere but there.
    constexpr double least_part = 0.25;
    if (!(square > least_part * (fall * fall))) return;
    set_velocity(state, body, v + down * (std::copysign(std::sqrt(square), fall) - fall));
    entry.outer_impulse += (velocity_of(state.bodies.motion[body]) - v) * mass_of(state, body);
}

void apply_haste(const Haste& haste, const Laws& laws, double approach, double speed, Encounter& encounter,
                 Occurrence& occurrence) {
    double e = encounter.restitution;
    if (haste.jams) {
        e = 0;
    } else if (haste.collapses) {
        e = 1;
    } else if (haste.lasts) {
        e = lasting_restitution(e, approach, laws);
    }
    // Friction would take what keeps the bodies apart; they would sink to get it back.
    if (haste.lasts && speed < contact_speed(laws)) encounter.friction = 0;
    occurrence.is_converted = e > encounter.restitution;
    encounter.restitution = e;
}

void write_down(const Response<double>& response, Occurrence& occurrence) {
    occurrence.is_impact = true;
    occurrence.entry.lost_to_restitution += response.restitution_loss;
    occurrence.entry.lost_to_friction += response.friction_loss;
    occurrence.impact.impulse = response.impulse;
    occurrence.impact.approach_speed = response.approach_speed;
    occurrence.impact.energy_lost = response.energy_lost();
}

/// What presses a body into a support that it meets: for one that lies already, also its sliding there.
template <class Real>
Pressure pressure_here(const State<Real>& state, Index body, const Support& support, const Vec3& v) {
    Pressure pressure = pressure_on(state, state.bodies.motion[body], state.bodies.slot[body], support, v);
    pressure.acceleration =
        std::max(pressure.acceleration, dot(acceleration_of(state, body) - support.acceleration, support.normal));
    return pressure;
}

/// m/s, of a body with velocity v.
double approach_to(const Support& support, const Vec3& v) { return dot(v - support.velocity, support.normal); }

template <class Real>
bool is_obstacle(const State<Real>& state, const Support& support) {
    return support.is_wall() && state.bounds.is_facet(support.wall());
}

/// A support that a body, not piled, touches at the speed `approach`, and goes along with `v`: whether the body comes
/// to rest there. `rounding`: what is slower does not approach at all. On a support that moves it leans, as on another
/// body.
template <class Real>
bool rests(const State<Real>& state, Index body, const Support& support, double approach, const Vec3& v,
           double rounding, double e) {
    const Pressure pressure = pressure_here(state, body, support, v);
    if (approach <= rounding) return pressure.acceleration > 0;
    const double felt = std::max(0.0, approach - pressure.kick);
    if (support.is_driven) return felt < resting_speed(e, pressure.acceleration, state.laws.rest_time);
    return comes_to_rest(e, felt, pressure.acceleration, state.laws.rest_time);
}

/// A body comes to lie on a support: on an obstacle, or on what moves, it leans, as in a pile.
template <class Real>
void lie_down(State<Real>& state, Index body, const Support& support, Occurrence& occurrence) {
    if (support.is_driven || is_obstacle(state, support)) {
        pile_up(state.bodies, body);
        occurrence.piles_up = true;
    } else {
        hold_against(state, body, support, state.laws.kick_interval - occurrence.impact.offset, occurrence.entry);
    }
}

/// The blow itself.
template <class Real>
void strike(State<Real>& state, Index body, const Support& support, const Encounter& encounter,
            Occurrence& occurrence) {
    Vec3 v = velocity_of(state.bodies.motion[body]);
    Vec3 support_velocity = support.velocity;
    const Response<double> response = respond(support.normal, mass_of(state, body), v, infinite_mass, support_velocity,
                                              encounter.restitution, encounter.friction);
    set_velocity(state, body, v);
    const Vec3 impulse = -(support.normal * response.impulse) - response.friction_impulse;
    occurrence.entry.outer_impulse += impulse;
    occurrence.entry.prescribed_work += dot(impulse, support.velocity);
    write_down(response, occurrence);
}

/// Whether a body stops at a support, along which it goes with `v`, because it is squeezed against it and nothing pulls
/// it away: else whatever squeezes it would wear down in ever more impacts of a light body in between.
template <class Real>
bool stops_squeezed(const State<Real>& state, Index body, const Support& support, const Vec3& v, const Haste& haste,
                    double e) {
    const bool is_squeezed = haste.jams || (haste.stands && (e < 1 || state.laws.wears));
    return is_squeezed && !support.is_driven && pressure_here(state, body, support, v).acceleration >= 0;
}

/// What jams stands still once its speed would not take it one unit of the resolution further in the rest time: else
/// the impacts in a wedge go on down to the smallest numbers, and from the start with whatever squeezes the body next.
template <class Real>
void stand_still(State<Real>& state, Index body, const Support& support, Entry& entry) {
    const Vec3 v = velocity_of(state.bodies.motion[body]);
    if (support.is_driven || length(v) * state.laws.rest_time >= state.resolution.metres) return;
    set_velocity(state, body, {});
    entry.outer_impulse -= v * mass_of(state, body);
    entry.lost_to_restitution += 0.5 * mass_of(state, body) * length_squared(v);
}

/// A body, already at its time, against something whose motion is prescribed: a face, a static or a kinematic body. An
/// approach that is mere rounding is no impact: the body only finds one more support, beside those it may have.
template <class Real>
void meet_support(State<Real>& state, Index body, const Support& support, Encounter encounter, Occurrence& occurrence) {
    const double time = occurrence.impact.offset;
    const Vec3 v = velocity_of(state.bodies.motion[body]);
    const Vec3 relative = v - support.velocity;
    const double approach = approach_to(support, v);
    const double rounding = approach_rounding<Real>(v, support.velocity, support.normal);
    bool stays = false;
    const bool leans = is_obstacle(state, support);
    const bool is_piled = state.bodies.kind[body] == Kind::piled;
    // What its contact did not keep from sinking in: that belongs to the contact, and is no impact.
    const bool only_stops = is_piled && leans && approach <= striking_speed_at(state, body, support.wall());
    if (only_stops) encounter.restitution = 0;
    const auto radius = static_cast<double>(state.bodies.motion[body].radius);
    const bool may_rest = !is_piled && (!leans || may_lie_on_obstacle(state, support, radius, v));
    // What turns stays where it is: what presses a body on there is its own way along it.
    const Vec3 along = leans ? v : relative;
    const double e = encounter.resting_restitution;
    bool come_to_rest = may_rest && rests(state, body, support, approach, along, rounding, e);
    if (come_to_rest && support.is_driven) {
        lie_down(state, body, support, occurrence);
        return;
    }
    if (approach > rounding) {
        Haste haste = count_impact(state, body, time, approach, encounter.restitution < 1);
        // What presses a body on brings it to rest.
        haste.lasts = haste.lasts && !(pressure_here(state, body, support, along).acceleration > 0);
        occurrence.is_crushed = haste.jams && support.is_driven;
        come_to_rest = come_to_rest || (may_rest && stops_squeezed(state, body, support, along, haste, e));
        // What comes to rest in a wedge lies on both sides: else it would go from one to the other without end.
        stays = come_to_rest ? stays_on_supports(state, body, -support.normal)
                             : haste.collapses && moves_along_supports(state, body, support.normal);
        if (!stays) release(state.bodies, body);
        if (come_to_rest) {
            encounter.restitution = 0;
        } else {
            apply_haste(haste, state.laws, approach, length(relative), encounter, occurrence);
        }
        strike(state, body, support, encounter, occurrence);
        if (haste.jams) stand_still(state, body, support, occurrence.entry);
        occurrence.is_impact = !only_stops;
    }
    if (come_to_rest) {
        lie_down(state, body, support, occurrence);
    } else if (stays) {
        refresh_hold(state, body, state.laws.kick_interval - time, occurrence.entry);
    }
}

/// Undoes what roundings brought a body into a facet: in many low bounces on a surface that bends round the body, they
/// could add up until a small one comes out on the other side.
template <class Real>
void put_back(State<Real>& state, Index body, std::uint32_t wall, Entry& entry) {
    constexpr double least = 4; // units
    constexpr double most = 64; // units; more is no rounding
    Motion<Real>& m = state.bodies.motion[body];
    const Touch touch = state.bounds.impact(wall, m.x, {}, static_cast<double>(m.radius), m.t, state.resolution);
    const double depth = -touch.gap * state.resolution.per_metre;
    if (depth < least || depth > most) return;
    const Int3 shift = round_to_units(touch.normal * touch.gap, state.resolution);
    m.x = m.x + shift;
    entry.lost_to_restitution += mass_of(state, body) * dot(state.laws.gravity, to_metres(shift, state.resolution));
}

template <class Real>
void execute_wall(State<Real>& state, const Event& event, Occurrence& occurrence) {
    const std::uint32_t wall = event.wall();
    const Motion<Real>& m = state.bodies.motion[event.a];
    const Vec3 a = acceleration_of(state, event.a);
    const double duration = event.time - m.t;
    const Vec3 d = displacement(velocity_of(m), a, duration);
    const Touch touch =
        state.bounds.impact(wall, m.x, d, radius_at(state.bodies, event.a, event.time), event.time, state.resolution);
    const bool at_facet = state.bounds.is_facet(wall);
    Support support;
    const double growth = growth_of(state.bodies, event.a);
    if (at_facet) support = support_by_facet(state, wall, touch, m, d, velocity_of(m) + a * duration, growth);
    if (at_facet) {
        // It is put back onto the facet: it must not get the speed of the rounded place as well.
        take_part(state, event.a, event.time, occurrence.entry);
        put_back(state, event.a, wall, occurrence.entry);
    } else {
        come_to_surface(state, event.a, event.time, occurrence.entry);
        support = support_by_wall(state, wall, touch.normal, m, growth);
    }
    const Encounter encounter =
        encounter_of(state, event.a, state.bounds.surface(wall), approach_to(support, velocity_of(m)));
    support.friction = encounter.friction;
    occurrence.impact = {.offset = event.time,
                         .a = state.bodies.slot[event.a],
                         .face = state.bounds.face(wall),
                         .x = m.x,
                         .arm = support.normal * static_cast<double>(m.radius),
                         .normal = support.normal};
    meet_support(state, event.a, support, encounter, occurrence);
}

/// A blow on two bodies of which one lies at least, and how they yield to it.
template <class Real>
class Blow {
public:
    /// A unit impulse (N s) on b, and its reaction on a.
    Blow(const State<Real>& state, Index a, Index b, const Vec3& v_a, const Vec3& v_b, const Vec3& direction)
        : direction_(direction), mass_a_(mass_of(state, a)), mass_b_(mass_of(state, b)),
          a_(yield_to(state, a, v_a, direction / -mass_a_)), b_(yield_to(state, b, v_b, direction / mass_b_)) {}

    /// 1/kg, by how much a unit impulse changes the relative velocity along a direction.
    [[nodiscard]] double softness(const Vec3& along) const { return dot(b_.change - a_.change, along); }

    void strike(double impulse, Vec3& v_a, Vec3& v_b, Entry& entry) const {
        strike_one(impulse, a_, -direction_, mass_a_, v_a, entry);
        strike_one(impulse, b_, direction_, mass_b_, v_b, entry);
    }

private:
    static void strike_one(double impulse, const Yielding& yielding, const Vec3& direction, double mass, Vec3& v,
                           Entry& entry) {
        const Vec3 change = yielding.change * impulse;
        entry.outer_impulse += change * mass - direction * impulse;
        entry.lost_to_friction -= 0.5 * mass * impulse * dot(yielding.friction, v + v + change);
        v += change;
    }

    Vec3 direction_;
    double mass_a_;
    double mass_b_;
    Yielding a_;
    Yielding b_;
};

/// Impulses along the normal and across it, N s.
struct Impulses {
    double normal = 0;
    double across = 0;
};

/// What turns an approach into e times that and stops the sliding (m/s) across it, within Coulomb's limit. Each blow
/// also changes the other's velocity: a body that lies does not yield straight. Friction that would speed sliding up
/// does not act.
template <class Real>
Impulses impulses_of(const Blow<Real>& blow, const Vec3& n, const Blow<Real>& rub, const Vec3& t, double approach,
                     double sliding, const Encounter& encounter) {
    const double turn = (1 + encounter.restitution) * approach;
    const double softness = blow.softness(n);
    const Impulses smooth{turn / softness, 0};
    if (!(encounter.friction > 0 && sliding > 0)) return smooth;
    const double determinant = softness * rub.softness(t) - blow.softness(t) * rub.softness(n);
    Impulses both;
    both.across = (sliding * softness - turn * blow.softness(t)) / determinant;
    both.normal = (turn - both.across * rub.softness(n)) / softness;
    if (!(determinant > 0 && both.across <= encounter.friction * both.normal)) {
        both.normal = turn / (softness + encounter.friction * rub.softness(n));
        both.across = encounter.friction * both.normal;
    }
    const double left = sliding - both.normal * blow.softness(t) - both.across * rub.softness(t);
    return both.normal > 0 && both.across > 0 && sliding + left >= 0 ? both : smooth;
}

/// What a pair of blows makes of two bodies.
struct Struck {
    Vec3 v_a{};
    Vec3 v_b{};
    Entry entry{};
    double lost = 0; ///< J, between the two
};

template <class Real>
Struck struck(const Impulses& impulses, const Blow<Real>& blow, const Vec3& n, const Blow<Real>& rub, const Vec3& t,
              const Meeting& meeting) {
    Struck s{.v_a = meeting.v_a, .v_b = meeting.v_b};
    const auto strike = [&s](double impulse, const Blow<Real>& by, const Vec3& along) {
        const double before = dot(s.v_a - s.v_b, along);
        by.strike(impulse, s.v_a, s.v_b, s.entry);
        s.lost += impulse * (before - 0.5 * impulse * by.softness(along));
    };
    strike(impulses.normal, blow, n);
    if (impulses.across > 0) strike(impulses.across, rub, t);
    return s;
}

/// The collapse of an impact between a lying body and what it lies on: the limit of endlessly many impacts, in which it
/// passes the blow on to its supports and stays on them. False if the bodies, released, are to collide alone.
template <class Real>
bool meet_lying(State<Real>& state, Index a, Index b, const Meeting& meeting, const Encounter& encounter,
                Occurrence& occurrence) {
    const Vec3& n = occurrence.impact.normal;
    const Vec3 relative = meeting.v_a - meeting.v_b;
    const double approach = dot(relative, n);
    const Vec3 across = relative - n * approach;
    const double sliding = length(across);
    const Vec3 t = sliding > 0 ? across / sliding : Vec3{};
    const Blow<Real> blow(state, a, b, meeting.v_a, meeting.v_b, n);
    if (!(approach > 0 && blow.softness(n) > 0)) return false;
    const Blow<Real> rub(state, a, b, meeting.v_a, meeting.v_b, t);
    Impulses impulses = impulses_of(blow, n, rub, t, approach, sliding, encounter);
    Struck s = struck(impulses, blow, n, rub, t, meeting);
    if (impulses.across > 0 && s.lost + s.entry.lost_to_friction < 0) {
        // Friction at the supports was taken for a body that moves the other way.
        impulses = {(1 + encounter.restitution) * approach / blow.softness(n), 0};
        s = struck(impulses, blow, n, rub, t, meeting);
    }
    set_velocity(state, a, s.v_a);
    set_velocity(state, b, s.v_b);
    occurrence.entry.outer_impulse += s.entry.outer_impulse;
    occurrence.entry.lost_to_friction += s.entry.lost_to_friction;
    const double bounce_loss = 0.5 * (1 - encounter.restitution) * approach * impulses.normal;
    write_down({.approach_speed = approach,
                .impulse = impulses.normal,
                .friction_impulse = t * impulses.across,
                .restitution_loss = bounce_loss,
                .friction_loss = impulses.across > 0 ? s.lost - bounce_loss : 0},
               occurrence);
    for (const Index body : {a, b}) {
        if (state.bodies.kind[body] != Kind::held) continue;
        refresh_hold(state, body, state.laws.kick_interval - occurrence.impact.offset, occurrence.entry);
    }
    return true;
}

/// Whether two bodies that move come to rest against each other: something carries one of them, against uniform
/// gravity.
template <class Real>
bool come_to_lean(const State<Real>& state, Index a, Index b, const Meeting& meeting, const Vec3& n, double e) {
    const Bodies<Real>& bodies = state.bodies;
    if (state.laws.gravity == Vec3{} || (!rests(bodies.kind[a]) && !rests(bodies.kind[b]))) return false;
    if (leans(bodies.kind[a]) && leans(bodies.kind[b])) return false;
    const Vec3 pull = pull_on(state, b) - pull_on(state, a);
    const double pressing = pressing_along(n, length(meeting.delta), meeting.v_b - meeting.v_a, pull);
    const double speed = resting_speed(e, pressing, state.laws.rest_time);
    const double growth = growth_of(bodies, a) + growth_of(bodies, b);
    return speed > 0 && dot(meeting.v_a - meeting.v_b, n) + growth <= speed;
}

/// Two bodies that both move.
template <class Real>
void meet_body(State<Real>& state, Index a, Index b, const Meeting& meeting, const Vec3& pull, Occurrence& occurrence) {
    const ImpactRecord& impact = occurrence.impact;
    // What grows drives the surfaces on: Lubachevsky & Stillinger, J. Stat. Phys. 60, 561 (1990).
    const double growth = growth_of(state.bodies, a) + growth_of(state.bodies, b);
    const Vec3 own_growth = impact.normal * growth;
    Vec3 v_a = meeting.v_a + own_growth;
    Vec3 v_b = meeting.v_b;
    const double approach = dot(v_a - v_b, impact.normal);
    Encounter encounter = encounter_of(state, a, b, approach);
    if (come_to_lean(state, a, b, meeting, impact.normal, encounter.resting_restitution)) {
        pile_up(state.bodies, a);
        pile_up(state.bodies, b);
        occurrence.piles_up = true;
        return;
    }
    for (const Index body : {a, b}) occurrence.piles_up = wake(state.bodies, body) || occurrence.piles_up;
    const Haste haste_a = count_impact(state, a, impact.offset, approach, false);
    const Haste haste_b = count_impact(state, b, impact.offset, approach, false);
    Haste haste{.lasts = haste_a.lasts || haste_b.lasts,
                .collapses = haste_a.collapses || haste_b.collapses,
                .jams = haste_a.jams || haste_b.jams};
    occurrence.is_crushed = haste.jams && growth != 0;
    const bool one_lies = state.bodies.kind[a] == Kind::held || state.bodies.kind[b] == Kind::held;
    const bool is_contact = haste.collapses || (haste.lasts && approach < contact_speed(state.laws));
    if (one_lies && is_contact && growth == 0 && stays_on_supports(state, a, -impact.normal) &&
        stays_on_supports(state, b, impact.normal)) {
        // With the blow passed on, it is no collapse of bodies that are pressed together, only a contact; nor do they
        // fill the room between faces.
        const double pressing = pressing_along(impact.normal, length(meeting.delta), v_b - v_a, pull);
        if (pressing > 0) haste = {.lasts = true};
        apply_haste(haste, state.laws, approach, length(v_a - v_b), encounter, occurrence);
        if (meet_lying(state, a, b, meeting, encounter, occurrence)) return;
    } else {
        apply_haste(haste, state.laws, approach, length(v_a - v_b), encounter, occurrence);
    }
    release(state.bodies, a);
    release(state.bodies, b);
    const Response<double> response = respond(impact.normal, mass_of(state, a), v_a, mass_of(state, b), v_b,
                                              encounter.restitution, encounter.friction);
    if (haste.jams) {
        set_velocity_in_jam(state, a, v_a - own_growth, -impact.normal);
        set_velocity_in_jam(state, b, v_b, impact.normal);
    } else {
        set_velocity(state, a, v_a - own_growth);
        set_velocity(state, b, v_b);
    }
    occurrence.entry.prescribed_work += response.impulse * growth;
    write_down(response, occurrence);
}

/// A body, already at its time, against a static or kinematic one.
template <class Real>
void meet_static(State<Real>& state, Index body, Index fixed, const Vec3& n, Occurrence& occurrence) {
    const Bodies<Real>& bodies = state.bodies;
    occurrence.piles_up = wake(state.bodies, body);
    const double growth = growth_of(bodies, body) + growth_of(bodies, fixed);
    Support support = support_by_body(bodies.slot[fixed], n, bodies.motion[body], bodies.motion[fixed], growth);
    const Encounter encounter =
        encounter_of(state, body, fixed, approach_to(support, velocity_of(bodies.motion[body])));
    support.friction = encounter.friction;
    meet_support(state, body, support, encounter, occurrence);
}

template <class Real>
void execute_pair(State<Real>& state, const Event& event, Occurrence& occurrence) {
    const Bodies<Real>& bodies = state.bodies;
    const bool in_order = bodies.slot[event.a] < bodies.slot[event.b];
    const Index a = in_order ? event.a : event.b;
    const Index b = in_order ? event.b : event.a;
    const Path<Real> path_a = path_of(state, a);
    const Path<Real> path_b = path_of(state, b);
    const Meeting meeting = meeting_at(state, path_a, path_b, event.time);
    const Vec3 n = contact_normal(meeting.delta, meeting.v_b - meeting.v_a);
    const auto bring = [&](Index body, Index other) {
        if (bodies.kind[other] == Kind::fixed) {
            come_to_surface(state, body, event.time, occurrence.entry);
        } else {
            take_part(state, body, event.time, occurrence.entry);
        }
    };
    bring(a, b);
    bring(b, a);
    occurrence.impact = {.offset = event.time,
                         .a = bodies.slot[a],
                         .b = bodies.slot[b],
                         .x = bodies.motion[a].x,
                         .arm = n * static_cast<double>(bodies.motion[a].radius),
                         .normal = n};
    if (is_prescribed(bodies.kind[a])) {
        meet_static(state, b, a, -n, occurrence);
    } else if (is_prescribed(bodies.kind[b])) {
        meet_static(state, a, b, n, occurrence);
    } else {
        meet_body(state, a, b, meeting, path_b.acceleration - path_a.acceleration, occurrence);
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
    if (record && occurrence.impact.impulse >= least_impulse) record(occurrence.impact);
}

template void execute(State<float>&, const Event&, Occurrence&);
template void execute(State<double>&, const Event&, Occurrence&);

} // namespace carom::core
