/// \file
/// Reads the table [region] of a scene file.
#pragma once

#include "scene/reader.hpp"

#include <carom/region.hpp>

namespace carom::scene {

/// The bounds that the table describes.
Region read_region(TableReader table);

} // namespace carom::scene
