#include "space/vicinity.hpp"

namespace carom::core {

namespace {

constexpr double infinite = std::numeric_limits<double>::infinity();

/// Loops over bodies have parts of at least so many.
constexpr std::size_t body_grain = 4096;

/// A body whose path in an epoch is longer than this many typical covers is too fast for single precision.
constexpr double longest_track = 16;

/// A body may have so many times the typical room: what needs more is covered along its path.
constexpr double most_rooms = 4;

/// s until a body may have come `gap` m nearer, at `speed` (m/s) and `acceleration` (m/s^2) at most.
double time_to_cover(double gap, double speed, double acceleration) {
    if (gap <= 0) return 0;
    if (acceleration == 0) return gap / speed;
    const double top = speed + std::sqrt(speed * speed + 2 * acceleration * gap);
    return 2 * gap / top;
}

/// Whether a body goes another way than in free flight.
bool is_led(Kind kind) { return rests(kind) || kind == Kind::kinematic; }

void sort_and_unite(std::vector<Index>& bodies) {
    std::sort(bodies.begin(), bodies.end());
    bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
}

} // namespace

// ---------------------------------------------------------------------------------------------------------------------
// Epochs
// ---------------------------------------------------------------------------------------------------------------------

template <class Real>
void Vicinity<Real>::end_step(double reached) {
    epoch_ -= reached;
    if (kicked_) epoch_valid_ = false;
}

template <class Real>
void Vicinity<Real>::prepare(const Census& census, const Window& window, bool kicked) {
    // The frame of the covers is another one then.
    if (kicked != kicked_) forget();
    kicked_ = kicked;
    piece_end_ = window.piece_end;
    step_end_ = window.step_end();
    track_search_ = track_search();
    clear_for_reuse(exits_);
    if (continues_epoch(window)) {
        ++window_;
        window_start_ = relative(window.from);
        window_end_ = static_cast<float>(exact_relative(window.to) + slack * length_);
        neighbours_.drop_extensions();
        if (window.from == 0) charge_led();
        if (window.begins_piece) charge_piled();
        renew_disturbed();
    } else {
        start_epoch(census, window);
    }
    calendar_.take_exits(window_, exits_);
    renew_exits();
    collect_due();
}

/// Whether the window is the next one of the epoch, as long as all others.
template <class Real>
bool Vicinity<Real>::continues_epoch(const Window& window) const {
    constexpr double rounding = 1e-9;
    constexpr std::size_t few = 64;
    if (!epoch_valid_ || window_ + 1 >= windows_ || neighbours_.crowded()) return false;
    if (disturbed_.size() > few + state_.bodies.size() / 8) return false;
    const double expected = length_ * (window_ + 1.0);
    return std::abs(exact_relative(window.from) - expected) <= rounding * expected &&
           std::abs((window.to - window.from) - length_) <= rounding * length_;
}

template <class Real>
void Vicinity<Real>::start_epoch(const Census& census, const Window& window) {
    const double duration = window.to - window.from;
    const double left = std::clamp(std::round((window.step_end() - window.from) / duration), 1.0,
                                   static_cast<double>(Calendar::most_windows));
    const auto left_in_step = static_cast<std::uint32_t>(left);
    clear_for_reuse(disturbed_);
    if (!kicked_ || !carry_on(window, left_in_step)) {
        const double way = (census.typical_speed + length(state_.laws.gravity) * duration) * duration;
        windows_ahead_ = windows_worthwhile(census, way);
        set_epoch(window, kicked_ ? left_in_step : windows_ahead_);
        build(census, way);
    }
    epoch_valid_ = true;
    // Twice 2^-24 of the speed that still suits tracks, along three axes.
    scale_.speed_error = static_cast<float>(0x1p-22 * longest_track * typical_size_ / (length_ * windows_));
    plan_pairs();
}

template <class Real>
void Vicinity<Real>::set_epoch(const Window& window, std::uint32_t windows) {
    epoch_ = window.from;
    length_ = window.to - window.from;
    windows_ = windows;
    window_ = 0;
    const double duration = length_ * windows;
    // The covers' frame must not change while they last, which may be for many steps if bodies are kicked.
    frame_ = kicked_ ? Vec3{} : state_.laws.gravity;
    fall_ = 0.5 * length(frame_) * duration * duration;
    // A path bends from the body's own time on, which may be the start of the step.
    sag_ = 0.5 * length(state_.laws.gravity - frame_) * window.step_end() * window.step_end();
    window_start_ = 0;
    window_end_ = static_cast<float>(length_ * (1 + slack));
}

/// How many windows the lists had better last. Building costs about `fixed + a pair` a body each time, and every body
/// that an impact turned looks at its neighbours: more windows mean more room, so more pairs, by its cube.
template <class Real>
std::uint32_t Vicinity<Real>::windows_worthwhile(const Census& census, double way) const {
    // All in units of one pair found; fitted to the workloads.
    constexpr double fixed = 22;
    constexpr double looked_at = 36;
    constexpr double planned = 0.1; // anew in every step if bodies are kicked
    const double per_window = looked_at * turning_ + (kicked_ ? planned : 0);
    // The crowding is known from the last lists, and as far as they reached: one window at first.
    constexpr std::uint32_t growth = 2;
    const std::uint32_t most = std::clamp(growth * windows_ahead_, 1U, Calendar::most_windows);
    double best = infinite;
    std::uint32_t windows = 1;
    for (std::uint32_t k = 1; k <= most; ++k) {
        const double reach = 2 * (census.mean_radius + way * (k + spare_windows()) * (1 - lead_share()));
        const double pairs = crowding_ * reach * reach * reach;
        const double cost = (fixed + pairs) / k + per_window * pairs;
        if (cost >= best) continue;
        best = cost;
        windows = k;
    }
    return windows;
}

/// Part of a cover's time that a body needs to its middle. The nearer to a half, the smaller are covers; but whom an
/// impact turns before or after the middle leaves its cover the sooner.
template <class Real>
double Vicinity<Real>::lead_share() const {
    // Where so large a part of the bodies turns in a window, it does not pay; measured.
    constexpr double too_many = 1.0 / 20;
    return 0.5 * std::max(0.0, 1 - turning_ / too_many);
}

/// Room for so many windows more: impacts make some bodies faster.
template <class Real>
double Vicinity<Real>::spare_windows() const {
    constexpr double per_turn = 3;
    return std::min(1.0, per_turn * turning_);
}

/// Takes new tracks with the old lists; false if so many bodies have no room that the lists had better be built anew.
template <class Real>
bool Vicinity<Real>::carry_on(const Window& window, std::uint32_t windows) {
    if (!lists_valid_ || neighbours_.crowded() || !state_.bodies.growth.empty()) return false;
    neighbours_.drop_extensions();
    calendar_.clear();
    const float elapsed = relative(window.from);
    set_epoch(window, windows);
    middle_ -= elapsed;
    const auto needed = static_cast<float>(windows_ * length_);
    std::array<std::size_t, most_parts> without_room{};
    for_each_in_parts(*executor_, state_.bodies.size(), body_grain, [&](std::size_t part, std::size_t k) {
        const auto body = static_cast<Index>(k);
        take_kicked(body, elapsed);
        plan_alone(part, body, 0);
        if (room_at(body, needed) < 0) ++without_room[part];
    });
    charge_led();
    if (window.begins_piece) charge_piled();
    std::size_t all = 0;
    for (const std::size_t count : without_room) all += count;
    constexpr std::size_t few = 16;
    constexpr std::size_t part_of_all = 32;
    return all <= few + state_.bodies.size() / part_of_all;
}

template <class Real>
void Vicinity<Real>::build(const Census& census, double way) {
    const std::size_t bodies = state_.bodies.size();
    clear_for_reuse(exits_);
    const double windows = windows_ahead_ + spare_windows();
    horizon_ = length_ * windows;
    const double share = lead_share();
    lead_ = share * horizon_;
    middle_ = static_cast<float>(lead_);
    typical_room_ = way * windows * (1 - share);
    // Piled bodies creep for long, and have few others to look for: large covers cost them nothing.
    constexpr double creep = 0.05;
    if (has_pile_) typical_room_ = std::max(typical_room_, creep * census.mean_radius);
    typical_size_ = std::max(2 * (census.mean_radius + typical_room_), state_.resolution.metres);
    ticks_ = Ticks(state_.bounds, state_.resolution, typical_size_);
    const auto [x, y, z] = ticks_.metres_per_tick();
    scale_.metres = {static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
    ticks_per_metre_ = {1 / scale_.metres[0], 1 / scale_.metres[1], 1 / scale_.metres[2]};
    // A tick along each axis, and roundings.
    tick_loss_ = 2 * (scale_.metres[0] + scale_.metres[1] + scale_.metres[2]);
    // Ticks are 2^-15 of the size or less; tracks are two of them wrong along each axis.
    reach_margin_ = 2e-4 * typical_size_ + 2.0 * Calendar::most_windows * state_.resolution.metres;
    scale_.tolerance = static_cast<float>(4 * reach_margin_);
    // A radius is as of the body's own time, which may be the start of the step in which the epoch begins.
    reach_margin_ += state_.bodies.top_growth * (step_end_ + static_cast<double>(epoch_end()));
    // An eighth of the torus, where something has its images.
    longest_reach_ = state_.bounds.any_periodic() ? 0x1p29 * std::min({x, y, z}) : infinite;
    tracks_.resize(bodies);
    calendar_.clear();
    for_each_in_parts(*executor_, bodies, body_grain, [&](std::size_t part, std::size_t k) {
        const auto body = static_cast<Index>(k);
        prefetch_ahead(state_.bodies.motion.data() + k);
        take_room(body, 0);
        plan_alone(part, body, 0);
    });
    neighbours_.build(
        *executor_, bodies, ticks_.axes(census), [this](Index body) { return cover_at(body, 0); },
        [this](Index body) { return state_.bodies.kind[body] != Kind::fixed; });
    lists_valid_ = true;
    const auto pairs = 0.5 * static_cast<double>(neighbours_.found());
    crowding_ = pairs / static_cast<double>(std::max<std::size_t>(census.moving, 1)) /
                (typical_size_ * typical_size_ * typical_size_);
}

/// Plans all pairs, each once.
template <class Real>
void Vicinity<Real>::plan_pairs() {
    const std::size_t bodies = state_.bodies.size();
    for_parts(*executor_, bodies, body_grain, [&](std::size_t part, std::size_t begin, std::size_t end) {
        constexpr std::size_t ahead = 8;
        const auto soon = [end](std::size_t k) { return static_cast<Index>(std::min(k, end - 1)); };
        for (std::size_t k = begin; k < end; ++k) {
            const auto body = static_cast<Index>(k);
            neighbours_.prefetch_list(soon(k + 2 * ahead));
            prefetch_tracks(soon(k + ahead));
            if (state_.bodies.kind[body] == Kind::fixed) continue;
            for_each_meeting(body, tracks_[body], 0, epoch_end(), [&](Index other, float time) {
                if (other > body || state_.bodies.kind[other] == Kind::fixed) plan_pair(part, body, other, time, 0);
            });
        }
    });
}

// ---------------------------------------------------------------------------------------------------------------------
// Windows
// ---------------------------------------------------------------------------------------------------------------------

/// Bodies that the caller changed since the last step.
template <class Real>
void Vicinity<Real>::renew_disturbed() {
    sort_and_unite(disturbed_);
    for (const Index body : disturbed_) {
        take_track(body, room_around(tracks_[body], window_start_), window_start_);
        plan_meetings(0, body, window_start_, window_);
        plan_alone(0, body, window_);
    }
    clear_for_reuse(disturbed_);
}

/// Bodies that may leave their covers in this window get new ones, or balls along their paths if they are too fast.
template <class Real>
void Vicinity<Real>::renew_exits() {
    constexpr std::size_t grain = 256;
    const auto looks_up = [this](Index other) { return state_.bodies.kind[other] != Kind::fixed; };
    sort_and_unite(exits_);
    clear_for_reuse(fast_);
    clear_for_reuse(renewed_);
    for (const Index body : exits_) {
        if (room_at(body, window_end_) < 0) {
            take_room(body, window_start_);
            if (tracks_[body].room < 0) {
                neighbours_.uncover(body);
                fast_.push_back(body);
            } else {
                neighbours_.replace_cover(body, cover_at(body, window_start_));
                renewed_.push_back(body);
            }
        }
        plan_exit(0, body, window_ + 1);
    }
    neighbours_.link_all(*executor_, renewed_, looks_up);
    for_each_in_parts(*executor_, renewed_.size(), grain, [&](std::size_t part, std::size_t k) {
        plan_meetings(part, renewed_[k], window_start_, window_);
    });
    neighbours_.start_extensions();
    for (const Index body : fast_) {
        cover_along(body, flown(state_, body));
        plan_meetings(0, body, window_start_, window_);
    }
}

/// Takes the room that the held and the kinematic bodies need in the step.
template <class Real>
void Vicinity<Real>::charge_led() {
    for (const auto& [slot, hold] : state_.bodies.holds) charge(state_.bodies.slots[slot]);
    for (const std::uint32_t slot : state_.bodies.kinematics) charge(state_.bodies.slots[slot]);
}

/// Takes the room that the piled bodies need in the piece.
template <class Real>
void Vicinity<Real>::charge_piled() {
    for (Index body = 0; body < state_.bodies.size(); ++body) {
        if (state_.bodies.kind[body] == Kind::piled) charge(body);
    }
}

template <class Real>
void Vicinity<Real>::charge(Index body) {
    const Motion<Real>& motion = state_.bodies.motion[body];
    const double way = resting_way(motion, acceleration_of(state_, body), state_.bodies.kind[body]);
    tracks_[body].room -= static_cast<float>(way);
    if (tracks_[body].room < 0) exits_.push_back(body);
}

/// m, at least what a held or kinematic body moves until the end of the step, or a piled one until that of the piece; a
/// held one may also be put back onto a curved support, by no more than it slid.
template <class Real>
double Vicinity<Real>::resting_way(const Motion<Real>& motion, const Vec3& acceleration, Kind kind) const {
    const double duration = (kind == Kind::piled ? piece_end_ : step_end_) - motion.t;
    return 2 * (length(velocity_of(motion)) + length(acceleration) * duration) * duration +
           2 * state_.resolution.metres;
}

/// How far the contacts of a pile tell what a body may meet of it.
template <class Real>
auto Vicinity<Real>::telling_of(Index body) const -> Telling {
    const Bodies<Real>& bodies = state_.bodies;
    if (is_still(bodies.kind[body])) return {.unless_struck = true, .if_slow = true};
    if (bodies.kind[body] != Kind::piled || body >= bodies.loads.size() || !bodies.loads[body].is_told) return {};
    const Motion<Real>& m = bodies.motion[body];
    return {.unless_struck = m.v == bodies.loads[body].given,
            .if_slow = length_squared(velocity_of(m)) <= told_speed_ * told_speed_};
}

template <class Real>
bool Vicinity<Real>::is_told(Index body) const {
    if (state_.bodies.kind[body] == Kind::free) return false;
    const Telling telling = telling_of(body);
    return telling.unless_struck || telling.if_slow;
}

template <class Real>
bool Vicinity<Real>::are_told(Index a, Index b) const {
    const std::vector<Kind>& kind = state_.bodies.kind;
    if (kind[a] == Kind::free || kind[b] == Kind::free) return false; // nearly always
    const Telling of_a = telling_of(a);
    const Telling of_b = telling_of(b);
    return (of_a.unless_struck && of_b.unless_struck) || (of_a.if_slow && of_b.if_slow);
}

/// What the calendar has for this window, and the suspects.
template <class Real>
void Vicinity<Real>::collect_due() {
    clear_for_reuse(near_walls_);
    calendar_.take_walls(window_, near_walls_);
    near_walls_.insert(near_walls_.end(), wall_suspects_.begin(), wall_suspects_.end());
    sort_and_unite(near_walls_);
    clear_for_reuse(due_);
    calendar_.take_pairs(window_, due_);
    constexpr std::size_t grain = 2048;
    for (std::vector<Pair>& kept : kept_) clear_for_reuse(kept);
    for_each_in_parts(*executor_, due_.size(), grain, [&](std::size_t part, std::size_t k) {
        constexpr std::size_t ahead = 12;
        const Pair& soon = due_[std::min(k + ahead, due_.size() - 1)];
        prefetch(&tracks_[soon.first]);
        prefetch(&tracks_[soon.second]);
        const auto [a, b] = due_[k];
        if (are_told(a, b)) return;
        const float time = first_meeting(tracks_[a], tracks_[b], window_start_, epoch_end(), scale_);
        if (time == never) return;
        if (time <= window_end_) {
            kept_[part].push_back(due_[k]);
        } else {
            calendar_.add_pair(part, window_of(static_cast<double>(time), window_ + 1), a, b);
        }
    });
    clear_for_reuse(candidates_);
    for (const std::vector<Pair>& kept : kept_) candidates_.insert(candidates_.end(), kept.begin(), kept.end());
    candidates_.insert(candidates_.end(), suspects_.begin(), suspects_.end());
}

template <class Real>
void Vicinity<Real>::cover_along(Index body, const Flown<Real>& path) {
    for_each_piece(path, [&](const Ball& ball) {
        neighbours_.extend_cover(body, ball, [this](Index other) { return state_.bodies.kind[other] != Kind::fixed; });
    });
}

template <class Real>
float Vicinity<Real>::room_left(Index body, const Flown<Real>& path) const {
    const Motion<Real>& before = state_.bodies.motion[body];
    const bool was_free = state_.bodies.kind[body] == Kind::free;
    const float known = was_free ? std::max(window_start_, middle_) : window_start_;
    const Vec3 from = was_free ? place_on_track(before, static_cast<double>(known))
                               : place_on_path(flown(state_, body), static_cast<double>(known));
    const Vec3 way = to_metres(path.motion.x - before.x, state_.resolution) - from;
    const double turn = exact_relative(path.motion.t);
    const double end = static_cast<double>(window_end_);
    // A straight way lies in a ball if its ends do.
    double distance = std::max(length(way + place_on_path(path, turn)), length(way + place_on_path(path, end)));
    const double duration = end - turn;
    if (path.acceleration != frame_) distance += 0.5 * length(path.acceleration - frame_) * duration * duration;
    // What is held stays behind the falling frame: it needs another cover, unless it has one already.
    if (rests(path.kind)) distance += resting_way(path.motion, path.acceleration, path.kind) + fall_;
    return static_cast<float>(static_cast<double>(room_at(body, known)) - distance - reach_margin_);
}

/// m from a body's position at its own time to where it is in the falling frame at `time`.
template <class Real>
Vec3 Vicinity<Real>::place_on_path(const Flown<Real>& path, double time) const {
    return displacement(velocity_of(path.motion), path.acceleration, time - exact_relative(path.motion.t)) -
           frame_ * (0.5 * time * time);
}

/// The same along the track of a free body: straight in the frame.
template <class Real>
Vec3 Vicinity<Real>::place_on_track(const Motion<Real>& motion, double time) const {
    const double own = exact_relative(motion.t);
    return (velocity_of(motion) - frame_ * own) * (time - own) - frame_ * (0.5 * own * own);
}

template <class Real>
Track Vicinity<Real>::track_in_window(const Flown<Real>& path) const {
    const double room = rests(path.kind) ? resting_way(path.motion, path.acceleration, path.kind) : 0;
    return track_of(path.motion, path.kind, room);
}

template <class Real>
void Vicinity<Real>::settle(std::span<const TurnedBody* const> turned) {
    // Of late, more or less.
    constexpr double weight = 0.25;
    const auto bodies = static_cast<double>(std::max<std::size_t>(state_.bodies.size(), 1));
    turning_ += weight * (static_cast<double>(turned.size()) / bodies - turning_);
    const bool is_last = window_ + 1 >= windows_;
    if (is_last && !kicked_) return;
    constexpr std::size_t grain = 512;
    for_each_in_parts(*executor_, turned.size(), grain, [&](std::size_t, std::size_t k) {
        constexpr std::size_t ahead = 8;
        prefetch_object(turned[std::min(k + 2 * ahead, turned.size() - 1)]);
        prefetch_body(turned[std::min(k + ahead, turned.size() - 1)]->body);
        const TurnedBody& t = *turned[k];
        if (state_.bodies.kind[t.body] == Kind::free) {
            put_track(t.body, t.track, t.room, window_end_);
        } else {
            take_track(t.body, t.room, window_end_);
        }
    });
    if (is_last) return;
    for (const Index body : near_walls_) plan_wall(0, body, window_ + 1);
    for_parts(*executor_, turned.size(), grain, [&](std::size_t part, std::size_t begin, std::size_t end) {
        constexpr std::size_t ahead = 4;
        const auto soon = [&](std::size_t k) { return turned[std::min(k, end - 1)]->body; };
        const auto from = static_cast<float>(static_cast<double>(window_end_) - 2 * slack * length_);
        for (std::size_t k = begin; k < end; ++k) {
            prefetch_body(soon(k + 3 * ahead));
            prefetch_object(&state_.bodies.motion[soon(k + 2 * ahead)]);
            prefetch_list(soon(k + 2 * ahead));
            prefetch_tracks(soon(k + ahead));
            plan_meetings(part, turned[k]->body, from, window_ + 1);
            plan_alone(part, turned[k]->body, window_ + 1);
        }
    });
}

// ---------------------------------------------------------------------------------------------------------------------
// Tracks and covers
// ---------------------------------------------------------------------------------------------------------------------

/// Whether single precision and the torus of ticks do for a body.
template <class Real>
bool Vicinity<Real>::suits_tracks(double speed, double reach) const {
    const double way = speed * length_ * windows_;
    if (!(way < longest_track * typical_size_)) return false;
    return reach + way < longest_reach_;
}

/// The track of a path in this epoch; one that is not in free flight stays within `room` (m).
template <class Real>
Track Vicinity<Real>::track_of(const Motion<Real>& m, Kind kind, double room) const {
    constexpr double rounding = 2e-6;
    const Vec3& g = frame_;
    const double now = exact_relative(m.t);
    const bool is_free = kind == Kind::free;
    const Vec3 v = is_free ? velocity_of(m) - g * now : Vec3{};
    const double reach =
        static_cast<double>(m.radius) * (1 + rounding) + reach_margin_ + (is_free ? sag_ : room + fall_);
    Track track;
    if (!suits_tracks(length(v), reach)) {
        track.start = ticks_.of(m.x);
        track.reach = -std::numeric_limits<float>::infinity();
        return track;
    }
    track.start = ticks_.of(m.x, is_free ? v * -now + g * (-0.5 * now * now) : Vec3{});
    // Who parts may grow faster.
    track.reach = static_cast<float>(is_free && sag_ == 0 && state_.bodies.growth.empty() ? reach : -reach);
    track.speed = {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
    return track;
}

/// A body goes its present way, with so much room at `now`.
template <class Real>
void Vicinity<Real>::take_track(Index body, float room, float now) {
    const Motion<Real>& m = state_.bodies.motion[body];
    const Kind kind = state_.bodies.kind[body];
    // The room of a body at rest is what it has beside its way in this step or piece.
    const double way = is_led(kind) ? resting_way(m, acceleration_of(state_, body), kind) : 0;
    put_track(body, track_of(m, kind, static_cast<double>(std::max(0.0F, room)) + way), room, now);
}

/// A body goes along a track, with so much room at `now`.
template <class Real>
void Vicinity<Real>::put_track(Index body, const Track& track, float room, float now) {
    Track& own = tracks_[body] = track;
    if (state_.bodies.kind[body] == Kind::fixed) {
        own.room = std::numeric_limits<float>::infinity();
    } else if (std::isinf(track.reach)) {
        own.room = -1;
    } else {
        own.room = room - static_cast<float>(sag_) + speed_of(track) * now;
    }
}

/// m, the room that is left where a kick turns a track, at the start of both. As long as it is on its track, so much of
/// its way is left: w / v of it at another speed w, and as much less as the kick may bend it. Or any way, if less.
template <class Real>
float Vicinity<Real>::room_after_kick(const Track& before, const Track& after) const {
    const float left = before.room;
    const float around = room_around(before, 0);
    if (left < 0 || around < 0) return std::min(left, around);
    const float v = speed_of(before);
    const float w = speed_of(after);
    const auto change = [&](std::size_t axis) { return after.speed[axis] - before.speed[axis]; };
    const float kick = std::sqrt(change(0) * change(0) + change(1) * change(1) + change(2) * change(2));
    if (left < (v + kick) * std::max(0.0F, middle_)) return around;
    return std::max(around, left * ((2 * w - v - kick) / w));
}

/// A body goes its present way, which kicks have turned `elapsed` s after the start of the epoch before.
template <class Real>
void Vicinity<Real>::take_kicked(Index body, float elapsed) {
    Track before = tracks_[body];
    before.room -= speed_of(before) * elapsed;
    take_track(body, before.room, 0);
    Track& after = tracks_[body];
    if (after.room < 0 || state_.bodies.kind[body] == Kind::fixed) return;
    after.room += room_after_kick(before, after) - before.room;
}

/// Takes the track and the room of a body that is to have a new cover. The room is negative if it is too fast for one.
template <class Real>
void Vicinity<Real>::take_room(Index body, float now) {
    const Motion<Real>& m = state_.bodies.motion[body];
    const Kind kind = state_.bodies.kind[body];
    if (kind == Kind::fixed) {
        take_track(body, 0, now);
        return;
    }
    const bool is_bound = is_led(kind);
    const double speed = length(velocity_of(m) - frame_ * exact_relative(m.t));
    const double needed =
        is_bound ? resting_way(m, acceleration_of(state_, body), kind) : speed * length_ * (1 + 2 * slack) + sag_;
    // Some more than the body needs if nothing strikes it.
    constexpr double spare = 1.05;
    const double around = std::clamp(spare * speed * (horizon_ - lead_), typical_room_, most_rooms * typical_room_);
    const double ahead = speed * static_cast<double>(std::max(0.0F, middle_ - now));
    const double room = around + (!is_bound && around >= ahead ? ahead : 0);
    take_track(body, static_cast<float>(room), now);
    if (needed > room || tracks_[body].room < 0) {
        tracks_[body] = {.start = ticks_.of(m.x), .reach = -std::numeric_limits<float>::infinity(), .room = -1};
    } else if (is_bound) {
        tracks_[body].room -= static_cast<float>(needed);
    }
}

template <class Real>
Ball Vicinity<Real>::unusual_cover_at(Index body, float now) const {
    const Track& track = tracks_[body];
    if (std::isinf(track.reach)) {
        const double radius = static_cast<double>(state_.bodies.motion[body].radius) + reach_margin_;
        return ticks_.ball(state_.bodies.motion[body].x, {}, track.room < 0 ? radius : radius + fall_);
    }
    if (state_.bodies.kind[body] != Kind::free) return {track.start, std::abs(track.reach)};
    // Around the place where it will be in the middle of a cover's time, if the room does for the way there.
    const float speed = speed_of(track);
    const float ahead = std::max(0.0F, middle_ - now);
    const float middle = track.room - speed * now >= 2 * speed * ahead ? now + ahead : now;
    const auto moved = [&](std::size_t axis) {
        const float ticks = track.speed[axis] * middle * ticks_per_metre_[axis];
        return track.start[axis] + static_cast<Tick>(static_cast<std::int32_t>(ticks));
    };
    return {{moved(0), moved(1), moved(2)}, std::abs(track.reach) + (track.room - speed * middle) + tick_loss_};
}

// ---------------------------------------------------------------------------------------------------------------------
// The calendar
// ---------------------------------------------------------------------------------------------------------------------

/// The first window, from `earliest` on, that has not ended at a time (s since the epoch's start).
template <class Real>
std::uint32_t Vicinity<Real>::window_of(double time, std::uint32_t earliest) const {
    const double window = time / length_ - slack;
    if (window >= windows_) return windows_;
    return std::max(earliest, static_cast<std::uint32_t>(std::max(window, 0.0)));
}

/// Plans when a body leaves its cover, and when it comes to a wall.
template <class Real>
void Vicinity<Real>::plan_alone(std::size_t part, Index body, std::uint32_t earliest) {
    plan_exit(part, body, earliest);
    plan_wall(part, body, earliest);
}

/// Plans which other bodies a body may meet after `from`.
template <class Real>
void Vicinity<Real>::plan_meetings(std::size_t part, Index body, float from, std::uint32_t earliest) {
    for_each_meeting(body, tracks_[body], from, epoch_end(),
                     [&](Index other, float time) { plan_pair(part, body, other, time, earliest); });
}

template <class Real>
void Vicinity<Real>::plan_pair(std::size_t part, Index a, Index b, float time, std::uint32_t earliest) {
    // Whoever is too fast for a track looks for others itself, in each window.
    if (tracks_[b].room < 0 && tracks_[a].room >= 0) return;
    if (are_told(a, b)) return;
    const std::uint32_t window = window_of(static_cast<double>(time), earliest);
    if (window < windows_) calendar_.add_pair(part, window, a, b);
}

template <class Real>
void Vicinity<Real>::plan_exit(std::size_t part, Index body, std::uint32_t earliest) {
    if (state_.bodies.kind[body] == Kind::fixed || earliest >= windows_) return;
    const auto room = static_cast<double>(tracks_[body].room);
    const auto speed = static_cast<double>(speed_of(tracks_[body]));
    if (room < 0) {
        calendar_.add_exit(part, earliest, body);
    } else if (speed * windows_ * length_ * (1 + slack) > room) {
        const std::uint32_t window = window_of(room / speed, earliest);
        if (window < windows_) calendar_.add_exit(part, window, body);
    }
}

template <class Real>
void Vicinity<Real>::plan_wall(std::size_t part, Index body, std::uint32_t earliest) {
    if (state_.bounds.is_empty() || is_prescribed(state_.bodies.kind[body]) || earliest >= windows_) return;
    // Contacts tell of walls that rest.
    if (is_told(body) && !state_.bounds.any_driven()) return;
    if (rests(state_.bodies.kind[body])) {
        calendar_.add_wall(part, earliest, body);
        return;
    }
    const Motion<Real>& m = state_.bodies.motion[body];
    const double end = epoch_ + windows_ * length_ * (1 + slack);
    double reach = reach_of(m, state_.laws.gravity, end) + wall_margin(m) + state_.bodies.top_growth * end;
    if (state_.bounds.any_driven()) reach += state_.bounds.farthest_way(end);
    if (!state_.bounds.may_touch(m.x, reach, state_.resolution)) return;
    const std::uint32_t window = window_of(exact_relative(m.t) + first_wall_contact(m), earliest);
    if (window < windows_) calendar_.add_wall(part, window, body);
}

/// m that rounded positions may bring a body nearer to a wall, and more: what touches may come to rest.
template <class Real>
double Vicinity<Real>::wall_margin(const Motion<Real>& m) const {
    return 2.0 * Calendar::most_windows * state_.resolution.metres + 1e-9 * static_cast<double>(m.radius);
}

/// s from a free body's own time, before which it does not meet any wall.
template <class Real>
double Vicinity<Real>::first_wall_contact(const Motion<Real>& m) const {
    const Vec3 v = velocity_of(m);
    const Vec3& g = state_.laws.gravity;
    const auto radius = static_cast<double>(m.radius);
    const double margin = wall_margin(m);
    double first = infinite;
    for (const Bounds::Wall& wall : state_.bounds.walls()) {
        const double gap = state_.bounds.gap(wall, m.x, {}, radius, m.t, state_.resolution) - margin;
        const bool is_flat = state_.bounds.shape() == Bounds::Shape::flat;
        // A wall's vibration comes and goes: at most as if it always came.
        const double own = is_flat ? std::max(0.0, dot(v, wall.normal)) : length(v);
        const double speed = own + state_.bodies.top_growth + (wall.is_driven ? Bounds::top_speed(wall) : 0);
        const double pull = is_flat ? std::max(0.0, dot(g, wall.normal)) : length(g);
        first = std::min(first, time_to_cover(gap, speed, pull));
    }
    if (const Obstacles* obstacles = state_.bounds.obstacles()) {
        const double until = epoch_ + windows_ * length_ * (1 + slack);
        const double reach = reach_of(m, g, until) + state_.bodies.top_growth * until + margin;
        const double gap = obstacles->distance(m.x, reach) - (radius + margin);
        first = std::min(first, time_to_cover(gap, length(v) + state_.bodies.top_growth, length(g)));
    }
    return first;
}

template class Vicinity<float>;
template class Vicinity<double>;

} // namespace carom::core
