/// \file
/// The way back: snapshots of a world, from which every step of the past is computed again.
#pragma once

#include <carom/world.hpp>

#include <cstddef>
#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace carom::viewer {

/// Keeps snapshots of the past, as many as fit into a number of bytes: steps are the same bits again, so in between
/// they are repeated. What the user changes is never repeated: after it comes a snapshot.
class History {
public:
    /// `world` is the start. `steps_between`: how many steps to repeat at most.
    History(const World& world, std::size_t most_bytes, std::uint64_t steps_between);

    /// To be called after each step.
    void stepped(const World& world);
    /// To be called after each change that is no step.
    void changed(const World& world);
    /// The world as it was after step `step` (World::step_count), or the oldest one that can be reached; what came
    /// later is forgotten. `dt`: the steps' length, s.
    World back_to(std::uint64_t step, double dt);
    /// The start of it all.
    [[nodiscard]] World start() const;

    [[nodiscard]] std::size_t bytes() const { return bytes_; }
    [[nodiscard]] std::uint64_t oldest_step() const { return snapshots_.front().step; }

private:
    struct Snapshot {
        std::uint64_t step;
        std::vector<std::byte> world;
    };

    void keep(const World& world);

    std::vector<std::byte> start_;
    std::deque<Snapshot> snapshots_; ///< from old to new, never empty
    std::size_t bytes_;
    std::size_t most_bytes_;
    std::uint64_t steps_between_;
};

} // namespace carom::viewer
