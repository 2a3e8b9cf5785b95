#include "contact/pile.hpp"

#include <carom/collision.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <tuple>

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
Pieces Pile<Real>::pieces_of(double duration) const {
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
            const bool is_a_above = dot(delta, state_.laws.gravity) > 0;
            most_heavy = std::max(most_heavy, is_a_above ? mass / other : other / mass);
        }
        if (reach > 0) most_stretched = std::max(most_stretched, force.normal * compliance / (wanted_overlap * reach));
    }
    const double rate = std::max({least_rate, std::sqrt(most_stretched) / (2 * std::numbers::pi * stiffness),
                                  std::min(rate_per_ratio * most_heavy, most_rate)});
    constexpr double rounding = 1 - 1e-9;
    const double pieces = std::clamp(duration * rate * rounding, 1.0, most_pieces);
    return {duration, static_cast<std::uint32_t>(std::ceil(pieces))};
}

template <class Real>
void Pile<Real>::begin_step() {
    clear_for_reuse(released_);
    clear_for_reuse(contacts_);
    if (leaners_.empty() && state_.bodies.contacts.empty()) return;
    leaners_.clear();
    // Whatever is piled is to be gathered anew: bodies may have gone, or changed places in memory.
    state_.bodies.newly_piled = true;
}

template <class Real>
void Pile<Real>::begin_piece(double from, double to) {
    clear_for_reuse(released_);
    const bool is_listed = !state_.bodies.newly_piled && from < listed_until_;
    if (!is_listed && !contacts_.empty()) keep_forces();
    piece_ = to - from;
    if (!is_listed) start_list(from);
    if (leaners_.empty()) return;
    take_velocities(state_.laws.gravity * piece_);
    warm_up();
    constexpr double swing = 2 * std::numbers::pi * stiffness; // in a piece
    constexpr double damped = 2 * damping_ratio + swing;
    constexpr double a = swing * damped;
    pass({.rate = swing / (damped * piece_), .mass = a / (1 + a), .impulse = 1 / (1 + a)});
    put_velocities();
    enter_loads();
}

template <class Real>
void Pile<Real>::end_piece(double at) {
    if (leaners_.empty()) return;
    advance_all(at);
    measure();
    take_velocities({});
    pass(Softness{});
    put_velocities();
    release_unsupported();
}

template <class Real>
void Pile<Real>::end_step(double reached) {
    keep_forces();
    if (state_.bodies.newly_piled) {
        gather();
        advance_all(reached);
    }
    state_.bodies.loads.clear();
}

// ---------------------------------------------------------------------------------------------------------------------
// The list of contacts
// ---------------------------------------------------------------------------------------------------------------------

template <class Real>
void Pile<Real>::start_list(double from) {
    gather();
    clear_for_reuse(contacts_);
    if (leaners_.empty()) return;
    advance_all(from);
    listed_until_ = from + list_life;
    // In that time, pairs that are no impacts approach by no more than this.
    const double gravity = length(state_.laws.gravity);
    const double strike = 2 * told_speed();
    margin_ = (strike + gravity * list_life) * list_life + 4 * state_.resolution.metres;
    find_contacts();
    assign_cells();
    sort_contacts();
    recall_forces();
    measure();
}

template <class Real>
void Pile<Real>::gather() {
    Bodies<Real>& bodies = state_.bodies;
    leaners_.clear();
    statics_.clear();
    places_.assign(bodies.size(), nobody);
    bodies.loads.assign(bodies.size(), {});
    for (Index i = 0; i < bodies.size(); ++i) {
        if (bodies.kind[i] == Kind::fixed) statics_.push_back(i);
        if (bodies.kind[i] != Kind::piled) continue;
        places_[i] = static_cast<std::uint32_t>(leaners_.size());
        leaners_.push_back({.body = i, .inverse_mass = 1 / static_cast<double>(bodies.mass[i])});
    }
    bodies.newly_piled = false;
}

