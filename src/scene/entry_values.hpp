/// \file
/// Reads what the bodies of an entry are like: radius, growth, mass, restitution, friction, material.
#pragma once

#include "scene/entry.hpp"

#include <cstdint>
#include <vector>

namespace carom::scene {

/// `radius`: a number, one per body, or a distribution. The entry's count is known already.
void read_radii(Entry& entry, std::uint64_t seed);

/// `material`, and `restitution` and `friction`, which go before the material's.
void read_surfaces(Entry& entry, const std::vector<Material>& materials);

/// `mass`, or `density` and the radii.
void read_masses(Entry& entry);

} // namespace carom::scene
