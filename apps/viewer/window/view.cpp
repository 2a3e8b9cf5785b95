#include "viewer/window/view.hpp"

#include "scene/atomic_file.hpp"
#include "viewer/window/app.hpp"
#include "viewer/window/pace.hpp"
#include "viewer/window/script.hpp"
#include "viewer/window/settings.hpp"

#include <carom/base.hpp>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace carom::viewer {

namespace {

std::string last_glfw_error() {
    const char* text = nullptr;
    glfwGetError(&text);
    return text != nullptr ? text : "unknown";
}

class Glfw {
public:
    Glfw() {
        if (glfwInit() == GLFW_TRUE) return;
        throw Error(ErrorCode::not_available, "window", "there is no display: " + last_glfw_error());
    }
    ~Glfw() { glfwTerminate(); }
    Glfw(const Glfw&) = delete;
    Glfw& operator=(const Glfw&) = delete;
};

class Interface {
public:
    Interface() {
        ImGui::CreateContext();
        ImGui::GetIO().IniFilename = nullptr; // panels stay where they are
        set_style();
    }
    ~Interface() { ImGui::DestroyContext(); }
    Interface(const Interface&) = delete;
    Interface& operator=(const Interface&) = delete;
};

std::optional<Key> key_of(int key) {
    constexpr std::array<std::pair<int, Key>, key_names.size() + 1> keys{{{GLFW_KEY_SPACE, Key::space},
                                                                          {GLFW_KEY_LEFT, Key::left},
                                                                          {GLFW_KEY_RIGHT, Key::right},
                                                                          {GLFW_KEY_ESCAPE, Key::escape},
                                                                          {GLFW_KEY_F1, Key::f1},
                                                                          {GLFW_KEY_W, Key::w},
                                                                          {GLFW_KEY_A, Key::a},
                                                                          {GLFW_KEY_S, Key::s},
                                                                          {GLFW_KEY_D, Key::d},
                                                                          {GLFW_KEY_Q, Key::q},
                                                                          {GLFW_KEY_E, Key::e},
                                                                          {GLFW_KEY_F, Key::f},
                                                                          {GLFW_KEY_C, Key::c},
                                                                          {GLFW_KEY_R, Key::r},
                                                                          {GLFW_KEY_B, Key::b},
                                                                          {GLFW_KEY_H, Key::h},
                                                                          {GLFW_KEY_T, Key::t},
                                                                          {GLFW_KEY_1, Key::one},
                                                                          {GLFW_KEY_2, Key::two},
                                                                          {GLFW_KEY_3, Key::three},
                                                                          {GLFW_KEY_P, Key::p},
                                                                          {GLFW_KEY_M, Key::m},
                                                                          {GLFW_KEY_LEFT_SHIFT, Key::shift},
                                                                          {GLFW_KEY_RIGHT_SHIFT, Key::shift}}};
    for (const auto& [code, name] : keys) {
        if (code == key) return name;
    }
    return std::nullopt;
}

std::optional<MouseButton> button_of(int button) {
    if (button == GLFW_MOUSE_BUTTON_LEFT) return MouseButton::left;
    if (button == GLFW_MOUSE_BUTTON_RIGHT) return MouseButton::right;
    if (button == GLFW_MOUSE_BUTTON_MIDDLE) return MouseButton::middle;
    return std::nullopt;
}

/// Pixels of the picture for each unit of the window's coordinates.
double pixel_scale(GLFWwindow* window) {
    int width = 0;
    int pixels = 0;
    glfwGetWindowSize(window, &width, nullptr);
    glfwGetFramebufferSize(window, &pixels, nullptr);
    return width > 0 ? static_cast<double>(pixels) / width : 1;
}

Input& input_of(GLFWwindow* window) { return static_cast<App*>(glfwGetWindowUserPointer(window))->input(); }

void listen(GLFWwindow* window, App& app) {
    glfwSetWindowUserPointer(window, &app);
    glfwSetKeyCallback(window, [](GLFWwindow* w, int code, int /*scancode*/, int action, int /*modifiers*/) {
        const auto key = key_of(code);
        if (!key) return;
        if (action == GLFW_PRESS) input_of(w).press(*key);
        if (action == GLFW_RELEASE) input_of(w).release(*key);
    });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int code, int action, int /*modifiers*/) {
        const auto button = button_of(code);
        if (!button) return;
        if (action == GLFW_PRESS) input_of(w).press(*button);
        if (action == GLFW_RELEASE) input_of(w).release(*button);
    });
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
        input_of(w).move_mouse(x * pixel_scale(w), y * pixel_scale(w));
    });
    glfwSetScrollCallback(window, [](GLFWwindow* w, double /*x*/, double y) { input_of(w).turn_wheel(y); });
}

