/// \file
/// Cells: swept boxes of bodies, sorted so that neighbours in space are neighbours in memory.
///
/// Lengths here are *ticks*: every axis is cut into 2^32 of them and taken modulo 2^32, as a torus. A position is a
/// 32-bit number whose differences wrap correctly; what aliases is told apart by the exact tests that follow. Along
/// a periodic axis the period is the torus, so that images need no care. Memory goes by bodies, never by volume: a
/// level's grid of cells covers the torus as often as needed to keep within a few cells per body.
///
/// A level has cells of one edge and holds the bodies whose boxes are no longer than that; the next level's edge is
/// twice as long. Two bodies of one level can then only meet if their cells are neighbours. The last level is one
/// cell for everything that is too long for the others.
#pragma once

#include "space/bodies.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace carom::core {

using Tick = std::uint32_t;

/// Where a body may be during a window: lo + [0, length] on each of the three axes, in ticks. The fourth element of
/// each, which fills the line, is no part of the box: it says whose box this is and where it is registered.
struct alignas(32) SweptBox {
    std::array<Tick, 4> lo{};
    std::array<Tick, 4> length{};

    static constexpr std::size_t tag = 3;
    static constexpr Index outdated_bit = 0x80000000U;

    [[nodiscard]] Index body() const { return lo[tag] & ~outdated_bit; }
    /// The body is registered with another box by now.
    [[nodiscard]] bool outdated() const { return (lo[tag] & outdated_bit) != 0; }
    /// Number of the cell among all cells of all levels.
    [[nodiscard]] std::uint32_t cell() const { return length[tag]; }

    /// Whether all of `inner` lies in this box.
    [[nodiscard]] bool holds(const SweptBox& inner) const;

    void set_body(Index body) { lo[tag] = body; }
    void set_outdated() { lo[tag] |= outdated_bit; }
    void set_cell(std::uint32_t cell) { length[tag] = cell; }
};

/// Tests boxes against one: conservative, boxes that only share a tick meet. All axes at once and without branches, in
/// the vector types that GCC and Clang translate for any machine: which axis parts two boxes is anybody's guess.
class MeetingTest {
public:
    explicit MeetingTest(const SweptBox& box)
        : shifted_lo_(lanes(box.lo) - half_turn), shifted_length_(signed_lanes(lanes(box.length) - half_turn)) {}

    [[nodiscard]] bool operator()(const SweptBox& other) const {
        const Lanes lo = lanes(other.lo);
        // Unsigned comparisons as signed ones, both sides shifted by half a turn.
        const SignedLanes before = signed_lanes(lo - shifted_lo_) > shifted_length_;
        const SignedLanes behind = signed_lanes(shifted_lo_ - lo) > signed_lanes(lanes(other.length) - half_turn);
        const auto apart = std::bit_cast<Halves>(before & behind);
        constexpr std::uint64_t third_lane = 0xffffffffU;
        return (apart[0] | (apart[1] & third_lane)) == 0;
    }

private:
    using Lanes [[gnu::vector_size(16)]] = std::uint32_t;
    using SignedLanes [[gnu::vector_size(16)]] = std::int32_t;
    using Halves [[gnu::vector_size(16)]] = std::uint64_t;
    static constexpr std::uint32_t half_turn = 0x80000000U;

    static Lanes lanes(const std::array<Tick, 4>& values) { return std::bit_cast<Lanes>(values); }
    static SignedLanes signed_lanes(Lanes values) { return std::bit_cast<SignedLanes>(values); }

    Lanes shifted_lo_;
    SignedLanes shifted_length_;
};

/// A list of pairs that keeps its memory and is filled without a branch per element.
class PairList {
public:
    using Pair = std::pair<Index, Index>;

    void clear() { size_ = 0; }
    [[nodiscard]] std::span<const Pair> pairs() const { return {storage_.data(), size_}; }

    /// Room for `most` more pairs, to be written from here on; `take` tells how far it went.
    Pair* room(std::size_t most) {
        if (size_ + most > storage_.size()) storage_.resize(std::max(size_ + most, size_ + size_ / 4));
        return storage_.data() + size_;
    }
    void take(const Pair* end) { size_ = static_cast<std::size_t>(end - storage_.data()); }

