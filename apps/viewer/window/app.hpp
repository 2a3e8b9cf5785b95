/// \file
/// The viewer, frame by frame: what the user does, the session, the picture and the panels over it.
#pragma once

#include "viewer/render/renderer.hpp"
#include "viewer/window/detail.hpp"
#include "viewer/window/ears.hpp"
#include "viewer/window/input.hpp"
#include "viewer/window/panels.hpp"
#include "viewer/window/session.hpp"
#include "viewer/window/settings.hpp"

#include <filesystem>
#include <future>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace carom::viewer {

class App {
public:
    /// Dear ImGui's context must be set. `lockstep`: frames wait for the simulation and for files, so that what is
    /// shown depends on nothing but what was done.
    App(Screen& screen, Settings settings, const std::filesystem::path& scenes, bool lockstep);
    ~App();
    App(const App&) = delete;
    App& operator=(const App&) = delete;

    void set_lockstep(bool lockstep) { lockstep_ = lockstep; }
    void show(std::unique_ptr<Session> session);
    /// Opens a scene or snapshot in the background; what is wrong with it is shown in the window.
    void open(const std::filesystem::path& file);
    /// Draws the next frame, of a window with so many pixels, `seconds` of the wall clock after the last one.
    void frame(double seconds, int width, int height);

    [[nodiscard]] Input& input() { return input_; }
    [[nodiscard]] const Panels& panels() const { return panels_; }
    /// Nothing is shown any more. What is returned waits for what is still being computed: a step, or a scene that is
    /// being opened.
    [[nodiscard]] std::vector<std::future<void>> close();
    /// As they are now.
    [[nodiscard]] Settings settings(int width, int height);
    /// What there is, as numbers by name, for scripts.
    [[nodiscard]] std::map<std::string, double> facts();
    /// Why the last file could not be opened.
    [[nodiscard]] const std::string& problem() const { return state_.problem; }

private:
    void finish_opening();
    void close_session();
    void remember_camera();
    void feed_interface(double seconds, int width, int height);
    void obey_keys();
    void obey_key(Key key);
    void obey_mouse(double seconds);
    void draw_picture(int width, int height);
    /// What is shown is what the last picture showed.
    [[nodiscard]] bool stands_still() const;
    /// What has happened from `before` (s of the world) to what is shown now, in `seconds` of the wall clock.
    void hear(double before, double seconds);
    void set_sound();
    [[nodiscard]] Place under_mouse() const;

    Screen& screen_;
    Settings settings_;
    Browser browser_;
    bool lockstep_;
    Input input_;
    Panels panels_;
    PanelState state_;
    std::unique_ptr<Session> session_;
    Ears ears_;
    Detail detail_;
    Camera last_camera_;
    std::weak_ptr<const Moment> last_moment_;
    Stage empty_; ///< what is shown without a session
    std::future<std::unique_ptr<Session>> opening_;
    std::vector<std::future<void>> closing_; ///< sessions that wait for the end of their last step
    int width_ = 1;
    int height_ = 1;
};

} // namespace carom::viewer
