#include "viewer/window/browser.hpp"

#include "scene/scene.hpp"
#include "viewer/stage/camera_path.hpp"
#include "viewer/stage/stage.hpp"

#include <algorithm>
#include <chrono>
#include <memory>
#include <system_error>

namespace carom::viewer {

namespace {

/// Scenes with more bodies than this have no picture: it would take too long.
constexpr std::uint64_t most_bodies = 300'000;

} // namespace

SceneAtStart scene_at_start(const std::filesystem::path& file) {
    SceneAtStart start;
    try {
        scene::Overrides overrides;
        overrides.max_bodies = most_bodies;
        const scene::Scene scene = scene::load_scene(file, overrides);
        Spectator spectator(scene.view.picture.colour_by);
        start.title = scene.title;
        start.moment = spectator.look(scene::make_world(scene), false);
        start.obstacles = scene.options.obstacles;
        start.camera = camera_at(scene.view.camera, 0, Stage(start.obstacles).to_see(*start.moment),
                                 up_of(scene.view.camera, scene.options.gravity));
    } catch (const std::runtime_error& error) { // SceneError and carom::Error
        start.problem = error.what();
    }
    return start;
}

Browser::Browser(const std::filesystem::path& folder) {
    std::error_code error;
    for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
        if (entry.path().extension() == ".toml") entries_.push_back({entry.path()});
    }
    std::sort(entries_.begin(), entries_.end(),
              [](const BrowserEntry& a, const BrowserEntry& b) { return a.file < b.file; });
}

std::size_t Browser::pictures() const {
    return static_cast<std::size_t>(std::count_if(entries_.begin(), entries_.end(),
                                                  [](const BrowserEntry& entry) { return entry.texture != nullptr; }));
}

void Browser::start_reading() {
    if (next_ < entries_.size()) reading_ = std::async(std::launch::async, scene_at_start, entries_[next_].file);
}

void Browser::go_on(Screen& screen) {
    using namespace std::chrono_literals;
    if (!reading_.valid()) return start_reading();
    if (reading_.wait_for(0s) != std::future_status::ready) return;
    BrowserEntry& entry = entries_[next_++];
    entry.scene = reading_.get();
    entry.known = true;
    if (entry.scene.moment) {
        Stage stage(entry.scene.obstacles);
        screen.renderer().draw(stage.draw(*entry.scene.moment, entry.scene.moment->end, entry.scene.camera),
                               {thumbnail_width, thumbnail_height, 2});
        entry.texture = screen.add_texture(screen.renderer().picture());
        entry.scene.moment = nullptr;
    }
}

} // namespace carom::viewer
