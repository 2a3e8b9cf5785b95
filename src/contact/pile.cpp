#include "contact/pile.hpp"

#include <carom/collision.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace carom::core {

namespace {

/// Contacts swing at this part of the rate of the pieces, and are damped so many times as much as would just keep them
/// from swinging: the values of Catto's Solver2D.
constexpr double stiffness = 0.25;
constexpr double damping_ratio = 10;
/// How stiff contacts are across the normal, until they slip, in stiffnesses along it: as is usual for grains, since
/// Cundall and Strack, Géotechnique 29 (1979) 47.
constexpr double stiffness_across = 2.0 / 7;

/// Pieces a second, at least: a heap of some ten layers keeps its shape.
constexpr double least_rate = 1 / longest_piece;
/// Overlap, in diameters, at which a contact is to carry its load.
constexpr double wanted_overlap = 0.01;
/// Pieces a second for a body on one that is so many times lighter; and the most of them.
constexpr double rate_per_ratio = 2;
constexpr double most_rate = 1e5;
constexpr double most_pieces = 1e6;

} // namespace

// ---------------------------------------------------------------------------------------------------------------------
// Pieces
// ---------------------------------------------------------------------------------------------------------------------

/// A contact under the load F overlaps by F / (m w^2) if it swings at w: the larger the load, the shorter the pieces. A
/// heavy body M on a light one m gives way to one pass of a piece h by h^2 M g / m, and its swinging ends in 2 h M / m.
template <class Real>
auto Pile<Real>::wanted_rates() const -> Rates {
    double most_stretched = 0; // 1/s^2
    double most_heavy = 0;     // mass of an upper body, in masses of the lower one
    for (const ContactForce& force : state_.bodies.contacts) {
        if (!(force.normal > 0)) continue;
        const Index a = state_.bodies.slots[force.a];
        const auto mass = static_cast<double>(state_.bodies.mass[a]);
        auto reach = 2 * static_cast<double>(state_.bodies.motion[a].radius);
        double compliance = 1 / mass;
        if ((force.code & Support::wall_bit) == 0) {
            const Index b = state_.bodies.slots[force.code];
            const auto other = static_cast<double>(state_.bodies.mass[b]);
            compliance += 1 / other;
            reach = static_cast<double>(state_.bodies.motion[a].radius) +
                    static_cast<double>(state_.bodies.motion[b].radius);
            const Vec3 delta = separation(state_, state_.bodies.motion[a], state_.bodies.motion[b], {}, {});
            const double upper = dot(delta, state_.laws.gravity) > 0 ? mass : other;
            // A static body rests on nothing.
            if (std::isfinite(upper)) most_heavy = std::max(most_heavy, upper / (upper == mass ? other : mass));
        }
        if (reach > 0) most_stretched = std::max(most_stretched, force.normal * compliance / (wanted_overlap * reach));
    }
    return {.load = std::min(std::sqrt(most_stretched) / (2 * std::numbers::pi * stiffness), most_rate),
            .mass_ratio = std::min(rate_per_ratio * most_heavy, most_rate)};
}

/// Loads change from step to step. Contacts that became stiffer and softer with them would stir a heap: their rate
/// doubles for loads, and is halved when half would have done for a while.
template <class Real>
Pieces Pile<Real>::cut(double duration) {
    constexpr double low = 0.48;
    constexpr double late = 0.1; // s
    const Rates wanted = wanted_rates();
    double& rate = state_.bodies.piece_rate;
    double& calm = state_.bodies.calm;
    const double before = rate = std::max(rate, least_rate);
    while (rate < wanted.load) rate *= 2;
    rate = std::max(rate, wanted.mass_ratio);
    calm = rate > least_rate && std::max(wanted.load, wanted.mass_ratio) < low * rate ? calm + duration : 0;
    if (calm > late) {
        rate = std::max(rate / 2, least_rate);
        calm = 0;
    }
    stiffening_ = (rate / before) * (rate / before);
    constexpr double rounding = 1 - 1e-9;
    const double pieces = std::clamp(duration * rate * rounding, 1.0, most_pieces);
    return {duration, static_cast<std::uint32_t>(std::ceil(pieces))};
}

