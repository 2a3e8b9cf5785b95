/// \file
/// Reads the restitution of a material: a number, or a table with a law.
#pragma once

#include "scene/reader.hpp"

#include <carom/body.hpp>

#include <optional>

namespace carom::scene {

/// The law that a table describes; nothing if the value is no table.
std::optional<RestitutionLaw> read_law(const ValueReader& value);

} // namespace carom::scene
