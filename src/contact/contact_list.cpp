#include "contact/contact_list.hpp"

#include <cmath>
#include <numeric>

namespace carom::core {

namespace {

/// The lower of two neighbouring cells along an axis, of which a periodic one has `turn`.
std::uint32_t lower_cell(std::uint32_t a, std::uint32_t b, std::uint32_t turn) {
    const bool is_around = turn > 2 && std::max(a, b) - std::min(a, b) == turn - 1;
    return is_around ? std::max(a, b) : std::min(a, b);
}

} // namespace

template <class Real>
void ContactList<Real>::clear() {
    names_.clear();
    groups_.clear();
    bundles_.clear();
    at_walls_.clear();
    driven_.clear();
    colour_ends_ = {};
    movers_ = 0;
}

template <class Real>
void ContactList<Real>::find(Executor& executor, double margin, double time) {
    number_leaners();
    look_around(executor, margin, time);
    arrange(executor);
}

template <class Real>
void ContactList<Real>::recall(Executor& executor) {
    number_leaners();
    clear_for_reuse(found_);
    const auto leaner = [this](std::uint32_t slot) { return places_[state_.bodies.slots[slot]]; };
    for (const ContactForce& force : state_.bodies.contacts) {
        const bool is_wall = (force.code & Support::wall_bit) != 0;
        found_.push_back({leaner(force.a), is_wall ? nobody : leaner(force.code), force.a, force.code});
    }
    arrange(executor);
}

template <class Real>
void ContactList<Real>::number_leaners() {
    const Bodies<Real>& bodies = state_.bodies;
    places_.assign(bodies.size(), nobody);
    for (std::uint32_t k = 0; k < bodies.listed.size(); ++k) places_[bodies.slots[bodies.listed[k].slot]] = k;
}

// ---------------------------------------------------------------------------------------------------------------------
// Finding
// ---------------------------------------------------------------------------------------------------------------------

template <class Real>
void ContactList<Real>::look_around(Executor& executor, double margin, double time) {
    const Bodies<Real>& bodies = state_.bodies;
    clear_for_reuse(statics_);
    CensusTaker taker;
    for (Index i = 0; i < bodies.size(); ++i) {
        const bool is_leaner = places_[i] != nobody;
        if (!is_leaner && !is_still(bodies.kind[i]) && !is_prescribed(bodies.kind[i])) continue;
        if (!is_leaner) statics_.push_back(i);
        taker.count(bodies.motion[i], bodies.kind[i]);
    }
    const Census census = taker.census();
    ticks_ = Ticks(state_.bounds, state_.resolution, std::max(4 * census.mean_radius, state_.resolution.metres));
    const auto leaning = static_cast<Index>(bodies.listed.size());
    const auto body_at = [&](Index k) {
        return k < leaning ? bodies.slots[bodies.listed[k].slot] : statics_[k - leaning];
    };
    neighbours_.build(
        executor, bodies.listed.size() + statics_.size(), ticks_.axes(census),
        [&](Index k) {
            const Motion<Real>& m = bodies.motion[body_at(k)];
            const Vec3 way = k < leaning ? Vec3{} : velocity_of(m) * (time - m.t);
            return ticks_.ball(m.x, way, radius_at(bodies, body_at(k), time) + margin / 2);
        },
        [leaning](Index k) { return k < leaning; });
    for_each_in_parts(executor, bodies.listed.size(), leaner_grain, [&](std::size_t part, std::size_t k) {
        const auto place = static_cast<Index>(k);
        neighbours_.for_each(
            place, [&](Index other) { add_pair(found_in_part_[part], body_at(place), body_at(other), margin, time); });
        add_walls(found_in_part_[part], place, margin, time);
    });
    clear_for_reuse(found_);
    for (std::vector<Found>& found : found_in_part_) {
        found_.insert(found_.end(), found.begin(), found.end());
        clear_for_reuse(found);
    }
}

template <class Real>
void ContactList<Real>::add_pair(std::vector<Found>& found, Index a, Index b, double margin, double time) const {
    const Bodies<Real>& bodies = state_.bodies;
    const bool is_static = places_[b] == nobody;
    // Of two leaners both have the other in their lists.
    if (!is_static && bodies.slot[a] > bodies.slot[b]) return;
    const Motion<Real>& m_a = bodies.motion[a];
    const Motion<Real>& m_b = bodies.motion[b];
    const double touching = radius_at(bodies, a, time) + radius_at(bodies, b, time);
    const Vec3 way = is_static ? velocity_of(m_b) * (time - m_b.t) : Vec3{};
    if (length(separation(state_, m_a, m_b, {}, way)) > touching + margin) return;
    found.push_back({places_[a], is_static ? nobody : places_[b], bodies.slot[a], bodies.slot[b]});
}

template <class Real>
void ContactList<Real>::add_walls(std::vector<Found>& found, std::uint32_t a, double margin, double time) const {
    const std::uint32_t slot = state_.bodies.listed[a].slot;
    const Index body = state_.bodies.slots[slot];
    const Motion<Real>& m = state_.bodies.motion[body];
    const double radius = radius_at(state_.bodies, body, time);
    const Bounds& bounds = state_.bounds;
    const auto add = [&](std::uint32_t wall) { found.push_back({a, nobody, slot, Support::wall_bit | wall}); };
    if (bounds.may_touch_wall(m.x, radius + margin, state_.resolution)) {
        for (std::uint32_t k = 0; k < bounds.first_facet(); ++k) {
            if (bounds.gap(bounds.walls()[k], m.x, {}, radius, time, state_.resolution) <= margin) add(k);
        }
    }
    if (bounds.obstacles() == nullptr) return;
    // Those too to which it slides while the list lasts.
    constexpr double ahead = 1.0 / 50; // s
    bounds.obstacles()->for_each_contact(m.x, radius + margin + length(velocity_of(m)) * ahead,
                                         [&](std::uint32_t facet) { add(bounds.first_facet() + facet); });
}

// ---------------------------------------------------------------------------------------------------------------------
// The order
// ---------------------------------------------------------------------------------------------------------------------

template <class Real>
void ContactList<Real>::arrange(Executor& executor) {
    assign_cells();
    sort(executor);
    make_groups(executor);
}

template <class Real>
std::uint64_t ContactList<Real>::wanted_edge(double time) const {
    const Bodies<Real>& bodies = state_.bodies;
    double largest = 0;
    for (const ListedBody& l : bodies.listed) {
        largest = std::max(largest, radius_at(bodies, bodies.slots[l.slot], time));
    }
    return static_cast<std::uint64_t>((2 * largest + bodies.list_margin) * state_.resolution.per_metre) + 1;
}

/// Puts every leaner into a cell.
template <class Real>
void ContactList<Real>::assign_cells() {
    const Bodies<Real>& bodies = state_.bodies;
    CensusTaker taker;
    for (const ListedBody& l : bodies.listed) taker.count(Motion<Real>{.x = l.x}, Kind::piled);
    const Census census = taker.census();
    const std::uint64_t edge = bodies.list_edge;
    const Vec3& g = state_.laws.gravity;
    const auto pull = [&g](int axis) { return std::abs(component(g, axis)); };
    const int up = pull(0) > std::max(pull(1), pull(2)) ? 0 : (pull(1) > pull(2) ? 1 : 2);
    const std::array<CellAxis, 3> axes{cell_axis((up + 1) % 3, census, edge), cell_axis((up + 2) % 3, census, edge),
                                       cell_axis(up, census, edge)};
    const bool is_up_positive = component(g, up) <= 0;
    turns_ = {axes[0].turn, axes[1].turn};
    cells_.resize(bodies.listed.size());
    for (std::size_t k = 0; k < bodies.listed.size(); ++k) {
        const Int3 x = state_.bounds.wrapped(bodies.listed[k].x);
        const std::uint32_t along = axes[2].cell_of(x);
        cells_[k] = {{axes[0].cell_of(x), axes[1].cell_of(x)}, is_up_positive ? along : CellAxis::most - along};
    }
}

template <class Real>
auto ContactList<Real>::cell_axis(int axis, const Census& census, std::uint64_t edge) const -> CellAxis {
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
auto ContactList<Real>::order_of(std::uint32_t number) const -> Order {
    const Found& found = found_[number];
    const Cell& a = cells_[found.a];
    const Cell& b = found.b == nobody ? a : cells_[found.b];
    const std::uint64_t first = lower_cell(a.across[0], b.across[0], turns_[0]);
    const std::uint64_t second = lower_cell(a.across[1], b.across[1], turns_[1]);
    const std::uint64_t colour = (first & 1U) + 2 * (second & 1U);
    return {.column = (colour << Order::column_bits | first) << Order::column_bits | second,
            .height = std::min(a.height, b.height),
            .contact = number,
            .ids = std::uint64_t{found.slot} << 32U | found.code};
}

/// Into buckets first, which neighbouring columns of one colour share where there are more columns than buckets:
/// columns of one colour may be solved in any order.
template <class Real>
void ContactList<Real>::sort(Executor& executor) {
    constexpr std::size_t order_grain = 4096;
    constexpr std::size_t bucket_grain = 16;
    constexpr std::size_t leaners_of_bucket = 8;
    constexpr unsigned most_bits = 10;
    unsigned bits = 0; // along either axis
    while (bits < most_bits && (colours << 2 * (bits + 1)) * leaners_of_bucket <= state_.bodies.listed.size()) ++bits;
    const auto bucket_of = [bits](const Order& order) {
        const std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
        const std::uint64_t colour = order.column >> 2 * Order::column_bits;
        const std::uint64_t first = order.column >> (Order::column_bits + 1) & mask;
        return (colour << bits | first) << bits | (order.column >> 1U & mask);
    };
    unsorted_.resize(found_.size());
    orders_.resize(found_.size());
    for_each_in_parts(executor, found_.size(), order_grain,
                      [&](std::size_t, std::size_t k) { unsorted_[k] = order_of(static_cast<std::uint32_t>(k)); });
    bucket_ends_.assign((colours << 2 * bits) + 1, 0);
    for (const Order& order : unsorted_) ++bucket_ends_[bucket_of(order) + 1];
    std::partial_sum(bucket_ends_.begin(), bucket_ends_.end(), bucket_ends_.begin());
    for (const Order& order : unsorted_) orders_[bucket_ends_[bucket_of(order)]++] = order;
    for_each_in_parts(executor, colours << 2 * bits, bucket_grain, [&](std::size_t, std::size_t bucket) {
        const auto place = [this](std::uint32_t k) { return orders_.begin() + static_cast<std::ptrdiff_t>(k); };
        std::sort(place(bucket == 0 ? 0 : bucket_ends_[bucket - 1]), place(bucket_ends_[bucket]));
    });
}

// ---------------------------------------------------------------------------------------------------------------------
// Groups
// ---------------------------------------------------------------------------------------------------------------------

template <class Real>
void ContactList<Real>::make_groups(Executor& executor) {
    plan_bundles();
    names_.resize(orders_.size());
    next_group_.assign(state_.bodies.listed.size(), 0);
    needs_.resize(bundles_.size());
    kinds_.resize(bundles_.size());
    for_each_coloured(
        executor, [this](std::size_t part, std::size_t k) { needs_[k] = assign_groups(bundles_[k], fillings_[part]); });
    give_room();
    for_each_in_parts(executor, bundles_.size(), 1,
                      [this](std::size_t, std::size_t k) { kinds_[k] = fill(bundles_[k]); });
    rubs_ = false;
    largest_restitution_ = 0;
    for (const Kinds& kinds : kinds_) {
        rubs_ = rubs_ || kinds.rubs;
        largest_restitution_ = std::max(largest_restitution_, kinds.largest_restitution);
    }
}

/// Whole columns make up bundles, which are for one thread each, and large enough to fill groups.
template <class Real>
void ContactList<Real>::plan_bundles() {
    constexpr std::size_t bundled = 1024;
    clear();
    const auto colour_of = [this](std::size_t k) { return orders_[k].column >> 2 * Order::column_bits; };
    for (std::size_t begin = 0, k = 0; k < orders_.size(); begin = k) {
        do {
            ++k;
            const bool ends_column = k == orders_.size() || orders_[k].column != orders_[k - 1].column;
            const bool is_enough = k - begin >= bundled || k == orders_.size() || colour_of(k) != colour_of(begin);
            if (ends_column && is_enough) break;
        } while (true);
        bundles_.push_back({.first = static_cast<std::uint32_t>(begin), .last = static_cast<std::uint32_t>(k)});
        colour_ends_[colour_of(begin)] = static_cast<std::uint32_t>(bundles_.size());
    }
    for (std::size_t c = 1; c < colours; ++c) colour_ends_[c] = std::max(colour_ends_[c], colour_ends_[c - 1]);
}

/// A contact joins the first group with room behind all groups of its bodies. Places count from the bundle's own first
/// group.
template <class Real>
auto ContactList<Real>::assign_groups(const Bundle& bundle, Fillings& fillings) -> Needs {
    Needs needs;
    auto& [contacts, open_from] = fillings;
    clear_for_reuse(contacts);
    clear_for_reuse(open_from);
    for (std::size_t k = bundle.first; k < bundle.last; ++k) {
        const Found& found = found_[orders_[k].contact];
        std::uint32_t group = next_group_[found.a];
        if (found.b != nobody) group = std::max(group, next_group_[found.b]);
        while (group < contacts.size() && contacts[group] == group_size) {
            // Shortcuts over full groups.
            std::uint32_t& next = open_from[group];
            if (next < contacts.size() && contacts[next] == group_size) next = open_from[next];
            group = next;
        }
        if (group >= contacts.size()) {
            group = static_cast<std::uint32_t>(contacts.size());
            contacts.push_back(0);
            open_from.push_back(group + 1);
        }
        next_group_[found.a] = group + 1;
        if (found.b != nobody) next_group_[found.b] = group + 1;
        const std::size_t place = group * group_size + contacts[group]++;
        ContactName& name = names_[k] = {.slot = found.slot,
                                         .code = found.code,
                                         .place = static_cast<std::uint32_t>(place),
                                         .is_driven = is_driven(found)};
        needs.anchors += found.b == nobody ? 1U : 0U;
        needs.walls += name.is_wall() ? 1U : 0U;
        needs.driven += name.is_driven ? 1U : 0U;
    }
    for (std::size_t k = bundle.first; k < bundle.last; ++k) {
        const Found& found = found_[orders_[k].contact];
        next_group_[found.a] = 0;
        if (found.b != nobody) next_group_[found.b] = 0;
    }
    needs.groups = static_cast<std::uint32_t>(contacts.size());
    return needs;
}

/// Gives each bundle its part of everything.
template <class Real>
void ContactList<Real>::give_room() {
    Bundle next{.mover = static_cast<std::uint32_t>(state_.bodies.listed.size())};
    for (std::size_t k = 0; k < bundles_.size(); ++k) {
        Bundle& bundle = bundles_[k];
        const Needs& needs = needs_[k];
        next.first = bundle.first;
        next.last = bundle.last;
        next.end = next.begin + needs.groups;
        bundle = next;
        next.begin = next.end;
        next.mover += 1 + needs.anchors;
        next.wall += needs.walls;
        next.drive += needs.driven;
    }
    groups_.resize(next.begin);
    movers_ = next.mover;
    at_walls_.resize(next.wall);
    driven_.resize(next.drive);
}

template <class Real>
auto ContactList<Real>::fill(const Bundle& bundle) -> Kinds {
    ContactGroup<Real> empty;
    empty.a.fill(bundle.mover);
    empty.b.fill(bundle.mover);
    empty.mass.fill(1);
    empty.gap.fill(std::numeric_limits<Real>::infinity());
    empty.touching.fill(-1);
    std::fill(groups_.begin() + bundle.begin, groups_.begin() + bundle.end, empty);
    Kinds kinds;
    Bundle next = bundle;
    for (std::uint32_t k = bundle.first; k < bundle.last; ++k) {
        const Found& found = found_[orders_[k].contact];
        ContactName& name = names_[k];
        name.place += static_cast<std::uint32_t>(bundle.begin * group_size);
        if (name.is_wall()) at_walls_[next.wall++] = k;
        if (name.is_driven) driven_[next.drive++] = k;
        const Encounter encounter = fill(name, found, found.b == nobody ? ++next.mover : nobody);
        name.restitution = encounter.resting_restitution;
        kinds.rubs = kinds.rubs || encounter.friction != 0;
        kinds.largest_restitution = std::max(kinds.largest_restitution, name.restitution);
    }
    return kinds;
}

/// Whether what a leaner meets has a surface that moves as prescribed.
template <class Real>
bool ContactList<Real>::is_driven(const Found& found) const {
    if (found.b != nobody) return false;
    const Bodies<Real>& bodies = state_.bodies;
    if (growth_of(bodies, bodies.slots[found.slot]) != 0) return true;
    if ((found.code & Support::wall_bit) != 0) return state_.bounds.is_driven(found.code & ~Support::wall_bit);
    const Index other = bodies.slots[found.code];
    return bodies.kind[other] == Kind::kinematic || growth_of(bodies, other) != 0;
}

/// Fills the lane of a contact. `anchor`: mover in place of the other body, where there is none.
template <class Real>
Encounter ContactList<Real>::fill(const ContactName& name, const Found& found, std::uint32_t anchor) {
    const Bodies<Real>& bodies = state_.bodies;
    ContactGroup<Real>& group = group_of(name);
    const std::size_t lane = name.lane();
    const Index body = bodies.slots[found.slot];
    group.a[lane] = found.a;
    group.b[lane] = found.b == nobody ? anchor : found.b;
    Encounter encounter;
    double inverse = 1 / static_cast<double>(bodies.mass[body]);
    if (name.is_wall()) {
        encounter = encounter_of(state_, body, state_.bounds.surface(name.wall()), 0);
    } else {
        const Index other = bodies.slots[found.code];
        encounter = encounter_of(state_, body, other, 0);
        inverse += 1 / static_cast<double>(bodies.mass[other]);
        const Int3 x = found.b == nobody ? bodies.motion[other].x : bodies.listed[found.b].x;
        const Int3 difference = nearest_image(state_.bounds, state_.resolution, x - bodies.listed[found.a].x, {});
        put_into(group.apart, lane, to_metres(difference, state_.resolution));
        open(name, bodies.motion[body].t);
    }
    group.mass[lane] = static_cast<Real>(1 / inverse);
    group.friction[lane] = static_cast<Real>(encounter.friction);
    return encounter;
}

template <class Real>
void ContactList<Real>::open(const ContactName& name, double time) {
    if (name.is_driven) return;
    const auto radius = [&](std::uint32_t slot) { return radius_at(state_.bodies, state_.bodies.slots[slot], time); };
    group_of(name).touching[name.lane()] = static_cast<Real>(radius(name.slot) + radius(name.code));
}

template class ContactList<float>;
template class ContactList<double>;

} // namespace carom::core
