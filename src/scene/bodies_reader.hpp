/// \file
/// Reads the entries [[bodies]] and [[attractor]] of a scene file, and makes the bodies that they describe.
#pragma once

#include "scene/entry.hpp"
#include "scene/reader.hpp"
#include "scene/scene.hpp"

#include <cstdint>
#include <vector>

namespace carom::scene {

/// Fills Scene::bodies, sources and attractors from the tables of `top`. Region, seed and file of the scene are
/// set already. Throws SceneError.
void read_bodies(TableReader& top, const std::vector<Material>& materials, std::uint64_t max_bodies, Scene& scene);

} // namespace carom::scene
