/// \file
/// Reads where the bodies of a generated entry are, and places them.
#pragma once

#include "scene/entry.hpp"

#include <carom/region.hpp>

#include <cstdint>
#include <vector>

namespace carom::scene {

/// True for the generators that look for places at random, and so need to know all other bodies first.
bool is_placed_at_random(Generator generator);

/// Places of "lattice" and "jittered_lattice"; count and radii are known.
void place_on_lattice(Entry& entry, const Cuboid& box, const Sites& sites, std::uint64_t seed);

/// Places of "fcc"; count and radii are known.
void place_on_fcc(Entry& entry, const Cuboid& box);

/// The box from `min` to `max`; those of a region that is a box if they are not given.
Cuboid read_cuboid(TableReader& table, const Region& region);

/// Places for all entries with random places, without overlap with each other and with all other entries.
void place_at_random(std::vector<Entry>& entries, const std::vector<NamedAttractor>& attractors, const Region& region,
                     std::uint64_t seed);

} // namespace carom::scene