/// What is found anew in each step: where bodies are in memory, and who was let go since.
template <class Real>
void Pile<Real>::begin_step() {
    clear_for_reuse(released_);
    clear_for_reuse(untold_);
    has_values_ = false;
    bearing_ = 0;
    solver_ = &group_solver<Real>();
    constexpr double still_part = 1e-3;
    still_speed_ = still_part * length(state_.laws.gravity) * state_.laws.rest_time;
    told_speed_ = 0.5 * striking_speed(0, 0, state_.laws);
    far_ = 0.5 * state_.bodies.list_margin;
    if (!is_active()) return;
    state_.bodies.loads.assign(state_.bodies.size(), {});
    if (!state_.bodies.listed.empty()) resume_list();
}

template <class Real>
void Pile<Real>::begin_piece(double from, double to) {
    clear_for_reuse(released_);
    clear_for_reuse(untold_);
    Bodies<Real>& bodies = state_.bodies;
    // Until then bodies may come near each other that have no contact in the list, but touch only just.
    const double life = std::min(list_life, bodies.list_margin / unlisted_approach());
    const bool is_outdated = bodies.listed.empty() || ((has_far_ || is_driven()) && bodies.list_age >= life);
    now_ = from;
    if (is_outdated || (bodies.newly_piled && !take_back(from))) start_list(from);
    piece_ = to - from;
    if (bodies.listed.empty()) return;
    if (!has_values_) start_values();
    bodies.list_age += piece_;
    if (stiffening_ > 1 && list_.rubs()) stiffen();
    stiffening_ = 1;
    const Softness<Real> soft = softness();
    set_out();
    list_.for_each_bundle(*executor_, [&](std::size_t bundle, std::span<ContactGroup<Real>> groups) {
        losses_[bundle] = solver_->solve_softly(run_of(groups), soft);
    });
    for (const double loss : losses_) friction_loss_ += loss;
    book_driven(-1);
    go();
}

/// Of an implicit spring and damper over a piece: Catto, "Soft Constraints", Game Developers Conference 2011. Across
/// the normal it is a spring alone: the damper there is the hard pass.
template <class Real>
Softness<Real> Pile<Real>::softness() const {
    const double pulse = 2 * std::numbers::pi * stiffness * state_.bodies.piece_rate; // rad/s
    const double swing = pulse * piece_;
    const double damped = 2 * damping_ratio + swing;
    const double a = swing * damped;
    const double across = stiffness_across * swing * swing;
    return {.rate = static_cast<Real>(pulse / damped),
            .mass = static_cast<Real>(a / (1 + a)),
            .impulse = static_cast<Real>(1 / (1 + a)),
            .frequency = static_cast<Real>(1 / piece_),
            .stick = static_cast<Real>(across / (1 + across))};
}

template <class Real>
void Pile<Real>::end_piece(double at) {
    if (state_.bodies.listed.empty() || !has_values_) return;
    now_ = at;
    arrive(at);
    measure_walls();
    close_contacts();
    note_turns();
    book_driven(1);
    list_.for_each_bundle(*executor_, [&](std::size_t, std::span<ContactGroup<Real>> groups) {
        solver_->solve_hard(run_of(groups), static_cast<Real>(1 / piece_));
    });
    book_driven(-1);
    note_carried();
    come_to_rest();
    turn_back();
}

template <class Real>
void Pile<Real>::end_step(double reached) {
    Bodies<Real>& bodies = state_.bodies;
    state_.books.held_mass_time.add(asleep_mass() * reached);
    if (has_values_) {
        keep_forces();
        fall_asleep(reached);
    }
    if (bodies.newly_piled) advance_newcomers(reached);
    settle_accounts();
    bearing_ += bodies.sleeping.size();
    bodies.loads.clear();
    if (!is_listed_) return;
    const bool is_over = std::all_of(marks_.begin(), marks_.begin() + static_cast<std::ptrdiff_t>(bodies.listed.size()),
                                     [](std::uint8_t marks) { return (marks & gone) != 0; });
    if (!is_over) return;
    bodies.listed.clear();
    bodies.contacts.clear();
    is_listed_ = false;
}

