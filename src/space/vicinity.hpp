/// \file
/// Who may meet whom in a window, from what lasts for many.
#pragma once

#include "space/calendar.hpp"
#include "space/neighbours.hpp"
#include "space/state.hpp"
#include "space/ticks.hpp"
#include "space/track.hpp"
#include "space/window.hpp"

namespace carom::core {

/// A path: how a body moves until something strikes it.
template <class Real>
struct Flown {
    Motion<Real> motion{};
    Vec3 acceleration{}; ///< m/s^2
    Kind kind = Kind::free;
};

template <class Real>
Flown<Real> flown(const State<Real>& state, Index i) {
    return {state.bodies.motion[i], acceleration_of(state, i), state.bodies.kind[i]};
}

/// A body that ends a window on a new path, and what is left of its room (m).
struct TurnedBody {
    Index body = no_index;
    float room = 0;
    Track track{}; ///< if it is free
};

/// Lists of neighbours, tracks, and a calendar of when bodies may meet. All hold for an *epoch* of several windows, so
/// that a body which meets nobody in a window costs nothing there.
///
/// A body's cover is a ball with *room* for its centre to move in any direction, impacts or not. A body that
/// uses its room up gets a new one; a body that is too fast for a ball has balls along its path, anew in each window.
/// Covers lie in the falling frame of tracks. Times that are float are s since the epoch's start.
template <class Real>
class Vicinity {
public:
    using Pair = Calendar::Pair;

    explicit Vicinity(State<Real>& state) : state_(state) {}

    void use(Executor& executor) { executor_ = &executor; }

    /// Cells to sort anything into; forget() is due then.
    [[nodiscard]] Cells& lend_cells() { return neighbours_.lend_cells(); }
    /// Bodies were added, removed, moved, or changed places in memory.
    void forget() { lists_valid_ = epoch_valid_ = false; }
    /// A body's velocity or hold was changed from outside, between two steps.
    void disturb(Index body) {
        if (epoch_valid_) disturbed_.push_back(body);
    }
    /// A piece begins. Of the piled bodies that are *told* of, as long as nothing has struck them, or they are not
    /// faster than `told_speed` (m/s), only the suspects may meet each other, a static body, or a wall.
    void begin_piece(double told_speed, bool has_pile) {
        told_speed_ = told_speed;
        has_pile_ = has_pile;
        clear_for_reuse(suspects_);
        clear_for_reuse(wall_suspects_);
    }
    void suspect(Index a, Index b) { suspects_.emplace_back(a, b); }
    void suspect_at_wall(Index body) { wall_suspects_.push_back(body); }
    /// A step ended after `reached` s.
    void end_step(double reached);
    /// The next window makes everything anew: bodies may change places in memory at no cost.
    [[nodiscard]] bool is_about_to_build() const { return !lists_valid_ || (!kicked_ && window_ + 1 >= windows_); }

    /// Start of a window. Drag and attractors change all velocities between steps: `kicked`.
    void prepare(const Census& census, const Window& window, bool kicked);
    /// Pairs that may meet in the window, some perhaps twice.
    [[nodiscard]] const std::vector<Pair>& candidates() const { return candidates_; }
    /// One of the candidates does not meet in this window.
    void defer(std::size_t part, const Pair& pair) {
        // Whoever has no room looks for others itself, in each window.
        if (window_ + 1 >= windows_ || tracks_[pair.first].room < 0 || tracks_[pair.second].room < 0) return;
        calendar_.add_pair(part, window_ + 1, pair.first, pair.second);
    }
    /// Bodies that may touch a wall in the window unless something strikes them.
    [[nodiscard]] const std::vector<Index>& near_walls() const { return near_walls_; }

    /// The track of a body as it began the window.
    [[nodiscard]] const Track& track(Index body) const { return tracks_[body]; }
    /// The track of a path until the window's end.
    [[nodiscard]] Track track_in_window(const Flown<Real>& path) const;
    /// Whether two tracks may meet between `now` (s since the start of the step), in this window, and its end.
    [[nodiscard]] bool may_meet(const Track& a, const Track& b, double now) const {
        return first_meeting(a, b, relative(now), window_end_, scale_) != never;
    }
    /// Calls f(other) for the neighbours of a body, once or more often, that its track may meet between `now` (s since
    /// the start of the step), in this window, and its end.
    template <class F>
    void for_each_met(Index body, const Track& track, double now, F&& f) const {
        for_each_meeting(body, track, relative(now), window_end_, [&f](Index other, float) { f(other); });
    }
    /// Calls f(other) for every neighbour of a body, once or more often.
    template <class F>
    void for_each(Index body, F&& f) const {
        neighbours_.for_each(body, f);
    }
    /// Asks for the memory that looking for a body's neighbours will need: three stages, some time apart.
    void prefetch_body(Index body) const {
        prefetch(&tracks_[body]);
        neighbours_.prefetch_body(body);
    }
    void prefetch_list(Index body) const { neighbours_.prefetch_list(body); }
    void prefetch_tracks(Index body) const {
        for (const Index other : neighbours_.list_of(body)) prefetch(&tracks_[other]);
    }

