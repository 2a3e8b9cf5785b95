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

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace carom::core {

using Tick = std::uint32_t;

/// Where a body may be during a window: lo + [0, length] on each axis, in ticks.
struct SweptBox {
    std::array<Tick, 3> lo{};
    std::array<Tick, 3> length{};
};

/// Conservative: boxes that only share a tick meet.
inline bool meet(const SweptBox& a, const SweptBox& b) {
    const auto meet_on = [&a, &b](std::size_t k) {
        return (b.lo[k] - a.lo[k] <= a.length[k]) || (a.lo[k] - b.lo[k] <= b.length[k]);
    };
    return meet_on(0) && meet_on(1) && meet_on(2);
}

/// A body's box and where it is registered.
struct Proxy {
    SweptBox box{};
    Index body = no_index;    ///< with outdated_bit: the body is registered elsewhere by now
    std::uint32_t cell = 0;   ///< number among all cells of all levels

    static constexpr Index outdated_bit = 0x80000000U;
    [[nodiscard]] bool outdated() const { return (body & outdated_bit) != 0; }
};

/// A sorted index of swept boxes that takes changed boxes as it goes.
class Cells {
public:
    using Pair = std::pair<Index, Index>;

    /// What the choice of levels needs to know of the axes.
    struct Axes {
        std::array<double, 3> ticks_per_metre{};
        /// Size of the world in ticks (2^32 and more: a whole turn): a hint that saves aliasing.
        std::array<double, 3> extent{};
    };

    /// Registers one box per body; `boxes[i]` is that of body i.
    void build(const std::vector<SweptBox>& boxes, const Axes& axes);
    /// Replaces the box of a body; a new body must have the next index.
    void update(Index body, const SweptBox& box);

    /// Every pair of bodies whose boxes of build() meet, once or more often. To be called before any update().
    void find_pairs(std::vector<Pair>& pairs) const;

    /// Calls f(body) for every registered body whose box meets `box`, once or more often.
    template <class F>
    void for_each_meeting(const SweptBox& box, F&& f) const;

    /// The bodies in the order of their cells.
    void spatial_order(std::vector<Index>& order) const;

    [[nodiscard]] std::size_t size() const { return place_.size(); }
    /// Boxes that were registered beside the sorted ones since build().
    [[nodiscard]] std::size_t late() const { return late_.size(); }

private:
    static constexpr std::uint32_t nothing = 0xffffffffU;
    static constexpr std::uint32_t late_bit = 0x80000000U;
    static constexpr double whole_turn = 4294967296.0;

    struct Level {
        std::array<Tick, 3> edge{};            ///< longest box of this level
        std::array<std::uint32_t, 3> turns{};  ///< how often the grid repeats along the torus
        std::array<std::uint32_t, 3> cells{};  ///< cells along each axis, 1 or at least 3
        std::uint32_t first_cell = 0;
        std::uint32_t population = 0;

        /// Cell coordinate of a tick: rises along each turn of the grid.
        [[nodiscard]] std::uint32_t coordinate(std::size_t axis, Tick tick) const {
            return static_cast<std::uint32_t>((std::uint64_t{tick * turns[axis]} * cells[axis]) >> 32U);
        }
        [[nodiscard]] std::uint32_t cell_at(std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
            return first_cell + (z * cells[1] + y) * cells[0] + x;
        }
        [[nodiscard]] std::uint32_t cell_count() const { return cells[0] * cells[1] * cells[2]; }
        /// Everything fits into the last level.
        [[nodiscard]] bool is_last() const { return edge[0] == 0xffffffffU; }
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

    void choose_levels(const std::vector<SweptBox>& boxes, const Axes& axes);
    [[nodiscard]] double first_edge(std::size_t bodies) const;
    static void lay_out_level(Level& level, const Axes& axes);
    [[nodiscard]] static bool fits(const Level& level, const SweptBox& box);
    [[nodiscard]] std::size_t level_of(const SweptBox& box) const;
    static std::uint32_t home_cell(const Level& level, const SweptBox& box);
    void sort_into_cells(const std::vector<SweptBox>& boxes);
    [[nodiscard]] static bool stays_findable(const Level& level, std::uint32_t cell, const SweptBox& box);

    void pairs_inside(const Level& level, std::vector<Pair>& pairs) const;
    void pairs_across(const Level& fine, const Level& coarse, std::vector<Pair>& pairs) const;
    [[nodiscard]] std::pair<std::uint32_t, std::uint32_t> sorted_range(const Level& level) const {
        return {start_[level.first_cell], start_[level.first_cell + level.cell_count()]};
    }

    template <class F>
    void for_each_sorted(const Level& level, const SweptBox& box, F&& f) const;
    template <class F>
    void for_each_late(const Level& level, const SweptBox& box, F&& f) const;

    struct Late {
        Proxy proxy{};
        std::uint32_t next = nothing;
    };

    std::vector<Level> levels_;
    std::vector<Proxy> sorted_;
    std::vector<std::uint32_t> start_;     ///< first of each cell in sorted_, and the end
    std::vector<std::uint32_t> late_head_; ///< per cell: list of late boxes
    std::vector<Late> late_;
    std::vector<std::uint32_t> place_;     ///< per body: where in sorted_, or late_bit | where in late_
    std::vector<std::uint32_t> histogram_; ///< of the logarithm of box lengths
    std::vector<std::uint32_t> home_;      ///< per body: its cell, while sorting
};

template <class F>
void Cells::for_each_sorted(const Level& level, const SweptBox& box, F&& f) const {
    const auto [xs, ys, zs] = reach_of(level, box);
    const auto scan = [&](std::uint32_t first_cell, std::uint32_t end_cell) {
        for (std::uint32_t k = start_[first_cell]; k < start_[end_cell]; ++k) {
            if (meet(sorted_[k].box, box) && !sorted_[k].outdated()) f(sorted_[k].body);
        }
    };
    for (std::uint32_t j = 0; j < zs.count; ++j) {
        for (std::uint32_t i = 0; i < ys.count; ++i) {
            const std::uint32_t row = level.cell_at(0, ys.at(i), zs.at(j));
            const std::uint32_t end = xs.first + xs.count;
            scan(row + xs.first, row + std::min(end, xs.cells));
            if (end > xs.cells) scan(row, row + (end - xs.cells));
        }
    }
}

template <class F>
void Cells::for_each_late(const Level& level, const SweptBox& box, F&& f) const {
    const auto [xs, ys, zs] = reach_of(level, box);
    for (std::uint32_t j = 0; j < zs.count; ++j) {
        for (std::uint32_t i = 0; i < ys.count; ++i) {
            for (std::uint32_t h = 0; h < xs.count; ++h) {
                std::uint32_t k = late_head_[level.cell_at(xs.at(h), ys.at(i), zs.at(j))];
                for (; k != nothing; k = late_[k].next) {
                    const Proxy& proxy = late_[k].proxy;
                    if (!proxy.outdated() && meet(proxy.box, box)) f(proxy.body);
                }
            }
        }
    }
}

template <class F>
void Cells::for_each_meeting(const SweptBox& box, F&& f) const {
    for (const Level& level : levels_) {
        if (level.population > 0) for_each_sorted(level, box, f);
        if (!late_.empty()) for_each_late(level, box, f);
    }
}

} // namespace carom::core
