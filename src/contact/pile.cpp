#include "contact/pile.hpp"

#include <carom/collision.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace carom::core {

namespace {

/// Contacts swing at this part of the rate of the pieces, and are damped so many times as much as would just keep them
/// from swinging: the values of Catto's Solver2D.
constexpr double stiffness = 0.25;
constexpr double damping_ratio = 10;

/// Pieces a second, at least: a heap of some ten layers keeps its shape.
constexpr double least_rate = 480;
/// Overlap, in diameters, at which a contact is to carry its load.
constexpr double wanted_overlap = 0.01;
/// Pieces a second for a body on one that is so many times lighter; and the most of them.
constexpr double rate_per_ratio = 2;
constexpr double most_rate = 1e5;
constexpr double most_pieces = 1e6;

/// s that contacts are listed for.
constexpr double list_life = 1.0 / 60;

/// The lower of two neighbouring cells along an axis, of which a periodic one has `turn`.
std::uint32_t lower_cell(std::uint32_t a, std::uint32_t b, std::uint32_t turn) {
    const bool is_around = turn > 2 && std::max(a, b) - std::min(a, b) == turn - 1;
    return is_around ? std::max(a, b) : std::min(a, b);
}

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
/// changes by halves, and goes back late.
template <class Real>
Pieces Pile<Real>::cut(double duration) {
    constexpr double low = 0.4;
    const Rates wanted = wanted_rates();
    double& rate = state_.bodies.piece_rate;
    rate = std::max(rate, least_rate);
    while (rate < wanted.load) rate *= 2;
    while (rate > least_rate && wanted.load < low * rate) rate /= 2;
    constexpr double rounding = 1 - 1e-9;
    const double pieces = std::clamp(duration * std::max(rate, wanted.mass_ratio) * rounding, 1.0, most_pieces);
    return {duration, static_cast<std::uint32_t>(std::ceil(pieces))};
}

template <class Real>
void Pile<Real>::begin_step() {
    clear_for_reuse(released_);
    clear_for_reuse(contacts_);
    listed_until_ = 0;
    if (leaners_.empty() && state_.bodies.contacts.empty()) return;
    leaners_.clear();
    // Whatever is piled is to be gathered anew: bodies may have gone, or changed places in memory.
    state_.bodies.newly_piled = true;
}

template <class Real>
void Pile<Real>::begin_piece(double from, double to) {
    clear_for_reuse(released_);
    const bool is_listed = from < listed_until_ && (!state_.bodies.newly_piled || take_back(from));
    if (!is_listed && !contacts_.empty()) keep_forces();
    piece_ = to - from;
    if (!is_listed) start_list(from);
    if (leaners_.empty()) return;
    take_velocities(state_.laws.gravity * piece_);
    warm_up();
    constexpr double swing = 2 * std::numbers::pi * stiffness; // in a piece
    constexpr double damped = 2 * damping_ratio + swing;
    constexpr double a = swing * damped;
    const Softness soft{.rate = swing / (damped * piece_), .mass = a / (1 + a), .impulse = 1 / (1 + a)};
    pass([this, &soft](std::uint32_t k) { return solve(contacts_[k], soft); });
    put_velocities();
    enter_loads();
}

template <class Real>
void Pile<Real>::end_piece(double at) {
    if (leaners_.empty()) return;
    advance_all(at);
    take_velocities({});
    pass([this](std::uint32_t k) {
        measure(k);
        return solve(contacts_[k], {});
    });
    put_velocities();
    release_unsupported();
}

template <class Real>
void Pile<Real>::end_step(double reached) {
    keep_forces();
    settle_accounts();
    if (state_.bodies.newly_piled) {
        gather();
        advance_all(reached);
        settle_accounts();
    }
    state_.bodies.loads.clear();
}

// ---------------------------------------------------------------------------------------------------------------------
// The list of contacts
// ---------------------------------------------------------------------------------------------------------------------

template <class Real>
void Pile<Real>::start_list(double from) {
    settle_accounts();
    gather();
    clear_for_reuse(contacts_);
    if (leaners_.empty()) return;
    advance_all(from);
    for (Leaner& l : leaners_) {
        l.listed = state_.bodies.motion[l.body].x;
        l.moved = {};
    }
    listed_until_ = from + list_life;
    // In that time, pairs that are no impacts approach by no more than this.
    const double gravity = length(state_.laws.gravity);
    margin_ = (2 * told_speed() + gravity * list_life) * list_life + 4 * state_.resolution.metres +
              2 * state_.bodies.top_growth * list_life;
    find_contacts();
    assign_cells();
    sort_contacts();
    recall_forces();
    measure_all();
}

template <class Real>
void Pile<Real>::gather() {
    Bodies<Real>& bodies = state_.bodies;
    leaners_.clear();
    statics_.clear();
    places_.assign(bodies.size(), nobody);
    bodies.loads.assign(bodies.size(), {});
    for (Index i = 0; i < bodies.size(); ++i) {
        if (is_prescribed(bodies.kind[i])) statics_.push_back(i);
        if (bodies.kind[i] != Kind::piled) continue;
        places_[i] = static_cast<std::uint32_t>(leaners_.size());
        leaners_.push_back({.body = i, .inverse_mass = 1 / static_cast<double>(bodies.mass[i])});
    }
    accounts_.assign(leaners_.size(), {});
    bodies.newly_piled = false;
}

/// Takes bodies back that were let go, and soon came to lean again; false if any is piled that the list does not do
/// for.
template <class Real>
bool Pile<Real>::take_back(double from) {
    const Bodies<Real>& bodies = state_.bodies;
    for (Index i = 0; i < bodies.size(); ++i) {
        if (bodies.kind[i] != Kind::piled) continue;
        if (places_[i] == nobody) return false;
        Leaner& l = leaners_[places_[i]];
        if (!l.is_gone) continue;
        Entry entry;
        advance(state_, i, from, entry);
        add_to_account(places_[i], entry);
        l.moved = to_metres(bodies.motion[i].x - l.listed, state_.resolution);
        l.way = length(l.moved);
        if (l.way > margin_ / 2) return false;
        l.is_gone = false;
        l.before = velocity_of(bodies.motion[i]);
    }
    state_.bodies.newly_piled = false;
    measure_all();
    return true;
}

template <class Real>
void Pile<Real>::add_to_account(std::uint32_t leaner, const Entry& entry) {
    accounts_[leaner].lost += entry.lost_to_restitution;
    accounts_[leaner].held_mass_time += entry.held_mass_time;
}

template <class Real>
void Pile<Real>::measure_all() {
    for_each_in_parts(*executor_, contacts_.size(), contact_grain,
                      [this](std::size_t, std::size_t k) { measure(static_cast<std::uint32_t>(k)); });
}

template <class Real>
void Pile<Real>::advance_all(double at) {
    now_ = at;
    for_each_leaner([&](std::size_t, std::size_t k) {
        Leaner& l = leaners_[k];
        Entry entry;
        advance(state_, l.body, at, entry);
        add_to_account(static_cast<std::uint32_t>(k), entry);
        l.moved = to_metres(state_.bodies.motion[l.body].x - l.listed, state_.resolution);
    });
}

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

/// Finds all that the piled bodies are nearer to than the margin.
template <class Real>
void Pile<Real>::find_contacts() {
    const Bodies<Real>& bodies = state_.bodies;
    CensusTaker taker;
    for (const Leaner& l : leaners_) taker.count(bodies.motion[l.body], Kind::piled);
    for (const Index i : statics_) taker.count(bodies.motion[i], Kind::fixed);
    const Census census = taker.census();
    ticks_ = Ticks(state_.bounds, state_.resolution, std::max(4 * census.mean_radius, state_.resolution.metres));
    const auto leaning = static_cast<Index>(leaners_.size());
    const auto body_at = [&](Index k) { return k < leaning ? leaners_[k].body : statics_[k - leaning]; };
    neighbours_.build(
        *executor_, leaners_.size() + statics_.size(), ticks_.axes(census),
        [&](Index k) {
            const Motion<Real>& m = bodies.motion[body_at(k)];
            return ticks_.ball(m.x, {}, static_cast<double>(m.radius) + margin_ / 2);
        },
        [leaning](Index k) { return k < leaning; });
    for_each_in_parts(*executor_, leaners_.size(), leaner_grain, [&](std::size_t part, std::size_t k) {
        const auto place = static_cast<Index>(k);
        neighbours_.for_each(place, [&](Index other) { add_pair(found_[part], body_at(place), body_at(other)); });
        add_walls(found_[part], place);
    });
    clear_for_reuse(all_found_);
    for (std::vector<Found>& found : found_) {
        all_found_.insert(all_found_.end(), found.begin(), found.end());
        clear_for_reuse(found);
    }
}

template <class Real>
void Pile<Real>::add_pair(std::vector<Found>& found, Index a, Index b) const {
    const Bodies<Real>& bodies = state_.bodies;
    const bool is_static = is_prescribed(bodies.kind[b]);
    // Of two leaners both have the other in their lists.
    if (!is_static && bodies.slot[a] > bodies.slot[b]) return;
    const Motion<Real>& m_a = bodies.motion[a];
    const Motion<Real>& m_b = bodies.motion[b];
    const double touching = static_cast<double>(m_a.radius) + static_cast<double>(m_b.radius);
    const Vec3 apart = separation(state_, m_a, m_b, {}, {});
    if (length(apart) > touching + margin_) return;
    const Encounter encounter = encounter_of(state_, a, b);
    found.push_back({{.slot = bodies.slot[a], .code = bodies.slot[b], .restitution = encounter.restitution},
                     {.a = places_[a],
                      .b = is_static ? nobody : places_[b],
                      .apart = apart,
                      .touching = touching,
                      .mass = reduced_mass(a, b),
                      .friction = encounter.friction,
                      .surface = is_static && (bodies.kind[b] == Kind::kinematic || grows(a, b)) ? 1U : 0U}});
}

template <class Real>
double Pile<Real>::reduced_mass(Index a, Index b) const {
    const auto inverse = [this](Index i) { return 1 / static_cast<double>(state_.bodies.mass[i]); };
    return 1 / (inverse(a) + inverse(b));
}

/// Whether one of two bodies grows.
template <class Real>
bool Pile<Real>::grows(Index a, Index b) const {
    return growth_of(state_.bodies, a) != 0 || growth_of(state_.bodies, b) != 0;
}

/// m, at which the bodies of a contact touch now.
template <class Real>
double Pile<Real>::distance_now(std::uint32_t number) const {
    const Bodies<Real>& bodies = state_.bodies;
    return radius_at(bodies, leaners_[contacts_[number].a].body, now_) +
           radius_at(bodies, bodies.slots[names_[number].code], now_);
}

template <class Real>
void Pile<Real>::add_walls(std::vector<Found>& found, std::uint32_t a) const {
    const Index body = leaners_[a].body;
    const Motion<Real>& m = state_.bodies.motion[body];
    const auto radius = static_cast<double>(m.radius);
    if (!state_.bounds.may_touch(m.x, radius + margin_, state_.resolution)) return;
    for (std::uint32_t k = 0; k < state_.bounds.walls().size(); ++k) {
        const Bounds::Wall& wall = state_.bounds.walls()[k];
        if (state_.bounds.gap(wall, m.x, {}, radius, m.t, state_.resolution) > margin_) continue;
        const Encounter encounter = encounter_of(state_, body, wall);
        found.push_back(
            {{.slot = state_.bodies.slot[body], .code = Support::wall_bit | k, .restitution = encounter.restitution},
             {.a = a,
              .mass = static_cast<double>(state_.bodies.mass[body]),
              .friction = encounter.friction,
              .surface = wall.is_driven || grows(body, body) ? 1U : 0U}});
    }
}

/// Puts every leaner into a cell with edges that no contact is longer than.
template <class Real>
void Pile<Real>::assign_cells() {
    const Bodies<Real>& bodies = state_.bodies;
    CensusTaker taker;
    double largest = 0;
    for (const Leaner& l : leaners_) {
        taker.count(bodies.motion[l.body], Kind::piled);
        largest = std::max(largest, static_cast<double>(bodies.motion[l.body].radius));
    }
    const Census census = taker.census();
    const auto edge = static_cast<std::uint64_t>((2 * largest + margin_) * state_.resolution.per_metre) + 1;
    const Vec3& g = state_.laws.gravity;
    const auto pull = [&g](int axis) { return std::abs(component(g, axis)); };
    const int up = pull(0) > std::max(pull(1), pull(2)) ? 0 : (pull(1) > pull(2) ? 1 : 2);
    const std::array<CellAxis, 3> axes{cell_axis((up + 1) % 3, census, edge), cell_axis((up + 2) % 3, census, edge),
                                       cell_axis(up, census, edge)};
    const bool is_up_positive = component(g, up) <= 0;
    turns_ = {axes[0].turn, axes[1].turn};
    cells_.resize(leaners_.size());
    for (std::size_t k = 0; k < leaners_.size(); ++k) {
        const Int3 x = state_.bounds.wrapped(bodies.motion[leaners_[k].body].x);
        const std::uint32_t along = axes[2].cell_of(x);
        cells_[k] = {{axes[0].cell_of(x), axes[1].cell_of(x)}, is_up_positive ? along : CellAxis::most - along};
    }
}

template <class Real>
auto Pile<Real>::cell_axis(int axis, const Census& census, std::uint64_t edge) const -> CellAxis {
    const auto period = static_cast<std::uint64_t>(state_.bounds.period(axis));
    if (period != 0) {
        // An even number of cells, or one, so that colours alternate all the way round.
        const auto turn = std::clamp<std::uint64_t>(period / edge / 2 * 2, 1, CellAxis::most);
        return {axis, state_.bounds.period_start(axis), period / turn, static_cast<std::uint32_t>(turn)};
    }
    const std::uint64_t extent = static_cast<std::uint64_t>(component(census.high, axis)) -
                                 static_cast<std::uint64_t>(component(census.low, axis));
    return {axis, component(census.low, axis), std::max(edge, extent / CellAxis::most + 1), 0};
}

template <class Real>
auto Pile<Real>::order_of(std::uint32_t number) const -> Order {
    const auto& [name, contact] = all_found_[number];
    const Cell& a = cells_[contact.a];
    const Cell& b = contact.b == nobody ? a : cells_[contact.b];
    const std::uint64_t first = lower_cell(a.across[0], b.across[0], turns_[0]);
    const std::uint64_t second = lower_cell(a.across[1], b.across[1], turns_[1]);
    const std::uint64_t colour = (first & 1U) + 2 * (second & 1U);
    return {.column = colour << 60U | first << 30U | second,
            .height = std::min(a.height, b.height),
            .contact = number,
            .ids = std::uint64_t{name.slot} << 32U | name.code};
}

template <class Real>
void Pile<Real>::sort_contacts() {
    orders_.resize(all_found_.size());
    for (std::uint32_t k = 0; k < orders_.size(); ++k) orders_[k] = order_of(k);
    std::sort(orders_.begin(), orders_.end());
    surfaces_.resize(1);
    contacts_.resize(orders_.size());
    names_.resize(orders_.size());
    least_strike_ = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < orders_.size(); ++k) {
        names_[k] = all_found_[orders_[k].contact].name;
        contacts_[k] = all_found_[orders_[k].contact].contact;
        if (contacts_[k].surface != 0) {
            contacts_[k].surface = static_cast<std::uint32_t>(surfaces_.size());
            surfaces_.emplace_back();
        }
        least_strike_ = std::min(least_strike_, striking_speed(names_[k].restitution, 0, state_.laws));
    }
    clear_for_reuse(columns_);
    colour_ends_ = {};
    for (std::uint32_t k = 0; k < orders_.size(); ++k) {
        if (k == 0 || orders_[k].column != orders_[k - 1].column) columns_.push_back({k, k});
        columns_.back().end = k + 1;
        colour_ends_[orders_[k].column >> 60U] = static_cast<std::uint32_t>(columns_.size());
    }
    for (std::size_t c = 1; c < colours; ++c) colour_ends_[c] = std::max(colour_ends_[c], colour_ends_[c - 1]);
}

