/// \file
/// The world of the viewer, in a thread of its own: the window never waits for a step.
#pragma once

#include "scene/view.hpp"
#include "viewer/stage/moment.hpp"
#include "viewer/window/ears.hpp"
#include "viewer/window/history.hpp"
#include "viewer/window/next_impact.hpp"

#include <carom/world.hpp>

#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

namespace carom::viewer {

/// A body that the user has picked.
struct PickedBody {
    BodyId id{};
    Body body{};
    bool held = false;
    std::optional<NextImpact> next{};
};

/// A row of the plots.
struct PlotRow {
    double time = 0;        ///< s
    double kinetic = 0;     ///< J
    double total = 0;       ///< J
    double impact_rate = 0; ///< 1/s of the world's time, faces included
};

/// What the window shows in numbers.
struct Status {
    double time = 0; ///< s
    std::uint64_t steps = 0;
    std::size_t bodies = 0;
    StepReport report{};
    Energy energy{};
    Ledger ledger{};
    double step_seconds = 0; ///< of the wall clock, a mean over the last steps
    std::optional<PickedBody> picked{};
    std::string problem{}; ///< why it stopped, or why a change was refused; empty if all is well
};

class Simulation {
public:
    /// Goes on with a world, in a thread.
    Simulation(World world, double dt, scene::ColourBy colour_by);
    ~Simulation();
    Simulation(const Simulation&) = delete;
    Simulation& operator=(const Simulation&) = delete;

    [[nodiscard]] double dt() const { return dt_; } ///< s
    /// Not shared with the thread: what never changes.
    [[nodiscard]] std::span<const Obstacle> obstacles() const { return obstacles_; }
    /// Those that suit the start.
    [[nodiscard]] const sound::SoundSettings& sound_settings() const { return sound_settings_; }

    /// \name Orders; each returns at once
    /// @{
    void run_to(double time); ///< s
    void step();
    void step_back();
    void restart(); ///< Moment::era tells when it is done
    /// Runs between two steps. What it throws becomes Status::problem.
    void change(std::function<void(World&)> order);
    void colour_by(scene::ColourBy by);
    void pick(std::optional<BodyId> id);
    void show_forces(bool forces);
    /// Strikes are kept for take_strikes() from now on, or are not.
    void hear(bool wanted);
    /// @}

    /// What was seen last.
    [[nodiscard]] std::shared_ptr<const Moment> moment() const;
    [[nodiscard]] Status status() const;
    /// Rows since the last call; after a step back the first one is earlier than the last one before.
    [[nodiscard]] std::vector<PlotRow> take_rows();
    /// Strikes since the last call, if they are wanted.
    [[nodiscard]] std::vector<TimedStrike> take_strikes();
    /// Waits until all orders are done.
    void wait_until_idle();

private:
    using Order = std::function<void(World&)>;

    void live();
    void obey(std::unique_lock<std::mutex>& lock);
    void do_step();
    void set_back(World world);
    /// Shows the state after a step, or after a change.
    void publish();
    void add_order(Order order);
    [[nodiscard]] bool has_work() const { return !orders_.empty() || (goal_ > world_.time() && !stuck_); }

    // Of the thread alone.
    World world_;
    double dt_;
    std::vector<Obstacle> obstacles_;
    sound::SoundSettings sound_settings_;
    Spectator spectator_;
    History history_;
    std::optional<BodyId> picked_;
    LookAhead look_ahead_;
    bool forces_ = false;
    bool hears_ = false;
    std::uint64_t era_ = 0; ///< restarts so far
    double step_seconds_ = 0;
    std::shared_ptr<Moment> spare_; ///< memory of a moment that nobody looks at any more

    // Of both.
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::condition_variable idle_;
    std::deque<Order> orders_;
    double goal_;        ///< s
    bool stuck_ = false; ///< a step has failed, so no further one is tried until something changes
    bool busy_ = false;
    bool ending_ = false;
    std::shared_ptr<Moment> moment_;
    Status status_;
    std::vector<PlotRow> rows_;
    std::vector<TimedStrike> strikes_;
    std::thread thread_;
};

} // namespace carom::viewer
