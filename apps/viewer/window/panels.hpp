/// \file
/// The user interface over the picture, with Dear ImGui.
#pragma once

#include "viewer/window/browser.hpp"
#include "viewer/window/session.hpp"

#include <imgui.h>

#include <filesystem>
#include <map>
#include <optional>
#include <string>

namespace carom::viewer {

/// What the panels show and change.
struct PanelState {
    bool hidden = false; ///< all but what was asked for
    bool help = false;
    bool browser = false;
    bool fine = true; ///< several samples for each pixel
    int divisor = 1;  ///< the window is so many times as wide and high as its picture
    bool shadows = true;
    double volume = 1; ///< 0 to 1
    bool muted = false;
    std::string silence{};  ///< why there is no sound; empty while there is
    bool try_sound = false; ///< the user wants to try again
    std::string device{};
    double frame_seconds = 0; ///< of the wall clock, a mean
    std::string problem{};    ///< of opening a file
    std::string loading{};    ///< the file that is being opened; empty if none is
};

class Panels {
public:
    /// Draws all panels. Returns the file that the user wants to open, if any.
    std::optional<std::filesystem::path> draw(Session* session, Browser& browser, PanelState& state);

    /// Where the middle of a widget was in the last frame, by its label: scripts click there.
    [[nodiscard]] const std::map<std::string, ImVec4>& widgets() const { return widgets_; }

private:
    void draw_control(Session& session, PanelState& state);
    void draw_time(Session& session);
    void draw_view(Session& session, PanelState& state);
    void draw_sound(PanelState& state);
    void draw_world(Session& session);
    void draw_picked(Session& session);
    void draw_measurements(Session& session);
    void draw_phases(const Status& status);
    void draw_browser(Browser& browser, PanelState& state, std::optional<std::filesystem::path>& chosen);
    void draw_help(PanelState& state);
    void draw_messages(const Session* session, const PanelState& state);
    void draw_scale(const Session& session);
    bool button(const char* label);
    bool slider(const char* label, double& value, double low, double high, const char* format,
                bool logarithmic = false);
    bool check(const char* label, bool& value);
    void note(const char* label);

    float control_bottom_ = 0;              ///< pixels, where the panel at the left ended in this frame
    std::map<std::string, ImVec4> widgets_; ///< x, y, width, height
};

/// How the interface looks.
void set_style();

} // namespace carom::viewer
