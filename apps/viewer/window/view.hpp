/// \file
/// `carom view`: the window.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace carom::viewer {

struct ViewOptions {
    std::filesystem::path file;   ///< a scene, a snapshot or a checkpoint
    std::filesystem::path script; ///< what to do instead of waiting for a user; none if empty
};

/// Shows the file in a window until it is closed, or `stop` says so, or the script ends. Throws
/// carom::Error{not_available} where there is no display or no OpenGL 4.5, SceneError or carom::Error for a file that
/// cannot be opened, and ScriptError.
void view(const ViewOptions& options, const std::function<bool()>& stop);

} // namespace carom::viewer
