/// \file
/// What the viewer remembers from one time to the next: the window, the volume, and the camera of each
/// scene.
#pragma once

#include "viewer/render/drawing.hpp"

#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace carom::viewer {

struct Settings {
    int width = 1280; ///< of the window
    int height = 800;
    double volume = 0.7; ///< 0 to 1
    bool muted = false;
    std::map<std::string, Camera> cameras{}; ///< by the scene's file
};

/// $XDG_CONFIG_HOME/carom/view.json, or ~/.config/carom/view.json; nothing if neither variable is set.
std::optional<std::filesystem::path> settings_file();

/// What the file says. Whatever it does not say, or says in a way that makes no sense, is as in a new Settings.
Settings load_settings(const std::filesystem::path& file);

/// Throws carom::Error{input_output} that names the file.
void save_settings(const Settings& settings, const std::filesystem::path& file);

} // namespace carom::viewer
