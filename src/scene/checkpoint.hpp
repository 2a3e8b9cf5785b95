/// \file
/// Checkpoints: a run as it stands after a step, to be continued bit-identically.
#pragma once

#include "scene/metrics.hpp"
#include "scene/observation.hpp"
#include "scene/timeline.hpp"

#include <carom/world.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace carom::scene {

/// What a run was started with, as far as its results depend on it: a checkpoint is continued only by the same.
struct RunIdentity {
    std::string scene;           ///< its name
    std::uint64_t bodies = 0;    ///< at the start
    std::uint64_t world = 0;     ///< hash of the world's snapshot at the start: everything else of the scene
    std::uint64_t observers = 0; ///< hash of them, before they have seen anything
    Precision precision = Precision::double_precision;
    double dt = 0;             ///< s
    double timeline_every = 0; ///< s between rows of the timeline; 0: a row per step
    double bodies_every = 0;   ///< s between tables of all bodies; 0: none
    bool check_overlap = true;
    bool record_impacts = false;

    friend bool operator==(const RunIdentity&, const RunIdentity&) = default;
    template <class Archive, class Self>
    static void transfer(Archive& archive, Self& self) {
        archive(self.scene, self.bodies, self.world, self.observers, self.precision, self.dt, self.timeline_every,
                self.bodies_every, self.check_overlap, self.record_impacts);
    }
};

/// The identity of the run of `world`, which has not done a step yet; the other members are the caller's to fill in.
/// A snapshot holds the number that the world has in its process: two processes agree if it is the first in each.
RunIdentity identity_of(const World& world, std::string scene, std::span<const Observation> observations);

/// What keeps a run with the identity `wanted` from continuing one that was `saved`; nothing if they are the same.
std::optional<std::string> difference(const RunIdentity& saved, const RunIdentity& wanted);

/// How far a run has come, apart from its world.
struct RunProgress {
    std::uint64_t steps = 0;       ///< steps of dt done
    bool last_step_short = false;  ///< the last one was shortened to end at the time asked for
    Books start;                   ///< at time 0
    double largest_overlap = 0;    ///< over the ends of all steps so far, diameters
    std::uint64_t contacts = 0;    ///< resting ones, at the end of the last step
    std::vector<TimelineRow> rows; ///< those that are due at regular times
    std::string impact_log;        ///< lines of impacts.csv; empty if impacts are not recorded
    std::uint64_t frames = 0;      ///< tables of all bodies that were due

    template <class Archive, class Self>
    static void transfer(Archive& archive, Self& self) {
        archive(self.steps, self.last_step_short, self.start, self.largest_overlap, self.contacts, self.rows,
                self.impact_log, self.frames);
    }
};

struct Checkpoint {
    RunIdentity identity;
    RunProgress progress;
    std::vector<std::byte> observations; ///< for restore_observations()
    World world;
};

/// A checkpoint as bytes: versioned, checksummed, the same on every machine.
std::vector<std::byte> save_checkpoint(const RunIdentity& identity, const RunProgress& progress,
                                       std::span<const Observation> observations, const World& world);

/// True if the bytes begin like a checkpoint's, sound or not.
bool looks_like_checkpoint(std::span<const std::byte> bytes);

/// Throws carom::Error{bad_data} saying what is wrong with the bytes.
Checkpoint load_checkpoint(std::span<const std::byte> bytes);

} // namespace carom::scene