// ---------------------------------------------------------------------------------------------------------------------
// Contacts
// ---------------------------------------------------------------------------------------------------------------------

template <class Real>
ContactRun<Real> Pile<Real>::run_of(std::span<ContactGroup<Real>> groups) {
    return {groups, movers_.data(), places_.data(), carried_.data(), list_.rubs()};
}

/// Contacts that get stiffer go on bearing what they bore: the rest of their overlap is *plastic*, as after Walton and
/// Braun, Acta Mechanica 63 (1986) 73, and bears nothing. Were it to be undone, a heap would swell between its walls,
/// and friction would keep it from doing so with any force.
template <class Real>
void Pile<Real>::stiffen() {
    const auto kept = static_cast<Real>(1 / stiffening_);
    for (ContactGroup<Real>& group : list_.groups()) {
        for (std::size_t lane = 0; lane < group_size; ++lane) {
            const Real overlap = -group.gap[lane];
            if (overlap > 0) group.plastic[lane] = overlap - (overlap - group.plastic[lane]) * kept;
        }
    }
}

/// Looks how far the walls are.
template <class Real>
void Pile<Real>::measure_walls() {
    const std::span<const std::uint32_t> at_walls = list_.at_walls();
    for_each_in_parts(*executor_, at_walls.size(), contact_grain, [&](std::size_t, std::size_t k) {
        const ContactName& name = list_.names()[at_walls[k]];
        ContactGroup<Real>& group = list_.group_of(name);
        const std::size_t lane = name.lane();
        const Motion<Real>& m = state_.bodies.motion[bodies_[group.a[lane]]];
        if (name.is_driven) return;
        const Touch touch =
            state_.bounds.contact(name.wall(), m.x, static_cast<double>(m.radius), now_, state_.resolution);
        group.gap[lane] = static_cast<Real>(touch.gap);
        put_into(group.apart, lane, touch.normal);
    });
    measure_driven();
}

/// Looks where the surfaces that move as prescribed are, and gives their anchors the velocities of the next piece.
template <class Real>
void Pile<Real>::measure_driven() {
    const std::span<const std::uint32_t> driven = list_.driven();
    for_each_in_parts(*executor_, driven.size(), contact_grain, [&](std::size_t, std::size_t k) {
        const ContactName& name = list_.names()[driven[k]];
        ContactGroup<Real>& group = list_.group_of(name);
        const std::size_t lane = name.lane();
        const Touch touch = touch_of(name, bodies_[group.a[lane]]);
        group.gap[lane] = static_cast<Real>(touch.gap);
        put_into(group.apart, lane, touch.normal);
        movers_[group.b[lane]].v = surface_velocity(name, touch.normal);
        marks_[group.b[lane]] = fast;
    });
}

/// How a body lies on a surface that moves as prescribed, now.
template <class Real>
Touch Pile<Real>::touch_of(const ContactName& name, Index body) const {
    const Bodies<Real>& bodies = state_.bodies;
    const Motion<Real>& m = bodies.motion[body];
    const double radius = radius_at(bodies, body, now_);
    if (name.is_wall()) return state_.bounds.contact(name.wall(), m.x, radius, now_, state_.resolution);
    const Index other = bodies.slots[name.code];
    const Motion<Real>& m_other = bodies.motion[other];
    const Vec3 delta = separation(state_, m, m_other, {}, velocity_of(m_other) * (now_ - m_other.t));
    return {length(delta) - (radius + radius_at(bodies, other, now_)), contact_normal(delta, Vec3{})};
}