    template <class Predicate>
    void keep_if(Predicate&& keep) {
        Pair* out = storage_.data();
        for (std::size_t k = 0; k < size_; ++k) {
            const Pair pair = storage_[k];
            *out = pair;
            out += keep(pair.first, pair.second) ? 1 : 0;
        }
        take(out);
    }

private:
    std::vector<Pair> storage_;
    std::size_t size_ = 0;
};

/// A sorted index of swept boxes that takes changed boxes as it goes.
class Cells {
public:
    using Pair = PairList::Pair;

    /// What the choice of levels needs to know of the axes.
    struct Axes {
        std::array<double, 3> metres_per_tick{};
        /// Size of the world in ticks (2^32 and more: a whole turn): a hint that saves aliasing.
        std::array<double, 3> extent{};
    };

    /// Registers one box per body; `boxes[i]` is that of body i. Uses its tags.
    void build(std::vector<SweptBox>& boxes, const Axes& axes);
    /// Replaces the box of a body; a new body must have the next index.
    void update(Index body, const SweptBox& box);
    /// Registers a body with one more box, until the next build().
    void add(Index body, const SweptBox& box);

    /// Every pair of bodies whose boxes of build() meet, once or more often. To be called before any update().
    void find_pairs(PairList& pairs) const;

    /// Calls f(body) for every registered body whose box meets `box`, once or more often.
    template <class F>
    void for_each_meeting(const SweptBox& box, F&& f) const;

    /// The bodies in the order of their cells.
    void spatial_order(std::vector<Index>& order) const;

    [[nodiscard]] std::size_t size() const { return place_.size(); }
    /// The box that a body is registered with.
    [[nodiscard]] const SweptBox& box_of(Index body) const {
        const std::uint32_t place = place_[body];
        return (place & late_bit) != 0 ? late_[place & ~late_bit].box : sorted_[place];
    }
    void prefetch(Index body) const { __builtin_prefetch(&place_[body]); }
    /// Boxes that were registered beside the sorted ones since build().
    [[nodiscard]] std::size_t late() const { return late_.size(); }

private:
    static constexpr std::uint32_t nothing = 0xffffffffU;
    static constexpr std::uint32_t late_bit = 0x80000000U;
    static constexpr double whole_turn = 4294967296.0;

    struct Level {
        std::array<Tick, 3> edge{};           ///< longest box of this level
        std::array<std::uint32_t, 3> turns{}; ///< how often the grid repeats along the torus
        std::array<std::uint32_t, 3> cells{}; ///< cells along each axis, 1 or at least 3
        std::uint32_t first_cell = 0;
        std::uint32_t population = 0; ///< of build()
        std::uint32_t late = 0;       ///< boxes that came later

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
    };

    struct Cell {
        std::uint32_t start = 0;      ///< of its boxes in sorted_, which end where the next cell's start
        std::uint32_t late = nothing; ///< head of the list of its late boxes
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
        [[nodiscard]] bool contains(std::uint32_t c) const {
            return (c >= first ? c - first : c + cells - first) < count;
        }
    };

    static Span span_of(const Level& level, std::size_t axis, Tick lo, std::uint64_t length);
    /// The cells of `level` in which a body registered by its centre may meet a box.
    static std::array<Span, 3> reach_of(const Level& level, const SweptBox& box);

    void choose_levels(std::vector<SweptBox>& boxes, const Axes& axes);
    [[nodiscard]] double first_edge(std::size_t bodies) const;
    static void lay_out_level(Level& level, const Axes& axes);
    [[nodiscard]] static bool fits(const Level& level, const SweptBox& box);
    [[nodiscard]] std::size_t level_of(const SweptBox& box) const;
    static std::uint32_t home_cell(const Level& level, const SweptBox& box);
    void sort_into_cells(std::vector<SweptBox>& boxes);
    std::uint32_t add_late(Index body, const SweptBox& box);
    [[nodiscard]] static bool stays_findable(const Level& level, std::uint32_t cell, const SweptBox& box);

    /// From one place to before another.
    struct Run {
        std::uint32_t from = 0;
        std::uint32_t to = 0;
    };
    struct Runs {
        std::array<Run, 10> runs{};
        std::size_t count = 0;
        std::uint32_t boxes = 0;

