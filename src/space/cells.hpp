/// \file
/// Cells: balls of bodies, sorted so that neighbours in space are neighbours in memory.
///
/// Memory goes by bodies, never by volume: a level's grid of cells covers the torus of ticks as often as needed to keep
/// within a few cells per body. A level has cells of one edge and holds the balls whose diameters are no longer than
/// that; the next level's edge is four times as long. Two bodies of one level can then only meet if their cells are
/// neighbours. The last level is one cell for everything that is too long for the others.
#pragma once

#include "space/parallel.hpp"
#include "space/reuse.hpp"
#include "space/simd_search.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <span>
#include <vector>

namespace carom::core {

/// Searches among the balls of Cells, on one thread: the functions of the instruction set in use, and buffers.
class BallSearcher {
public:
    BallSearcher() {
        constexpr std::size_t few = 256;
        runs_.reserve(few);
        constexpr std::size_t few_levels = 16;
        other_levels_.reserve(few_levels);
    }

    /// Has room from now on for what lies around most balls.
    void get_ready();
    /// To be called when the balls or the instruction set may have changed.
    void start() {
        packing_ = ball_packing();
        search_ = ball_search();
        cell_ = {};
    }

private:
    friend class Cells;

    /// Balls seen from one place.
    struct View {
        std::array<Tick, 3> origin{};
        std::size_t size = 0; ///< the arrays are longer
        std::vector<float> x;
        std::vector<float> y;
        std::vector<float> z;
        std::vector<float> radius;
        std::vector<Index> body;

        void reserve(std::size_t balls);
        [[nodiscard]] PackedBalls arrays() { return {x.data(), y.data(), z.data(), radius.data(), body.data()}; }
    };

    BallPacking packing_ = nullptr;
    BallSearch search_ = nullptr;
    Run cell_{};                              ///< balls of a cell that have all that they may meet in `around_`,
    std::vector<std::uint32_t> other_levels_; ///< but for those of these levels
    float margin_ = 0;                        ///< m, more than what roundings make of distances there
    View around_;
    View apart_; ///< of one ball
    std::vector<Run> runs_;
};

/// A sorted index of balls that takes changed ones as it goes.
class Cells {
public:
    /// What the choice of levels needs to know of the axes.
    struct Axes {
        std::array<double, 3> metres_per_tick{};
        /// Size of the world in ticks (2^32 and more: a whole turn): a hint that saves aliasing.
        std::array<double, 3> extent{};
    };

    /// Registers one ball per body: `ball_at(i)` is that of body i.
    template <class BallAt>
    void build(Executor& executor, std::size_t bodies, const Axes& axes, BallAt&& ball_at);
    /// Replaces the ball of a body; a new body must have the next index.
    void update(Index body, const Ball& ball);
    /// Registers a body with one more ball, until the next build().
    void add(Index body, const Ball& ball) { add_late(body, ball); }

    /// Takes out the ball of a body, which keeps what add() gave it.
    void remove(Index body);
    /// Forgets the balls that came last, all by add(), down to the first `late` of late().
    void undo(std::size_t late);

    /// Calls f(body) for every registered body one of whose balls meets `ball`, once or more often.
    template <class F>
    void for_each_meeting(const Ball& ball, F&& f) const;

    /// The bodies in the order of their cells.
    [[nodiscard]] std::span<const Index> spatial_order() const { return {body_.data(), body_.size() - simd_padding}; }
    /// The same bodies, but tile by tile of some cells along each axis: all neighbours but those of a tile's faces are
    /// near in memory. The order takes the place of what finds balls, which build() has to make anew.
    [[nodiscard]] std::span<Index> take_tiled_order();
    /// The bodies whose balls of build() meet that of the k-th body in spatial order; to be called before any update().
    /// Writes to `found`, from `used` on, and moves `used` on. Cheap if k rises by one from call to call.
    void find_neighbours(std::uint32_t k, BallSearcher& searcher, std::vector<Index>& found, std::size_t& used) const;
    /// The bodies other than `self` one of whose balls meets `ball`, once or more often, into `found`.
    void find_meeting(const Ball& ball, Index self, BallSearcher& searcher, std::vector<Index>& found) const;

    [[nodiscard]] std::size_t size() const { return place_.size(); }
    /// The ball that a body is registered with.
    [[nodiscard]] Ball ball_of(Index body) const {
        const std::uint32_t place = place_[body];
        return (place & late_bit) != 0 ? late_[place & ~late_bit].ball : sorted_ball(place);
    }
    [[nodiscard]] const TickScale& scale() const { return scale_; }
    /// Balls that were registered beside the sorted ones since build().
    [[nodiscard]] std::size_t late() const { return late_.size(); }

private:
    static constexpr std::uint32_t nothing = 0xffffffffU;
    static constexpr std::uint32_t late_bit = 0x80000000U;
    static constexpr double whole_turn = 4294967296.0;

