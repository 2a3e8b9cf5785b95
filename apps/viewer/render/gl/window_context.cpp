#include "viewer/render/gl/context.hpp"
#include "viewer/render/renderer.hpp"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace carom::viewer {

void prepare_window() {
    glfwDefaultWindowHints();
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
}

namespace gl {

namespace {

class WindowContext final : public Context {
public:
    explicit WindowContext(GLFWwindow* window) : window_(window) {
        glfwMakeContextCurrent(window);
        glfwSwapInterval(1);
    }
    ~WindowContext() override { glfwMakeContextCurrent(nullptr); }
    WindowContext(const WindowContext&) = delete;
    WindowContext& operator=(const WindowContext&) = delete;
    void show() override { glfwSwapBuffers(window_); }

private:
    GLFWwindow* window_;
};

} // namespace

std::unique_ptr<Context> make_window_context(GLFWwindow* window) { return std::make_unique<WindowContext>(window); }

} // namespace gl

} // namespace carom::viewer
