/// \file
/// Who may meet whom: for each body the list of those whose covers meet its own.
#pragma once

#include "space/cells.hpp"
#include "space/parallel.hpp"

#include <vector>

namespace carom::core {

/// A body's *cover* is a ball that it stays in for some time. As long as it does, whatever impacts do to it, all that
/// it may meet are its neighbours: a list that lies together in memory, where a search through cells would touch dozens
/// of places. A body that leaves its cover gets a new one, and new links.
class Neighbours {
public:
    /// `cover_at(i)` is the cover of body i. Those of which `looks_up(i)` is false will never be asked for their
    /// neighbours, nor get links.
    template <class CoverAt, class Predicate>
    void build(Executor& executor, std::size_t bodies, const Cells::Axes& axes, CoverAt&& cover_at,
               Predicate&& looks_up) {
        cells_.build(executor, bodies, axes, cover_at);
        start_lists(bodies);
        for_parts(executor, bodies, grain, [&](std::size_t part, std::size_t begin, std::size_t end) {
            make_lists(part, begin, end, looks_up);
        });
    }

    /// Cells to sort anything into. All lists are gone until build().
    [[nodiscard]] Cells& lend_cells() { return cells_; }

    /// How many neighbours build() found, over all bodies.
    [[nodiscard]] std::size_t found() const;

    /// Whether `ball` lies in the cover of a body.
    [[nodiscard]] bool covers(Index body, const Ball& ball) const {
        return ball_holds(cells_.ball_of(body), ball, cells_.scale());
    }
    /// Replaces the cover of a body, which is without neighbours until link_all().
    void replace_cover(Index body, const Ball& cover) {
        cells_.update(body, cover);
        known_[body] = {};
    }
    /// Links some bodies, and all whose covers meet theirs.
    template <class Predicate>
    void link_all(Executor& executor, std::span<const Index> bodies, Predicate&& looks_up) {
        // Covers run out in bursts: what is found waits in lists that must not become long.
        for (; bodies.size() > batch; bodies = bodies.subspan(batch))
            link_batch(executor, bodies.first(batch), looks_up);
        link_batch(executor, bodies, looks_up);
    }
    /// Takes a body's cover away, and its neighbours.
    void uncover(Index body) {
        cells_.remove(body);
        known_[body] = {};
    }

    /// From here on covers are only extended, until drop_extensions().
    void start_extensions() {
        extensions_from_ = cells_.late();
        extending_ = true;
    }
    /// Covers a body with one more ball for a while.
    template <class Predicate>
    void extend_cover(Index body, const Ball& cover, Predicate&& looks_up) {
        cells_.add(body, cover);
        Part& part = parts_[0];
        part.searcher.start();
        cells_.find_meeting(cover, body, part.searcher, part.meeting);
        for (const Index other : part.meeting) link_both(body, other, looks_up);
    }
    /// Takes away what extend_cover() gave.
    void drop_extensions();
    /// Calls f(other) for every body one of whose covers meets the ball, once or more often.
    template <class F>
    void for_each_meeting(const Ball& ball, F&& f) const {
        cells_.for_each_meeting(ball, f);
    }

    /// Calls f(other) for every neighbour, once or more often.
    template <class F>
    void for_each(Index body, F&& f) const {
        for (const Index other : list_of(body)) f(other);
        for_each_link(body, f);
    }

    /// The part of a body's neighbours that lies together; it may be read up to simd_padding elements behind its end.
    [[nodiscard]] std::span<const Index> list_of(Index body) const {
        const std::uint32_t place = known_[body].list;
        if (place == nothing) return {};
        const Index* const list = list_at(place);
        return {list + 1, list[0]};
    }
    /// Calls f(other) for the others, once or more often.
    template <class F>
    void for_each_link(Index body, F&& f) const {
        for (std::uint32_t k = known_[body].newest_link; k != nothing; k = links_[k].next) f(links_[k].other);
    }

