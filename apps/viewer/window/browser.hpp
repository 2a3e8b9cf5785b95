/// \file
/// The scenes of a folder and small pictures of them.
#pragma once

#include "viewer/render/renderer.hpp"
#include "viewer/stage/moment.hpp"

#include <filesystem>
#include <future>
#include <string>
#include <vector>

namespace carom::viewer {

/// A scene as it is at the start, read in a thread of its own.
struct SceneAtStart {
    std::string title{};
    std::shared_ptr<const Moment> moment{}; ///< null if the scene was refused
    std::vector<Obstacle> obstacles{};
    Camera camera{};
    std::string problem{};
};

struct BrowserEntry {
    std::filesystem::path file;
    SceneAtStart scene{};
    void* texture = nullptr; ///< an ImTextureID, null until there is one
    bool known = false;      ///< the scene was read, or refused
};

class Browser {
public:
    static constexpr int thumbnail_width = 192;  ///< pixels
    static constexpr int thumbnail_height = 108; ///< pixels

    /// Lists the scene files of a folder, in the order of their names; none if it cannot be read.
    explicit Browser(const std::filesystem::path& folder);

    [[nodiscard]] const std::vector<BrowserEntry>& entries() const { return entries_; }
    /// Scenes that have a picture so far.
    [[nodiscard]] std::size_t pictures() const;
    /// A little more of the work: to be called once a frame while the browser is open.
    void go_on(Screen& screen);

private:
    void start_reading();

    std::vector<BrowserEntry> entries_;
    std::size_t next_ = 0; ///< entry that is being read
    std::future<SceneAtStart> reading_;
};

/// Reads a scene and looks at its world.
SceneAtStart scene_at_start(const std::filesystem::path& file);

} // namespace carom::viewer