    struct Level {
        std::array<Tick, 3> edge{};           ///< longest diameter of this level
        float largest_radius = 0;             ///< m, that such a diameter allows for
        std::array<std::uint32_t, 3> turns{}; ///< how often the grid repeats along the torus
        std::array<std::uint32_t, 3> cells{}; ///< cells along each axis, 1 or at least 3
        std::uint32_t first_cell = 0;
        std::uint32_t population = 0; ///< of build(); first a guess
        std::uint32_t late = 0;       ///< balls that came later

        /// Cell coordinate of a tick: rises along each turn of the grid.
        [[nodiscard]] std::uint32_t coordinate(std::size_t axis, Tick tick) const {
            const Tick turned = tick * turns[axis];
            return static_cast<std::uint32_t>((std::uint64_t{turned} * cells[axis]) >> 32U);
        }
        [[nodiscard]] std::uint32_t cell_at(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
            return first_cell + (z * cells[1] + y) * cells[0] + x;
        }
        [[nodiscard]] std::uint32_t cell_count() const { return cells[0] * cells[1] * cells[2]; }
        /// Everything fits into the last level.
        [[nodiscard]] bool is_last() const { return edge[0] == 0xffffffffU; }
        [[nodiscard]] bool fits(const Ball& ball) const { return is_last() || ball.radius <= largest_radius; }
    };

    /// `count` cells from `first` on, modulo `cells`.
    struct Span {
        std::uint32_t first = 0;
        std::uint32_t count = 0;
        std::uint32_t cells = 0;
        [[nodiscard]] std::uint32_t at(std::uint32_t k) const {
            const std::uint32_t c = first + k;
            return c < cells ? c : c - cells;
        }
    };

    /// A ball's half size along each axis, more than all roundings.
    using Reach = std::array<std::uint64_t, 3>;
    struct Region {
        std::array<Tick, 3> centre{};
        Reach reach{};
    };

    struct Late {
        Ball ball{};
        Index body = no_index;
        std::uint32_t next = nothing;
    };

    /// Cells share lists of late balls, of which there are few, with the next ones along x: lists take little memory.
    static std::uint32_t late_group(std::uint32_t cell) { return cell / 4; }
    [[nodiscard]] Ball sorted_ball(std::uint32_t place) const {
        return {{x_[place], y_[place], z_[place]}, radius_[place]};
    }

    void start_levels(const Axes& axes);
    void count_diameter(const Ball& ball);
    void choose_levels(std::size_t sampled);
    [[nodiscard]] double first_edge(std::size_t bodies) const;
    void lay_out_levels(const Axes& axes, std::size_t bodies);
    static void lay_out_level(Level& level, const Axes& axes, double most_cells);
    [[nodiscard]] float largest_radius(const Level& level) const;
    [[nodiscard]] std::size_t level_of(const Ball& ball) const {
        std::size_t level = 0;
        while (!levels_[level].fits(ball)) ++level;
        return level;
    }
    static std::uint32_t home_cell(const Level& level, const Ball& ball);
    void start_sorting(std::size_t bodies);
    void sort_places(std::size_t bodies);
    void replace(std::uint32_t place, const Ball& ball);
    std::uint32_t add_late(Index body, const Ball& ball);

    /// Calls f(run of cells) for the cells of `level` in which a registered ball may meet one at `centre`.
    template <class F>
    static void for_each_row(const Level& level, const std::array<Tick, 3>& centre, const Reach& reach, F&& f);
    [[nodiscard]] Reach reach_of(const Ball& ball) const;
    [[nodiscard]] static Span span_of(const Level& level, std::size_t axis, Tick centre, std::uint64_t reach);
    void look_around(std::uint32_t k, BallSearcher& searcher) const;
    void view(BallSearcher& searcher, BallSearcher::View& view, const std::array<Tick, 3>& origin) const;
    void take_rows(const Level& level, const Region& region, std::vector<Run>& runs) const;
    [[nodiscard]] Region region_of(const Run& balls, const std::array<Tick, 3>& centre) const;
    template <class F>
    void scan_row(const Run& row, const Ball& ball, F& f) const;
    template <class F>
    void scan_late(const Run& row, const Ball& ball, F& f) const;
    [[nodiscard]] BallArrays sorted_balls() const {
        return {x_.data(), y_.data(), z_.data(), radius_.data(), body_.data(), scale_};
    }
    void prefetch_sorted(std::uint32_t place) const {
        prefetch(x_.data() + place);
        prefetch(y_.data() + place);
        prefetch(z_.data() + place);
        prefetch(radius_.data() + place);
        prefetch(body_.data() + place);
    }

