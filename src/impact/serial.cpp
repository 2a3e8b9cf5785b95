#include "impact/serial.hpp"

#include "space/stopwatch.hpp"

namespace carom::core {

namespace {

/// The length (m) that ticks are made for: a body and its way through the window.
double tick_scale(const Census& census, double duration, const Resolution& resolution) {
    return std::max(2 * (census.mean_radius + census.typical_speed * duration), resolution.metres);
}

} // namespace

template <class Real>
Progress SerialSolver<Real>::resolve(const Census& census, const Window& window, std::uint64_t work_cap,
                                     Outcome& outcome) {
    Stopwatch watch;
    recall_flights();
    find_neighbours(census, window.from, window.to);
    costs_.seconds.cells += watch.lap();
    queue_.clear();
    predict_first(window.from, window.to);
    costs_.seconds.pairs += watch.lap();
    const std::uint64_t before = outcome.impacts;
    const Progress progress = run_queue(window, work_cap, outcome);
    remember_flights(progress.reached);
    impacts_per_body_ = static_cast<double>(outcome.impacts - before) / static_cast<double>(state_.bodies.size() + 1);
    costs_.seconds.impacts += watch.lap();
    return progress;
}

template <class Real>
void SerialSolver<Real>::recall_flights() {
    Bodies<Real>& bodies = state_.bodies;
    bodies.course.assign(bodies.size(), {});
    for (const auto& [slot, flight] : bodies.recent_flights) bodies.course[bodies.slots[slot]].flight = flight;
}

template <class Real>
void SerialSolver<Real>::remember_flights(double now) {
    Bodies<Real>& bodies = state_.bodies;
    bodies.recent_flights.clear();
    for (Index i = 0; i < bodies.size(); ++i) {
        const Flight& flight = bodies.course[i].flight;
        if (is_recent(flight, now, state_.laws.collapse_time)) {
            bodies.recent_flights.push_back({bodies.slot[i], flight});
        }
    }
    sort_by_slot(bodies.recent_flights);
    bodies.course.clear();
}

template <class Real>
void SerialSolver<Real>::find_neighbours(const Census& census, double from, double to) {
    const Bodies<Real>& bodies = state_.bodies;
    const double duration = to - from;
    ticks_ = Ticks(state_.bounds, state_.resolution, tick_scale(census, duration, state_.resolution));
    // More slack means more neighbours to predict, less means more bodies that leave their covers: it pays where there
    // are many impacts.
    constexpr double most_slack = 0.3;
    constexpr double slack_per_impact = 6;
    slack_ = std::min(most_slack, slack_per_impact * impacts_per_body_) * census.typical_speed * duration;
    covers_.resize(bodies.size());
    near_walls_.clear();
    for (Index i = 0; i < bodies.size(); ++i) {
        const Motion<Real>& m = bodies.motion[i];
        const Vec3 a = acceleration_of(state_, i);
        const double growth = bodies.top_growth * to;
        covers_[i] = swept_ball(ticks_, m, a, from, to, slack_ + growth);
        if (state_.bounds.may_touch(m.x, reach_of(m, a, to) + growth, state_.resolution)) near_walls_.push_back(i);
    }
    neighbours_.build(
        *loops_, bodies.size(), ticks_.axes(census), [this](Index i) { return covers_[i]; },
        [&](Index i) { return !is_prescribed(bodies.kind[i]); });
}

template <class Real>
void SerialSolver<Real>::predict_first(double from, double to) {
    const Bodies<Real>& bodies = state_.bodies;
    for (Index a = 0; a < bodies.size(); ++a) {
        if (is_prescribed(bodies.kind[a])) continue;
        neighbours_.for_each(a, [&](Index b) {
            if (b > a || is_prescribed(bodies.kind[b])) predict(a, b, from, to);
        });
    }
    for (const Index i : near_walls_) predict_walls(i, to);
}

template <class Real>
Progress SerialSolver<Real>::run_queue(const Window& window, std::uint64_t work_cap, Outcome& outcome) {
    double until = window.piece_end;
    const auto end = [&] { return std::min(window.to, until); };
    while (!queue_.empty() && queue_.top().time <= end()) {
        const Event event = queue_.top();
        if (queue_.outdated(event)) {
            queue_.pop();
            continue;
        }
        if (work_cap != 0 && outcome.all_impacts() >= work_cap) {
            return {.reached = event.time, .until = until, .work_cap_reached = true};
        }
        if (neighbours_.crowded()) return {.reached = event.time, .until = until};
        queue_.pop();
        prefetch_next();
        Occurrence occurrence;
        execute(state_, event, occurrence);
        state_.books.add(occurrence.entry);
        outcome.add(occurrence);
        if (occurrence.piles_up) until = std::min(until, window.pieces.end_after(event.time));
        if (occurrence.is_crushed) return {.reached = event.time, .until = until, .crushed = true};
        bool inside = register_motion(event.a, event.time, end());
        if (!event.at_wall()) inside = register_motion(event.b, event.time, end()) && inside;
        if (!inside) return {.reached = event.time, .until = until, .edge_reached = true};
        predict_again(event.a, no_index, event.time, end());
        if (event.at_wall()) continue;
        const bool seen_from_a = !is_prescribed(state_.bodies.kind[event.a]);
        predict_again(event.b, seen_from_a ? event.a : no_index, event.time, end());
    }
    return {.reached = end(), .until = until};
}

/// Successive impacts are anywhere in space, so in memory: asking for the next ones' bodies while this one is worked on
/// hides most of the wait.
template <class Real>
void SerialSolver<Real>::prefetch_next() const {
    constexpr std::size_t top_and_children = 3;
    for (std::size_t k = 0; k < top_and_children; ++k) {
        const Event* const next = queue_.candidate(k);
        if (next == nullptr) return;
        for (const Index body : {next->a, next->at_wall() ? next->a : next->b}) {
            prefetch_object(&state_.bodies.motion[body]);
            prefetch(&state_.bodies.slot[body]);
            if (k == 0) {
                prefetch_neighbours(body);
            } else {
                neighbours_.prefetch_body(body);
            }
        }
    }
}

template <class Real>
void SerialSolver<Real>::prefetch_neighbours(Index body) const {
    neighbours_.for_each(body, [&](Index other) { prefetch_object(&state_.bodies.motion[other]); });
}

template <class Real>
bool SerialSolver<Real>::register_motion(Index body, double now, double to) {
    if (is_prescribed(state_.bodies.kind[body])) return true;
    // To the end of the step, not of the window: no result may depend on windows.
    if (!stays_in_world(state_, body, state_.laws.kick_interval - now)) return false;
    const Vec3 a = acceleration_of(state_, body);
    const Motion<Real>& m = state_.bodies.motion[body];
    const double growth = state_.bodies.top_growth * to;
    if (neighbours_.covers(body, swept_ball(ticks_, m, a, now, to, growth))) return true;
    neighbours_.replace_cover(body, swept_ball(ticks_, m, a, now, to, slack_ + growth));
    neighbours_.link_all(*loops_, {&body, 1},
                         [this](Index other) { return !is_prescribed(state_.bodies.kind[other]); });
    return true;
}

template <class Real>
void SerialSolver<Real>::predict_again(Index body, Index except, double now, double to) {
    if (is_prescribed(state_.bodies.kind[body])) return;
    prefetch_neighbours(body);
    neighbours_.for_each(body, [&](Index other) {
        if (other != except) predict(body, other, now, to);
    });
    predict_walls(body, to);
}

template <class Real>
void SerialSolver<Real>::predict(Index a, Index b, double now, double to) {
    ++costs_.predictions;
    const double time = predict_pair(state_, a, b, now, to);
    if (time <= to) queue_.push({time, a, b, state_.bodies.course[a].version, state_.bodies.course[b].version});
}

template <class Real>
void SerialSolver<Real>::predict_walls(Index body, double to) {
    for_each_wall_event(state_, body, to, [&](double time, std::uint32_t wall) {
        queue_.push({time, body, wall, state_.bodies.course[body].version, 0});
    });
}

template class SerialSolver<float>;
template class SerialSolver<double>;

} // namespace carom::core
