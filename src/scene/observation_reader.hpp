/// \file
/// Reads the tables [[observe]] of a scene file.
#pragma once

#include "scene/reader.hpp"
#include "scene/scene.hpp"

namespace carom::scene {

/// Appends the observers of the file to Scene::observations; all else of the scene is there already.
void read_observations(TableReader& top, Scene& scene);

} // namespace carom::scene