/// Gives the contacts the impulses that their forces come to in a piece.
template <class Real>
void Pile<Real>::recall_forces() {
    const std::vector<ContactForce>& forces = state_.bodies.contacts;
    if (forces.empty()) return;
    // By body a: where its forces begin, once they are in order.
    first_forces_.assign(state_.bodies.slots.size() + 1, 0);
    for (const ContactForce& force : forces) ++first_forces_[force.a + 1];
    for (std::size_t k = 1; k < first_forces_.size(); ++k) first_forces_[k] += first_forces_[k - 1];
    force_order_.resize(forces.size());
    for (std::uint32_t k = 0; k < forces.size(); ++k) force_order_[first_forces_[forces[k].a]++] = k;
    for_each_in_parts(*executor_, contacts_.size(), contact_grain, [&](std::size_t, std::size_t k) {
        const ContactName& name = names_[k];
        // The list of a body ends where it was counted up to.
        const std::uint32_t begin = name.slot == 0 ? 0 : first_forces_[name.slot - 1];
        for (std::uint32_t i = begin; i < first_forces_[name.slot]; ++i) {
            const ContactForce& force = forces[force_order_[i]];
            if (force.code != name.code) continue;
            contacts_[k].impulse = force.normal * piece_;
            contacts_[k].friction_impulse = force.friction * piece_;
        }
    });
}

