/// \file
/// Where OpenGL draws: a context of version 4.5 core without a window, or that of a window.
#pragma once

#include <memory>

struct GLFWwindow;

namespace carom::viewer::gl {

/// A context that is current in the thread that made it.
class Context {
public:
    Context() = default;
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;
    virtual ~Context() = default;
    /// Shows what was drawn to the window's own framebuffer. Nothing without a window.
    virtual void show() {}
};

/// EGL without any surface. Throws carom::Error{not_available} saying what is missing.
std::unique_ptr<Context> make_surfaceless_context();

/// The context that prepare_window() had GLFW make.
std::unique_ptr<Context> make_window_context(GLFWwindow* window);

} // namespace carom::viewer::gl