template <class Real>
void Pile<Real>::advance_all(double at) {
    std::array<ExactSum, most_parts> lost{};
    std::array<ExactSum, most_parts> mass_time{};
    for_each_in_parts(*executor_, leaners_.size(), leaner_grain, [&](std::size_t part, std::size_t k) {
        Entry entry;
        advance(state_, leaners_[k].body, at, entry);
        lost[part].add(entry.lost_to_restitution);
        mass_time[part].add(entry.held_mass_time);
    });
    for (std::size_t part = 1; part < parts_of(leaners_.size(), leaner_grain); ++part) {
        lost[0].add(lost[part]);
        mass_time[0].add(mass_time[part]);
    }
    state_.books.lost_to_restitution.add(lost[0].value());
    state_.books.held_mass_time.add(mass_time[0].value());
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
    for (std::vector<Contact>& found : found_) {
        contacts_.insert(contacts_.end(), found.begin(), found.end());
        clear_for_reuse(found);
    }
}

template <class Real>
void Pile<Real>::add_pair(std::vector<Contact>& found, Index a, Index b) const {
    const Bodies<Real>& bodies = state_.bodies;
    const bool is_static = bodies.kind[b] == Kind::fixed;
    // Of two leaners both have the other in their lists.
    if (!is_static && bodies.slot[a] > bodies.slot[b]) return;
    const Motion<Real>& m_a = bodies.motion[a];
    const Motion<Real>& m_b = bodies.motion[b];
    const double touching = static_cast<double>(m_a.radius) + static_cast<double>(m_b.radius);
    if (length(separation(state_, m_a, m_b, {}, {})) > touching + margin_) return;
    const Encounter encounter = encounter_of(state_, a, b);
    found.push_back({.a = places_[a],
                     .b = is_static ? nobody : places_[b],
                     .slot = bodies.slot[a],
                     .code = bodies.slot[b],
                     .mass = reduced_mass(a, b),
                     .friction = encounter.friction,
                     .restitution = encounter.restitution});
}

template <class Real>
double Pile<Real>::reduced_mass(Index a, Index b) const {
    const auto inverse = [this](Index i) { return 1 / static_cast<double>(state_.bodies.mass[i]); };
    return 1 / (inverse(a) + inverse(b));
}

template <class Real>
void Pile<Real>::add_walls(std::vector<Contact>& found, std::uint32_t a) const {
    const Index body = leaners_[a].body;
    const Motion<Real>& m = state_.bodies.motion[body];
    const auto radius = static_cast<double>(m.radius);
    if (!state_.bounds.may_touch(m.x, radius + margin_, state_.resolution)) return;
    for (std::uint32_t k = 0; k < state_.bounds.walls().size(); ++k) {
        const Bounds::Wall& wall = state_.bounds.walls()[k];
        if (state_.bounds.gap(wall, m.x, {}, radius, state_.resolution) > margin_) continue;
        const Encounter encounter = encounter_of(state_, body, wall);
        found.push_back({.a = a,
                         .slot = state_.bodies.slot[body],
                         .code = Support::wall_bit | k,
                         .mass = static_cast<double>(state_.bodies.mass[body]),
                         .friction = encounter.friction,
                         .restitution = encounter.restitution});
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
    const Contact& contact = contacts_[number];
    const Cell& a = cells_[contact.a];
    const Cell& b = contact.b == nobody ? a : cells_[contact.b];
    const std::uint64_t first = lower_cell(a.across[0], b.across[0], turns_[0]);
    const std::uint64_t second = lower_cell(a.across[1], b.across[1], turns_[1]);
    const std::uint64_t colour = (first & 1U) + 2 * (second & 1U);
    return {.column = colour << 60U | first << 30U | second,
            .height = std::min(a.height, b.height),
            .contact = number,
            .ids = std::uint64_t{contact.slot} << 32U | contact.code};
}

template <class Real>
void Pile<Real>::sort_contacts() {
    orders_.resize(contacts_.size());
    for (std::uint32_t k = 0; k < orders_.size(); ++k) orders_[k] = order_of(k);
    std::sort(orders_.begin(), orders_.end());
    sorted_.resize(contacts_.size());
    for (std::size_t k = 0; k < orders_.size(); ++k) sorted_[k] = contacts_[orders_[k].contact];
    contacts_.swap(sorted_);
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
        Contact& contact = contacts_[k];
        // The list of a body ends where it was counted up to.
        const std::uint32_t begin = contact.slot == 0 ? 0 : first_forces_[contact.slot - 1];
        for (std::uint32_t i = begin; i < first_forces_[contact.slot]; ++i) {
            const ContactForce& force = forces[force_order_[i]];
            if (force.code != contact.code) continue;
            contact.impulse = force.normal * piece_;
            contact.friction_impulse = force.friction * piece_;
        }
    });
}