template <class Real>
void Pile<Real>::keep_forces() {
    std::vector<ContactForce>& forces = state_.bodies.contacts;
    clear_for_reuse(forces);
    for (std::size_t k = 0; k < contacts_.size(); ++k) {
        const Contact& c = contacts_[k];
        if (!(c.impulse > 0) || leaners_[c.a].is_gone) continue;
        forces.push_back({names_[k].slot, names_[k].code, c.impulse / piece_, c.friction_impulse / piece_});
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Solving them
// ---------------------------------------------------------------------------------------------------------------------

/// Looks where the bodies of a contact are.
template <class Real>
void Pile<Real>::measure(std::uint32_t number) {
    Contact& contact = contacts_[number];
    const Leaner& a = leaners_[contact.a];
    if (a.is_gone || (contact.b != nobody && leaners_[contact.b].is_gone)) {
        contact.gap = std::numeric_limits<double>::infinity();
        contact.is_open = true;
        contact.impulse = 0;
        return;
    }
    const std::uint32_t code = contact.b == nobody ? names_[number].code : 0;
    if ((code & Support::wall_bit) != 0) {
        const Motion<Real>& m = state_.bodies.motion[a.body];
        const Bounds::Wall& wall = state_.bounds.walls()[code & ~Support::wall_bit];
        contact.normal = state_.bounds.normal(wall, m.x, {}, state_.resolution);
        const double growth = growth_of(state_.bodies, a.body);
        contact.gap = state_.bounds.gap(wall, m.x, {}, radius_at(state_.bodies, a.body, now_), now_, state_.resolution);
        if (contact.surface != 0) surfaces_[contact.surface] = mean_velocity(wall, m.x) - contact.normal * growth;
    } else if (contact.surface != 0) {
        look_at_kinematic(number);
    } else {
        const Vec3 delta = contact.apart + (contact.b == nobody ? -a.moved : leaners_[contact.b].moved - a.moved);
        const double distance = length(delta);
        contact.normal = distance > 0 ? delta / distance : contact_normal(delta, Vec3{});
        const bool one_grows = !state_.bodies.growth.empty();
        contact.gap = distance - (one_grows ? distance_now(number) : contact.touching);
    }
    const double approach = approach_of(contact);
    contact.is_open = contact.gap > 0 && approach > least_strike_ && approach > strike_of(number);
    if (contact.is_open) contact.impulse = 0;
    if (contact.friction == 0) return;
    contact.friction_impulse -= contact.normal * dot(contact.friction_impulse, contact.normal);
    if (contact.impulse == 0) contact.friction_impulse = {};
}

/// The same where the other is a kinematic body.
template <class Real>
void Pile<Real>::look_at_kinematic(std::uint32_t number) {
    Contact& contact = contacts_[number];
    const Bodies<Real>& bodies = state_.bodies;
    const Index a = leaners_[contact.a].body;
    const Index b = bodies.slots[names_[number].code];
    const Motion<Real>& m = bodies.motion[a];
    const Motion<Real>& other = bodies.motion[b];
    const Vec3 delta = separation(state_, m, other, {}, velocity_of(other) * (now_ - other.t));
    contact.normal = contact_normal(delta, Vec3{});
    contact.gap = length(delta) - (radius_at(bodies, a, now_) + radius_at(bodies, b, now_));
    const double growth = growth_of(bodies, a) + growth_of(bodies, b);
    surfaces_[contact.surface] = velocity_of(other) - contact.normal * growth;
}

/// m/s, of a wall at a body, over the next piece: the way there is exact, and no swinging wall is taken for another.
template <class Real>
Vec3 Pile<Real>::mean_velocity(const Bounds::Wall& wall, const Int3& x) const {
    const Vec3 now = Bounds::velocity(wall, x, {}, now_);
    const double way = Bounds::offset_at(wall, now_ + piece_) - Bounds::offset_at(wall, now_);
    return now - wall.normal * (way / piece_ + dot(now, wall.normal));
}

/// m/s, by the velocities that the bodies had before the passes.
template <class Real>
double Pile<Real>::approach_of(const Contact& contact) const {
    const Vec3 other = contact.b == nobody ? surfaces_[contact.surface] : leaners_[contact.b].before;
    return dot(leaners_[contact.a].before - other, contact.normal);
}

template <class Real>
double Pile<Real>::strike_of(std::uint32_t number) const {
    const Contact& contact = contacts_[number];
    double load = load_on(state_.bodies, leaners_[contact.a].body);
    if (contact.b != nobody) load = std::min(load, load_on(state_.bodies, leaners_[contact.b].body));
    return striking_speed(names_[number].restitution, load, state_.laws);
}

/// Whether the two may strike each other in the piece that has begun.
template <class Real>
bool Pile<Real>::may_strike(std::uint32_t number) const {
    const Contact& contact = contacts_[number];
    // The normal turns on the way.
    // Nor is a wall's velocity the same all the way.
    if (contact.surface != 0) return true;
    const double closing = length(leaners_[contact.a].v - velocity_of_other(contact));
    const double way = 1.001 * closing * piece_ + 2 * state_.resolution.metres;
    return closing > least_strike_ && way >= contact.gap && closing > strike_of(number);
}

/// Takes the bodies' velocities, changed by so much (m/s).
template <class Real>
void Pile<Real>::take_velocities(const Vec3& change) {
    for_each_leaner([&](std::size_t, std::size_t k) {
        Leaner& l = leaners_[k];
        l.before = velocity_of(state_.bodies.motion[l.body]);
        l.v = l.before + change;
    });
}

/// Gives the bodies their velocities, and enters what that changed.
template <class Real>
void Pile<Real>::put_velocities() {
    for_each_leaner([&](std::size_t, std::size_t k) {
        Leaner& l = leaners_[k];
        Motion<Real>& m = state_.bodies.motion[l.body];
        m.v = rounded<Real>(l.v);
        const Vec3 after = velocity_of(m);
        const auto mass = static_cast<double>(state_.bodies.mass[l.body]);
        accounts_[k].momentum += (after - l.before) * mass;
        accounts_[k].lost += 0.5 * mass * dot(l.before - after, l.before + after);
    });
}

/// Calls f(part, k) for all bodies that have not been let go.
template <class Real>
template <class F>
void Pile<Real>::for_each_leaner(F&& f) {
    for_each_in_parts(*executor_, leaners_.size(), leaner_grain, [&](std::size_t part, std::size_t k) {
        if (!leaners_[k].is_gone) f(part, k);
    });
}

/// Calls f(part, number) for all contacts, colour by colour: columns of one colour at the same time, and each upwards.
template <class Real>
template <class F>
void Pile<Real>::for_each_contact(F&& f) {
    std::uint32_t begin = 0;
    for (const std::uint32_t end : colour_ends_) {
        if (end == begin) continue;
        for_each_in_parts(*executor_, end - begin, column_grain, [&](std::size_t part, std::size_t k) {
            const Column& column = columns_[begin + k];
            for (std::uint32_t c = column.begin; c < column.end; ++c) f(part, c);
        });
        begin = end;
    }
}

/// Applies the impulses of the piece before, and finds the strongest of each body.
template <class Real>
void Pile<Real>::warm_up() {
    for_each_leaner([this](std::size_t, std::size_t k) {
        leaners_[k].pressing = 0;
        leaners_[k].is_supported = false;
    });
    for_each_contact([this](std::size_t, std::uint32_t k) {
        const Contact& contact = contacts_[k];
        if (!(contact.impulse > 0)) return;
        push(contact, contact.normal * contact.impulse + contact.friction_impulse);
        const auto press = [&](Leaner& l) {
            l.pressing = std::max(l.pressing, contact.impulse * l.inverse_mass / piece_);
        };
        press(leaners_[contact.a]);
        if (contact.b != nobody) press(leaners_[contact.b]);
    });
}

/// Calls f(number), which returns the energy (J) that friction took, for all contacts.
template <class Real>
template <class F>
void Pile<Real>::pass(F&& f) {
    std::array<double, most_parts> losses{};
    for_each_contact([&](std::size_t part, std::uint32_t k) { losses[part] += f(k); });
    for (const double loss : losses) friction_loss_ += loss;
}

/// Solves one contact; returns the energy that its friction took, J.
template <class Real>
double Pile<Real>::solve(Contact& contact, const Softness& softness) {
    if (contact.is_open) return 0;
    Leaner& a = leaners_[contact.a];
    const Vec3 slip = velocity_of_other(contact) - a.v;
    const double parting = dot(slip, contact.normal);
    double impulse = 0;
    if (contact.gap > 0) {
        // As fast as they just do not touch at the end of the piece.
        impulse = -contact.mass * (parting + contact.gap / piece_);
    } else {
        impulse = -contact.mass * softness.mass * (parting + softness.rate * contact.gap) -
                  softness.impulse * contact.impulse;
    }
    impulse = std::max(impulse, -contact.impulse);
    contact.impulse += impulse;
    if (contact.impulse > 0 && contact.b != nobody) a.is_supported = leaners_[contact.b].is_supported = true;
    if (contact.impulse > 0 && contact.surface != 0) a.is_supported = true;
    push(contact, contact.normal * impulse);
    return contact.friction == 0 ? 0 : rub(contact, slip - contact.normal * parting);
}

/// Brakes the sliding (m/s) of the other on a leaner, as far as friction can; returns the energy that it took, J.
template <class Real>
double Pile<Real>::rub(Contact& contact, const Vec3& sliding) {
    const Vec3 before = contact.friction_impulse;
    Vec3 wanted = before - sliding * contact.mass;
    const double most = contact.friction * contact.impulse;
    const double size = length(wanted);
    if (size > most) wanted *= most / size;
    contact.friction_impulse = wanted;
    const Vec3 change = wanted - before;
    push(contact, change);
    return -dot(change, sliding + change * (0.5 / contact.mass));
}

/// Gives the other of a contact an impulse (N s), and the leaner the opposite.
template <class Real>
void Pile<Real>::push(const Contact& contact, const Vec3& impulse) {
    Leaner& a = leaners_[contact.a];
    a.v -= impulse * a.inverse_mass;
    if (contact.surface != 0) accounts_[contact.a].prescribed_work -= dot(impulse, surfaces_[contact.surface]);
    if (contact.b == nobody) return;
    Leaner& b = leaners_[contact.b];
    b.v += impulse * b.inverse_mass;
}

/// Lets everybody know how the bodies are pressed.
template <class Real>
void Pile<Real>::enter_loads() {
    std::array<double, most_parts> tops{}; // m^2/s^2
    for_each_leaner([&](std::size_t part, std::size_t k) {
        Leaner& l = leaners_[k];
        const double squared = length_squared(l.v);
        tops[part] = std::max(tops[part], squared);
        // An impact may change its speed within the piece.
        l.way += std::max(std::sqrt(squared), told_speed()) * piece_ + state_.resolution.metres;
        const bool is_told = l.way <= margin_ / 2;
        state_.bodies.loads[l.body] = {.pull = (l.v - l.before) / piece_, .pressing = l.pressing, .is_told = is_told};
    });
    top_speed_ = std::sqrt(*std::max_element(tops.begin(), tops.end()));
}

/// Lets those go that no contact with anything that moves carried or pushed.
template <class Real>
void Pile<Real>::release_unsupported() {
    for (Leaner& l : leaners_) {
        if (l.is_supported || l.is_gone) continue;
        l.is_gone = true;
        state_.bodies.kind[l.body] = Kind::free;
        state_.bodies.loads[l.body] = {};
        released_.push_back(l.body);
    }
}

template <class Real>
std::size_t Pile<Real>::size() const {
    return static_cast<std::size_t>(
        std::count_if(leaners_.begin(), leaners_.end(), [](const Leaner& l) { return !l.is_gone; }));
}

template class Pile<float>;
template class Pile<double>;

} // namespace carom::core