    /// Asks for the memory that for_each() will need.
    void prefetch_body(Index body) const { prefetch(&known_[body]); }
    /// Then, for that of its list.
    void prefetch_list(Index body) const {
        const Known& known = known_[body];
        if (known.newest_link != nothing) prefetch(&links_[known.newest_link]);
        if (known.list == nothing) return;
        const Index* const list = list_at(known.list);
        constexpr std::size_t line = 16;
        prefetch(list);
        prefetch(list + line);
    }

    /// So many covers were replaced that searching among the outdated ones costs more than building anew.
    [[nodiscard]] bool crowded() const {
        constexpr std::size_t few = 256;
        return cells_.late() > few + 2 * cells_.size();
    }

private:
    static constexpr std::uint32_t nothing = 0xffffffffU;
    static constexpr std::size_t grain = 2048;
    static constexpr std::size_t batch = 1024; ///< bodies that are linked at a time
    static constexpr std::size_t link_grain = 64;
    /// A list is named by its part and by where it begins there: with its length.
    static constexpr std::uint32_t place_bits = 27;
    static constexpr std::uint32_t place_mask = (1U << place_bits) - 1;
    static_assert(most_parts <= 1U << (32 - place_bits));

    /// Where a body's neighbours are.
    struct Known {
        std::uint32_t list = nothing;        ///< of build(), or nothing once its cover was replaced
        std::uint32_t newest_link = nothing; ///< of those that came later
    };
    struct Link {
        Index other = no_index;
        std::uint32_t next = nothing;
    };
    [[nodiscard]] const Index* list_at(std::uint32_t place) const {
        return parts_[place >> place_bits].lists.data() + (place & place_mask);
    }
    /// Two bodies whose covers meet.
    struct Meeting {
        Index body = no_index;
        Index other = no_index;
    };
    struct Part {
        std::vector<Index> lists;
        std::size_t used = 0;
        BallSearcher searcher;
        std::vector<Index> meeting; ///< one body
        std::vector<Meeting> meetings;
    };

    void start_lists(std::size_t bodies);
    template <class Predicate>
    void make_lists(std::size_t part, std::size_t begin, std::size_t end, Predicate&& looks_up) {
        parts_[part].searcher.start();
        for (std::size_t k = begin; k < end; ++k) {
            const Index body = cells_.spatial_order()[k];
            if (looks_up(body)) make_list(parts_[part], static_cast<std::uint32_t>(part), k);
        }
    }
    void make_list(Part& part, std::uint32_t number, std::size_t k);

    template <class Predicate>
    void link_batch(Executor& executor, std::span<const Index> bodies, Predicate&& looks_up) {
        get_ready(parts_of(bodies.size(), link_grain));
        for_parts(executor, bodies.size(), link_grain, [&](std::size_t part, std::size_t begin, std::size_t end) {
            find_meeting(parts_[part], bodies.subspan(begin, end - begin));
        });
        for (Part& part : std::span(parts_).first(parts_of(batch, link_grain))) {
            for (const Meeting& m : part.meetings) prefetch(&known_[m.other]);
            for (const Meeting& m : part.meetings) link_both(m.body, m.other, looks_up);
            most_meetings_ = std::max(most_meetings_, part.meetings.size());
            clear_for_bursts(part.meetings, most_meetings_);
        }
    }
    /// Another batch may have some parts more.
    void get_ready(std::size_t parts);
    void find_meeting(Part& part, std::span<const Index> bodies) const;
    /// Who has the body in a list of build() has it twice then: to find that out would cost more.
    template <class Predicate>
    void link_both(Index body, Index other, Predicate&& looks_up) {
        link(body, other);
        if (looks_up(other) && !is_linked(other, body)) link(other, body);
    }
    void link(Index body, Index other);
    [[nodiscard]] bool is_linked(Index body, Index other) const;

    Cells cells_;
    std::array<Part, most_parts> parts_;
    std::size_t most_meetings_ = 0; ///< of a part so far
    std::size_t ready_ = 0;         ///< parts
    std::vector<Known> known_;      ///< per body
    std::vector<Link> links_;
    bool extending_ = false;
    std::size_t extensions_from_ = 0; ///< in the cells
    std::vector<Index> extended_;     ///< whose the links are that came since
};

} // namespace carom::core