    /// m, what is left of a body's room when it ends the window on a new path; negative if it leaves its cover.
    [[nodiscard]] float room_left(Index body, const Flown<Real>& path) const;
    /// Calls f(other) for every body whose cover a path meets from its start to the window's end, once or more often.
    template <class F>
    void for_each_along(const Flown<Real>& path, F&& f) const {
        for_each_piece(path, [&](const Ball& ball) { neighbours_.for_each_meeting(ball, f); });
    }
    /// Covers a body on one more path, until the window's end.
    void cover_along(Index body, const Flown<Real>& path);

    /// End of a window.
    void settle(std::span<const TurnedBody* const> turned);

private:
    /// s since the epoch's start, of a time since the step's start.
    [[nodiscard]] double exact_relative(double time) const { return time - epoch_; }
    [[nodiscard]] float relative(double time) const { return static_cast<float>(exact_relative(time)); }
    [[nodiscard]] float epoch_end() const { return static_cast<float>((windows_ + slack) * length_); }

    [[nodiscard]] bool continues_epoch(const Window& window) const;
    void start_epoch(const Census& census, const Window& window);
    void set_epoch(const Window& window, std::uint32_t windows);
    [[nodiscard]] std::uint32_t windows_worthwhile(const Census& census, double way) const;
    [[nodiscard]] double spare_windows() const;
    [[nodiscard]] double lead_share() const;
    [[nodiscard]] bool carry_on(const Window& window, std::uint32_t windows);
    void build(const Census& census, double way);
    void plan_pairs();
    void collect_due();
    void renew_disturbed();
    void renew_exits();
    /// Whether the suspects are all that a body may meet of its pile.
    struct Telling {
        bool unless_struck = false; ///< it still goes as the contacts have it go
        bool if_slow = false;       ///< it is too slow to strike another slow one
    };
    [[nodiscard]] Telling telling_of(Index body) const;
    [[nodiscard]] bool is_told(Index body) const;
    [[nodiscard]] bool are_told(Index a, Index b) const;
    void charge_led();
    void charge_piled();
    void charge(Index body);
    [[nodiscard]] double resting_way(const Motion<Real>& motion, const Vec3& acceleration, Kind kind) const;

    [[nodiscard]] bool suits_tracks(double speed, double reach) const;
    [[nodiscard]] Track track_of(const Motion<Real>& motion, Kind kind, double room) const;
    void take_track(Index body, float room, float now);
    void put_track(Index body, const Track& track, float room, float now);
    [[nodiscard]] float room_at(Index body, float now) const {
        return tracks_[body].room - speed_of(tracks_[body]) * now;
    }
    /// m that a body may go in any direction from where its track is at `now`, and stays in its cover.
    [[nodiscard]] float room_around(const Track& track, float now) const {
        return track.room - speed_of(track) * (now + 2 * std::max(0.0F, middle_ - now));
    }
    [[nodiscard]] float room_after_kick(const Track& before, const Track& after) const;
    void take_kicked(Index body, float elapsed);
    [[nodiscard]] Vec3 place_on_path(const Flown<Real>& path, double time) const;
    [[nodiscard]] Vec3 place_on_track(const Motion<Real>& motion, double time) const;
    void take_room(Index body, float now);
    /// The cover for the room that a body has just taken at `now`.
    [[nodiscard]] Ball cover_at(Index body, float now) const {
        const Track& track = tracks_[body];
        const bool is_around_start = now == 0 && middle_ <= 0 && track.reach > 0;
        return is_around_start ? Ball{track.start, track.reach + track.room} : unusual_cover_at(body, now);
    }
    [[nodiscard]] Ball unusual_cover_at(Index body, float now) const;

    void plan_alone(std::size_t part, Index body, std::uint32_t earliest);
    void plan_meetings(std::size_t part, Index body, float from, std::uint32_t earliest);
    void plan_pair(std::size_t part, Index a, Index b, float time, std::uint32_t earliest);
    void plan_exit(std::size_t part, Index body, std::uint32_t earliest);
    void plan_wall(std::size_t part, Index body, std::uint32_t earliest);
    [[nodiscard]] double wall_margin(const Motion<Real>& m) const;
    [[nodiscard]] double first_wall_contact(const Motion<Real>& m) const;
    [[nodiscard]] std::uint32_t window_of(double time, std::uint32_t earliest) const;

    /// Calls f(other, time) for the neighbours that a track of a body may meet between `from` and `to`.
    template <class F>
    void for_each_meeting(Index body, const Track& track, float from, float to, F&& f) const;
    template <class F>
    void for_each_piece(const Flown<Real>& path, F&& f) const;

    /// Of a window: more than the roundings of single precision put a time wrong.
    static constexpr double slack = 1e-3;

    State<Real>& state_;
    Executor* executor_ = nullptr;
    TrackSearch track_search_ = nullptr; ///< of this window

