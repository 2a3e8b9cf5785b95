/// \file
/// The sound of a run as a file.
#pragma once

#include "scene/subject.hpp"
#include "viewer/sound/sound_track.hpp"

#include <filesystem>
#include <functional>

namespace carom::sound {

/// True if the file's name says that it is to be sound alone.
bool is_sound(const std::filesystem::path& file);

/// Runs the world to the end of its run, and writes what it sounds like to a WAV file, heard from where all is in
/// view. `go_on` is asked after each step. Returns false, with no file written, if it has said no. Throws
/// carom::Error{not_available} without OpenAL, {input_output} where the file cannot be written.
bool render_sound(scene::Subject subject, const std::filesystem::path& file,
                  const std::function<bool(const World&)>& go_on);

} // namespace carom::sound
