/// \file
/// Impacts by islands: groups of bodies that impacts couple inside one window, each resolved on its own, several at the
/// same time. The result is, to the last bit, that of the serial reference.
///
/// Islands are resolved in rounds, on copies: while a round runs, nothing changes that another island could see. An
/// island that met a body of another, or one of whose bodies on its new path meets the new path of another island's
/// body, is merged with that island and run again from the start of the window. When nothing meets any more, no island
/// has influenced another: their sequences, merged by time, are those of the one queue.
#pragma once

#include "impact/serial.hpp"
#include "impact/workshop.hpp"

#include <array>
#include <memory>
#include <utility>

namespace carom::core {

/// What the islands of a step were like.
struct IslandCounts {
    std::uint64_t islands = 0;
    std::uint64_t largest = 0; ///< bodies
    std::uint64_t rounds = 0;
    std::uint64_t merges = 0;
    std::uint64_t candidates = 0; ///< pairs whose times of impact had to be looked at
};

/// Resolves the impacts of windows, one after the other. Keeps its buffers, and lists of neighbours between windows.
template <class Real>
class IslandSolver {
public:
    IslandSolver(State<Real>& state, SerialSolver<Real>& serial);

    void use(std::shared_ptr<Executor> executor);

    /// Executes impacts in [from, to], or in a first part of it where too many depend on each other.
    Progress resolve(const Census& census, Window window, bool kicked, std::uint64_t work_cap, Outcome& outcome);

    [[nodiscard]] Vicinity<Real>& vicinity() { return vicinity_; }

    /// Of all windows since it was asked last.
    SolverCosts take_costs() { return std::exchange(costs_, {}); }
    IslandCounts take_counts() { return std::exchange(counts_, {}); }

private:
    /// A body of an island.
    struct Member {
        Index body = no_index;
        std::uint32_t island = nowhere;
        std::uint32_t part = 0;         ///< whose workshop has what became of it
        std::uint32_t turned = nowhere; ///< there; nowhere if it had no impact
    };

    struct Island {
        Range roster{}; ///< in roster_
        Range events{}; ///< in island_events_
        std::uint32_t part = 0;
        Outturn outturn{};
        std::uint32_t parent = nowhere; ///< while islands are merged: one that this belongs to; itself if it stays
    };

    /// An island, and a body of another that it meets.
    struct Meeting {
        std::uint32_t island = nowhere;
        Index other = no_index;
    };

    Progress resolve_serially(const Census& census, std::uint64_t work_cap, Outcome& outcome);

    void predict_first();
    void predict_batch(std::size_t part, std::size_t begin, std::size_t end);
    void enter_first(const Event& event);
    std::uint32_t member_of(Index body);
    std::uint32_t root_of(std::uint32_t member);
    void form_islands();

    bool run_to_fixpoint();
    void expect_shares();
    void run_pending();
    void publish(std::uint32_t id);
    void cover_strays();
    void compare_pending();
    void compare(std::size_t part, std::uint32_t id);
    [[nodiscard]] bool paths_meet(const Member& a, const Member& b) const;

    void merge();
    void unite(std::uint32_t a, std::uint32_t b);
    std::uint32_t island_root(std::uint32_t id);
    void join_group(std::span<const std::uint32_t> group);

    [[nodiscard]] double end_of_piece() const;
    void commit(Outcome& outcome);
    void write_back();
    void write_holds_back();
    void remember_flights();
    void write_down(Outcome& outcome);
    void sort_places();
    void clear_window();

    [[nodiscard]] const Turned<Real>& turned_of(const Member& member) const {
        return workshops_[member.part]->turned[member.turned];
    }
    [[nodiscard]] std::span<const Index> bodies_of(const Island& island) const {
        return {roster_.data() + island.roster.begin, roster_.data() + island.roster.end};
    }
    [[nodiscard]] std::span<const Event> events_of(const Island& island) const {
        return {island_events_.data() + island.events.begin, island_events_.data() + island.events.end};
    }

    State<Real>& state_;
    SerialSolver<Real>& serial_;
    std::shared_ptr<Executor> executor_;
    Vicinity<Real> vicinity_;

    Window window_{};
    bool given_up_ = false; ///< this window is for the serial solver

    std::array<std::unique_ptr<Workshop<Real>>, most_parts> workshops_;
    std::size_t expected_parts_ = 0;                        ///< workshops that have room for their share of a window
    std::array<std::vector<Event>, most_parts> found_;      ///< first events
    std::array<std::vector<Meeting>, most_parts> meetings_; ///< of paths
    std::vector<std::uint32_t> memberships_;                ///< per body: in members_, or nowhere
    std::vector<std::uint64_t> is_turned_; ///< per body a bit: 0 for most, and in the cache where memberships_ are not
    std::vector<Member> members_;
    std::vector<std::uint32_t> parents_; ///< per member: the forest in which islands are found
    std::vector<Event> first_events_;
    std::vector<std::uint32_t> first_members_; ///< whose first events these are
    std::vector<Island> islands_;
    std::vector<Index> roster_;
    std::vector<Event> island_events_;
    std::vector<std::uint32_t> pending_; ///< islands to run
    std::vector<std::uint32_t> merged_;  ///< islands that are being merged
    std::vector<const TurnedBody*> turned_;

    /// The place of an occurrence in the order of all.
    struct Place {
        double time = 0;
        EventIds ids{};
        std::uint32_t part = 0;
        std::uint32_t log = 0;
        [[nodiscard]] bool at_wall() const { return (ids.second & Event::wall_bit) != 0; }
        friend auto operator<=>(const Place&, const Place&) = default;
    };
    std::vector<Place> places_;
    std::vector<Place> sorted_places_;

    SolverCosts costs_;
    IslandCounts counts_{};
};

} // namespace carom::core
