#include "viewer/window/simulation.hpp"

#include <carom/base.hpp>

#include <algorithm>
#include <chrono>
#include <utility>

namespace carom::viewer {

namespace {

constexpr std::size_t most_history = std::size_t{1} << 29U; ///< bytes
constexpr std::uint64_t steps_between_snapshots = 20;
/// What is computed ahead of the picture is shown that often, so that it costs little.
constexpr std::chrono::milliseconds between_moments{8};
constexpr std::size_t most_strikes = 65536;
/// s of the world that the look ahead of a picked body goes.
constexpr double horizon = 100;

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

} // namespace

Simulation::Simulation(World world, double dt, scene::ColourBy colour_by)
    : world_(std::move(world)), dt_(dt), obstacles_(world_.options().obstacles),
      sound_settings_(sound::settings_for(world_)), spectator_(colour_by),
      history_(world_, most_history, steps_between_snapshots), goal_(world_.time()) {
    publish();
    thread_ = std::thread([this] { live(); });
}

Simulation::~Simulation() {
    {
        const std::scoped_lock lock(mutex_);
        ending_ = true;
    }
    changed_.notify_all();
    thread_.join();
}

void Simulation::live() {
    auto shown = std::chrono::steady_clock::now();
    std::unique_lock lock(mutex_);
    while (!ending_) {
        if (!has_work()) {
            busy_ = false;
            idle_.notify_all();
            changed_.wait(lock, [&] { return ending_ || busy_ || has_work(); });
            continue;
        }
        busy_ = true;
        if (!orders_.empty()) {
            obey(lock);
            continue;
        }
        const double goal = goal_;
        lock.unlock();
        std::string problem;
        try {
            do_step();
        } catch (const Error& error) {
            problem = error.what();
        }
        if (world_.time() >= goal || std::chrono::steady_clock::now() - shown > between_moments) {
            publish();
            shown = std::chrono::steady_clock::now();
        }
        lock.lock();
        if (problem.empty()) continue;
        stuck_ = true;
        status_.problem = problem;
    }
}

void Simulation::obey(std::unique_lock<std::mutex>& lock) {
    const Order order = std::move(orders_.front());
    orders_.pop_front();
    stuck_ = false;
    lock.unlock();
    std::string problem;
    try {
        order(world_);
    } catch (const Error& error) {
        problem = error.what();
    }
    publish();
    lock.lock();
    status_.problem = problem;
}

void Simulation::do_step() {
    const auto start = std::chrono::steady_clock::now();
    world_.step(dt_);
    constexpr double newest = 0.1; // of the mean
    const double seconds = seconds_since(start);
    step_seconds_ = step_seconds_ > 0 ? step_seconds_ + (seconds - step_seconds_) * newest : seconds;
    spectator_.watch_step(world_);
    history_.stepped(world_);

    const StepReport& report = world_.report();
    const Energy energy = world_.energy();
    const double impacts = static_cast<double>(report.impacts + report.face_impacts);
    const PlotRow row{world_.time(), energy.kinetic, energy.total(),
                      report.advanced > 0 ? impacts / report.advanced : 0};
    const std::vector<TimedStrike> strikes = hears_ ? timed_strikes_of(world_) : std::vector<TimedStrike>{};
    const std::scoped_lock lock(mutex_);
    rows_.push_back(row);
    if (strikes_.size() > most_strikes) strikes_.clear(); // nobody has taken them for long
    strikes_.insert(strikes_.end(), strikes.begin(), strikes.end());
}

void Simulation::publish() {
    if (picked_ && !world_.contains(*picked_)) picked_.reset();
    std::shared_ptr<Moment> next = spectator_.look(world_, forces_, std::move(spare_));
    next->era = era_;
    Status status;
    status.time = world_.time();
    status.steps = world_.step_count();
    status.bodies = world_.size();
    status.report = world_.report();
    status.energy = world_.energy();
    status.ledger = world_.ledger();
    status.step_seconds = step_seconds_;
    if (picked_) {
        status.picked = PickedBody{*picked_, world_.get(*picked_), world_.held(*picked_),
                                   look_ahead_.next_impact(world_, *picked_, horizon)};
    }
    const std::scoped_lock lock(mutex_);
    status.problem = status_.problem;
    status_ = std::move(status);
    std::swap(moment_, next);
    if (next.use_count() == 1) spare_ = std::move(next);
}

void Simulation::set_back(World world) {
    world_ = std::move(world);
    spectator_.bodies_changed();
    const std::scoped_lock lock(mutex_);
    strikes_.clear();
    goal_ = world_.time();
}

void Simulation::add_order(Order order) {
    {
        const std::scoped_lock lock(mutex_);
        orders_.push_back(std::move(order));
    }
    changed_.notify_all();
}

void Simulation::run_to(double time) {
    {
        const std::scoped_lock lock(mutex_);
        goal_ = time;
        busy_ = true; // until the thread has looked whether there is something to do
    }
    changed_.notify_all();
}

void Simulation::step() {
    add_order([this](World& /*world*/) { do_step(); });
}

void Simulation::step_back() {
    add_order([this](World& world) {
        if (world.step_count() > 0) set_back(history_.back_to(world.step_count() - 1, dt_));
    });
}

void Simulation::restart() {
    add_order([this](World& /*world*/) {
        set_back(history_.start());
        history_ = History(world_, most_history, steps_between_snapshots);
        ++era_;
    });
}

void Simulation::change(std::function<void(World&)> order) {
    add_order([this, order = std::move(order)](World& world) {
        order(world);
        spectator_.bodies_changed();
        history_.changed(world);
    });
}

void Simulation::colour_by(scene::ColourBy by) {
    add_order([this, by](World& /*world*/) { spectator_.colouring().set(by); });
}

void Simulation::pick(std::optional<BodyId> id) {
    add_order([this, id](World& /*world*/) { picked_ = id; });
}

void Simulation::hear(bool wanted) {
    add_order([this, wanted](World& /*world*/) { hears_ = wanted; });
}

void Simulation::show_forces(bool forces) {
    add_order([this, forces](World& /*world*/) { forces_ = forces; });
}

std::shared_ptr<const Moment> Simulation::moment() const {
    const std::scoped_lock lock(mutex_);
    return moment_;
}

Status Simulation::status() const {
    const std::scoped_lock lock(mutex_);
    return status_;
}

std::vector<PlotRow> Simulation::take_rows() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(rows_, {});
}

std::vector<TimedStrike> Simulation::take_strikes() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(strikes_, {});
}

void Simulation::wait_until_idle() {
    std::unique_lock lock(mutex_);
    idle_.wait(lock, [&] { return !busy_ && orders_.empty(); });
}

} // namespace carom::viewer
