/// \file
/// Who may meet whom during a window: for each body the list of those whose covers meet its own.
#pragma once

#include "space/cells.hpp"

#include <vector>

namespace carom::core {

/// A body's *cover* is a box that holds its swept box with some slack. As long as the body stays in its cover,
/// whatever impacts do to it, all that it may meet are its neighbours: a list that lies together in memory, where a
/// search through cells would touch dozens of places. A body that leaves its cover gets a new one, and new links.
class Neighbours {
public:
    using Pair = Cells::Pair;

    /// `covers[i]` is that of body i.
    void build(std::vector<SweptBox>& covers, const Cells::Axes& axes) {
        build(covers, axes, [](Index, Index) { return true; });
    }
    /// The same with only those pairs of which `keep(a, b)` is true.
    template <class Predicate>
    void build(std::vector<SweptBox>& covers, const Cells::Axes& axes, Predicate&& keep) {
        cells_.build(covers, axes);
        pairs_.clear();
        cells_.find_pairs(pairs_);
        pairs_.keep_if(keep);
        make_lists(covers.size());
    }

    /// Pairs of neighbours as of build(), once or more often; for serial solvers that keep no list per body.
    [[nodiscard]] std::span<const Pair> first_pairs() const { return pairs_.pairs(); }
    /// How many pairs build() found.
    [[nodiscard]] std::size_t pairs() const { return list_.size() / 2; }

    /// Whether `box` lies in the cover of a body.
    [[nodiscard]] bool covers(Index body, const SweptBox& box) const { return cells_.box_of(body).holds(box); }
    /// Replaces the cover of a body and finds its neighbours again. Those of which `looks_up(other)` is false will
    /// never be asked for their own neighbours.
    template <class Predicate>
    void cover_anew(Index body, const SweptBox& cover, Predicate&& looks_up) {
        cells_.update(body, cover);
        asks_list_[body] = 0;
        newest_link_[body] = nothing;
        link_all(body, cover, looks_up);
    }
    /// Covers a body with one more box.
    template <class Predicate>
    void extend_cover(Index body, const SweptBox& cover, Predicate&& looks_up) {
        cells_.add(body, cover);
        link_all(body, cover, looks_up);
    }
    /// Calls f(other) for every body whose cover meets the box, once or more often.
    template <class F>
    void for_each_meeting(const SweptBox& box, F&& f) const {
        cells_.for_each_meeting(box, f);
    }

    /// Calls f(other) for every neighbour, once or more often.
    template <class F>
    void for_each(Index body, F&& f) const {
        for (std::uint32_t k = first_[body]; asks_list_[body] != 0 && k < first_[body + 1]; ++k) f(list_[k]);
        for (std::uint32_t k = newest_link_[body]; k != nothing; k = links_[k].next) f(links_[k].other);
    }

    /// Asks for the memory that covers() and for_each() will need.
    void prefetch(Index body) const {
        __builtin_prefetch(&first_[body]);
        __builtin_prefetch(&newest_link_[body]);
        cells_.prefetch(body);
    }

    /// So many covers were replaced that searching among the outdated ones costs more than building anew.
    [[nodiscard]] bool crowded() const {
        constexpr std::size_t few = 256;
        return cells_.late() > few + 2 * cells_.size();
    }

    void spatial_order(std::vector<Index>& order) const { cells_.spatial_order(order); }

private:
    static constexpr std::uint32_t nothing = 0xffffffffU;

    struct Link {
        Index other = no_index;
        std::uint32_t next = nothing;
    };

    void make_lists(std::size_t bodies);
    template <class Predicate>
    void link_all(Index body, const SweptBox& cover, Predicate&& looks_up) {
        cells_.for_each_meeting(cover, [&](Index other) {
            if (other == body) return;
            link(body, other);
            if (looks_up(other) && !knows(other, body)) link(other, body);
        });
    }
    void link(Index body, Index other);
    /// Whether for_each(body) already gives `other`, whose own list of build() is shorter to search than that of a
    /// giant.
    [[nodiscard]] bool knows(Index body, Index other) const;

    Cells cells_;
    PairList pairs_;
    std::vector<std::uint32_t> first_;    ///< per body: where its neighbours begin in list_; and the end
    std::vector<std::uint8_t> asks_list_; ///< per body: false once its cover was replaced
    std::vector<Index> list_;
    std::vector<std::uint32_t> newest_link_; ///< per body: head of its later neighbours
    std::vector<Link> links_;
};

} // namespace carom::core