        void add(std::uint32_t from, std::uint32_t to) {
            runs[count] = {from, to};
            count += from < to ? 1 : 0;
            boxes += to - from;
        }
    };

    /// The rows of cells that come after row (y, z) and touch it: half of its neighbours, so that pairs come once.
    static std::size_t rows_after(const Level& level, std::uint32_t y, std::uint32_t z,
                                  std::array<std::uint32_t, 4>& rows);
    /// What the boxes of cell x of a row may meet in the rows after it, and in its own row after the cell.
    [[nodiscard]] Runs runs_after(std::uint32_t row, std::uint32_t x, std::uint32_t nx,
                                  std::span<const std::uint32_t> rows) const;
    void pairs_of_cell(Run cell, const Runs& others, PairList& pairs) const;
    void pairs_inside(const Level& level, PairList& pairs) const;
    void pairs_across(const Level& fine, const Level& coarse, PairList& pairs) const;
    [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> sorted_range(const Level& level) const {
        return {cells_[level.first_cell].start, cells_[level.first_cell + level.cell_count()].start};
    }

    /// Rows of cells that are to be scanned: asking for their memory in turn, all before the first is needed, hides
    /// most of the wait.
    struct Rows {
        static constexpr std::size_t most = 32;
        std::array<Run, most> runs{};
        std::size_t count = 0;

        void add(Run row, const Cell* cells) {
            __builtin_prefetch(cells + row.from);
            runs[count++] = row;
        }
        [[nodiscard]] bool is_full() const { return count + 2 > most; }
    };

    template <class F>
    void for_each_in(const Level& level, const SweptBox& box, F&& f) const;
    template <class F>
    void scan_row(const Run& row, const MeetingTest& meets, F& f) const;
    void prefetch_boxes(const Run& row) const {
        // The row may be empty and at the end.
        const SweptBox* const first = sorted_.data() + cells_[row.from].start;
        __builtin_prefetch(first);
        __builtin_prefetch(first + 2);
    }

    struct Late {
        SweptBox box{};
        std::uint32_t next = nothing;
    };

    std::vector<Level> levels_;
    std::vector<SweptBox> sorted_;
    std::vector<Cell> cells_; ///< and one more, which is the end
    std::vector<Late> late_;
    std::vector<std::uint32_t> place_;     ///< per body: where in sorted_, or late_bit | where in late_
    std::vector<std::uint32_t> histogram_; ///< of the logarithm of box lengths
};

template <class F>
void Cells::for_each_in(const Level& level, const SweptBox& box, F&& f) const {
    const auto [xs, ys, zs] = reach_of(level, box);
    const MeetingTest meets(box);
    Rows rows;
    const auto scan_all = [&] {
        for (std::size_t k = 0; k < rows.count; ++k) prefetch_boxes(rows.runs[k]);
        for (std::size_t k = 0; k < rows.count; ++k) scan_row(rows.runs[k], meets, f);
        rows.count = 0;
    };
    const std::uint32_t end = xs.first + xs.count;
    for (std::uint32_t j = 0; j < zs.count; ++j) {
        for (std::uint32_t i = 0; i < ys.count; ++i) {
            const std::uint32_t row = level.cell_at(0, ys.at(i), zs.at(j));
            rows.add({row + xs.first, row + std::min(end, xs.cells)}, cells_.data());
            if (end > xs.cells) rows.add({row, row + (end - xs.cells)}, cells_.data());
            if (rows.is_full()) scan_all();
        }
    }
    scan_all();
}

template <class F>
void Cells::scan_row(const Run& row, const MeetingTest& meets, F& f) const {
    for (std::uint32_t k = cells_[row.from].start; k < cells_[row.to].start; ++k) {
        if (meets(sorted_[k]) && !sorted_[k].outdated()) f(sorted_[k].body());
    }
    for (std::uint32_t c = row.from; c < row.to; ++c) {
        for (std::uint32_t k = cells_[c].late; k != nothing; k = late_[k].next) {
            if (!late_[k].box.outdated() && meets(late_[k].box)) f(late_[k].box.body());
        }
    }
}

template <class F>
void Cells::for_each_meeting(const SweptBox& box, F&& f) const {
    for (const Level& level : levels_) {
        if (level.population + level.late > 0) for_each_in(level, box, f);
    }
}

} // namespace carom::core
