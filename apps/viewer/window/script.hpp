/// \file
/// A user made of text: it moves mouse and keys of a window, and looks at what comes of it.
#pragma once

#include "viewer/window/app.hpp"
#include "viewer/window/pace.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace carom::viewer {

/// One command a line; what stands behind a # is a remark. Each takes a frame, of a sixtieth of a second, or a few.
///
///     wait FRAMES
///     key NAME                  press and release; names are in input.hpp
///     move X Y                  the mouse, in pixels from the upper left
///     click X Y
///     drag X Y X2 Y2
///     wheel NOTCHES
///     press WIDGET [PART]       click on a widget of the panels, in its middle or at a part of its width
///     open FILE
///     size WIDTH HEIGHT         of the window
///     picture FILE.png          what the window shows
///     live SECONDS FILE.json    frames come at their pace, as for a person; then all facts and FrameTimes
///     expect FACT <|=|> NUMBER  App::facts()
///
/// Throws carom::Error{bad_data} naming file and line, for a line that means nothing and for an `expect` that is not
/// met.
class Script {
public:
    explicit Script(const std::filesystem::path& file);

    /// What the script needs of the window, besides the App.
    struct Window {
        std::function<void(int width, int height)> resize;
        std::function<Image()> picture;
        std::function<FrameTimes(double seconds)> live;
    };

    /// Does what is next before a frame. False once the script is at its end.
    bool go_on(App& app, const Window& window);

private:
    struct Line {
        int number = 0;
        std::vector<std::string> words;
    };

    [[noreturn]] void fail(const std::string& reason) const;
    void obey(App& app, const Window& window);
    void expect(App& app) const;
    void press_widget(App& app);
    [[nodiscard]] const std::string& word(std::size_t i) const;
    [[nodiscard]] double number(std::size_t i) const;

    std::filesystem::path file_;
    std::vector<Line> lines_;
    std::size_t next_ = 0;
    int waiting_ = 0;                                ///< frames
    std::vector<std::function<void(Input&)>> later_; ///< one in each of the next frames
};

} // namespace carom::viewer