/// m/s, over the next piece. A wall's way in it is exact: no swinging wall is taken for another.
template <class Real>
auto Pile<Real>::surface_velocity(const ContactName& name, const Vec3& normal) const -> Vector {
    const Bodies<Real>& bodies = state_.bodies;
    const Index body = bodies.slots[name.slot];
    const Vec3 grown = normal * -growth_of(bodies, body);
    if (!name.is_wall()) {
        const Index other = bodies.slots[name.code];
        return detail::narrow<Real>(velocity_of(bodies.motion[other]) + grown - normal * growth_of(bodies, other));
    }
    if (state_.bounds.is_facet(name.wall())) {
        const Motion<Real>& m = bodies.motion[body];
        const std::uint32_t facet = name.wall() - state_.bounds.first_facet();
        return detail::narrow<Real>(
            grown + state_.bounds.obstacles()->surface_velocity(facet, m.x, {}, static_cast<double>(m.radius), normal));
    }
    const Bounds::Wall& wall = state_.bounds.walls()[name.wall()];
    if (!wall.is_driven) return detail::narrow<Real>(grown);
    const Vec3 now = Bounds::velocity(wall, bodies.motion[body].x, {}, now_);
    const double way = Bounds::offset_at(wall, now_ + piece_) - Bounds::offset_at(wall, now_);
    return detail::narrow<Real>(now - wall.normal * (way / piece_ + dot(now, wall.normal)) + grown);
}

/// Enters, `sign` times, the work of the impulses so far on the surfaces that move as prescribed, at their present
/// velocities; and notes whom those carry.
template <class Real>
void Pile<Real>::book_driven(double sign) {
    for (const std::uint32_t number : list_.driven()) {
        const ContactName& name = list_.names()[number];
        const ContactGroup<Real>& group = list_.group_of(name);
        const std::size_t lane = name.lane();
        if (!(group.impulse[lane] > 0)) continue;
        const Vector impulse = vector_in(group.normal, lane) * group.impulse[lane] + vector_in(group.rub, lane);
        const Vec3 surface = detail::wide(movers_[group.b[lane]].v);
        accounts_[group.a[lane]].prescribed_work += sign * dot(detail::wide(impulse), surface);
        carried_[group.a[lane]] = 1;
    }
}

/// Closes the contacts with facets that bodies have left for others: they carried them so far.
template <class Real>
void Pile<Real>::leave_facets() {
    for_each_facet([this](std::uint32_t number) {
        const ContactName& name = list_.names()[number];
        const ContactGroup<Real>& group = list_.group_of(name);
        const std::size_t lane = name.lane();
        if (!(group.impulse[lane] > 0) || !std::isinf(group.gap[lane])) return;
        carried_[group.a[lane]] = 1;
        close(number, std::numeric_limits<double>::infinity());
    });
}

/// Notes how far the normals of facets have turned under the bodies in the piece.
template <class Real>
void Pile<Real>::note_turns() {
    clear_for_reuse(turns_);
    for_each_facet([this](std::uint32_t number) {
        const ContactName& name = list_.names()[number];
        const ContactGroup<Real>& group = list_.group_of(name);
        const std::size_t lane = name.lane();
        if (!(group.impulse[lane] > 0)) return;
        const Vector way = vector_in(group.apart, lane) - vector_in(group.normal, lane);
        turns_.push_back({number, way, dot(movers_[group.a[lane]].v, way)});
    });
}

/// The hard pass turns impulses all the way with the normals, for the next piece to begin with. But what bears a load
/// does so where the load came, at the start of the piece; and what takes a body round a bend, from one speed along it
/// to the same a little further on, points halfway: neither does work.
template <class Real>
void Pile<Real>::turn_back() {
    for (const Turn& turn : turns_) {
        const ContactName& name = list_.names()[turn.number];
        const ContactGroup<Real>& group = list_.group_of(name);
        const std::uint32_t a = group.a[name.lane()];
        const Real impulse = group.impulse[name.lane()];
        if ((marks_[a] & gone) != 0 || !(impulse > 0)) continue;
        const Real all = impulse * movers_[a].inverse_mass;
        state_.bodies.motion[bodies_[a]].v += turn.way * (all - static_cast<Real>(0.5) * turn.deflection);
    }
}