    // What lasts until the lists are built anew.
    bool lists_valid_ = false;
    Ticks ticks_;
    TrackScale scale_{};
    Neighbours neighbours_;
    double typical_room_ = 0;                ///< m
    double typical_size_ = 0;                ///< m, of a cover
    double reach_margin_ = 0;                ///< m, added to radii: more than all roundings of tracks
    double longest_reach_ = 0;               ///< m, of tracks
    double horizon_ = 0;                     ///< s that covers are meant to do for
    double lead_ = 0;                        ///< s from when covers are made to when their bodies are in the middle
    std::array<float, 3> ticks_per_metre_{}; ///< along each axis: division is too dear for each cover
    float tick_loss_ = 0;                    ///< m, more than what ticks make of a place
    double crowding_ = 0;                    ///< 1/m^3, pairs of neighbours per body and cube of a cover's size
    double turning_ = 0.1;            ///< part of the bodies that end a window on a new path, of late; first a guess
    std::uint32_t windows_ahead_ = 0; ///< that the lists were built for

    // The epoch.
    bool epoch_valid_ = false;
    bool kicked_ = false;       ///< velocities change in every step, and so do tracks
    double epoch_ = 0;          ///< s since the start of the step, when the epoch began
    double length_ = 0;         ///< s, of a window
    double piece_end_ = 0;      ///< s since the start of the step
    double step_end_ = 0;       ///< s since the start of the step
    std::uint32_t windows_ = 0; ///< in the epoch
    std::uint32_t window_ = 0;  ///< the present one
    Vec3 frame_{};              ///< m/s^2, the acceleration of the frame: gravity, or none where bodies are kicked
    double fall_ = 0;           ///< m that the frame falls during the epoch
    double sag_ = 0;            ///< m that a free body falls in the frame
    float middle_ = 0;          ///< s since the epoch's start, when bodies without impacts are in the middle of covers
    LineVector<Track> tracks_;
    Calendar calendar_;

    // The window.
    float window_start_ = 0;
    float window_end_ = 0;
    std::vector<Pair> due_;
    std::vector<Pair> candidates_;
    std::vector<Index> near_walls_;
    std::vector<Index> exits_;
    std::vector<Index> renewed_; ///< bodies with new covers
    std::vector<Index> fast_;    ///< bodies with balls along their paths
    std::vector<Index> disturbed_;
    std::vector<Pair> suspects_;
    std::vector<Index> wall_suspects_;
    double told_speed_ = 0; ///< m/s
    bool has_pile_ = false;
    std::array<std::vector<Pair>, most_parts> kept_;
};

template <class Real>
template <class F>
void Vicinity<Real>::for_each_meeting(Index body, const Track& track, float from, float to, F&& f) const {
    constexpr std::size_t batch = 192;
    std::array<Index, batch + simd_padding> bodies; // NOLINT(cppcoreguidelines-pro-type-member-init): written first
    std::array<float, batch + simd_padding> times;  // NOLINT(cppcoreguidelines-pro-type-member-init)
    const std::span<const Index> list = neighbours_.list_of(body);
    for (std::size_t begin = 0; begin < list.size(); begin += batch) {
        const std::size_t count = std::min(batch, list.size() - begin);
        const std::size_t found = track_search_(tracks_.data(), scale_, track, list.data() + begin, count, from, to,
                                                {bodies.data(), times.data()});
        for (std::size_t k = 0; k < found; ++k) f(bodies[k], times[k]);
    }
    neighbours_.for_each_link(body, [&](Index other) {
        const float time = first_meeting(track, tracks_[other], from, to, scale_);
        if (time != never) f(other, time);
    });
}

/// Cuts a path into pieces that are not much longer than covers are wide: a ball around a long path would hold far too
/// much.
template <class Real>
template <class F>
void Vicinity<Real>::for_each_piece(const Flown<Real>& path, F&& f) const {
    constexpr double most_pieces = 64;
    const Vec3& g = frame_;
    const double own = exact_relative(path.motion.t);
    const double begin = std::max(own, static_cast<double>(window_start_)) - own;
    const double end = static_cast<double>(window_end_) - own;
    const Vec3 v = velocity_of(path.motion) - g * own;
    const Vec3 fallen = g * (-0.5 * own * own);
    const double bend = 0.5 * length(path.acceleration - g) * end * end;
    const double reach = static_cast<double>(path.motion.radius) + 2 * reach_margin_ + bend;
    const double wanted = std::clamp(std::ceil(length(v) * (end - begin) / (2 * typical_size_)), 1.0, most_pieces);
    const auto pieces = static_cast<int>(wanted);
    for (int k = 0; k < pieces; ++k) {
        const Vec3 middle = v * (begin + (end - begin) * ((k + 0.5) / wanted));
        f(ticks_.ball(path.motion.x, fallen + middle, reach + 0.5 * length(v) * (end - begin) / wanted));
    }
}

} // namespace carom::core