struct CloseWindow {
    void operator()(GLFWwindow* window) const { glfwDestroyWindow(window); }
};
using WindowHandle = std::unique_ptr<GLFWwindow, CloseWindow>;

WindowHandle make_window(const Settings& settings, const std::string& title) {
    prepare_window();
    WindowHandle window(glfwCreateWindow(settings.width, settings.height, title.c_str(), nullptr, nullptr));
    if (!window) {
        throw Error(ErrorCode::not_available, "window", "no window with OpenGL 4.5 core: " + last_glfw_error());
    }
    return window;
}

/// The folder whose scenes can be chosen: the one of the scene, or scenes/.
std::filesystem::path scenes_beside(const std::filesystem::path& file) {
    if (file.extension() != ".toml") return "scenes";
    return file.has_parent_path() ? file.parent_path() : ".";
}

double seconds_between(std::chrono::steady_clock::time_point from, std::chrono::steady_clock::time_point to) {
    return std::chrono::duration<double>(to - from).count();
}

/// s that the calling thread has computed.
double processor_seconds() {
    std::timespec used{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &used);
    return static_cast<double>(used.tv_sec) + 1e-9 * static_cast<double>(used.tv_nsec);
}

/// Frames at their pace, until the window is closed or `stop` says so.
FrameTimes show(GLFWwindow* window, App& app, const std::function<bool()>& stop) {
    FrameTimes times;
    const auto start = std::chrono::steady_clock::now();
    auto last = start;
    while (glfwWindowShouldClose(window) == GLFW_FALSE && !stop()) {
        const auto now = std::chrono::steady_clock::now();
        glfwPollEvents();
        int width = 0;
        int height = 0;
        glfwGetFramebufferSize(window, &width, &height);
        app.frame(seconds_between(last, now), width, height);
        last = now;
        ++times.frames;
        times.late += std::max(seconds_between(now + frame_time, std::chrono::steady_clock::now()), 0.0);
        const double awake = processor_seconds();
        pace(now);
        times.asleep += processor_seconds() - awake;
    }
    times.seconds = seconds_between(start, std::chrono::steady_clock::now());
    return times;
}

/// Each frame is a sixtieth of a second, however long it takes, unless the script wants it otherwise.
void play(GLFWwindow* window, App& app, Screen& screen, const std::filesystem::path& file,
          const std::function<bool()>& stop) {
    Script script(file);
    const auto size = [window] {
        std::pair<int, int> pixels;
        glfwGetFramebufferSize(window, &pixels.first, &pixels.second);
        return pixels;
    };
    const auto live = [&](double seconds) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
        app.set_lockstep(false);
        const FrameTimes times = show(window, app, [&] { return stop() || std::chrono::steady_clock::now() >= end; });
        app.set_lockstep(true);
        return times;
    };
    const Script::Window hands{[window](int width, int height) { glfwSetWindowSize(window, width, height); },
                               [&] { return screen.shown(size().first, size().second); }, live};
    while (glfwWindowShouldClose(window) == GLFW_FALSE && !stop()) {
        glfwPollEvents();
        if (!script.go_on(app, hands)) return;
        app.frame(1.0 / 60, size().first, size().second);
    }
}

} // namespace

std::vector<std::future<void>> view(const ViewOptions& options, const std::function<bool()>& stop) {
    const auto memory = settings_file();
    auto session = std::make_unique<Session>(options.file);
    const Glfw glfw;
    const Interface interface;
    const Settings settings = memory ? load_settings(*memory) : Settings{};
    const WindowHandle window = make_window(settings, "carom: " + options.file.filename().string());
    const std::unique_ptr<Screen> screen = make_screen(window.get());
    App app(*screen, settings, scenes_beside(options.file), !options.script.empty());
    app.show(std::move(session));
    listen(window.get(), app);
    if (options.script.empty()) {
        show(window.get(), app, stop);
    } else {
        play(window.get(), app, *screen, options.script, stop);
    }
    int width = 0;
    int height = 0;
    glfwGetWindowSize(window.get(), &width, &height);
    if (memory) save_settings(app.settings(width, height), *memory);
    return app.close();
}

} // namespace carom::viewer
