/// \file
/// Where one island is resolved: on copies of its bodies, so that islands never see each other at work.
#pragma once

#include "impact/index_map.hpp"
#include "impact/response.hpp"
#include "space/vicinity.hpp"

#include <span>

namespace carom::core {

/// From one place to before another.
struct Range {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
};

inline constexpr std::uint32_t nowhere = 0xffffffffU;

/// A path between two impacts of a body in the window.
template <class Real>
struct Leg {
    Flown<Real> path{};
    std::uint32_t earlier = nowhere; ///< the leg before
};

/// How a body that had impacts ends the window.
template <class Real>
struct Turned : TurnedBody {
    Motion<Real> motion{};
    std::uint32_t earlier = nowhere; ///< the leg before
    std::uint32_t flight = nowhere;  ///< in flights, if it is to be remembered
    std::uint32_t hold = nowhere;    ///< in holds, if held
    Kind kind = Kind::free;
};

/// A body that an impact made leave its cover.
template <class Real>
struct Stray {
    Index body = no_index;
    Flown<Real> path{};
};

/// What an island came to; the ranges lie in the workshop's lists.
struct Outturn {
    bool finished = false; ///< false: it met a body of another island, and stopped
    Range log{};
    Range turned{};
    Range absorbed{};
    Range strays{};
    Range meetings{};
};

/// Resolves islands, one after the other. Within an island events run in the order of (time, ids), as in one queue.
/// Bodies outside count as on the paths on which they began the window. One that would have had no impact at all is
/// absorbed; at a body of another island the island stops.
template <class Real>
class Workshop {
public:
    Workshop();
    Workshop(const Workshop&) = delete;
    Workshop& operator=(const Workshop&) = delete;

    /// Start of a window: `memberships[body]` is nowhere for a body that belongs to no island.
    void open(const State<Real>& state, const Vicinity<Real>& vicinity, const std::vector<std::uint32_t>& memberships,
              const Window& window, std::size_t most_occurrences);
    /// So many bodies may turn.
    void expect(std::size_t bodies);
    /// Resolves an island of these bodies, of which these are the first events.
    Outturn run(std::span<const Index> bodies, std::span<const Event> events);
    /// Asks for the memory of an island that is to run soon, in three stages.
    void prefetch_bodies(std::span<const Index> bodies) const;
    void prefetch_lists(std::span<const Index> bodies) const;
    void prefetch_tracks(std::span<const Index> bodies) const;

    /// The window is for the one queue: an island has too many impacts, or a body leaves the world or is crushed.
    [[nodiscard]] bool has_given_up() const { return given_up_; }
    /// Whether a body that turned came to rest, or rests on.
    [[nodiscard]] bool any_rests() const { return any_rests_; }
    [[nodiscard]] std::uint64_t predictions() const { return predictions_; }
    /// The last path of a body that turned.
    [[nodiscard]] Flown<Real> last_path(const Turned<Real>& body) const {
        return {body.motion, last_acceleration(body), body.kind};
    }

    // Of all islands since open().
    std::vector<Occurrence> log;
    std::vector<EventIds> log_ids;
    std::vector<Turned<Real>> turned;
    std::vector<Leg<Real>> legs;
    std::vector<Flight> flights;
    std::vector<Hold> holds;
    std::vector<Index> absorbed;
    std::vector<Stray<Real>> strays;
    std::vector<Index> meetings; ///< bodies of other islands

private:
    /// A body here beside its copy.
    struct Guest {
        Index body = no_index;
        bool is_own = false;             ///< else it is only looked at
        bool has_turned = false;         ///< had an impact
        std::uint32_t earlier = nowhere; ///< the leg before the present one
        float room = 0;
        Track track{}; ///< once it has turned
    };

    [[nodiscard]] Vec3 last_acceleration(const Turned<Real>& body) const {
        if (body.kind == Kind::free) return local_.laws.gravity;
        return body.hold == nowhere ? Vec3{} : holds[body.hold].acceleration;
    }
    void clear();
    Index admit(Index body, bool as_own);
    bool take(const Event& event);
    void execute_event(const Event& event);
    void note_turn(Index local);
    void set_out(Index local, double now);
    void follow(Index local, Index except, double now);
    void look(Index local, Index other, double now);
    void look_at_own(Index local, Index except, double now);
    void look_at_turned(Index local, Index other, double now);
    void put_out(Outturn& outturn);
    void push(double time, Index a, Index b);

    const State<Real>* state_ = nullptr;
    const Vicinity<Real>* vicinity_ = nullptr;
    const std::vector<std::uint32_t>* memberships_ = nullptr;
    double to_ = 0;
    std::size_t most_occurrences_ = 0;
    bool given_up_ = false;
    bool any_rests_ = false;
    std::uint64_t predictions_ = 0;

    State<Real> local_;
    EventQueue<Real> queue_;
    std::vector<Guest> guests_; ///< beside local_.bodies
    IndexMap places_;           ///< from bodies to guests
    std::vector<Index> turned_; ///< guests that have
    std::vector<Index> own_strays_;
};

} // namespace carom::core
