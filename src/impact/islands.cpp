#include "impact/islands.hpp"

#include "space/stopwatch.hpp"

namespace carom::core {

namespace {

/// Loops over islands and over candidate pairs have parts of at least so many.
constexpr std::size_t island_grain = 64;
constexpr std::size_t pair_grain = 512;

} // namespace

template <class Real>
IslandSolver<Real>::IslandSolver(State<Real>& state, SerialSolver<Real>& serial)
    : state_(state), serial_(serial), vicinity_(state) {
    for (auto& workshop : workshops_) workshop = std::make_unique<Workshop<Real>>();
    for (auto& meetings : meetings_) meetings.reserve(4 * few_entries);
}

template <class Real>
void IslandSolver<Real>::use(std::shared_ptr<Executor> executor) {
    executor_ = std::move(executor);
    vicinity_.use(*executor_);
}

template <class Real>
Progress IslandSolver<Real>::resolve(const Census& census, Window window, bool kicked, std::uint64_t work_cap,
                                     Outcome& outcome) {
    Stopwatch watch;
    window_ = window;
    if (work_cap != 0 && outcome.all_impacts() >= work_cap) return resolve_serially(census, work_cap, outcome);
    vicinity_.prepare(census, window, kicked);
    costs_.seconds.cells += watch.lap();
    predict_first();
    costs_.seconds.pairs += watch.lap();
    form_islands();
    given_up_ = !run_to_fixpoint();
    if (!given_up_ && work_cap != 0) {
        std::uint64_t impacts = 0;
        for (const auto& workshop : workshops_) impacts += workshop->log.size();
        given_up_ = outcome.all_impacts() + impacts > work_cap;
    }
    const double until = end_of_piece();
    const bool is_done = !given_up_ && until >= window.to;
    if (is_done) commit(outcome);
    clear_window();
    costs_.seconds.impacts += watch.lap();
    if (given_up_) return resolve_serially(census, work_cap, outcome);
    if (is_done) return {.reached = window.to, .until = until};
    // Once more, up to where bodies that came to lean on each other get new velocities.
    vicinity_.forget();
    return {.reached = window.from, .until = until};
}

/// A window that ends early, or may: where exactly, the one queue knows.
template <class Real>
Progress IslandSolver<Real>::resolve_serially(const Census& census, std::uint64_t work_cap, Outcome& outcome) {
    vicinity_.forget();
    return serial_.resolve(census, window_, work_cap, outcome);
}

// ---------------------------------------------------------------------------------------------------------------------
// First predictions, and the islands that they make
// ---------------------------------------------------------------------------------------------------------------------

template <class Real>
void IslandSolver<Real>::predict_first() {
    memberships_.resize(state_.bodies.size(), nowhere);
    is_turned_.resize(state_.bodies.size() / 64 + 1);
    const std::size_t count = vicinity_.candidates().size();
    costs_.predictions += count;
    counts_.candidates += count;
    for_parts(*executor_, count, pair_grain,
              [this](std::size_t part, std::size_t begin, std::size_t end) { predict_batch(part, begin, end); });
    const std::vector<Index>& near_walls = vicinity_.near_walls();
    for_each_in_parts(*executor_, near_walls.size(), pair_grain, [&](std::size_t part, std::size_t k) {
        constexpr std::size_t ahead = 8;
        prefetch_object(&state_.bodies.motion[near_walls[std::min(k + ahead, near_walls.size() - 1)]]);
        for_each_wall_event(state_, near_walls[k], window_.to, [&](double time, std::uint32_t wall) {
            found_[part].push_back({time, near_walls[k], wall, 0, 0});
        });
    });
    for (std::vector<Event>& found : found_) {
        for (std::size_t k = 0; k < found.size(); ++k) {
            constexpr std::size_t ahead = 8;
            const Event& soon = found[std::min(k + ahead, found.size() - 1)];
            prefetch(&memberships_[soon.a]);
            if (!soon.at_wall()) prefetch(&memberships_[soon.b]);
            enter_first(found[k]);
        }
        clear_for_reuse(found);
    }
}

template <class Real>
void IslandSolver<Real>::predict_batch(std::size_t part, std::size_t begin, std::size_t end) {
    constexpr std::size_t ahead = 8;
    const auto& candidates = vicinity_.candidates();
    for (std::size_t k = begin; k < end; ++k) {
        const auto& soon = candidates[std::min(k + ahead, end - 1)];
        prefetch_object(&state_.bodies.motion[soon.first]);
        prefetch_object(&state_.bodies.motion[soon.second]);
        auto [a, b] = candidates[k];
        // An event's first body is one that it moves.
        if (is_prescribed(state_.bodies.kind[a])) std::swap(a, b);
        const double time = predict_pair(state_, a, b, window_.from, window_.to);
        if (time <= window_.to) {
            found_[part].push_back({time, a, b, 0, 0});
        } else {
            vicinity_.defer(part, candidates[k]);
        }
    }
}

template <class Real>
void IslandSolver<Real>::enter_first(const Event& event) {
    first_events_.push_back(event);
    first_members_.push_back(member_of(event.a));
    const std::uint32_t a = root_of(first_members_.back());
    if (event.at_wall() || is_prescribed(state_.bodies.kind[event.b])) return;
    const std::uint32_t b = root_of(member_of(event.b));
    parents_[std::max(a, b)] = std::min(a, b);
}

template <class Real>
std::uint32_t IslandSolver<Real>::member_of(Index body) {
    std::uint32_t& place = memberships_[body];
    if (place != nowhere) return place;
    place = static_cast<std::uint32_t>(members_.size());
    parents_.push_back(place);
    members_.push_back({.body = body});
    return place;
}

template <class Real>
std::uint32_t IslandSolver<Real>::root_of(std::uint32_t member) {
    while (parents_[member] != member) member = parents_[member] = parents_[parents_[member]];
    return member;
}

/// Roots are the first members of their islands: islands come in the order of their first bodies.
template <class Real>
void IslandSolver<Real>::form_islands() {
    const auto count = static_cast<std::uint32_t>(members_.size());
    clear_for_reuse(islands_);
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
    for (const std::uint32_t member : first_members_) ++islands_[members_[member].island].events.end;
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
    for (const Member& member : members_) roster_[islands_[member.island].roster.end++] = member.body;
    island_events_.resize(first_events_.size());
    for (std::size_t k = 0; k < first_events_.size(); ++k) {
        island_events_[islands_[members_[first_members_[k]].island].events.end++] = first_events_[k];
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Rounds
// ---------------------------------------------------------------------------------------------------------------------

template <class Real>
bool IslandSolver<Real>::run_to_fixpoint() {
    // More than this in one window, and one queue does better than keeping track: a few bodies that hit each other
    // over and over again.
    const std::size_t most_occurrences = 1024 + 8 * state_.bodies.size();
    for (auto& workshop : workshops_) {
        workshop->open(state_, vicinity_, memberships_, window_, most_occurrences);
    }
    pending_.resize(islands_.size());
    for (std::uint32_t id = 0; id < pending_.size(); ++id) pending_[id] = id;
    counts_.islands += pending_.size();
    expect_shares();
    while (!pending_.empty()) {
        ++counts_.rounds;
        run_pending();
        const bool one_gave_up = std::any_of(workshops_.begin(), workshops_.end(),
                                             [](const auto& workshop) { return workshop->has_given_up(); });
        if (one_gave_up) break;
        for (const std::uint32_t id : pending_) publish(id);
        cover_strays();
        compare_pending();
        merge();
    }
    for (const auto& workshop : workshops_) costs_.predictions += workshop->predictions();
    return pending_.empty();
}

/// Sees to it that a window with as many bodies finds room in the workshops, also if it has some parts more or less.
template <class Real>
void IslandSolver<Real>::expect_shares() {
    if (pending_.empty()) return;
    const std::size_t parts = parts_of(pending_.size(), island_grain);
    if (parts + parts / 2 + 1 > expected_parts_) expected_parts_ = std::min(2 * parts + 2, most_parts);
    const std::size_t islands = std::max(pending_.size() / parts, island_grain + island_grain / parts) + 1;
    const std::size_t bodies = islands * members_.size() / pending_.size() + 1;
    for (std::size_t k = 0; k < expected_parts_; ++k) workshops_[k]->expect(bodies);
}

template <class Real>
void IslandSolver<Real>::run_pending() {
    for_parts(*executor_, pending_.size(), island_grain, [this](std::size_t part, std::size_t begin, std::size_t end) {
        constexpr std::size_t ahead = 4;
        Workshop<Real>& workshop = *workshops_[part];
        for (std::size_t k = begin; k < end && !workshop.has_given_up(); ++k) {
            if (k + 3 * ahead < end) workshop.prefetch_bodies(bodies_of(islands_[pending_[k + 3 * ahead]]));
            if (k + 2 * ahead < end) workshop.prefetch_lists(bodies_of(islands_[pending_[k + 2 * ahead]]));
            if (k + ahead < end) workshop.prefetch_tracks(bodies_of(islands_[pending_[k + ahead]]));
            Island& island = islands_[pending_[k]];
            island.part = static_cast<std::uint32_t>(part);
            island.outturn = workshop.run(bodies_of(island), events_of(island));
        }
    });
}

/// Lets everybody know which bodies an island has, and what became of them.
template <class Real>
void IslandSolver<Real>::publish(std::uint32_t id) {
    const Island& island = islands_[id];
    const Workshop<Real>& workshop = *workshops_[island.part];
    for (std::uint32_t k = island.outturn.absorbed.begin; k < island.outturn.absorbed.end; ++k) {
        const Index body = workshop.absorbed[k];
        Member& member = members_[member_of(body)];
        if (member.island == nowhere) {
            member.island = id;
        } else {
            // Another island took it in the same round.
            meetings_[0].push_back({id, body});
        }
    }
    for (std::uint32_t k = island.outturn.meetings.begin; k < island.outturn.meetings.end; ++k) {
        meetings_[0].push_back({id, workshop.meetings[k]});
    }
    for (std::uint32_t k = island.outturn.turned.begin; k < island.outturn.turned.end; ++k) {
        const Index body = workshop.turned[k].body;
        Member& member = members_[memberships_[body]];
        is_turned_[body / 64] |= std::uint64_t{1} << (body % 64);
        if (member.island != id) continue;
        member.part = island.part;
        member.turned = k;
    }
}

/// Lets everybody see the bodies that left their covers.
template <class Real>
void IslandSolver<Real>::cover_strays() {
    for (const std::uint32_t id : pending_) {
        const Island& island = islands_[id];
        for (std::uint32_t k = island.outturn.strays.begin; k < island.outturn.strays.end; ++k) {
            const Stray<Real>& stray = workshops_[island.part]->strays[k];
            vicinity_.cover_along(stray.body, stray.path);
        }
    }
}

template <class Real>
void IslandSolver<Real>::compare_pending() {
    for_parts(*executor_, pending_.size(), island_grain, [this](std::size_t part, std::size_t begin, std::size_t end) {
        constexpr std::size_t ahead = 4;
        for (std::size_t k = begin; k < end; ++k) {
            if (k + ahead < end) workshops_[part]->prefetch_lists(bodies_of(islands_[pending_[k + ahead]]));
            compare(part, pending_[k]);
        }
    });
}

/// Finds the islands one of whose bodies, on a new path, meets one of this island's on its own new path.
template <class Real>
void IslandSolver<Real>::compare(std::size_t part, std::uint32_t id) {
    const Island& island = islands_[id];
    if (!island.outturn.finished) return;
    const Workshop<Real>& workshop = *workshops_[island.part];
    for (std::uint32_t k = island.outturn.turned.begin; k < island.outturn.turned.end; ++k) {
        const Index body = workshop.turned[k].body;
        const Member& member = members_[memberships_[body]];
        if (member.island != id) continue;
        vicinity_.for_each(body, [&](Index other) {
            if ((is_turned_[other / 64] >> (other % 64) & 1U) == 0) return;
            const Member& opposite = members_[memberships_[other]];
            if (opposite.turned == nowhere || opposite.island == id) return;
            if (!islands_[opposite.island].outturn.finished) return;
            if (paths_meet(member, opposite)) meetings_[part].push_back({id, other});
        });
    }
}

/// Whether any new leg of one meets any of the other.
template <class Real>
bool IslandSolver<Real>::paths_meet(const Member& a, const Member& b) const {
    const Turned<Real>& turned_a = turned_of(a);
    const Turned<Real>& turned_b = turned_of(b);
    if (turned_a.earlier == nowhere && turned_b.earlier == nowhere &&
        !vicinity_.may_meet(turned_a.track, turned_b.track, std::max(turned_a.motion.t, turned_b.motion.t))) {
        return false;
    }
    const auto for_each_leg = [this](const Member& member, auto&& f) {
        const std::uint32_t slot = state_.bodies.slot[member.body];
        const auto path_of = [this, slot, &member](const Flown<Real>& flown) {
            return Path<Real>{&flown.motion, flown.acceleration, flown.kind, slot, &state_.bodies, member.body};
        };
        const Turned<Real>& last = turned_of(member);
        const Flown<Real> last_path = workshops_[member.part]->last_path(last);
        if (f(path_of(last_path), window_.to)) return true;
        double end = last.motion.t;
        const std::vector<Leg<Real>>& legs = workshops_[member.part]->legs;
        for (std::uint32_t k = last.earlier; k != nowhere; k = legs[k].earlier) {
            if (f(path_of(legs[k].path), end)) return true;
            end = legs[k].path.motion.t;
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

/// Merges the islands that meet, and leaves what is to run next in pending_.
template <class Real>
void IslandSolver<Real>::merge() {
    clear_for_reuse(pending_);
    for (std::vector<Meeting>& meetings : meetings_) {
        for (const Meeting& m : meetings) unite(m.island, members_[memberships_[m.other]].island);
        clear_for_bursts(meetings);
    }
    pending_.swap(merged_);
    std::sort(merged_.begin(), merged_.end(), [this](std::uint32_t a, std::uint32_t b) {
        return std::pair(island_root(a), a) < std::pair(island_root(b), b);
    });
    for (std::size_t begin = 0; begin < merged_.size();) {
        std::size_t end = begin + 1;
        while (end < merged_.size() && island_root(merged_[end]) == island_root(merged_[begin])) ++end;
        join_group({merged_.data() + begin, merged_.data() + end});
        begin = end;
    }
    clear_for_reuse(merged_);
}

/// Marks two islands to be run again as one.
template <class Real>
void IslandSolver<Real>::unite(std::uint32_t a, std::uint32_t b) {
    for (const std::uint32_t id : {a, b}) {
        if (islands_[id].parent != nowhere) continue;
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

/// Makes one island of several, to be run next; they stay behind without bodies.
template <class Real>
void IslandSolver<Real>::join_group(std::span<const std::uint32_t> group) {
    counts_.merges += group.size() - 1;
    const auto joined = static_cast<std::uint32_t>(islands_.size());
    Island all{.roster = {static_cast<std::uint32_t>(roster_.size()), 0},
               .events = {static_cast<std::uint32_t>(island_events_.size()), 0}};
    const auto enlist = [&](std::uint32_t id, Index body) {
        Member& member = members_[memberships_[body]];
        // Two islands may have absorbed the same body.
        if (member.island != id) return;
        member.island = joined;
        member.turned = nowhere;
        roster_.push_back(body);
    };
    for (const std::uint32_t id : group) {
        const Island island = islands_[id];
        for (std::uint32_t k = island.roster.begin; k < island.roster.end; ++k) enlist(id, roster_[k]);
        for (std::uint32_t k = island.outturn.absorbed.begin; k < island.outturn.absorbed.end; ++k) {
            enlist(id, workshops_[island.part]->absorbed[k]);
        }
        for (std::uint32_t k = island.events.begin; k < island.events.end; ++k) {
            island_events_.push_back(island_events_[k]);
        }
        islands_[id] = {};
    }
    all.roster.end = static_cast<std::uint32_t>(roster_.size());
    all.events.end = static_cast<std::uint32_t>(island_events_.size());
    counts_.largest = std::max<std::uint64_t>(counts_.largest, all.roster.end - all.roster.begin);
    islands_.push_back(all);
    pending_.push_back(joined);
}

// ---------------------------------------------------------------------------------------------------------------------
// The end of a window
// ---------------------------------------------------------------------------------------------------------------------

template <class Real>
double IslandSolver<Real>::end_of_piece() const {
    double end = window_.piece_end;
    for (const auto& workshop : workshops_) {
        for (const Occurrence& occurrence : workshop->log) {
            if (occurrence.piles_up) end = std::min(end, window_.pieces.end_after(occurrence.impact.offset));
        }
    }
    return end;
}

template <class Real>
void IslandSolver<Real>::commit(Outcome& outcome) {
    write_back();
    remember_flights();
    write_down(outcome);
    clear_for_reuse(turned_);
    for (const Member& member : members_) {
        if (member.turned != nowhere) turned_.push_back(&turned_of(member));
    }
    vicinity_.settle(turned_);
}

template <class Real>
void IslandSolver<Real>::write_back() {
    Bodies<Real>& bodies = state_.bodies;
    constexpr std::size_t grain = 512;
    for_each_in_parts(*executor_, members_.size(), grain, [&](std::size_t, std::size_t k) {
        constexpr std::size_t ahead = 8;
        const Member& soon = members_[std::min(k + ahead, members_.size() - 1)];
        prefetch_object(&bodies.motion[soon.body]);
        if (soon.turned != nowhere) prefetch_object(&turned_of(soon));
        const Member& member = members_[k];
        if (member.turned != nowhere) bodies.motion[member.body] = turned_of(member).motion;
    });
    const bool one_rests =
        std::any_of(workshops_.begin(), workshops_.end(), [](const auto& workshop) { return workshop->any_rests(); });
    if (one_rests || !bodies.holds.empty()) write_holds_back();
}

template <class Real>
void IslandSolver<Real>::write_holds_back() {
    Bodies<Real>& bodies = state_.bodies;
    for (const Member& member : members_) {
        if (member.turned == nowhere) continue;
        const Turned<Real>& turned = turned_of(member);
        release(bodies, member.body);
        if (turned.kind == Kind::piled && bodies.kind[member.body] != Kind::piled) bodies.newly_piled = true;
        bodies.kind[member.body] = turned.kind;
        if (turned.hold != nowhere) {
            bodies.holds[bodies.slot[member.body]] = workshops_[member.part]->holds[turned.hold];
        }
    }
}

template <class Real>
void IslandSolver<Real>::remember_flights() {
    constexpr std::size_t few = 64;
    Bodies<Real>& bodies = state_.bodies;
    bodies.recent_flights.reserve(few);
    const double collapse_time = state_.laws.collapse_time;
    std::erase_if(bodies.recent_flights, [&](const RecentFlight& recent) {
        const std::uint32_t membership = memberships_[bodies.slots[recent.slot]];
        const bool is_replaced = membership != nowhere && members_[membership].turned != nowhere;
        return is_replaced || !is_recent(recent.flight, window_.to, collapse_time);
    });
    for (const Member& member : members_) {
        if (member.turned == nowhere) continue;
        const std::uint32_t flight = turned_of(member).flight;
        if (flight == nowhere) continue;
        bodies.recent_flights.push_back({bodies.slot[member.body], workshops_[member.part]->flights[flight]});
    }
    sort_by_slot(bodies.recent_flights);
}

/// Enters what happened, in the order in which one queue would have executed it: that of (time, ids), but that an event
/// never comes before the one of its island that led to it.
template <class Real>
void IslandSolver<Real>::write_down(Outcome& outcome) {
    clear_for_reuse(places_);
    for (const Island& island : islands_) {
        Place latest;
        const Workshop<Real>& workshop = *workshops_[island.part];
        for (std::uint32_t k = island.outturn.log.begin; k < island.outturn.log.end; ++k) {
            latest = std::max(latest, Place{workshop.log[k].impact.offset, workshop.log_ids[k], island.part, k});
            latest.part = island.part;
            latest.log = k;
            places_.push_back(latest);
        }
    }
    sort_places();
    for (std::size_t k = 0; k < places_.size(); ++k) {
        constexpr std::size_t ahead = 8;
        const Place& later = places_[std::min(k + 2 * ahead, places_.size() - 1)];
        const Place& soon = places_[std::min(k + ahead, places_.size() - 1)];
        prefetch_object(&workshops_[later.part]->log[later.log]);
        prefetch(&state_.bodies.slots[soon.ids.first]);
        if (!soon.at_wall()) prefetch(&state_.bodies.slots[soon.ids.second]);
        const Occurrence& occurrence = workshops_[places_[k].part]->log[places_[k].log];
        state_.books.add(occurrence.entry);
        outcome.add(occurrence);
    }
}

/// Sorts by slices of the window: those of a slice are few.
template <class Real>
void IslandSolver<Real>::sort_places() {
    constexpr std::size_t few = 512;
    if (places_.size() < few) {
        std::sort(places_.begin(), places_.end());
        return;
    }
    constexpr std::size_t slices = most_parts;
    const double per_second = slices / std::max(window_.to - window_.from, std::numeric_limits<double>::min());
    const auto slice_of = [&](const Place& place) {
        return static_cast<std::size_t>(std::clamp((place.time - window_.from) * per_second, 0.0, slices - 1.0));
    };
    std::array<std::size_t, slices + 1> ends{};
    for (const Place& place : places_) ++ends[slice_of(place) + 1];
    for (std::size_t k = 1; k < ends.size(); ++k) ends[k] += ends[k - 1];
    sorted_places_.resize(places_.size());
    for (const Place& place : places_) sorted_places_[ends[slice_of(place)]++] = place;
    places_.swap(sorted_places_);
    for_each_in_parts(*executor_, slices, 1, [&](std::size_t, std::size_t k) {
        const std::size_t begin = k == 0 ? 0 : ends[k - 1];
        std::sort(places_.data() + begin, places_.data() + ends[k]);
    });
}

template <class Real>
void IslandSolver<Real>::clear_window() {
    for (const Member& member : members_) {
        memberships_[member.body] = nowhere;
        is_turned_[member.body / 64] = 0;
    }
    clear_for_reuse(members_);
    clear_for_reuse(parents_);
    clear_for_reuse(first_events_);
    clear_for_reuse(first_members_);
    clear_for_reuse(roster_);
    clear_for_reuse(island_events_);
    for (std::vector<Meeting>& meetings : meetings_) clear_for_bursts(meetings);
    clear_for_reuse(pending_);
}

template class IslandSolver<float>;
template class IslandSolver<double>;

} // namespace carom::core