/// Notes whom obstacles carry.
template <class Real>
void Pile<Real>::note_carried() {
    for_each_facet([this](std::uint32_t number) {
        const ContactName& name = list_.names()[number];
        const ContactGroup<Real>& group = list_.group_of(name);
        if (group.impulse[name.lane()] > 0) carried_[group.a[name.lane()]] = 1;
    });
}

/// Closes the contacts of bodies that were let go, and those that are left to the impacts, because the two come too
/// fast.
template <class Real>
void Pile<Real>::close_contacts() {
    reopen_contacts();
    if (state_.bodies.top_growth != 0) {
        for (const ContactName& name : list_.names()) {
            if (!name.is_wall()) list_.open(name, now_);
        }
    }
    leave_facets();
    const auto closes = [this](const ContactName& name) {
        const ContactGroup<Real>& group = list_.group_of(name);
        const std::size_t lane = name.lane();
        if (((marks_[group.a[lane]] | marks_[group.b[lane]]) & gone) != 0) return true;
        if (!is_closing(name)) return false;
        const double approach = approach_of(name);
        return approach > least_strike_ && gap_of(name) > 0 && approach > strike_of(name);
    };
    for (const std::uint32_t number : find_marked(fast | gone, closes)) close(number, gap_of(list_.names()[number]));
}

/// What the impulse so far did remains, but is not done again.
template <class Real>
void Pile<Real>::close(std::uint32_t number, double gap) {
    const ContactName& name = list_.names()[number];
    ContactGroup<Real>& group = list_.group_of(name);
    const std::size_t lane = name.lane();
    const Real size = group.impulse[lane];
    const Vector impulse = vector_in(group.normal, lane) * size + vector_in(group.rub, lane);
    const std::uint32_t a = group.a[lane];
    const std::uint32_t b = group.b[lane];
    shares_[a] += impulse * movers_[a].inverse_mass;
    if (b < shares_.size()) shares_[b] -= impulse * movers_[b].inverse_mass;
    group.impulse[lane] = 0;
    for (auto& lanes : group.rub) lanes[lane] = 0;
    for (auto& lanes : group.sprung) lanes[lane] = 0;
    group.touching[lane] = -1;
    group.plastic[lane] = 0;
    group.gap[lane] = std::numeric_limits<Real>::infinity();
    closed_.push_back({number, gap});
}

template <class Real>
void Pile<Real>::reopen_contacts() {
    for (const Closed& closed : closed_) {
        const ContactName& name = list_.names()[closed.number];
        if (!name.is_wall()) list_.open(name, now_);
    }
    clear_for_reuse(closed_);
}

template <class Real>
double Pile<Real>::gap_of(const ContactName& name) const {
    const ContactGroup<Real>& group = list_.group_of(name);
    const std::size_t lane = name.lane();
    if (name.is_wall() || name.is_driven) return static_cast<double>(group.gap[lane]);
    const Vec3 apart = detail::wide(vector_in(group.apart, lane));
    const Vec3 delta = apart + (detail::wide(places_[group.b[lane]].x) - detail::wide(places_[group.a[lane]].x));
    return length(delta) - static_cast<double>(group.touching[lane]);
}

/// m/s, along the line between the two as they are now.
template <class Real>
double Pile<Real>::approach_of(const ContactName& name) const {
    const ContactGroup<Real>& group = list_.group_of(name);
    const std::size_t lane = name.lane();
    const std::uint32_t a = group.a[lane];
    const std::uint32_t b = group.b[lane];
    const Vec3 apart = detail::wide(vector_in(group.apart, lane));
    const bool is_given = name.is_wall() || name.is_driven;
    const Vec3 delta = is_given ? apart : apart + (detail::wide(places_[b].x) - detail::wide(places_[a].x));
    const double approach = dot(detail::wide(movers_[a].v) - detail::wide(movers_[b].v), contact_normal(delta, Vec3{}));
    if (is_given) return approach; // their own motion holds the growth
    const Bodies<Real>& bodies = state_.bodies;
    return approach + growth_of(bodies, bodies.slots[name.slot]) + growth_of(bodies, bodies.slots[name.code]);
}

