#include "viewer/window/script.hpp"

#include "scene/atomic_file.hpp"
#include "scene/reader.hpp"
#include "scene/text_file.hpp"
#include "viewer/film/png.hpp"

#include <carom/base.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <sstream>

namespace carom::viewer {

Script::Script(const std::filesystem::path& file) : file_(file) {
    std::istringstream text(scene::read_text_file(file));
    std::string line;
    for (int number = 1; std::getline(text, line); ++number) {
        Line parsed{number, {}};
        std::istringstream words(line.substr(0, line.find('#')));
        for (std::string word; words >> word;) parsed.words.push_back(word);
        if (!parsed.words.empty()) lines_.push_back(std::move(parsed));
    }
}

void Script::fail(const std::string& reason) const {
    throw Error(ErrorCode::bad_data, fmt::format("{}:{}", file_.string(), lines_[next_].number), reason);
}

const std::string& Script::word(std::size_t i) const {
    if (i >= lines_[next_].words.size()) fail("there is a word missing");
    return lines_[next_].words[i];
}

double Script::number(std::size_t i) const {
    const auto value = scene::number_of_text(word(i));
    if (!value) fail(fmt::format("'{}' is no number", word(i)));
    return *value;
}

bool Script::go_on(App& app, const Window& window) {
    if (!later_.empty()) {
        later_.front()(app.input());
        later_.erase(later_.begin());
        return true;
    }
    if (waiting_ > 0) {
        --waiting_;
        return true;
    }
    if (next_ == lines_.size()) return false;
    obey(app, window);
    ++next_;
    return true;
}

void Script::obey(App& app, const Window& window) {
    const std::string& command = word(0);
    Input& input = app.input();
    if (command == "wait") {
        waiting_ = static_cast<int>(number(1));
    } else if (command == "key") {
        const auto key = key_named(word(1));
        if (!key) fail(fmt::format("there is no key '{}'", word(1)));
        input.press(*key);
        later_ = {[key](Input& i) { i.release(*key); }};
    } else if (command == "move") {
        input.move_mouse(number(1), number(2));
    } else if (command == "click") {
        input.move_mouse(number(1), number(2));
        later_ = {[](Input& i) { i.press(MouseButton::left); }, [](Input& i) { i.release(MouseButton::left); }};
    } else if (command == "drag") {
        input.move_mouse(number(1), number(2));
        const double x = number(3);
        const double y = number(4);
        later_ = {[](Input& i) { i.press(MouseButton::left); }, [x, y](Input& i) { i.move_mouse(x, y); },
                  [](Input& i) { i.release(MouseButton::left); }};
    } else if (command == "wheel") {
        input.turn_wheel(number(1));
    } else if (command == "press") {
        press_widget(app);
    } else if (command == "open") {
        app.open(word(1));
    } else if (command == "size") {
        window.resize(static_cast<int>(number(1)), static_cast<int>(number(2)));
    } else if (command == "picture") {
        scene::write_file(word(1), to_png(window.picture()));
    } else if (command == "live") {
        const FrameTimes times = window.live(number(1));
        nlohmann::json json(app.facts());
        json.update(
            {{"frames", times.frames}, {"seconds", times.seconds}, {"late", times.late}, {"asleep", times.asleep}});
        scene::write_file(word(2), json.dump());
    } else if (command == "expect") {
        expect(app);
    } else {
        fail(fmt::format("there is no command '{}'", command));
    }
}

/// `press NAME [PART]`: clicks on a widget, at a part of its width; in the middle if that is not given.
void Script::press_widget(App& app) {
    const auto found = app.panels().widgets().find(word(1));
    if (found == app.panels().widgets().end()) fail(fmt::format("there is no widget '{}'", word(1)));
    const ImVec4& place = found->second;
    const double part = lines_[next_].words.size() > 2 ? number(2) : 0.5;
    app.input().move_mouse(static_cast<double>(place.x) + part * static_cast<double>(place.z),
                           static_cast<double>(place.y) + 0.5 * static_cast<double>(place.w));
    // Dear ImGui takes a click only where the mouse has been for a frame.
    later_ = {[](Input&) {}, [](Input& i) { i.press(MouseButton::left); }, [](Input&) {},
              [](Input& i) { i.release(MouseButton::left); }};
}

/// `expect FACT <|=|> NUMBER`
void Script::expect(App& app) const {
    const std::map<std::string, double> facts = app.facts();
    const auto fact = facts.find(word(1));
    if (fact == facts.end()) fail(fmt::format("there is no fact '{}'", word(1)));
    const double wanted = number(3);
    const bool met = word(2) == "<"   ? fact->second < wanted
                     : word(2) == ">" ? fact->second > wanted
                     : word(2) == "=" ? fact->second == wanted
                                      : false;
    if (!met) fail(fmt::format("{} is {}; {}", word(1), fact->second, app.problem()));
}

} // namespace carom::viewer
