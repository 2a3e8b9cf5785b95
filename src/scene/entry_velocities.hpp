/// \file
/// Reads and draws the velocities of an entry.
#pragma once

#include "scene/entry.hpp"

#include <cstdint>
#include <vector>

namespace carom::scene {

/// `velocity`: one for all, one per body, or a distribution. Places and masses of all entries are known, and
/// velocities of the entries before this one.
void read_velocities(Entry& entry, const std::vector<NamedAttractor>& attractors, const std::vector<Entry>& entries,
                     std::uint64_t seed);

} // namespace carom::scene
