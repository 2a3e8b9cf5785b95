/// \file
/// Reads a whole file into memory.
#pragma once

#include <filesystem>
#include <string>

namespace carom::scene {

/// The file's bytes. Throws SceneError saying why it cannot be read.
std::string read_text_file(const std::filesystem::path& file);

} // namespace carom::scene
