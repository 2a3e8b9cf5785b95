/// \file
/// Reads the tables [[obstacle]] of a scene file.
#pragma once

#include "scene/reader.hpp"

#include <carom/region.hpp>

#include <filesystem>
#include <vector>

namespace carom::scene {

/// The obstacle that a table describes; files that it names are relative to `folder`.
Obstacle read_obstacle(TableReader& table, const std::filesystem::path& folder);

} // namespace carom::scene