/// Whether the two go so fast relative to each other that they could strike, whatever their normal.
template <class Real>
bool Pile<Real>::is_closing(const ContactName& name) const {
    if (state_.bodies.top_growth != 0) return true;
    const ContactGroup<Real>& group = list_.group_of(name);
    const Vec3 v_a = detail::wide(movers_[group.a[name.lane()]].v);
    const Vec3 v_b = detail::wide(movers_[group.b[name.lane()]].v);
    return length_squared(v_a - v_b) > least_strike_ * least_strike_;
}

template <class Real>
double Pile<Real>::strike_of(const ContactName& name) const {
    const Bodies<Real>& bodies = state_.bodies;
    const ContactGroup<Real>& group = list_.group_of(name);
    double load = load_on(bodies, bodies_[group.a[name.lane()]]);
    const std::uint32_t b = group.b[name.lane()];
    if (b < bodies_.size()) load = std::min(load, load_on(bodies, bodies_[b]));
    return striking_speed(name.restitution, load, state_.laws);
}

/// Whether the two may strike each other in the piece that has begun.
template <class Real>
bool Pile<Real>::may_strike(const ContactName& name, double gap) const {
    const ContactGroup<Real>& group = list_.group_of(name);
    const std::uint32_t a = group.a[name.lane()];
    const std::uint32_t b = group.b[name.lane()];
    if (((marks_[a] | marks_[b]) & gone) != 0) return false;
    // What moves as prescribed may do so in another way soon; but what turns is where it is.
    if (name.is_driven && !(name.is_wall() && state_.bounds.is_facet(name.wall()))) return !std::isinf(gap);
    if (!is_closing(name)) return false;
    // The normal turns on the way.
    const double closing =
        length(detail::wide(movers_[a].v) - detail::wide(movers_[b].v)) + 2 * state_.bodies.top_growth;
    const double way = 1.001 * closing * piece_ + 2 * state_.resolution.metres;
    return way >= gap && closing > strike_of(name);
}

/// Whether a body may sink so deep into an obstacle in the piece that it has to be stopped.
template <class Real>
bool Pile<Real>::may_sink(const ContactName& name) const {
    const ContactGroup<Real>& group = list_.group_of(name);
    const std::uint32_t a = group.a[name.lane()];
    if ((marks_[a] & gone) != 0) return false;
    const auto radius = static_cast<double>(state_.bodies.motion[bodies_[a]].radius);
    const double deepest = (1 - deepest_in_surface) * state_.bounds.obstacles()->contact_distance(radius);
    const double speed = length(detail::wide(movers_[a].v)) + std::abs(growth_of(state_.bodies, bodies_[a]));
    const double way = 1.001 * speed * piece_ + 2 * state_.resolution.metres;
    return way >= static_cast<double>(group.gap[name.lane()]) + deepest;
}

// ---------------------------------------------------------------------------------------------------------------------
// Leaners
// ---------------------------------------------------------------------------------------------------------------------