template <class Real>
void Pile<Real>::keep_forces() {
    std::vector<ContactForce>& forces = state_.bodies.contacts;
    clear_for_reuse(forces);
    for (const Contact& c : contacts_) {
        if (!(c.impulse > 0)) continue;
        forces.push_back({c.slot, c.code, c.impulse / piece_, c.friction_impulse / piece_});
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Solving them
// ---------------------------------------------------------------------------------------------------------------------

/// Looks where the bodies of all contacts are.
template <class Real>
void Pile<Real>::measure() {
    for_each_in_parts(*executor_, contacts_.size(), contact_grain,
                      [this](std::size_t, std::size_t k) { measure(contacts_[k]); });
}

template <class Real>
void Pile<Real>::measure(Contact& contact) const {
    const Bodies<Real>& bodies = state_.bodies;
    const Motion<Real>& m = bodies.motion[leaners_[contact.a].body];
    const auto radius = static_cast<double>(m.radius);
    Vec3 relative = -velocity_of(m);
    if ((contact.code & Support::wall_bit) != 0) {
        const Bounds::Wall& wall = state_.bounds.walls()[contact.code & ~Support::wall_bit];
        contact.normal = state_.bounds.normal(wall, m.x, {}, state_.resolution);
        contact.gap = state_.bounds.gap(wall, m.x, {}, radius, state_.resolution);
    } else {
        const Motion<Real>& other = bodies.motion[bodies.slots[contact.code]];
        const Vec3 delta = separation(state_, m, other, {}, {});
        contact.normal = contact_normal(delta, Vec3{});
        contact.gap = length(delta) - radius - static_cast<double>(other.radius);
        relative += velocity_of(other);
    }
    contact.is_open = contact.gap > 0 && -dot(relative, contact.normal) > strike_of(contact);
    if (contact.is_open) contact.impulse = 0;
    contact.friction_impulse -= contact.normal * dot(contact.friction_impulse, contact.normal);
    if (contact.impulse == 0) contact.friction_impulse = {};
}

template <class Real>
double Pile<Real>::strike_of(const Contact& contact) const {
    double load = load_on(state_.bodies, leaners_[contact.a].body);
    if (contact.b != nobody) load = std::min(load, load_on(state_.bodies, leaners_[contact.b].body));
    return striking_speed(contact.restitution, load, state_.laws);
}

/// Whether the two may strike each other in the piece that has begun.
template <class Real>
bool Pile<Real>::may_strike(const Contact& contact) const {
    const Vec3 other = contact.b == nobody ? Vec3{} : leaners_[contact.b].v;
    // The normal turns on the way.
    const double closing = length(leaners_[contact.a].v - other);
    return closing > strike_of(contact) && 1.001 * closing * piece_ + 2 * state_.resolution.metres >= contact.gap;
}

/// Takes the bodies' velocities, changed by so much (m/s).
template <class Real>
void Pile<Real>::take_velocities(const Vec3& change) {
    for_each_in_parts(*executor_, leaners_.size(), leaner_grain, [&](std::size_t, std::size_t k) {
        Leaner& l = leaners_[k];
        l.before = velocity_of(state_.bodies.motion[l.body]);
        l.v = l.before + change;
    });
}

/// Gives the bodies their velocities, and enters what that changed.
template <class Real>
void Pile<Real>::put_velocities() {
    struct Change {
        ExactVectorSum momentum;
        ExactSum energy;
    };
    std::array<Change, most_parts> changes{};
    for_each_in_parts(*executor_, leaners_.size(), leaner_grain, [&](std::size_t part, std::size_t k) {
        Leaner& l = leaners_[k];
        Motion<Real>& m = state_.bodies.motion[l.body];
        m.v = rounded<Real>(l.v);
        const Vec3 after = velocity_of(m);
        const auto mass = static_cast<double>(state_.bodies.mass[l.body]);
        changes[part].momentum.add((after - l.before) * mass);
        changes[part].energy.add(0.5 * mass * dot(l.before - after, l.before + after));
    });
    for (std::size_t part = 1; part < parts_of(leaners_.size(), leaner_grain); ++part) {
        changes[0].momentum.add(changes[part].momentum);
        changes[0].energy.add(changes[part].energy);
    }
    state_.books.outer_impulse.add(changes[0].momentum.value());
    state_.books.lost_to_friction.add(friction_loss_);
    state_.books.lost_to_restitution.add(changes[0].energy.value() - friction_loss_);
}

/// Calls f(part, contact) for all contacts, colour by colour: columns of one colour at the same time, and each upwards.
template <class Real>
template <class F>
void Pile<Real>::for_each_contact(F&& f) {
    std::uint32_t begin = 0;
    for (const std::uint32_t end : colour_ends_) {
        if (end == begin) continue;
        for_each_in_parts(*executor_, end - begin, column_grain, [&](std::size_t part, std::size_t k) {
            const Column& column = columns_[begin + k];
            for (std::uint32_t c = column.begin; c < column.end; ++c) f(part, contacts_[c]);
        });
        begin = end;
    }
}

/// Applies the impulses of the piece before.
template <class Real>
void Pile<Real>::warm_up() {
    for_each_contact([this](std::size_t, Contact& contact) {
        contact.carries = false;
        if (contact.impulse > 0) push(contact, contact.normal * contact.impulse + contact.friction_impulse);
    });
}

template <class Real>
void Pile<Real>::pass(const Softness& softness) {
    std::array<double, most_parts> losses{};
    for_each_contact([&](std::size_t part, Contact& contact) {
        if (!contact.is_open) losses[part] += solve(contact, softness);
    });
    friction_loss_ = 0;
    for (const double loss : losses) friction_loss_ += loss;
}

/// Solves one contact; returns the energy that its friction took, J.
template <class Real>
double Pile<Real>::solve(Contact& contact, const Softness& softness) {
    const auto relative = [this, &contact] {
        return (contact.b == nobody ? Vec3{} : leaners_[contact.b].v) - leaners_[contact.a].v;
    };
    const double parting = dot(relative(), contact.normal);
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
    contact.carries = contact.carries || contact.impulse > 0;
    push(contact, contact.normal * impulse);
    if (contact.friction == 0) return 0;
    const Vec3 slip = relative();
    const Vec3 across = slip - contact.normal * dot(slip, contact.normal);
    const Vec3 before = contact.friction_impulse;
    Vec3 wanted = before - across * contact.mass;
    const double most = contact.friction * contact.impulse;
    const double size = length(wanted);
    if (size > most) wanted *= most / size;
    contact.friction_impulse = wanted;
    const Vec3 change = wanted - before;
    push(contact, change);
    return -dot(change, across + change * (0.5 / contact.mass));
}

/// Gives the other of a contact an impulse (N s), and the leaner the opposite.
template <class Real>
void Pile<Real>::push(const Contact& contact, const Vec3& impulse) {
    Leaner& a = leaners_[contact.a];
    a.v -= impulse * a.inverse_mass;
    if (contact.b == nobody) return;
    Leaner& b = leaners_[contact.b];
    b.v += impulse * b.inverse_mass;
}

/// Lets everybody know how the bodies are pressed.
template <class Real>
void Pile<Real>::enter_loads() {
    std::vector<Load>& loads = state_.bodies.loads;
    for (Leaner& l : leaners_) {
        // An impact may change its speed within the piece.
        l.way += std::max(length(l.v), told_speed()) * piece_ + state_.resolution.metres;
        loads[l.body] = {.pull = (l.v - l.before) / piece_, .is_told = l.way <= margin_ / 2};
    }
    for (const Contact& c : contacts_) {
        const double force = c.impulse / piece_;
        const auto press = [&](const Leaner& l) {
            double& pressing = loads[l.body].pressing;
            pressing = std::max(pressing, force * l.inverse_mass);
        };
        press(leaners_[c.a]);
        if (c.b != nobody) press(leaners_[c.b]);
    }
}

/// Lets those go that no contact with a moving body carried or pushed.
template <class Real>
void Pile<Real>::release_unsupported() {
    for (Leaner& l : leaners_) l.is_supported = false;
    for (const Contact& contact : contacts_) {
        if (!contact.carries || contact.b == nobody) continue;
        leaners_[contact.a].is_supported = true;
        leaners_[contact.b].is_supported = true;
    }
    for (const Leaner& l : leaners_) {
        if (l.is_supported) continue;
        state_.bodies.kind[l.body] = Kind::free;
        state_.bodies.loads[l.body] = {};
        released_.push_back(l.body);
    }
    // The list is without them from the next piece on.
    if (!released_.empty()) state_.bodies.newly_piled = true;
}

template class Pile<float>;
template class Pile<double>;

} // namespace carom::core
