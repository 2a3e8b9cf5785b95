// The list of a pile's contacts: made, gone on with, and what its contacts bore last.

#include "contact/pile.hpp"

#include <algorithm>

namespace carom::core {

template <class Real>
void Pile<Real>::start_list(double from) {
    Bodies<Real>& bodies = state_.bodies;
    if (has_values_) keep_forces();
    clear_for_reuse(closed_);
    wake_islands();
    do {
        settle_accounts();
        has_values_ = false;
        gather();
        if (bodies.listed.empty()) {
            bodies.contacts.clear();
            is_listed_ = false;
            return list_.clear();
        }
        for_each_leaner([&](Findings&, std::size_t k) {
            advance_leaner(k, from);
            bodies.listed[k].x = bodies.motion[bodies_[k]].x;
        });
        bodies.list_margin = wanted_margin();
        bodies.list_edge = list_.wanted_edge(from);
        far_ = 0.5 * bodies.list_margin;
        list_.find(*executor_, bodies.list_margin, from);
    } while (wake_neighbours());
    is_listed_ = true;
    bodies.list_age = 0;
}

/// m. A list ends when a body has moved by half of this: the more, the longer it lasts; but the more of its contacts
/// bear nothing. Small bodies have no room for much.
template <class Real>
double Pile<Real>::wanted_margin() const {
    constexpr double lives = 2;
    constexpr double part_of_radius = 0.2;
    ExactSum radii; // the same in any order
    for (const Index body : bodies_) radii.add(static_cast<double>(state_.bodies.motion[body].radius));
    const double mean_radius = radii.value() / static_cast<double>(bodies_.size());
    return std::min(lives * list_life * unlisted_approach(), part_of_radius * mean_radius) +
           4 * state_.resolution.metres;
}

/// m/s, the fastest approach of bodies that is no impact.
template <class Real>
double Pile<Real>::unlisted_approach() const {
    return 2 * told_speed_ + length(state_.laws.gravity) * list_life + 2 * state_.bodies.top_growth;
}

/// Whether anything moves as prescribed, so that a list does not last.
template <class Real>
bool Pile<Real>::is_driven() const {
    const Bodies<Real>& bodies = state_.bodies;
    const Obstacles* obstacles = state_.bounds.obstacles();
    return state_.bounds.any_driven() || (obstacles != nullptr && obstacles->any_turns()) ||
           !bodies.kinematics.empty() || bodies.top_growth != 0;
}

template <class Real>
void Pile<Real>::gather() {
    Bodies<Real>& bodies = state_.bodies;
    still_.assign(bodies.slots.size(), 0);
    borne_.assign(bodies.slots.size(), true);
    for (const ListedBody& l : bodies.listed) {
        still_[l.slot] = l.still;
        borne_[l.slot] = l.is_borne;
    }
    bodies.listed.clear();
    clear_for_reuse(bodies_);
    bodies.loads.assign(bodies.size(), {});
    for (Index i = 0; i < bodies.size(); ++i) {
        if (bodies.kind[i] != Kind::piled) continue;
        bodies_.push_back(i);
        const std::uint32_t slot = bodies.slot[i];
        bodies.listed.push_back({.slot = slot, .still = still_[slot], .is_borne = borne_[slot]});
    }
    accounts_.assign(bodies_.size(), {});
    marks_.assign(bodies_.size(), 0);
    all_marks_ = 0;
    bodies.newly_piled = false;
}

/// Goes on with the list that the state tells of.
template <class Real>
void Pile<Real>::resume_list() {
    Bodies<Real>& bodies = state_.bodies;
    if (!is_listed_) {
        clear_for_reuse(closed_);
        list_.recall(*executor_);
    }
    is_listed_ = true;
    bodies_.resize(bodies.listed.size());
    marks_.assign(list_.movers(), 0);
    all_marks_ = 0;
    places_.assign(list_.movers(), {});
    accounts_.assign(bodies_.size(), {});
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        bodies_[k] = bodies.slots[bodies.listed[k].slot];
        if (bodies.kind[bodies_[k]] != Kind::piled) marks_[k] = all_marks_ = gone;
    }
    has_far_ = false;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        if ((marks_[k] & gone) != 0) continue;
        place(k);
        has_far_ = has_far_ || is_far(k);
    }
}