/// Enters into the books what has happened to the bodies since they were gathered: exactly, so that their order in
/// memory does not matter.
template <class Real>
void Pile<Real>::settle_accounts() {
    struct Sums {
        ExactVectorSum momentum;
        ExactSum lost;
        ExactSum prescribed_work;
        ExactSum held_mass_time;
    };
    if (accounts_.empty()) return;
    if (has_values_)
        for_each_leaner([this](Findings&, std::size_t k) { enter(k, state_.bodies.motion[bodies_[k]].v); });
    std::array<Sums, most_parts> sums{};
    for_each_in_parts(*executor_, accounts_.size(), leaner_grain, [&](std::size_t part, std::size_t k) {
        sums[part].momentum.add(accounts_[k].momentum);
        sums[part].lost.add(accounts_[k].lost);
        sums[part].prescribed_work.add(accounts_[k].prescribed_work);
        sums[part].held_mass_time.add(accounts_[k].held_mass_time);
    });
    for (std::size_t part = 1; part < parts_of(accounts_.size(), leaner_grain); ++part) {
        sums[0].momentum.add(sums[part].momentum);
        sums[0].lost.add(sums[part].lost);
        sums[0].prescribed_work.add(sums[part].prescribed_work);
        sums[0].held_mass_time.add(sums[part].held_mass_time);
    }
    state_.books.outer_impulse.add(sums[0].momentum.value());
    state_.books.lost_to_friction.add(friction_loss_);
    const double work = sums[0].prescribed_work.value();
    state_.books.prescribed_work.add(work);
    state_.books.lost_to_restitution.add(sums[0].lost.value() + work - friction_loss_);
    state_.books.held_mass_time.add(sums[0].held_mass_time.value());
    friction_loss_ = 0;
    accounts_.clear();
}

/// Puts together what the parts of a loop have found.
template <class Real>
void Pile<Real>::collect(std::vector<Index>& bodies) {
    has_far_ = false;
    all_marks_ &= gone;
    if (!list_.driven().empty()) all_marks_ |= fast;
    for (Findings& findings : findings_) {
        has_far_ = has_far_ || findings.has_far;
        if (findings.has_fast) all_marks_ |= fast;
        bodies.insert(bodies.end(), findings.bodies.begin(), findings.bodies.end());
        clear_for_reuse(findings.bodies);
        findings.has_far = findings.has_fast = false;
    }
}

template <class Real>
void Pile<Real>::place(std::size_t leaner) {
    const Int3 way = state_.bodies.motion[bodies_[leaner]].x - state_.bodies.listed[leaner].x;
    places_[leaner].x = rounded<Real>(to_metres(way, state_.resolution));
}

/// Whether it has moved too far for the list.
template <class Real>
bool Pile<Real>::is_far(std::size_t leaner) const {
    return length_squared(detail::wide(places_[leaner].x)) > far_ * far_;
}

/// Whether a mover's speed, or what grows, could make a strike.
template <class Real>
bool Pile<Real>::mark(std::size_t leaner) {
    const bool is_fast = state_.bodies.top_growth != 0 ||
                         4 * length_squared(detail::wide(movers_[leaner].v)) > least_strike_ * least_strike_;
    marks_[leaner] = is_fast ? fast : 0;
    return is_fast;
}

/// What gravity and the contacts of the piece before give the bodies.
template <class Real>
void Pile<Real>::set_out() {
    fall_ = rounded<Real>(state_.laws.gravity * piece_);
    for_each_leaner(
        [this](Findings&, std::size_t k) { movers_[k].v = state_.bodies.motion[bodies_[k]].v + fall_ + shares_[k]; });
}

/// The bodies go as the contacts let them.
template <class Real>
void Pile<Real>::go() {
    const auto frequency = static_cast<Real>(1 / piece_);
    // The list does not know of what has grown since. An impact may change its speed within the piece.
    const double grown = state_.bodies.top_growth * state_.bodies.list_age;
    const double room = far_ - grown - state_.resolution.metres;
    const double room_if_slow = room - told_speed_ * piece_;
    for_each_leaner([&](Findings& findings, std::size_t k) {
        const Index body = bodies_[k];
        const Vector v = movers_[k].v;
        const Vector start = std::exchange(state_.bodies.motion[body].v, v);
        shares_[k] = v - (start + fall_);
        if (mark(k)) findings.has_fast = true;
        const double speed_squared = length_squared(detail::wide(v));
        const double moved_squared = length_squared(detail::wide(places_[k].x));
        const bool is_told = speed_squared <= told_speed_ * told_speed_
                                 ? room_if_slow >= 0 && moved_squared <= room_if_slow * room_if_slow
                                 : std::sqrt(moved_squared) + std::sqrt(speed_squared) * piece_ <= room;
        Load<Real>& load = state_.bodies.loads[body];
        load.given = v;
        load.pull = (v - start) * frequency;
        load.pressing = places_[k].pressing;
        load.is_told = is_told;
        if (!is_told) findings.bodies.push_back(body);
    });
    collect(untold_);
}

