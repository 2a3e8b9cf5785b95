#include "simulation.hpp"

#include "memory.hpp"
#include "options.hpp"
#include "scene/atomic_file.hpp"
#include "scene/impact_log.hpp"

#include <carom/base.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace carom::cli {

namespace {

/// The memory that a world needs is read after so many steps, or at the end if that comes earlier.
constexpr std::uint64_t steps_before_memory = 100;

/// How many whole intervals fit into `steps` steps; one that ends within a rounding of a step ends with it.
double intervals_in(std::uint64_t steps, double dt, double every) {
    return std::floor(static_cast<double>(steps) * dt / every * (1 + 1e-12) + 1e-9);
}

scene::RunIdentity identity_of(const World& world, const scene::Scene& scene) {
    scene::RunIdentity identity = scene::identity_of(world, scene.name, scene.observations);
    identity.dt = scene.run.dt;
    identity.timeline_every = scene.outputs.timeline_every;
    identity.bodies_every = scene.outputs.bodies_every;
    identity.check_overlap = scene.outputs.check_overlap;
    identity.record_impacts = scene.outputs.record_impacts;
    return identity;
}

} // namespace

Schedule schedule_of(const scene::RunSettings& run) {
    if (run.steps) return {*run.steps, run.dt, run.dt};
    const double exact = run.time / run.dt;
    const double nearest = std::round(exact);
    // A time such as 1 s in steps of 1/60 s is meant to be a multiple, though its quotient may round to either side.
    if (nearest >= 1 && std::abs(exact - nearest) <= std::min(1e-3, 1e-9 * nearest)) {
        return {static_cast<std::uint64_t>(nearest), run.dt, run.dt};
    }
    const double steps = std::ceil(exact);
    return {static_cast<std::uint64_t>(steps), run.dt, run.time - (steps - 1) * run.dt};
}

bool interval_ends(std::uint64_t step, double dt, double every) {
    return !(every > 0) || intervals_in(step, dt, every) > intervals_in(step - 1, dt, every);
}

Simulation::Simulation(const scene::Scene& scene)
    : scene_(scene), schedule_(schedule_of(scene.run)), memory_before_(resident_bytes()),
      world_(scene::make_world(scene)), identity_(identity_of(world_, scene)), observations_(scene.observations) {
    release_freed_memory();
    progress_.start = scene::read_books(world_);
    progress_.rows.push_back(scene::timeline_row(world_, 0));
    if (scene.outputs.check_overlap) overlap_search_.emplace(world_);
    if (scene.outputs.bodies_every > 0) progress_.frames = 1;
}

void Simulation::resume(const std::filesystem::path& file) {
    try {
        scene::Checkpoint saved = scene::load_checkpoint(scene::read_file(file));
        if (const auto reason = scene::difference(saved.identity, identity_)) {
            throw UsageError(fmt::format("--resume {}: this checkpoint is of another run: {}", file.string(), *reason));
        }
        restore_observations(observations_, saved.observations, saved.world);
        world_ = std::move(saved.world);
        progress_ = std::move(saved.progress);
    } catch (const Error& error) {
        throw UsageError(fmt::format("--resume {}: {}", file.string(), error.what()));
    }
    if (progress_.steps > schedule_.steps) {
        throw UsageError(fmt::format("--resume {}: this checkpoint has {} steps already, and {} are to be done",
                                     file.string(), progress_.steps, schedule_.steps));
    }
    if (progress_.last_step_short && progress_.steps < schedule_.steps) {
        throw UsageError(fmt::format("--resume {}: the last step before this checkpoint was shortened to end the run; "
                                     "from there no run goes on as it would have without the end",
                                     file.string()));
    }
    resumed_from_ = progress_.steps;
}

void Simulation::advance() {
    const std::uint64_t step = progress_.steps + 1;
    const double length = step < schedule_.steps ? schedule_.dt : schedule_.last;
    timed_step(world_, length, totals_);
    if (scene_.outputs.record_impacts) scene::append_impacts(progress_.impact_log, step, world_.impacts());
    scene::observe(observations_, world_, step);
    progress_.steps = step;
    progress_.last_step_short = length < schedule_.dt;
    progress_.contacts = world_.report().contacts;
    if (totals_.steps == steps_before_memory) measure_memory_once();
    if (overlap_search_) {
        progress_.largest_overlap = std::max(progress_.largest_overlap, overlap_search_->find(world_).largest);
    }
    if (interval_ends(step, schedule_.dt, scene_.outputs.timeline_every)) {
        progress_.rows.push_back(scene::timeline_row(world_, step));
    }
    if (frame_is_due()) ++progress_.frames;
}

bool Simulation::frame_is_due() const {
    const double every = scene_.outputs.bodies_every;
    return every > 0 && (progress_.steps == 0 || interval_ends(progress_.steps, schedule_.dt, every));
}

double Simulation::behind() const {
    const double last = progress_.last_step_short ? schedule_.last : schedule_.dt;
    return static_cast<double>(progress_.steps - 1) * schedule_.dt + last - world_.time();
}

std::vector<std::byte> Simulation::checkpoint() const {
    return scene::save_checkpoint(identity_, progress_, observations_, world_);
}

std::vector<scene::TimelineRow> Simulation::timeline() const {
    std::vector<scene::TimelineRow> rows = progress_.rows;
    if (rows.back().step == progress_.steps) return rows;
    rows.push_back(scene::timeline_row(world_, progress_.steps));
    rows.back().contacts = progress_.contacts;
    return rows;
}

void Simulation::measure_memory_once() {
    if (bytes_per_body_) return;
    // What the judge of the engine needs is no part of the world.
    overlap_search_.reset();
    bytes_per_body_ = cli::bytes_per_body(memory_before_, world_.size());
    if (scene_.outputs.check_overlap) overlap_search_.emplace(world_);
}

scene::Summary Simulation::summary(unsigned threads) {
    measure_memory_once();
    scene::Summary summary;
    summary.bodies = world_.size();
    summary.steps = progress_.steps;
    summary.dt = schedule_.dt;
    summary.threads = threads;
    summary.precision = scene_.options.precision;
    summary.wall_seconds = totals_.seconds;
    summary.ns_per_body_step = scene::ratio(totals_.seconds * 1e9, static_cast<double>(totals_.steps * world_.size()));
    summary.ns_per_body_step_min = summary.ns_per_body_step;
    summary.pair_impacts = world_.ledger().impacts;
    summary.face_impacts = world_.ledger().face_impacts;
    summary.impacts_per_second =
        scene::ratio(static_cast<double>(totals_.impacts + totals_.face_impacts), totals_.seconds);
    summary.contacts = progress_.contacts;
    summary.start = progress_.start;
    summary.end = scene::read_books(world_);
    summary.peak_rss_bytes = peak_resident_bytes();
    if (overlap_search_) {
        summary.overlap = overlap_search_->find(world_);
        summary.overlap->largest = progress_.largest_overlap;
    }
    summary.bytes_per_body = *bytes_per_body_;
    summary.hash = world_.hash();
    return summary;
}

} // namespace carom::cli
