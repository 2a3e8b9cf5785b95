/// \file
/// Reads [camera] and [picture] of a scene file.
#pragma once

#include "scene/reader.hpp"
#include "scene/view.hpp"

namespace carom::scene {

/// Reads both tables from the top of the file, if they are there. Throws SceneError.
ViewSettings read_view(TableReader& top);

} // namespace carom::scene
