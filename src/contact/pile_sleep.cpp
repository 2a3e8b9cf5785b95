// Islands of a pile that fall asleep, and wake.

#include "contact/pile.hpp"

#include <algorithm>
#include <cmath>

namespace carom::core {

/// Bodies with contacts to each other, listed ones that bear nothing among them, are an island; who was let go belongs
/// to none. It falls asleep when all of it has lain still for long: looked for ten times a second, or in each step
/// where lists last no longer.
template <class Real>
void Pile<Real>::fall_asleep(double reached) {
    constexpr double long_enough = 0.5;
    constexpr double looks = 10;
    Bodies<Real>& bodies = state_.bodies;
    const bool is_due =
        is_driven() || std::floor(bodies.list_age * looks) != std::floor((bodies.list_age - reached) * looks);
    if (!is_due || !state_.laws.sleeping || !state_.laws.fields.empty() || bodies.newly_piled) return;
    if (state_.bounds.any_driven() || bodies.top_growth != 0) return;
    const auto sleeps = [](const ListedBody& l) { return l.still >= long_enough; };
    if (std::none_of(bodies.listed.begin(), bodies.listed.end(), sleeps)) return;
    const auto leans = [&](std::uint32_t mover) { return mover < bodies_.size() && (marks_[mover] & gone) == 0; };
    islands_.start(bodies_.size());
    for (const ContactName& name : list_.names()) {
        const ContactGroup<Real>& group = list_.group_of(name);
        const std::uint32_t a = group.a[name.lane()];
        const std::uint32_t b = group.b[name.lane()];
        if (leans(a) && leans(b)) islands_.unite(a, b);
    }
    wakeful_.assign(bodies_.size(), false);
    for (const std::uint32_t number : list_.driven()) {
        const ContactName& name = list_.names()[number];
        wakeful_[islands_.root(list_.group_of(name).a[name.lane()])] = true;
    }
    for (std::uint32_t k = 0; k < bodies_.size(); ++k) {
        if ((marks_[k] & gone) != 0 || !sleeps(bodies.listed[k])) wakeful_[islands_.root(k)] = true;
    }
    bool sleeps_any = false;
    for (std::uint32_t k = 0; k < bodies_.size(); ++k) {
        if (wakeful_[islands_.root(k)]) continue;
        sleeps_any = true;
        enter(k, {});
        bodies.motion[bodies_[k]].v = {};
        bodies.kind[bodies_[k]] = Kind::asleep;
    }
    if (sleeps_any) leave_sleepers();
}

/// Takes those who have fallen asleep off the list.
template <class Real>
void Pile<Real>::leave_sleepers() {
    Bodies<Real>& bodies = state_.bodies;
    settle_accounts();
    const auto is_asleep = [&bodies](std::uint32_t slot) { return bodies.kind[bodies.slots[slot]] == Kind::asleep; };
    for (const ContactForce& force : bodies.contacts) {
        if (is_asleep(force.a) && force.normal > 0) bodies.sleeping.push_back(force);
    }
    std::erase_if(bodies.contacts, [&](const ContactForce& force) {
        return is_asleep(force.a) || ((force.code & Support::wall_bit) == 0 && is_asleep(force.code));
    });
    std::erase_if(bodies.listed, [&](const ListedBody& l) { return is_asleep(l.slot); });
    bearing_ = static_cast<std::size_t>(std::count_if(bodies.contacts.begin(), bodies.contacts.end(),
                                                      [](const ContactForce& force) { return force.normal > 0; }));
    if (bodies.listed.empty()) bodies.contacts.clear();
    is_listed_ = has_values_ = false;
    asleep_mass_.reset();
}

/// Wakes the islands of those who have been woken, or who are gone.
template <class Real>
void Pile<Real>::wake_islands() {
    Bodies<Real>& bodies = state_.bodies;
    if (bodies.sleeping.empty()) return;
    const auto kind_of = [&bodies](std::uint32_t slot) { return bodies.kind[bodies.slots[slot]]; };
    const auto has_other = [&](const ContactForce& force) {
        return (force.code & Support::wall_bit) == 0 && kind_of(force.code) != Kind::fixed;
    };
    islands_.start(bodies.slots.size());
    for (const ContactForce& force : bodies.sleeping) {
        if (has_other(force)) islands_.unite(force.a, force.code);
    }
    wakeful_.assign(bodies.slots.size(), false);
    const auto note = [&](std::uint32_t slot) {
        if (kind_of(slot) != Kind::asleep) wakeful_[islands_.root(slot)] = true;
    };
    for (const ContactForce& force : bodies.sleeping) {
        note(force.a);
        if (has_other(force)) note(force.code);
    }
    const auto wakes = [&](const ContactForce& force) { return wakeful_[islands_.root(force.a)]; };
    for (const ContactForce& force : bodies.sleeping) {
        if (!wakes(force)) continue;
        wake(bodies, bodies.slots[force.a]);
        if (has_other(force)) wake(bodies, bodies.slots[force.code]);
        bodies.contacts.push_back(force);
    }
    std::erase_if(bodies.sleeping, wakes);
    asleep_mass_.reset();
}

/// Wakes the islands that the list has found near those who are awake; whether there were any.
template <class Real>
bool Pile<Real>::wake_neighbours() {
    Bodies<Real>& bodies = state_.bodies;
    bool finds_any = false;
    for (const ContactName& name : list_.names()) {
        if (!name.is_wall()) finds_any = wake(bodies, bodies.slots[name.code]) || finds_any;
    }
    if (finds_any) wake_islands();
    return finds_any;
}

/// kg, of those who are asleep: what gravity gives them, what they lie on takes.
template <class Real>
double Pile<Real>::asleep_mass() {
    const Bodies<Real>& bodies = state_.bodies;
    if (bodies.sleeping.empty()) return 0;
    const std::size_t now_asleep = asleep();
    if (asleep_mass_ && asleep_ == now_asleep) return *asleep_mass_;
    ExactSum sum; // the same in any order
    for (Index i = 0; i < bodies.size(); ++i) {
        if (bodies.kind[i] == Kind::asleep) sum.add(static_cast<double>(bodies.mass[i]));
    }
    asleep_ = now_asleep;
    asleep_mass_ = sum.value();
    return *asleep_mass_;
}

template <class Real>
std::size_t Pile<Real>::asleep() const {
    if (state_.bodies.sleeping.empty()) return 0;
    const std::vector<Kind>& kinds = state_.bodies.kind;
    return static_cast<std::size_t>(std::count(kinds.begin(), kinds.end(), Kind::asleep));
}

#define CAROM_INSTANTIATE(Real)                                                                                        \
    template void Pile<Real>::fall_asleep(double);                                                                     \
    template void Pile<Real>::wake_islands();                                                                          \
    template bool Pile<Real>::wake_neighbours();                                                                       \
    template double Pile<Real>::asleep_mass();                                                                         \
    template std::size_t Pile<Real>::asleep() const;
CAROM_INSTANTIATE(float)
CAROM_INSTANTIATE(double)
#undef CAROM_INSTANTIATE

} // namespace carom::core
