/// \file
/// Reads the values of a surface, which stand beside others in a table.
#pragma once

#include "scene/reader.hpp"

#include <carom/region.hpp>

namespace carom::scene {

/// Overwrites what the table has.
inline Surface read_surface(TableReader& table, Surface surface = {}) {
    if (const auto value = table.find("restitution")) surface.restitution = value->number(zero_to_one);
    if (const auto value = table.find("friction")) surface.friction = value->number(not_negative);
    return surface;
}

} // namespace carom::scene