/// Looks where the bodies have come to.
template <class Real>
void Pile<Real>::arrive(double at) {
    for_each_leaner([&](Findings& findings, std::size_t k) {
        advance_leaner(k, at);
        place(k);
        carried_[k] = 0;
        places_[k].pressing = 0;
        const Vector v = state_.bodies.motion[bodies_[k]].v;
        if (v != movers_[k].v) { // it was struck, and the impact is in the books
            enter(k, movers_[k].v);
            movers_[k].v = entered_[k] = v;
            mark(k);
        }
        if ((marks_[k] & fast) != 0) findings.has_fast = true;
        if (is_far(k)) findings.has_far = true;
    });
    collect(untold_);
}

/// What the hard pass leaves of the velocities; those whom no contact with a moving body or an obstacle carried or
/// pushed in two pieces are let go. Not in one: what would carry it may have come to lean in that piece, and be listed
/// only now; and would be let go in the next, as nothing but the one that it carries leans on it.
template <class Real>
void Pile<Real>::come_to_rest() {
    const bool had_far = has_far_;
    for_each_leaner([this](Findings& findings, std::size_t k) {
        const Index body = bodies_[k];
        Vector& v = state_.bodies.motion[body].v;
        shares_[k] += movers_[k].v - v;
        v = movers_[k].v;
        ListedBody& listed = state_.bodies.listed[k];
        const bool is_still = length_squared(detail::wide(movers_[k].v)) <= still_speed_ * still_speed_;
        listed.still = is_still ? listed.still + piece_ : 0;
        const bool was_borne = std::exchange(listed.is_borne, carried_[k] != 0);
        if (was_borne || listed.is_borne) return;
        listed.is_borne = true; // when it comes back
        enter(k, movers_[k].v);
        marks_[k] = gone;
        state_.bodies.kind[body] = Kind::free;
        state_.bodies.loads[body] = {};
        findings.bodies.push_back(body);
    });
    collect(released_);
    has_far_ = had_far;
    if (!released_.empty()) all_marks_ |= gone;
}

/// Brings a body to time `at`.
template <class Real>
void Pile<Real>::advance_leaner(std::size_t leaner, double at) {
    Motion<Real>& m = state_.bodies.motion[bodies_[leaner]];
    const double duration = at - m.t;
    const Int3 start = m.x;
    move_on(m, {}, at, state_.resolution);
    Entry entry;
    // What creeps by less than the resolution stays, and gravity does no work on it.
    book_piled_way(state_, bodies_[leaner], to_metres(m.x - start, state_.resolution), duration, entry);
    accounts_[leaner].lost += entry.lost_to_restitution;
    accounts_[leaner].held_mass_time += entry.held_mass_time;
}

/// Enters what has changed a body's velocity since that was entered, but for impacts.
template <class Real>
void Pile<Real>::enter(std::size_t leaner, const Vector& v) {
    const auto mass = static_cast<double>(state_.bodies.mass[bodies_[leaner]]);
    const Vec3 before = detail::wide(entered_[leaner]);
    const Vec3 after = detail::wide(v);
    accounts_[leaner].momentum += (after - before) * mass;
    accounts_[leaner].lost += 0.5 * mass * dot(before - after, before + after);
    entered_[leaner] = v;
}

template <class Real>
std::size_t Pile<Real>::size() const {
    const Bodies<Real>& bodies = state_.bodies;
    if (!is_active() && bodies.sleeping.empty()) return 0;
    return static_cast<std::size_t>(std::count_if(bodies.kind.begin(), bodies.kind.end(), leans));
}

template class Pile<float>;
template class Pile<double>;

} // namespace carom::core
