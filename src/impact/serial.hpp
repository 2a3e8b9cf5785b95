/// \file
/// The serial reference: one event queue, every impact in the order of (time, ids). Every other way to resolve
/// impacts has to give the same bits.
#pragma once

#include "impact/events.hpp"
#include "impact/response.hpp"
#include "space/neighbours.hpp"
#include "space/ticks.hpp"
#include "space/window.hpp"

#include <memory>
#include <utility>

namespace carom::core {

/// What resolving impacts cost.
struct SolverCosts {
    std::uint64_t predictions = 0; ///< times of impact computed
    PhaseTimes seconds{};          ///< of wall-clock time
};

/// How far one window got.
struct Progress {
    double reached = 0; ///< s since the start of the step
    double until = 0;   ///< where the piece ends: earlier than it was meant to if bodies came to lean on each other
    bool work_cap_reached = false;
    bool edge_reached = false;
    bool crushed = false;
    [[nodiscard]] bool ends_step() const { return work_cap_reached || edge_reached || crushed; }
};

/// Resolves the impacts of windows, one after the other. Keeps its buffers.
template <class Real>
class SerialSolver {
public:
    explicit SerialSolver(State<Real>& state) : state_(state), queue_(state.bodies) {}

    /// Executes all impacts of a window.
    Progress resolve(const Census& census, const Window& window, std::uint64_t work_cap, Outcome& outcome);

    [[nodiscard]] const Neighbours& neighbours() const { return neighbours_; }
    /// Cells to sort anything into, between windows.
    [[nodiscard]] Cells& lend_cells() { return neighbours_.lend_cells(); }
    /// Of all windows since it was asked last.
    SolverCosts take_costs() { return std::exchange(costs_, {}); }

private:
    void recall_flights();
    void remember_flights(double now);
    void find_neighbours(const Census& census, double from, double to);
    void predict_first(double from, double to);
    Progress run_queue(const Window& window, std::uint64_t work_cap, Outcome& outcome);

    void prefetch_next() const;
    void prefetch_neighbours(Index body) const;

    /// Registers the new motion of a body at `now`; false if it leaves the representable world before `to`.
    bool register_motion(Index body, double now, double to);
    void predict_again(Index body, Index except, double now, double to);
    void predict_walls(Index body, double to);
    void predict(Index a, Index b, double now, double to);

    State<Real>& state_;
    std::shared_ptr<Executor> loops_ = make_serial_executor(); ///< in the caller's thread: that makes it the reference
    Ticks ticks_;
    Neighbours neighbours_;
    double slack_ = 0; ///< m, room in the covers for what impacts do
    EventQueue<Real> queue_;
    std::vector<Ball> covers_;
    std::vector<Index> near_walls_; ///< bodies that may meet a wall in the window
    double impacts_per_body_ = 0;   ///< in the last window
    SolverCosts costs_;
};

} // namespace carom::core
