#include "impact/serial.hpp"

#include "space/stopwatch.hpp"

namespace carom::core {

namespace {

/// Whether a body stays within the world on a path of constant acceleration for `duration` s.
template <class Real>
bool stays_in_world(const State<Real>& state, Index body, const Vec3& acceleration, double duration) {
    const Motion<Real>& m = state.bodies.motion[body];
    const Vec3 v = velocity_of(m);
    for (int axis = 0; axis < 3; ++axis) {
        const double path = (std::abs(component(v, axis)) + std::abs(component(acceleration, axis)) * duration) *
                            duration * state.resolution.per_metre;
        const double end = std::abs(static_cast<double>(component(m.x, axis))) + path;
        if (!(end < static_cast<double>(flight_edge))) return false;
    }
    return true;
}

/// The length (m) that ticks are made for: a body and its way through the window.
double tick_scale(const Census& census, double duration, const Resolution& resolution) {
    return std::max(2 * (census.mean_radius + census.rms_speed * duration), resolution.metres);
}

} // namespace

template <class Real>
Progress SerialSolver<Real>::resolve(const Census& census, double from, double to, std::uint64_t work_cap,
                                     Outcome& outcome) {
    Stopwatch watch;
    build_cells(census, from, to);
    seconds_.cells += watch.lap();
    queue_.clear();
    predict_first(from, to);
    seconds_.pairs += watch.lap();
    const Progress progress = run_queue(to, work_cap, outcome);
    seconds_.impacts += watch.lap();
    return progress;
}

template <class Real>
void SerialSolver<Real>::build_cells(const Census& census, double from, double to) {
    const Bodies<Real>& bodies = state_.bodies;
    ticks_ = Ticks(state_.bounds, state_.resolution, tick_scale(census, to - from, state_.resolution));
    boxes_.resize(bodies.size());
    for (Index i = 0; i < bodies.size(); ++i) {
        boxes_[i] = swept_box(ticks_, bodies.motion[i], acceleration_of(state_, i), from, to);
    }
    cells_.build(boxes_, ticks_.axes(census));
}

template <class Real>
void SerialSolver<Real>::predict_first(double from, double to) {
    pairs_.clear();
    cells_.find_pairs(pairs_);
    for (const auto& [a, b] : pairs_) predict(a, b, from, to);
    for (Index i = 0; i < state_.bodies.size(); ++i) predict_walls(i, to);
}

template <class Real>
Progress SerialSolver<Real>::run_queue(double to, std::uint64_t work_cap, Outcome& outcome) {
    while (!queue_.empty()) {
        const Event event = queue_.top();
        if (queue_.outdated(event)) {
            queue_.pop();
            continue;
        }
        if (work_cap != 0 && outcome.impacts + outcome.face_impacts >= work_cap) {
            return {.reached = event.time, .work_cap_reached = true};
        }
        queue_.pop();
        execute(state_, event, outcome);
        bool inside = register_motion(event.a, event.time, to);
        if (!event.at_wall()) inside = register_motion(event.b, event.time, to) && inside;
        if (!inside) return {.reached = event.time, .edge_reached = true};
        predict_again(event.a, no_index, event.time, to);
        if (!event.at_wall()) predict_again(event.b, event.a, event.time, to);
    }
    return {.reached = to};
}

template <class Real>
bool SerialSolver<Real>::register_motion(Index body, double now, double to) {
    if (state_.bodies.kind[body] == Kind::fixed) return true;
    const Vec3 a = acceleration_of(state_, body);
    if (!stays_in_world(state_, body, a, to - now)) return false;
    cells_.update(body, swept_box(ticks_, state_.bodies.motion[body], a, now, to));
    return true;
}

template <class Real>
void SerialSolver<Real>::predict_again(Index body, Index except, double now, double to) {
    if (state_.bodies.kind[body] == Kind::fixed) return;
    const Vec3 a = acceleration_of(state_, body);
    const SweptBox box = swept_box(ticks_, state_.bodies.motion[body], a, now, to);
    cells_.for_each_meeting(box, [&](Index other) {
        if (other != body && other != except) predict(body, other, now, to);
    });
    predict_walls(body, to);
}

template <class Real>
void SerialSolver<Real>::predict(Index a, Index b, double now, double to) {
    ++predictions_;
    const double time = predict_pair(state_, a, b, now, to);
    if (time <= to) queue_.push({time, a, b, state_.bodies.version[a], state_.bodies.version[b]});
}

template <class Real>
void SerialSolver<Real>::predict_walls(Index body, double to) {
    if (state_.bodies.kind[body] == Kind::fixed) return;
    const auto count = static_cast<std::uint32_t>(state_.bounds.walls().size());
    for (std::uint32_t wall = 0; wall < count; ++wall) {
        const double time = predict_wall(state_, body, wall, to);
        if (time <= to) queue_.push({time, body, Event::wall_bit | wall, state_.bodies.version[body], 0});
    }
}

template class SerialSolver<float>;
template class SerialSolver<double>;

} // namespace carom::core
