#include "space/vicinity.hpp"

namespace carom::core {

namespace {

/// Room is a float that is added to and taken from: this part of it is left for the roundings.
constexpr double room_for_rounding = 1e-4;

} // namespace

template <class Real>
double Vicinity<Real>::acceleration_size(Index body) const {
    return state_.bodies.kind[body] == Kind::free ? gravity_ : length(acceleration_of(state_, body));
}

/// m, at least what a body moves from `from` to `to` on a path, and what rounding may add. Of adjoining intervals the
/// sum is no less than the whole's.
template <class Real>
double Vicinity<Real>::way(const Motion<Real>& motion, double acceleration, double from, double to) const {
    const double top_speed = length(velocity_of(motion)) + acceleration * (state_.laws.kick_interval - motion.t);
    return top_speed * (to - from) + 2 * state_.resolution.metres;
}

template <class Real>
double Vicinity<Real>::path_length(Index body, double from, double to) const {
    const double length = way(state_.bodies.motion[body], acceleration_size(body), from, to);
    // A held body may be put back onto a curved support, by no more than it slid.
    return state_.bodies.kind[body] == Kind::held ? 2 * length : length;
}

template <class Real>
void Vicinity<Real>::prepare(const Census& census, double from, double to) {
    gravity_ = length(state_.laws.gravity);
    if (!update(from, to)) {
        build(census, from, to);
        // New covers are centred where the bodies were at their own times: their whole ways count.
        start_bodies(0, to);
    }
    std::sort(covered_anew_.begin(), covered_anew_.end());
    covered_anew_.erase(std::unique(covered_anew_.begin(), covered_anew_.end()), covered_anew_.end());
}

/// Carries the lists over from the last window; false if they had better be built anew.
template <class Real>
bool Vicinity<Real>::update(double from, double to) {
    if (!is_valid_ || neighbours_.crowded()) return false;
    start_bodies(from, to);
    return cover_strays(from, to);
}

/// Takes the room that every body needs in the window.
template <class Real>
void Vicinity<Real>::start_bodies(double from, double to) {
    const Bodies<Real>& bodies = state_.bodies;
    near_walls_.clear();
    strays_.clear();
    for (Index i = 0; i < bodies.size(); ++i) {
        prefetch_ahead(bodies.motion.data() + i);
        const Motion<Real>& m = bodies.motion[i];
        const auto radius = static_cast<double>(m.radius);
        if (bodies.kind[i] == Kind::fixed) {
            first_balls_[i] = balls_.ball(m.x, radius);
            continue;
        }
        const double length = path_length(i, m.t, to);
        const double reach = length + radius;
        first_balls_[i] = balls_.ball(m.x, reach);
        if (state_.bounds.may_touch(m.x, reach, state_.resolution)) near_walls_.push_back(i);
        use_room(i, from == m.t ? length : path_length(i, from, to));
        if (room_[i] < 0) strays_.push_back(i);
    }
}

/// Gives the bodies without room new covers; false if there are so many that all had better be built anew.
template <class Real>
bool Vicinity<Real>::cover_strays(double from, double to) {
    constexpr std::size_t few = 16;
    constexpr std::size_t part = 32;
    if (strays_.size() > few + state_.bodies.size() / part) return false;
    for (const Index i : strays_) {
        cover_anew(i, from, to);
        use_room(i, path_length(i, state_.bodies.motion[i].t, to));
    }
    return true;
}

/// Longer lists cost more in each window, shorter ones are built more often: some pairs per body beyond those that come
/// near in the window anyway are about as dear as the building, spread over the windows it lasts.
template <class Real>
void Vicinity<Real>::choose_horizon(const Census& census, double duration) {
    constexpr double most_windows = 64;
    constexpr double change = 1.25;
    if (is_valid_) {
        const auto moving = static_cast<double>(census.moving);
        const auto pairs = static_cast<double>(neighbours_.pairs().size());
        const double wanted = 2 * moving + 2 * static_cast<double>(candidates_);
        windows_ahead_ =
            std::clamp(pairs > wanted ? windows_ahead_ / change : windows_ahead_ * change, 1.0, most_windows);
    }
    typical_room_ = (census.typical_speed + gravity_ * duration) * duration * windows_ahead_;
}

template <class Real>
void Vicinity<Real>::build(const Census& census, double from, double to) {
    const Bodies<Real>& bodies = state_.bodies;
    choose_horizon(census, to - from);
    typical_size_ = std::max(2 * (census.mean_radius + typical_room_), state_.resolution.metres);
    ticks_ = Ticks(state_.bounds, state_.resolution, typical_size_);
    balls_ = Balls(ticks_);
    covered_anew_.clear();
    covers_.resize(bodies.size());
    room_.resize(bodies.size());
    first_balls_.resize(bodies.size());
    for (Index i = 0; i < bodies.size(); ++i) {
        prefetch_ahead(bodies.motion.data() + i);
        covers_[i] = make_cover(i, to);
        const double room = static_cast<double>(std::max(room_[i], 0.0F)) * (1 + 2 * room_for_rounding);
        first_balls_[i] = balls_.ball(bodies.motion[i].x, radius_of(i) + room);
    }
    neighbours_.build(covers_, ticks_.axes(census),
                      [this](Index a, Index b) { return balls_.may_meet(first_balls_[a], first_balls_[b]); });
    is_valid_ = true;
    for (Index i = 0; i < bodies.size(); ++i) {
        if (room_[i] < 0) cover_along(i, {bodies.motion[i], acceleration_of(state_, i)}, from, to);
    }
}

/// The box of a body's ball; sets its room.
template <class Real>
SweptBox Vicinity<Real>::make_cover(Index body, double to) {
    const Motion<Real>& m = state_.bodies.motion[body];
    const auto radius = static_cast<double>(m.radius);
    if (state_.bodies.kind[body] == Kind::fixed) {
        room_[body] = 0;
        return ticks_.box(m.x, {}, {}, radius);
    }
    constexpr double most_rooms = 4;
    const double length = path_length(body, m.t, to);
    const double room = std::clamp(length * windows_ahead_, typical_room_, most_rooms * typical_room_);
    if (length > room) {
        room_[body] = -1;
        return ticks_.box(m.x, {}, {}, radius);
    }
    room_[body] = static_cast<float>(room * (1 - room_for_rounding));
    return ticks_.box(m.x, Vec3{-room, -room, -room}, Vec3{room, room, room}, radius);
}

template <class Real>
void Vicinity<Real>::cover_anew(Index body, double from, double to) {
    covered_anew_.push_back(body);
    neighbours_.cover_anew(body, make_cover(body, to),
                           [this](Index other) { return state_.bodies.kind[other] != Kind::fixed; });
    if (room_[body] < 0) cover_along(body, {state_.bodies.motion[body], acceleration_of(state_, body)}, from, to);
}

template <class Real>
void Vicinity<Real>::cover_along(Index body, const Flown<Real>& path, double from, double to) {
    covered_anew_.push_back(body);
    for_each_piece(path, from, to, [&](const SweptBox& box) {
        neighbours_.extend_cover(body, box, [this](Index other) { return state_.bodies.kind[other] != Kind::fixed; });
    });
}

/// m, how far a body may be at any time until `to` from where the path `before` began.
template <class Real>
double Vicinity<Real>::strayed(Index body, const Flown<Real>& before, double to) const {
    const Motion<Real>& m = state_.bodies.motion[body];
    return length(to_metres(m.x - before.motion.x, state_.resolution)) + path_length(body, m.t, to);
}

template <class Real>
bool Vicinity<Real>::follow(Index body, const Flown<Real>& before, double to) {
    const double distance = strayed(body, before, to);
    first_balls_[body].radius = std::max(first_balls_[body].radius, balls_.radius(distance + radius_of(body)));
    const double used = way(before.motion, length(before.acceleration), before.motion.t, to);
    return distance <= static_cast<double>(room_[body]) + used;
}

template <class Real>
void Vicinity<Real>::settle(Index body, const Flown<Real>& before, double to) {
    if (room_[body] < 0) return;
    use_room(body, strayed(body, before, to) - way(before.motion, length(before.acceleration), before.motion.t, to));
}

template class Vicinity<float>;
template class Vicinity<double>;

} // namespace carom::core
