/// \file
/// Who may meet whom, for several windows.
#pragma once

#include "space/balls.hpp"
#include "space/neighbours.hpp"
#include "space/state.hpp"

namespace carom::core {

/// A body's path as it was.
template <class Real>
struct Flown {
    Motion<Real> motion{};
    Vec3 acceleration{}; ///< m/s^2
};

/// Lists of neighbours that last. A body's cover is a ball's box with *room* for its centre to move in any direction,
/// impacts or not; the lists hold until too many bodies have used their room up. A body that is too fast for a ball
/// has boxes along its path instead, anew for each window.
template <class Real>
class Vicinity {
public:
    explicit Vicinity(State<Real>& state) : state_(state) {}

    /// Bodies were added, removed, or moved other than by a window.
    void forget() { is_valid_ = false; }

    /// Start of a window, [from, to] in s since the start of the step: covers every body's path. What each body can
    /// reach without an impact counts as used up.
    void prepare(const Census& census, double from, double to);

    /// Calls f(a, b) for every pair of neighbours whose first balls meet, once or more often.
    template <class F>
    void for_each_pair(F&& f) const {
        const auto look = [&](Index a, Index b) {
            if (balls_.may_meet(first_balls_[a], first_balls_[b])) f(a, b);
        };
        const std::span<const Neighbours::Pair> pairs = neighbours_.pairs();
        constexpr std::size_t ahead = 24;
        for (std::size_t k = 0; k < pairs.size(); ++k) {
            __builtin_prefetch(&first_balls_[pairs[std::min(k + ahead, pairs.size() - 1)].second]);
            look(pairs[k].first, pairs[k].second);
        }
        for (const Index a : covered_anew_) neighbours_.for_each(a, [&](Index b) { look(a, b); });
    }
    /// Calls f(other) for every neighbour of a body, once or more often.
    template <class F>
    void for_each(Index body, F&& f) const {
        neighbours_.for_each(body, f);
    }
    /// Asks for the memory that for_each() will need.
    void prefetch(Index body) const { neighbours_.prefetch(body); }
    /// Asks for the balls of a body's neighbours.
    void prefetch_balls(Index body) const {
        neighbours_.for_each(body, [this](Index other) { __builtin_prefetch(&first_balls_[other]); });
    }
    /// Bodies that may touch a wall in the window unless something strikes them.
    [[nodiscard]] const std::vector<Index>& near_walls() const { return near_walls_; }

    /// The ball that holds a body's path from its own time to `to`.
    [[nodiscard]] Ball ball_of(Index body, double to) const {
        return balls_.ball(state_.bodies.motion[body].x,
                           path_length(body, state_.bodies.motion[body].t, to) + radius_of(body));
    }
    /// A ball that holds its path from the start of the window on, whatever it meets.
    [[nodiscard]] const Ball& first_ball(Index body) const { return first_balls_[body]; }
    [[nodiscard]] bool may_meet(const Ball& a, const Ball& b) const { return balls_.may_meet(a, b); }

    /// How many pairs of neighbours the balls did not tell apart: what the lists cost beyond that is what they could
    /// save.
    void note_candidates(std::size_t pairs) { candidates_ = pairs; }

    /// A body takes another path than `before`, on which the window began: widens its first ball accordingly. Whether
    /// the body stays in its cover.
    bool follow(Index body, const Flown<Real>& before, double to);
    /// Calls f(other) for every body whose cover a path meets until `to`, once or more often.
    template <class F>
    void for_each_along(const Flown<Real>& path, double to, F&& f) const {
        for_each_piece(path, path.motion.t, to, [&](const SweptBox& box) { neighbours_.for_each_meeting(box, f); });
    }
    /// Covers a body on one more path.
    void cover_along(Index body, const Flown<Real>& path, double from, double to);
    /// End of a window for a body that had impacts.
    void settle(Index body, const Flown<Real>& before, double to);

private:
    [[nodiscard]] double radius_of(Index body) const { return static_cast<double>(state_.bodies.motion[body].radius); }
    [[nodiscard]] double acceleration_size(Index body) const;
    [[nodiscard]] double way(const Motion<Real>& motion, double acceleration, double from, double to) const;
    [[nodiscard]] double path_length(Index body, double from, double to) const;
    [[nodiscard]] double strayed(Index body, const Flown<Real>& before, double to) const;
    void use_room(Index body, double length) {
        constexpr double far = 1e30;
        room_[body] -= static_cast<float>(std::min(length, far));
    }

    template <class F>
    void for_each_piece(const Flown<Real>& path, double from, double to, F&& f) const;

    void build(const Census& census, double from, double to);
    void choose_horizon(const Census& census, double duration);
    bool update(double from, double to);
    void start_bodies(double from, double to);
    bool cover_strays(double from, double to);
    SweptBox make_cover(Index body, double to);
    void cover_anew(Index body, double from, double to);

    State<Real>& state_;
    bool is_valid_ = false;
    Ticks ticks_;
    Balls balls_;
    Neighbours neighbours_;
    std::vector<SweptBox> covers_;
    std::vector<float> room_; ///< m, per body: how far its centre may still move; negative: not at all
    std::vector<Ball> first_balls_;
    std::vector<Index> near_walls_;
    std::vector<Index> strays_;       ///< bodies whose room does not do
    std::vector<Index> covered_anew_; ///< since the lists were built
    std::size_t candidates_ = 0;
    double gravity_ = 0;       ///< m/s^2
    double windows_ahead_ = 4; ///< that the lists are meant to last
    double typical_room_ = 0;  ///< m
    double typical_size_ = 0;  ///< m, of a cover
};

/// Cuts a path into pieces that are not much longer than covers are wide: the box of a long slanted path would hold
/// far too much.
template <class Real>
template <class F>
void Vicinity<Real>::for_each_piece(const Flown<Real>& path, double from, double to, F&& f) const {
    constexpr double most_pieces = 64;
    const double length = way(path.motion, carom::length(path.acceleration), from, to);
    const double wanted = std::clamp(std::ceil(length / (2 * typical_size_)), 1.0, most_pieces);
    const auto pieces = static_cast<int>(wanted);
    for (int k = 0; k < pieces; ++k) {
        const double start = from + (to - from) * (k / wanted);
        const double end = k + 1 == pieces ? to : from + (to - from) * ((k + 1) / wanted);
        f(swept_box(ticks_, path.motion, path.acceleration, start, end, 2 * state_.resolution.metres));
    }
}

} // namespace carom::core