/// Takes bodies back that were let go, and soon came to lean again; false if any is piled that the list does not do
/// for.
template <class Real>
bool Pile<Real>::take_back(double from) {
    Bodies<Real>& bodies = state_.bodies;
    clear_for_reuse(returned_);
    std::size_t listed = 0;
    for (std::uint32_t k = 0; k < bodies_.size(); ++k) {
        if (bodies.kind[bodies_[k]] != Kind::piled) continue;
        ++listed;
        if ((marks_[k] & gone) == 0) continue;
        const Motion<Real>& m = bodies.motion[bodies_[k]];
        const double moved = length(to_metres(m.x - bodies.listed[k].x, state_.resolution));
        if (moved + length(velocity_of(m)) * (from - m.t) > far_) return false;
        returned_.push_back(k);
    }
    const auto piled = std::count(bodies.kind.begin(), bodies.kind.end(), Kind::piled);
    if (listed != static_cast<std::size_t>(piled)) return false;
    bodies.newly_piled = false;
    if (returned_.empty()) return true;
    if (has_values_) {
        keep_forces();
        for_each_leaner([this](Findings&, std::size_t k) { enter(k, state_.bodies.motion[bodies_[k]].v); });
    }
    has_values_ = false;
    for (const std::uint32_t k : returned_) {
        marks_[k] = 0;
        advance_leaner(k, from);
    }
    return true;
}

/// Looks where the bodies are, and takes up the forces.
template <class Real>
void Pile<Real>::start_values() {
    const std::size_t leaners = bodies_.size();
    least_strike_ = striking_speed(list_.largest_restitution(), 0, state_.laws);
    entered_.resize(leaners);
    shares_.resize(leaners);
    movers_.assign(list_.movers(), {});
    places_.assign(list_.movers(), {});
    carried_.assign(list_.movers(), 0);
    marks_.resize(list_.movers(), 0);
    losses_.resize(list_.bundles());
    for_each_leaner([&](Findings& findings, std::size_t k) {
        movers_[k] = {state_.bodies.motion[bodies_[k]].v, 1 / state_.bodies.mass[bodies_[k]]};
        entered_[k] = movers_[k].v;
        place(k);
        if (mark(k)) findings.has_fast = true;
        if (is_far(k)) findings.has_far = true;
    });
    collect(untold_);
    measure_walls();
    recall_forces();
    close_contacts();
    list_.for_each_bundle(*executor_, [&](std::size_t, auto groups) { solver_->measure(run_of(groups)); });
    for_each_leaner([&](Findings&, std::size_t k) { movers_[k].v = {}; });
    list_.for_each_bundle(*executor_, [&](std::size_t, auto groups) { solver_->warm_up(run_of(groups)); });
    for_each_leaner([&](Findings&, std::size_t k) { shares_[k] = movers_[k].v; });
    note_pressings();
    has_values_ = true;
}

/// Gives the contacts the impulses that their forces come to in a piece.
template <class Real>
void Pile<Real>::recall_forces() {
    const std::vector<ContactForce>& forces = state_.bodies.contacts;
    const std::span<const ContactName> names = list_.names();
    const auto take = [this](const ContactName& name, const ContactForce& force) {
        ContactGroup<Real>& group = list_.group_of(name);
        group.impulse[name.lane()] = static_cast<Real>(force.normal * piece_);
        put_into(group.rub, name.lane(), force.friction * piece_);
        put_into(group.sprung, name.lane(), force.friction * piece_);
        group.plastic[name.lane()] = static_cast<Real>(force.plastic);
    };
    const auto is_of = [](const ContactName& name, const ContactForce& force) {
        return name.slot == force.a && name.code == force.code;
    };
    if (std::equal(names.begin(), names.end(), forces.begin(), forces.end(), is_of)) {
        for_each_in_parts(*executor_, names.size(), contact_grain,
                          [&](std::size_t, std::size_t k) { take(names[k], forces[k]); });
        return;
    }
    // By body a: where its forces begin, once they are in order.
    first_forces_.assign(state_.bodies.slots.size() + 1, 0);
    for (const ContactForce& force : forces) ++first_forces_[force.a + 1];
    for (std::size_t k = 1; k < first_forces_.size(); ++k) first_forces_[k] += first_forces_[k - 1];
    force_order_.resize(forces.size());
    for (std::uint32_t k = 0; k < forces.size(); ++k) force_order_[first_forces_[forces[k].a]++] = k;
    for_each_in_parts(*executor_, names.size(), contact_grain, [&](std::size_t, std::size_t k) {
        const ContactName& name = names[k];
        // The list of a body ends where it was counted up to.
        const std::uint32_t begin = name.slot == 0 ? 0 : first_forces_[name.slot - 1];
        for (std::uint32_t i = begin; i < first_forces_[name.slot]; ++i) {
            if (is_of(name, forces[force_order_[i]])) take(name, forces[force_order_[i]]);
        }
    });
}

