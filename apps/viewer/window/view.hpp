/// \file
/// `carom view`: the window.
#pragma once

#include <filesystem>
#include <functional>
#include <future>
#include <string>
#include <vector>

namespace carom::viewer {

struct ViewOptions {
    std::filesystem::path file;   ///< a scene, a snapshot or a checkpoint
    std::filesystem::path script; ///< what to do instead of waiting for a user; none if empty
};

/// Shows the file in a window until it is closed, or `stop` says so, or the script ends. Throws
/// carom::Error{not_available} where there is no display or no OpenGL 4.5, SceneError or carom::Error for a file that
/// cannot be opened, and ScriptError. Returns once the window is gone and remembered. What is returned is ready when
/// the steps that were running then have ended, which may last; a process that ends need not wait for them.
[[nodiscard]] std::vector<std::future<void>> view(const ViewOptions& options, const std::function<bool()>& stop);

} // namespace carom::viewer
