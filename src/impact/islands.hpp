/// \file
/// Impacts by islands: groups of bodies that impacts couple inside one window, each resolved on its own. The result is,
/// to the last bit, that of the serial reference.
///
/// Within an island events run in the order of (time, ids), as in one queue. Bodies outside count as on the paths on
/// which they began the window. An island that meets a body outside stops; afterwards it is merged with that body's
/// island and run again from the start of the window. So is one of whose bodies the new path meets the new path of
/// another island's body. When nothing meets any more, no island has influenced another: their sequences, merged by
/// time, are those of the one queue.
#pragma once

#include "impact/serial.hpp"
#include "space/vicinity.hpp"

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
    IslandSolver(State<Real>& state, SerialSolver<Real>& serial)
        : state_(state), serial_(serial), vicinity_(state), queue_(state.bodies) {}

    /// Executes all impacts in [from, to] (s since the start of the step).
    Progress resolve(const Census& census, double from, double to, std::uint64_t work_cap, Outcome& outcome);

    /// Bodies were added, removed, or moved otherwise than by resolve().
    void forget() { vicinity_.forget(); }

    /// Of all windows since it was asked last.
    SolverCosts take_costs() { return std::exchange(costs_, {}); }
    IslandCounts take_counts() { return std::exchange(counts_, {}); }

private:
    Progress resolve_serially(const Census& census, std::uint64_t work_cap, Outcome& outcome);

    static constexpr std::uint32_t none = 0xffffffffU;

    /// From one place to before another.
    struct Range {
        std::uint32_t begin = 0;
        std::uint32_t end = 0;
    };

    /// A body of an island, and how it began the window.
    struct Member {
        Index body = no_index;
        std::uint32_t island = none;
        std::uint32_t last_leg = none; ///< the newest of its legs, other than the one it is on
        std::uint32_t version = 0;
        Flown<Real> before{};
        Flight flight{};
        Kind kind = Kind::free;
        bool changed = false;      ///< had an impact
        std::uint32_t hold = none; ///< in former_holds_, if held
    };

    /// A path between two impacts of a body in the window.
    struct Leg {
        Flown<Real> flown{};
        Kind kind = Kind::free;
        std::uint32_t earlier = none; ///< the leg before
    };

    struct Island {
        Range roster{}; ///< in roster_
        Range events{}; ///< in island_events_
        Range log{};    ///< in log_: what happened
        bool finished = false;
        std::uint32_t parent = none; ///< while islands are merged: one that this belongs to; itself if it stays
    };

    /// An island, and a body outside that it meets.
    struct Meeting {
        std::uint32_t island = none;
        Index other = no_index;
    };
    /// A body that an impact made leave its cover.
    struct Stray {
        Index body = no_index;
        Flown<Real> path{};
    };

    void predict_first();
    void predict_batch();
    void push_first(const Event& event);
    std::uint32_t member_of(Index body);
    std::uint32_t root_of(std::uint32_t member);
    void form_islands();
    bool run_to_fixpoint();

    void run(std::uint32_t id);
    void prefetch(std::uint32_t id) const;
    void prefetch_balls(std::uint32_t id) const;
    [[nodiscard]] bool is_foreign(Index body) const;
    [[nodiscard]] bool is_own(Index body) const;
    /// More than this in one window, and one queue does better than keeping track: a few bodies that hit each other
    /// over and over again.
    [[nodiscard]] std::size_t occurrences_worthwhile() const { return 1024 + 8 * state_.bodies.size(); }
    [[nodiscard]] std::size_t strays_worthwhile() const { return 64 + state_.bodies.size() / 8; }
    bool execute_event(const Event& event);
    void note_change(Index body);
    void follow(Index body, Index except, double now);
    [[nodiscard]] double predict(Index body, Index other, double now);
    [[nodiscard]] Path<Real> former_path(const Member& member) const;

    void cover_strays();
    void compare(std::uint32_t id);
    [[nodiscard]] bool paths_meet(const Member& a, const Member& b) const;

    void merge();
    void unite(std::uint32_t a, std::uint32_t b);
    std::uint32_t island_root(std::uint32_t id);
    std::uint32_t island_of_single(Index body);
    void restart(std::uint32_t id);
    void join_group(const std::vector<std::uint32_t>& group);
    void restore(Member& member);

    void commit(Outcome& outcome);
    void clear_window();

    State<Real>& state_;
    SerialSolver<Real>& serial_;
    Vicinity<Real> vicinity_;
    EventQueue<Real> queue_;

    double from_ = 0;
    double to_ = 0;
    std::uint64_t impacts_allowed_ = 0; ///< in this window
    bool abandoned_ = false;            ///< this window is for the serial solver

    std::vector<std::uint32_t> member_; ///< per body: in members_, or none
    std::vector<Member> members_;
    std::vector<std::uint32_t> parents_;  ///< per member: the forest in which islands are found
    std::vector<Neighbours::Pair> batch_; ///< to be predicted next
    std::vector<Event> first_events_;
    std::vector<Island> islands_;
    std::vector<std::uint32_t> roster_;
    std::vector<Event> island_events_;
    std::vector<std::uint32_t> pending_; ///< islands to run
    std::uint32_t current_ = none;       ///< the island that runs

    std::vector<Occurrence> log_;
    std::vector<EventIds> log_ids_;
    std::vector<Leg> legs_;
    std::vector<Hold> former_holds_;
    std::vector<Meeting> meetings_;
    std::vector<Stray> strays_;  ///< of this round
    std::size_t own_strays_ = 0; ///< where the running island's begin

    /// The place of an occurrence in the order of all.
    struct Place {
        double time = 0;
        EventIds ids{};
        std::uint32_t log = 0;
        friend auto operator<=>(const Place&, const Place&) = default;
    };
    std::vector<Place> places_;

    SolverCosts costs_;
    IslandCounts counts_{};
};

} // namespace carom::core
