#include "impact/workshop.hpp"

namespace carom::core {

template <class Real>
Workshop<Real>::Workshop() : queue_(local_.bodies) {
    // What most islands have, and their lists.
    constexpr std::size_t few = 16;
    local_.bodies.motion.reserve(few);
    local_.bodies.kind.reserve(few);
    local_.bodies.slot.reserve(few);
    local_.bodies.course.reserve(few);
    guests_.reserve(few);
    turned_.reserve(few);
    own_strays_.reserve(few);
    legs.reserve(4 * few);
    flights.reserve(4 * few);
    absorbed.reserve(4 * few);
    strays.reserve(few);
    meetings.reserve(4 * few);
    queue_.reserve(4 * few);
}

template <class Real>
void Workshop<Real>::expect(std::size_t bodies) {
    if (turned.capacity() >= bodies + fluctuation(bodies, 1)) return;
    // The longest lists that there are get no more than they need.
    turned.reserve(bodies + fluctuation(bodies, 4));
    const std::size_t impacts = bodies / 2;
    log.reserve(impacts + fluctuation(impacts, 4));
    log_ids.reserve(impacts + fluctuation(impacts, 4));
}

template <class Real>
void Workshop<Real>::open(const State<Real>& state, const Vicinity<Real>& vicinity,
                          const std::vector<std::uint32_t>& memberships, const Window& window,
                          std::size_t most_occurrences) {
    state_ = &state;
    vicinity_ = &vicinity;
    memberships_ = &memberships;
    to_ = window.to;
    most_occurrences_ = most_occurrences;
    given_up_ = false;
    any_rests_ = false;
    predictions_ = 0;
    local_.bounds = state.bounds;
    local_.resolution = state.resolution;
    local_.laws = state.laws;
    local_.bodies.top_growth = state.bodies.top_growth;
    log.clear();
    log_ids.clear();
    turned.clear();
    clear_for_bursts(legs);
    clear_for_reuse(flights);
    clear_for_reuse(holds);
    clear_for_reuse(absorbed);
    clear_for_bursts(strays);
    clear_for_reuse(meetings);
}

template <class Real>
void Workshop<Real>::clear() {
    Bodies<Real>& bodies = local_.bodies;
    bodies.motion.clear();
    bodies.kind.clear();
    bodies.slot.clear();
    bodies.course.clear();
    bodies.holds.clear();
    bodies.loads.clear();
    bodies.growth.clear();
    guests_.clear();
    places_.clear();
    turned_.clear();
    own_strays_.clear();
    queue_.clear();
}

/// Copies a body; returns its place here.
template <class Real>
Index Workshop<Real>::admit(Index body, bool as_own) {
    const Bodies<Real>& from = state_->bodies;
    Bodies<Real>& bodies = local_.bodies;
    const auto place = static_cast<Index>(guests_.size());
    const std::uint32_t slot = from.slot[body];
    bodies.motion.push_back(from.motion[body]);
    bodies.kind.push_back(from.kind[body]);
    bodies.slot.push_back(slot);
    bodies.mass.append(from.mass[body], place);
    bodies.restitution.append(from.restitution[body], place);
    bodies.friction.append(from.friction[body], place);
    bodies.material.append(from.material[body], place);
    bodies.course.push_back({.flight = recent_flight(from, slot)});
    if (!from.loads.empty()) bodies.loads.push_back(from.loads[body]);
    if (!from.growth.empty()) bodies.growth.push_back(from.growth[body]);
    if (from.kind[body] == Kind::held) bodies.holds[slot] = hold_of(from, body);
    guests_.push_back({.body = body, .is_own = as_own});
    places_.insert(body, place);
    return place;
}

template <class Real>
Outturn Workshop<Real>::run(std::span<const Index> bodies, std::span<const Event> events) {
    clear();
    Outturn outturn{.finished = true};
    const auto size = [](const auto& list) { return static_cast<std::uint32_t>(list.size()); };
    outturn.log.begin = size(log);
    outturn.absorbed.begin = size(absorbed);
    outturn.strays.begin = size(strays);
    outturn.meetings.begin = size(meetings);
    for (const Index body : bodies) admit(body, true);
    for (const Event& event : events) {
        const Index a = places_.find(event.a);
        Index b = event.b;
        if (!event.at_wall()) {
            b = places_.find(event.b);
            if (b == no_index) b = admit(event.b, false);
        }
        queue_.push({event.time, a, b, 0, 0});
    }
    while (!queue_.empty() && outturn.finished && !given_up_) {
        const Event event = queue_.top();
        queue_.pop();
        if (!queue_.outdated(event)) outturn.finished = take(event);
    }
    outturn.log.end = size(log);
    outturn.absorbed.end = size(absorbed);
    outturn.strays.end = size(strays);
    outturn.meetings.end = size(meetings);
    put_out(outturn);
    return outturn;
}

/// Executes an event; false where it needs a body of another island.
template <class Real>
bool Workshop<Real>::take(const Event& event) {
    if (!event.at_wall() && !guests_[event.b].is_own && !is_prescribed(local_.bodies.kind[event.b])) {
        Guest& other = guests_[event.b];
        if ((*memberships_)[other.body] != nowhere) {
            meetings.push_back(other.body);
            return false;
        }
        other.is_own = true;
        absorbed.push_back(other.body);
    }
    if (log.size() >= most_occurrences_) {
        given_up_ = true;
    } else {
        execute_event(event);
    }
    return true;
}

template <class Real>
void Workshop<Real>::execute_event(const Event& event) {
    const bool two_move = !event.at_wall() && !is_prescribed(local_.bodies.kind[event.b]);
    note_turn(event.a);
    if (two_move) note_turn(event.b);
    log_ids.push_back(ids_of(local_.bodies, event));
    execute(local_, event, log.emplace_back());
    given_up_ = given_up_ || log.back().is_crushed;
    // Both have to be on their new ways before either looks for the other.
    set_out(event.a, event.time);
    if (two_move) set_out(event.b, event.time);
    follow(event.a, no_index, event.time);
    if (two_move) follow(event.b, event.a, event.time);
}

/// Keeps the leg that an impact is about to end. How a body began the window is kept where it came from.
template <class Real>
void Workshop<Real>::note_turn(Index local) {
    Guest& guest = guests_[local];
    if (guest.has_turned) {
        legs.push_back({flown(local_, local), guest.earlier});
        guest.earlier = static_cast<std::uint32_t>(legs.size() - 1);
    } else {
        turned_.push_back(local);
    }
    guest.has_turned = true;
}

/// Takes the track of a body's new way.
template <class Real>
void Workshop<Real>::set_out(Index local, double now) {
    // To the end of the step, not of the window: no result may depend on windows.
    if (!stays_in_world(local_, local, local_.laws.kick_interval - now)) given_up_ = true;
    const Flown<Real> path = flown(local_, local);
    guests_[local].track = vicinity_->track_in_window(path);
    guests_[local].room = vicinity_->room_left(guests_[local].body, path);
}

/// Predicts what a body meets after an impact.
template <class Real>
void Workshop<Real>::follow(Index local, Index except, double now) {
    if (given_up_) return;
    const Index body = guests_[local].body;
    const Track track = guests_[local].track; // guests move when others are admitted
    if (guests_[local].room >= 0) {
        vicinity_->for_each_met(body, track, now, [&](Index other) { look(local, other, now); });
    } else {
        const Flown<Real> path = flown(local_, local);
        own_strays_.push_back(local);
        strays.push_back({body, path});
        vicinity_->for_each_along(path, [&](Index other) {
            if (vicinity_->may_meet(track, vicinity_->track(other), now)) look(local, other, now);
        });
    }
    look_at_own(local, except, now);
    for_each_wall_event(local_, local, to_, [&](double time, std::uint32_t wall) {
        queue_.push({time, local, wall, local_.bodies.course[local].version, 0});
    });
}

/// Predicts a body's meeting with one whose path at the start of the window it may meet, if that one is still on it.
template <class Real>
void Workshop<Real>::look(Index local, Index other, double now) {
    if (other == guests_[local].body) return;
    Index place = places_.find(other);
    double time = 0;
    ++predictions_;
    if (place == no_index) {
        // Not worth a copy unless they meet.
        if (rests_on(local_.bodies, local, state_->bodies.slot[other])) return;
        time = predict_paths(*state_, path_of(local_, local), path_of(*state_, other), now, to_);
        if (time > to_) return;
        place = admit(other, false);
    } else if (guests_[place].has_turned) {
        return;
    } else {
        time = predict_pair(local_, local, place, now, to_);
    }
    push(time, local, place);
}

/// Predicts a body's meetings with those of its island that go other ways by now.
template <class Real>
void Workshop<Real>::look_at_own(Index local, Index except, double now) {
    constexpr std::size_t few = 32;
    const auto look_at_place = [&](Index other) {
        if (other != local && other != except && guests_[other].has_turned) look_at_turned(local, other, now);
    };
    if (turned_.size() <= few || guests_[local].room < 0) {
        for (const Index other : turned_) look_at_place(other);
        return;
    }
    vicinity_->for_each(guests_[local].body, [&](Index body) {
        const Index place = places_.find(body);
        if (place != no_index) look_at_place(place);
    });
    for (const Index other : own_strays_) look_at_place(other);
}

template <class Real>
void Workshop<Real>::look_at_turned(Index local, Index other, double now) {
    if (!vicinity_->may_meet(guests_[local].track, guests_[other].track, now)) return;
    ++predictions_;
    push(predict_pair(local_, local, other, now, to_), local, other);
}

template <class Real>
void Workshop<Real>::push(double time, Index a, Index b) {
    if (time > to_) return;
    queue_.push({time, a, b, local_.bodies.course[a].version, local_.bodies.course[b].version});
}

/// Leaves behind how the bodies end the window.
template <class Real>
void Workshop<Real>::put_out(Outturn& outturn) {
    outturn.turned.begin = static_cast<std::uint32_t>(turned.size());
    for (const Index local : turned_) {
        const Guest& guest = guests_[local];
        Turned<Real>& result = turned.emplace_back();
        static_cast<TurnedBody&>(result) = {guest.body, guest.room, guest.track};
        result.motion = local_.bodies.motion[local];
        result.earlier = guest.earlier;
        result.kind = local_.bodies.kind[local];
        const Flight& flight = local_.bodies.course[local].flight;
        if (is_recent(flight, to_, local_.laws.collapse_time)) {
            result.flight = static_cast<std::uint32_t>(flights.size());
            flights.push_back(flight);
        }
        any_rests_ = any_rests_ || rests(result.kind);
        if (result.kind == Kind::held) {
            result.hold = static_cast<std::uint32_t>(holds.size());
            holds.push_back(hold_of(local_.bodies, local));
        }
    }
    outturn.turned.end = static_cast<std::uint32_t>(turned.size());
}

template <class Real>
void Workshop<Real>::prefetch_bodies(std::span<const Index> bodies) const {
    for (const Index body : bodies) {
        prefetch_object(&state_->bodies.motion[body]);
        prefetch(&state_->bodies.slot[body]);
        vicinity_->prefetch_body(body);
    }
}

template <class Real>
void Workshop<Real>::prefetch_lists(std::span<const Index> bodies) const {
    for (const Index body : bodies) vicinity_->prefetch_list(body);
}

template <class Real>
void Workshop<Real>::prefetch_tracks(std::span<const Index> bodies) const {
    for (const Index body : bodies) vicinity_->prefetch_tracks(body);
}

template class Workshop<float>;
template class Workshop<double>;

} // namespace carom::core
