/// \file
/// Where bodies are put between steps: whether they overlap others.
#pragma once

#include "space/cells.hpp"
#include "space/state.hpp"
#include "space/ticks.hpp"

#include <memory>
#include <optional>

namespace carom::core {

/// An index of all bodies that grows as bodies are added, so that adding one by one stays cheap.
template <class Real>
class Placement {
public:
    explicit Placement(const State<Real>& state) : state_(state) {}

    /// To be called when all bodies may have moved, or changed places in memory.
    void forget() {
        if (valid_) cells_ = {};
        valid_ = false;
    }

    /// A body that overlaps body `i` by more than rounding, if there is one; of several the one in the lowest slot.
    /// Bodies from `end` on do not count. Static bodies may overlap each other.
    std::optional<Index> overlapping(Index i, Index end);

    /// To be called when the bodies from `first` to `last` are new, have moved or have come to these places in memory.
    /// Bodies behind the last one, removed or refused, need no word: they are never looked at.
    void note(Index first, Index last);

private:
    void build();
    [[nodiscard]] Ball ball_of(Index i) const;

    const State<Real>& state_;
    Ticks ticks_;
    Cells cells_;
    std::shared_ptr<Executor> loops_ = make_serial_executor();
    bool valid_ = false;
};

/// Largest gap below zero (m) that counts as touching: a rounding, not an overlap.
template <class Real>
double touching_tolerance(const State<Real>& state, double smaller_diameter) {
    const double relative = std::is_same_v<Real, float> ? 1e-6 : 1e-9;
    return std::max(relative * smaller_diameter, 2 * state.resolution.metres);
}

} // namespace carom::core
