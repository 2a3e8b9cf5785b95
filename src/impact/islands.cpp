#include "impact/islands.hpp"

#include "space/stopwatch.hpp"

namespace carom::core {

template <class Real>
Progress IslandSolver<Real>::resolve(const Census& census, double from, double to, std::uint64_t work_cap,
                                     Outcome& outcome) {
    Stopwatch watch;
    from_ = from;
    to_ = to;
    if (work_cap != 0 && outcome.all_impacts() >= work_cap) return resolve_serially(census, work_cap, outcome);
    impacts_allowed_ = work_cap == 0 ? std::numeric_limits<std::uint64_t>::max() : work_cap - outcome.all_impacts();
    abandoned_ = false;
    vicinity_.prepare(census, from, to);
    costs_.seconds.cells += watch.lap();
    predict_first();
    costs_.seconds.pairs += watch.lap();
    form_islands();
    const bool finished = run_to_fixpoint();
    if (finished) commit(outcome);
    clear_window();
    costs_.seconds.impacts += watch.lap();
    return finished ? Progress{.reached = to} : resolve_serially(census, work_cap, outcome);
}

/// A window that ends early, or may: where exactly, the one queue knows.
template <class Real>
Progress IslandSolver<Real>::resolve_serially(const Census& census, std::uint64_t work_cap, Outcome& outcome) {
    vicinity_.forget();
    return serial_.resolve(census, from_, to_, work_cap, outcome);
}

// ---------------------------------------------------------------------------------------------------------------------
// First predictions, and the islands that they make
// ---------------------------------------------------------------------------------------------------------------------

template <class Real>
void IslandSolver<Real>::predict_first() {
    member_.resize(state_.bodies.size(), none);
    const std::uint64_t before = costs_.predictions;
    constexpr std::size_t batch = 32;
    vicinity_.for_each_pair([this](Index a, Index b) {
        __builtin_prefetch(&state_.bodies.motion[a]);
        __builtin_prefetch(&state_.bodies.motion[b]);
        batch_.emplace_back(a, b);
        if (batch_.size() == batch) predict_batch();
    });
    predict_batch();
    vicinity_.note_candidates(costs_.predictions - before);
    counts_.candidates += costs_.predictions - before;
    for (const Index i : vicinity_.near_walls()) {
        for_each_wall_event(state_, i, to_, [this](const Event& event) { push_first(event); });
    }
}

/// Predicts the pairs whose motions were asked for since the last batch, and are there by now.
template <class Real>
void IslandSolver<Real>::predict_batch() {
    costs_.predictions += batch_.size();
    for (auto [a, b] : batch_) {
        // An event's first body is one that it moves.
        if (state_.bodies.kind[a] == Kind::fixed) std::swap(a, b);
        const double time = predict_pair(state_, a, b, from_, to_);
        if (time <= to_) push_first({time, a, b, state_.bodies.trait[a].version, state_.bodies.trait[b].version});
    }
    batch_.clear();
}

template <class Real>
void IslandSolver<Real>::push_first(const Event& event) {
    first_events_.push_back(event);
    const std::uint32_t a = root_of(member_of(event.a));
    if (event.at_wall() || state_.bodies.kind[event.b] == Kind::fixed) return;
    const std::uint32_t b = root_of(member_of(event.b));
    parents_[std::max(a, b)] = std::min(a, b);
}

template <class Real>
std::uint32_t IslandSolver<Real>::member_of(Index body) {
    std::uint32_t& place = member_[body];
    if (place != none) return place;
    place = static_cast<std::uint32_t>(members_.size());
    parents_.push_back(place);
    const Trait<Real>& trait = state_.bodies.trait[body];
    Member member{.body = body,
                  .version = trait.version,
                  .before = {state_.bodies.motion[body], acceleration_of(state_, body)},
                  .flight = trait.flight,
                  .kind = state_.bodies.kind[body]};
    if (member.kind == Kind::held) {
        member.hold = static_cast<std::uint32_t>(former_holds_.size());
        former_holds_.push_back(hold_of(state_.bodies, body));
    }
    members_.push_back(member);
    return place;
}

template <class Real>
std::uint32_t IslandSolver<Real>::root_of(std::uint32_t member) {
    while (parents_[member] != member) member = parents_[member] = parents_[parents_[member]];
    return member;
}

/// Roots are the first members of their islands: islands come in the order of their first bodies, so in the order of
/// memory.
template <class Real>
void IslandSolver<Real>::form_islands() {
    const auto count = static_cast<std::uint32_t>(members_.size());
    islands_.clear();
    for (std::uint32_t m = 0; m < count; ++m) {
        const std::uint32_t root = root_of(m);
        if (root == m) {
            members_[m].island = static_cast<std::uint32_t>(islands_.size());
            islands_.emplace_back();
        } else {
            members_[m].island = members_[root].island;
        }
        ++islands_[members_[m].island].roster.end;
    }
    for (const Event& event : first_events_) ++islands_[members_[member_[event.a]].island].events.end;
    std::uint32_t bodies = 0;
    std::uint32_t events = 0;
    for (Island& island : islands_) {
        counts_.largest = std::max<std::uint64_t>(counts_.largest, island.roster.end);
        const std::uint32_t next_bodies = bodies + island.roster.end;
        const std::uint32_t next_events = events + island.events.end;
        island.roster = {bodies, bodies};
        island.events = {events, events};
        bodies = next_bodies;
        events = next_events;
    }
    roster_.resize(count);
    for (std::uint32_t m = 0; m < count; ++m) roster_[islands_[members_[m].island].roster.end++] = m;
    island_events_.resize(first_events_.size());
    for (const Event& event : first_events_) {
        island_events_[islands_[members_[member_[event.a]].island].events.end++] = event;
    }
}

template <class Real>
bool IslandSolver<Real>::run_to_fixpoint() {
    pending_.resize(islands_.size());
    for (std::uint32_t id = 0; id < pending_.size(); ++id) pending_[id] = id;
    counts_.islands += pending_.size();
    while (!pending_.empty()) {
        ++counts_.rounds;
        for (std::size_t k = 0; k < pending_.size(); ++k) {
            constexpr std::size_t ahead = 4;
            if (k + 2 * ahead < pending_.size()) prefetch(pending_[k + 2 * ahead]);
            if (k + ahead < pending_.size()) prefetch_balls(pending_[k + ahead]);
            run(pending_[k]);
        }
        if (abandoned_) {
            for (Member& member : members_) restore(member);
            return false;
        }
        cover_strays();
        for (const std::uint32_t id : pending_) {
            if (islands_[id].finished) compare(id);
        }
        merge();
    }
    return true;
}

// ---------------------------------------------------------------------------------------------------------------------
// Running one island
// ---------------------------------------------------------------------------------------------------------------------

template <class Real>
void IslandSolver<Real>::run(std::uint32_t id) {
    if (abandoned_) return;
    Island& island = islands_[id];
    current_ = id;
    queue_.clear();
    for (std::uint32_t k = island.events.begin; k < island.events.end; ++k) queue_.push(island_events_[k]);
    own_strays_ = strays_.size();
    island.log.begin = static_cast<std::uint32_t>(log_.size());
    island.finished = true;
    while (!queue_.empty() && island.finished) {
        const Event event = queue_.top();
        queue_.pop();
        const bool foreign = !event.at_wall() && is_foreign(event.b);
        if (foreign ? queue_.outdated_for_a(event) : queue_.outdated(event)) continue;
        if (foreign) {
            meetings_.push_back({id, event.b});
            island.finished = false;
        } else {
            island.finished = execute_event(event);
        }
    }
    island.log.end = static_cast<std::uint32_t>(log_.size());
}

/// Asks for the memory of an island that is to run soon.
template <class Real>
void IslandSolver<Real>::prefetch(std::uint32_t id) const {
    for (std::uint32_t k = islands_[id].roster.begin; k < islands_[id].roster.end; ++k) {
        const Index body = members_[roster_[k]].body;
        __builtin_prefetch(&state_.bodies.motion[body]);
        __builtin_prefetch(&state_.bodies.trait[body]);
        vicinity_.prefetch(body);
    }
}

template <class Real>
void IslandSolver<Real>::prefetch_balls(std::uint32_t id) const {
    for (std::uint32_t k = islands_[id].roster.begin; k < islands_[id].roster.end; ++k) {
        vicinity_.prefetch_balls(members_[roster_[k]].body);
    }
}

/// Whether a body belongs to another island, or would make one of its own if it had an impact.
template <class Real>
bool IslandSolver<Real>::is_foreign(Index body) const {
    return !is_own(body) && state_.bodies.kind[body] != Kind::fixed;
}

template <class Real>
bool IslandSolver<Real>::is_own(Index body) const {
    return member_[body] != none && members_[member_[body]].island == current_;
}

/// False if the island cannot go on in this round.
template <class Real>
bool IslandSolver<Real>::execute_event(const Event& event) {
    if (log_.size() >= impacts_allowed_ || log_.size() >= occurrences_worthwhile() ||
        strays_.size() >= strays_worthwhile()) {
        abandoned_ = true;
        return false;
    }
    const bool two_move = !event.at_wall() && state_.bodies.kind[event.b] != Kind::fixed;
    note_change(event.a);
    if (two_move) note_change(event.b);
    log_ids_.push_back(ids_of(state_.bodies, event));
    execute(state_, event, log_.emplace_back());
    follow(event.a, no_index, event.time);
    if (two_move) follow(event.b, event.a, event.time);
    return !abandoned_;
}

/// Keeps the leg that an impact is about to end, if no member keeps it already.
template <class Real>
void IslandSolver<Real>::note_change(Index body) {
    Member& member = members_[member_[body]];
    if (member.changed) {
        legs_.push_back({.flown = {state_.bodies.motion[body], acceleration_of(state_, body)},
                         .kind = state_.bodies.kind[body],
                         .earlier = member.last_leg});
        member.last_leg = static_cast<std::uint32_t>(legs_.size() - 1);
    }
    member.changed = true;
}

/// Predicts what a body meets after an impact.
template <class Real>
void IslandSolver<Real>::follow(Index body, Index except, double now) {
    // To the end of the step, not of the window: no result may depend on windows.
    if (!stays_in_world(state_, body, state_.laws.kick_interval - now)) {
        abandoned_ = true;
        return;
    }
    const bool covered = vicinity_.follow(body, members_[member_[body]].before, to_);
    const Ball ball = vicinity_.ball_of(body, to_);
    const auto look = [&](Index other) {
        if (other == body || other == except || !vicinity_.may_meet(ball, vicinity_.first_ball(other))) return;
        const double time = predict(body, other, now);
        if (time > to_) return;
        queue_.push({time, body, other, state_.bodies.trait[body].version, state_.bodies.trait[other].version});
    };
    if (covered) {
        vicinity_.for_each(body, look);
    } else {
        strays_.push_back({body, {state_.bodies.motion[body], acceleration_of(state_, body)}});
        vicinity_.for_each_along(strays_.back().path, to_, look);
    }
    for (std::size_t k = own_strays_; k < strays_.size(); ++k) look(strays_[k].body);
    for_each_wall_event(state_, body, to_, [this](const Event& event) { queue_.push(event); });
}

/// s, when a body meets another, which is on the path of the start of the window unless it is of the same island.
template <class Real>
double IslandSolver<Real>::predict(Index body, Index other, double now) {
    ++costs_.predictions;
    const std::uint32_t member = member_[other];
    if (member == none || members_[member].island == current_ || !members_[member].changed) {
        return predict_pair(state_, body, other, now, to_);
    }
    return predict_paths(state_, path_of(state_, body), former_path(members_[member]), now, to_);
}

template <class Real>
Path<Real> IslandSolver<Real>::former_path(const Member& member) const {
    return {&member.before.motion, member.before.acceleration, member.kind, state_.bodies.trait[member.body].slot};
}

// ---------------------------------------------------------------------------------------------------------------------
// Comparing islands
// ---------------------------------------------------------------------------------------------------------------------

/// Lets everybody see the bodies that left their covers.
template <class Real>
void IslandSolver<Real>::cover_strays() {
    for (const Stray& stray : strays_) vicinity_.cover_along(stray.body, stray.path, stray.path.motion.t, to_);
    strays_.clear();
}

/// Finds the islands one of whose bodies, on a new path, meets one of this island's on its own new path.
template <class Real>
void IslandSolver<Real>::compare(std::uint32_t id) {
    for (std::uint32_t k = islands_[id].roster.begin; k < islands_[id].roster.end; ++k) {
        const Member& member = members_[roster_[k]];
        if (!member.changed) continue;
        const Ball ball = vicinity_.first_ball(member.body);
        vicinity_.for_each(member.body, [&](Index other) {
            if (!vicinity_.may_meet(ball, vicinity_.first_ball(other)) || member_[other] == none) return;
            const Member& opposite = members_[member_[other]];
            if (!opposite.changed || opposite.island == id || !islands_[opposite.island].finished) return;
            if (paths_meet(member, opposite)) meetings_.push_back({id, other});
        });
    }
}

/// Whether any new leg of one meets any of the other.
template <class Real>
bool IslandSolver<Real>::paths_meet(const Member& a, const Member& b) const {
    const auto for_each_leg = [this](const Member& member, auto&& f) {
        double end = to_;
        const Motion<Real>& last = state_.bodies.motion[member.body];
        if (f(path_of(state_, member.body), end)) return true;
        end = last.t;
        const std::uint32_t slot = state_.bodies.trait[member.body].slot;
        for (std::uint32_t k = member.last_leg; k != none; k = legs_[k].earlier) {
            const Leg& leg = legs_[k];
            if (f(Path<Real>{&leg.flown.motion, leg.flown.acceleration, leg.kind, slot}, end)) return true;
            end = leg.flown.motion.t;
        }
        return false;
    };
    return for_each_leg(a, [&](const Path<Real>& path_a, double end_a) {
        return for_each_leg(b, [&](const Path<Real>& path_b, double end_b) {
            const double start = std::max(path_a.motion->t, path_b.motion->t);
            const double end = std::min(end_a, end_b);
            return start <= end && predict_paths(state_, path_a, path_b, start, end) <= end;
        });
    });
}

// ---------------------------------------------------------------------------------------------------------------------
// Merging islands
// ---------------------------------------------------------------------------------------------------------------------

/// Merges the islands that meet, and leaves what is to run again in pending_.
template <class Real>
void IslandSolver<Real>::merge() {
    pending_.clear();
    for (const Meeting& meeting : meetings_) {
        unite(meeting.island, member_[meeting.other] == none ? island_of_single(meeting.other)
                                                             : members_[member_[meeting.other]].island);
    }
    std::sort(pending_.begin(), pending_.end(), [this](std::uint32_t a, std::uint32_t b) {
        return std::pair(island_root(a), a) < std::pair(island_root(b), b);
    });
    pending_.erase(std::unique(pending_.begin(), pending_.end()), pending_.end());
    for (const std::uint32_t id : pending_) restart(id);
    const std::vector<std::uint32_t> restarted = std::exchange(pending_, {});
    std::vector<std::uint32_t> group;
    for (std::size_t k = 0; k < restarted.size(); ++k) {
        group.push_back(restarted[k]);
        if (k + 1 < restarted.size() && island_root(restarted[k + 1]) == island_root(restarted[k])) continue;
        join_group(group);
        group.clear();
    }
    meetings_.clear();
}

/// Marks two islands to be run again as one.
template <class Real>
void IslandSolver<Real>::unite(std::uint32_t a, std::uint32_t b) {
    for (const std::uint32_t id : {a, b}) {
        if (islands_[id].parent != none) continue;
        islands_[id].parent = id;
        pending_.push_back(id);
    }
    const std::uint32_t root_a = island_root(a);
    const std::uint32_t root_b = island_root(b);
    islands_[std::max(root_a, root_b)].parent = std::min(root_a, root_b);
}

template <class Real>
std::uint32_t IslandSolver<Real>::island_root(std::uint32_t id) {
    while (islands_[id].parent != id) id = islands_[id].parent = islands_[islands_[id].parent].parent;
    return id;
}

template <class Real>
std::uint32_t IslandSolver<Real>::island_of_single(Index body) {
    const auto id = static_cast<std::uint32_t>(islands_.size());
    const auto place = static_cast<std::uint32_t>(roster_.size());
    const std::uint32_t member = member_of(body);
    members_[member].island = id;
    roster_.push_back(member);
    islands_.push_back({.roster = {place, place + 1}});
    return id;
}

/// Puts the bodies of an island back to the start of the window.
template <class Real>
void IslandSolver<Real>::restart(std::uint32_t id) {
    for (std::uint32_t k = islands_[id].roster.begin; k < islands_[id].roster.end; ++k) restore(members_[roster_[k]]);
    islands_[id].log = {};
}

/// Makes one island of several, to be run next; they stay behind without bodies.
template <class Real>
void IslandSolver<Real>::join_group(const std::vector<std::uint32_t>& group) {
    for (const std::uint32_t id : group) islands_[id].parent = none;
    counts_.merges += group.size() - 1;
    const auto joined = static_cast<std::uint32_t>(islands_.size());
    Island all{.roster = {static_cast<std::uint32_t>(roster_.size()), 0},
               .events = {static_cast<std::uint32_t>(island_events_.size()), 0}};
    for (const std::uint32_t id : group) {
        for (std::uint32_t k = islands_[id].roster.begin; k < islands_[id].roster.end; ++k) {
            members_[roster_[k]].island = joined;
            roster_.push_back(roster_[k]);
        }
        for (std::uint32_t k = islands_[id].events.begin; k < islands_[id].events.end; ++k) {
            island_events_.push_back(island_events_[k]);
        }
        islands_[id].roster = islands_[id].events = {};
    }
    all.roster.end = static_cast<std::uint32_t>(roster_.size());
    all.events.end = static_cast<std::uint32_t>(island_events_.size());
    counts_.largest = std::max<std::uint64_t>(counts_.largest, all.roster.end - all.roster.begin);
    islands_.push_back(all);
    pending_.push_back(joined);
}

template <class Real>
void IslandSolver<Real>::restore(Member& member) {
    if (!member.changed) return;
    Bodies<Real>& bodies = state_.bodies;
    Trait<Real>& trait = bodies.trait[member.body];
    bodies.motion[member.body] = member.before.motion;
    trait.flight = member.flight;
    trait.version = member.version;
    release(bodies, member.body);
    bodies.kind[member.body] = member.kind;
    if (member.kind == Kind::held) bodies.holds[trait.slot] = former_holds_[member.hold];
    member.changed = false;
    member.last_leg = none;
}

// ---------------------------------------------------------------------------------------------------------------------
// The end of a window
// ---------------------------------------------------------------------------------------------------------------------

/// Enters what happened, in the order in which one queue would have executed it: that of (time, ids), but that an event
/// never comes before the one of its island that led to it.
template <class Real>
void IslandSolver<Real>::commit(Outcome& outcome) {
    places_.clear();
    for (const Island& island : islands_) {
        Place latest;
        for (std::uint32_t k = island.log.begin; k < island.log.end; ++k) {
            latest = std::max(latest, Place{log_[k].impact.offset, log_ids_[k], k});
            latest.log = k;
            places_.push_back(latest);
        }
    }
    std::sort(places_.begin(), places_.end());
    for (std::size_t k = 0; k < places_.size(); ++k) {
        constexpr std::size_t ahead = 8;
        if (k + ahead < places_.size()) __builtin_prefetch(&log_[places_[k + ahead].log].entry);
        const Place& place = places_[k];
        state_.books.add(log_[place.log].entry);
        outcome.add(log_[place.log]);
    }
    for (const Member& member : members_) {
        if (member.changed) vicinity_.settle(member.body, member.before, to_);
    }
}

template <class Real>
void IslandSolver<Real>::clear_window() {
    for (const Member& member : members_) member_[member.body] = none;
    members_.clear();
    parents_.clear();
    first_events_.clear();
    roster_.clear();
    island_events_.clear();
    log_.clear();
    log_ids_.clear();
    legs_.clear();
    former_holds_.clear();
    meetings_.clear();
    strays_.clear();
    pending_.clear();
}

template class IslandSolver<float>;
template class IslandSolver<double>;

} // namespace carom::core