template <class Real>
void Pile<Real>::keep_forces() {
    std::vector<ContactForce>& forces = state_.bodies.contacts;
    const std::span<const ContactName> names = list_.names();
    forces.resize(names.size());
    std::array<std::size_t, most_parts> bearing{};
    for_each_in_parts(*executor_, names.size(), contact_grain, [&](std::size_t part, std::size_t k) {
        const ContactName& name = names[k];
        const ContactGroup<Real>& group = list_.group_of(name);
        const std::size_t lane = name.lane();
        const bool is_gone = (marks_[group.a[lane]] & gone) != 0;
        ContactForce& kept = forces[k] = {.a = name.slot, .code = name.code};
        if (!is_gone) kept.plastic = static_cast<double>(group.plastic[lane]);
        if (is_gone || !(group.impulse[lane] > 0)) return;
        kept.normal = static_cast<double>(group.impulse[lane]) / piece_;
        kept.friction = detail::wide(vector_in(group.sprung, lane)) / piece_;
        ++bearing[part];
    });
    bearing_ = 0;
    for (const std::size_t count : bearing) bearing_ += count;
}

/// Notes how the strongest contact of each body presses it, as each hard pass does.
template <class Real>
void Pile<Real>::note_pressings() {
    const auto frequency = static_cast<Real>(1 / piece_);
    list_.for_each_bundle(*executor_, [&](std::size_t, std::span<ContactGroup<Real>> groups) {
        const auto press = [&](std::uint32_t mover, Real impulse) {
            Real& pressing = places_[mover].pressing;
            pressing = std::max(pressing, impulse * movers_[mover].inverse_mass * frequency);
        };
        for (const ContactGroup<Real>& group : groups) {
            for (std::size_t lane = 0; lane < group_size; ++lane) {
                press(group.a[lane], group.impulse[lane]);
                press(group.b[lane], group.impulse[lane]);
            }
        }
    });
}

/// Brings bodies that have just come to lean, and are in no list yet, to the end of the step.
template <class Real>
void Pile<Real>::advance_newcomers(double at) {
    for (Index i = 0; i < state_.bodies.size(); ++i) {
        if (state_.bodies.kind[i] != Kind::piled || state_.bodies.motion[i].t == at) continue;
        Entry entry;
        advance(state_, i, at, entry);
        accounts_.push_back({.lost = entry.lost_to_restitution, .held_mass_time = entry.held_mass_time});
    }
}

#define CAROM_INSTANTIATE(Real)                                                                                        \
    template void Pile<Real>::start_list(double);                                                                      \
    template double Pile<Real>::unlisted_approach() const;                                                             \
    template bool Pile<Real>::is_driven() const;                                                                       \
    template void Pile<Real>::resume_list();                                                                           \
    template bool Pile<Real>::take_back(double);                                                                       \
    template void Pile<Real>::start_values();                                                                          \
    template void Pile<Real>::keep_forces();                                                                           \
    template void Pile<Real>::advance_newcomers(double);
CAROM_INSTANTIATE(float)
CAROM_INSTANTIATE(double)
#undef CAROM_INSTANTIATE

} // namespace carom::core
