/// \file
/// A run of a scene: its world and all that is recorded of it, step by step.
#pragma once

#include "scene/checkpoint.hpp"
#include "scene/overlap_search.hpp"
#include "scene/scene.hpp"
#include "scene/summary.hpp"
#include "stepping.hpp"

#include <carom/world.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace carom::cli {

/// How many steps of which length a run takes.
struct Schedule {
    std::uint64_t steps = 0;
    double dt = 0;   ///< s
    double last = 0; ///< s, the last step: shorter than dt where the time to run is no multiple of it
};
Schedule schedule_of(const scene::RunSettings& run);

/// True if a regular interval of `every` seconds ends in step number `step` (from 1): in the first step that reaches
/// a multiple of it. Every step for 0.
bool interval_ends(std::uint64_t step, double dt, double every);

class Simulation {
public:
    /// Makes the world. `scene` must outlive this. Throws SceneError.
    explicit Simulation(const scene::Scene& scene);

    /// Goes on from a checkpoint file of the same run. Throws UsageError saying why it cannot.
    void resume(const std::filesystem::path& file);

    [[nodiscard]] bool finished() const { return progress_.steps >= schedule_.steps; }
    [[nodiscard]] std::uint64_t steps() const { return progress_.steps; }
    [[nodiscard]] const Schedule& schedule() const { return schedule_; }
    [[nodiscard]] const World& world() const { return world_; }
    /// One step, and what is to be recorded of it. Throws what World::step throws.
    void advance();

    [[nodiscard]] std::vector<std::byte> checkpoint() const;
    /// The rows that were due, and one for now.
    [[nodiscard]] std::vector<scene::TimelineRow> timeline() const;
    /// True if a table of all bodies is to be written of now.
    [[nodiscard]] bool frame_is_due() const;
    /// Tables of all bodies that were due so far, that of now included.
    [[nodiscard]] std::uint64_t frames() const { return progress_.frames; }
    [[nodiscard]] const std::string& impact_log() const { return progress_.impact_log; }
    /// What the scene's observers have seen.
    [[nodiscard]] std::span<const scene::Observation> observations() const { return observations_; }
    void use_threads(unsigned threads) { world_.set_threads(threads); }
    [[nodiscard]] scene::Summary summary(unsigned threads);
    /// Steps that were done before this process went on from a checkpoint.
    [[nodiscard]] std::uint64_t resumed_from() const { return resumed_from_; }
    /// Steps of this process that ended early at the work cap.
    [[nodiscard]] std::uint64_t capped_steps() const { return totals_.capped; }
    /// s by which the world's time is behind that of all steps done.
    [[nodiscard]] double behind() const;

private:
    void measure_memory_once();

    const scene::Scene& scene_;
    Schedule schedule_;
    std::uint64_t memory_before_; ///< bytes, before the world was made
    World world_;
    scene::RunIdentity identity_;
    scene::RunProgress progress_;
    std::vector<scene::Observation> observations_;
    std::optional<scene::OverlapSearch> overlap_search_;
    StepTotals totals_; ///< of this process
    std::uint64_t resumed_from_ = 0;
    std::optional<double> bytes_per_body_;
};

} // namespace carom::cli
