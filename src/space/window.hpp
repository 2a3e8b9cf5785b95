/// \file
/// How a step is cut: into pieces, at whose ends piled bodies get new velocities, and into windows, at whose ends
/// nothing happens but that impacts so far are done with.
#pragma once

#include <algorithm>
#include <cstdint>

namespace carom::core {

/// The ends of the pieces of a step, s since its start.
struct Pieces {
    double duration = 0; ///< s, of the step
    std::uint32_t count = 1;

    [[nodiscard]] double end_of(std::uint32_t k) const {
        return k + 1 >= count ? duration : duration * (static_cast<double>(k + 1) / count);
    }
    /// The first end after `time`; the last one if there is none.
    [[nodiscard]] double end_after(double time) const {
        auto k = static_cast<std::uint32_t>(std::clamp(time / duration * count, 0.0, count - 1.0));
        while (k > 0 && end_of(k - 1) > time) --k;
        while (k + 1 < count && end_of(k) <= time) ++k;
        return end_of(k);
    }
};

/// A part of a step, s since the start of the step.
struct Window {
    double from = 0;
    double to = 0;
    Pieces pieces{};
    double piece_end = 0;      ///< when piled bodies get new velocities; the end of the step if there are none
    bool begins_piece = false; ///< piled bodies have just got new velocities

    [[nodiscard]] double step_end() const { return pieces.duration; }
};

} // namespace carom::core