    TickScale scale_{};
    std::array<double, 3> ticks_per_metre_{};
    std::vector<Level> levels_;
    std::vector<std::uint32_t> starts_;     ///< per cell, where its balls begin in the sorted arrays; and their end
    std::vector<std::uint32_t> late_heads_; ///< per group of cells, of the list of its late balls
    // Sorted, and padding.
    std::vector<Tick> x_;
    std::vector<Tick> y_;
    std::vector<Tick> z_;
    std::vector<float> radius_;
    std::vector<Index> body_ = std::vector<Index>(simd_padding);
    std::vector<Late> late_;
    std::vector<std::uint32_t> place_;     ///< per body: where in the sorted arrays, or late_bit | where in late_
    std::vector<std::uint32_t> histogram_; ///< of the logarithms of diameters
};

template <class BallAt>
void Cells::build(Executor& executor, std::size_t bodies, const Axes& axes, BallAt&& ball_at) {
    // A sample is enough: levels and their cells decide about speed only.
    constexpr std::size_t sample = 7;
    const auto ball_of = [&](std::size_t i) { return ball_at(static_cast<Index>(i)); };
    start_levels(axes);
    for (std::size_t i = 0; i < bodies; i += sample) count_diameter(ball_of(i));
    choose_levels(bodies);
    for (std::size_t i = 0; i < bodies; i += sample) levels_[level_of(ball_of(i))].population += sample;
    lay_out_levels(axes, bodies);
    start_sorting(bodies);
    constexpr std::size_t grain = 4096;
    for_each_in_parts(executor, bodies, grain, [&](std::size_t, std::size_t i) {
        const Ball ball = ball_of(i);
        place_[i] = home_cell(levels_[level_of(ball)], ball);
    });
    sort_places(bodies);
    for_each_in_parts(executor, bodies, grain, [&](std::size_t, std::size_t i) {
        replace(place_[i], ball_of(i));
        body_[place_[i]] = static_cast<Index>(i);
    });
}

template <class F>
void Cells::for_each_row(const Level& level, const std::array<Tick, 3>& centre, const Reach& reach, F&& f) {
    const Span xs = span_of(level, 0, centre[0], reach[0]);
    const Span ys = span_of(level, 1, centre[1], reach[1]);
    const Span zs = span_of(level, 2, centre[2], reach[2]);
    const std::uint32_t end = xs.first + xs.count;
    for (std::uint32_t j = 0; j < zs.count; ++j) {
        for (std::uint32_t i = 0; i < ys.count; ++i) {
            const std::uint32_t row = level.cell_at(0, ys.at(i), zs.at(j));
            f(Run{row + xs.first, row + std::min(end, xs.cells)});
            if (end > xs.cells) f(Run{row, row + (end - xs.cells)});
        }
    }
}

template <class F>
void Cells::scan_row(const Run& row, const Ball& ball, F& f) const {
    for (std::uint32_t k = starts_[row.from]; k < starts_[row.to]; ++k) {
        if (balls_meet(ball, sorted_ball(k), scale_)) f(body_[k]);
    }
    if (!late_.empty()) scan_late(row, ball, f);
}

template <class F>
void Cells::scan_late(const Run& row, const Ball& ball, F& f) const {
    for (std::uint32_t group = late_group(row.from); group <= late_group(row.to - 1); ++group) {
        for (std::uint32_t k = late_heads_[group]; k != nothing; k = late_[k].next) {
            if (balls_meet(ball, late_[k].ball, scale_)) f(late_[k].body);
        }
    }
}

template <class F>
void Cells::for_each_meeting(const Ball& ball, F&& f) const {
    // Asking for the memory of several rows, all before the first is needed, hides most of the wait.
    constexpr std::size_t most = 32;
    std::array<Run, most> rows{};
    std::size_t count = 0;
    const auto scan_all = [&] {
        for (std::size_t k = 0; k < count; ++k) prefetch_sorted(starts_[rows[k].from]);
        for (std::size_t k = 0; k < count; ++k) scan_row(rows[k], ball, f);
        count = 0;
    };
    const Reach reach = reach_of(ball);
    for (const Level& level : levels_) {
        if (level.population + level.late == 0) continue;
        for_each_row(level, ball.centre, reach, [&](const Run& row) {
            prefetch(starts_.data() + row.from);
            rows[count++] = row;
            if (count == most) scan_all();
        });
    }
    scan_all();
}

} // namespace carom::core
