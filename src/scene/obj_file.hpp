/// \file
/// Reads triangle meshes from Wavefront OBJ files.
#pragma once

#include <carom/region.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace carom::scene {

/// Vertices and faces of a file; what it says of normals, textures, groups and materials is passed over. Faces of more
/// than three corners become fans of triangles. Indices count from 1, or from the end if they are negative. Throws
/// SceneError naming file and line.
Mesh read_obj(const std::filesystem::path& file);

/// The same from text; `file` is what errors call it.
Mesh parse_obj(std::string_view text, const std::string& file);

} // namespace carom::scene
