// A window that shows the pictures of the OpenGL renderer.
#include "viewer/render/gl/gl_renderer.hpp"

#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <cstdint>
#include <utility>
#include <vector>

namespace carom::viewer {

namespace gl {

namespace {

class GlScreen final : public Screen {
public:
    explicit GlScreen(GLFWwindow* window) : renderer_(make_window_context(window)) {
        ImGui_ImplOpenGL3_Init("#version 450 core");
    }
    ~GlScreen() override { ImGui_ImplOpenGL3_Shutdown(); }
    GlScreen(const GlScreen&) = delete;
    GlScreen& operator=(const GlScreen&) = delete;

    [[nodiscard]] Renderer& renderer() override { return renderer_; }
    void begin_interface() override { ImGui_ImplOpenGL3_NewFrame(); }
    void present(int width, int height) override {
        show_in(0, width, height);
        renderer_.count_errors();
        renderer_.context().show();
    }
    [[nodiscard]] Image shown(int width, int height) override {
        const TextureHandle texture = make_texture(GL_RGBA8, width, height, GL_NEAREST);
        const FramebufferHandle framebuffer = make_target({texture.get()}, 0);
        show_in(framebuffer.get(), width, height);
        Image image = read_pixels(framebuffer.get(), width, height);
        renderer_.count_errors();
        return image;
    }
    void* add_texture(const Image& image) override {
        textures_.push_back(make_texture(GL_RGB8, image.width, image.height, GL_LINEAR));
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        glTextureSubImage2D(textures_.back().get(), 0, 0, 0, image.width, image.height, GL_RGB, GL_UNSIGNED_BYTE,
                            image.pixels.data());
        glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
        const std::uintptr_t number = textures_.back().get();
        return reinterpret_cast<void*>(number); // NOLINT(performance-no-int-to-ptr): what Dear ImGui's back end takes
    }

private:
    void show_in(GLuint framebuffer, int width, int height) {
        renderer_.copy_picture(framebuffer, width, height);
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
        glViewport(0, 0, width, height);
        ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
    }

    GlRenderer renderer_;
    std::vector<TextureHandle> textures_;
};

} // namespace

} // namespace gl

std::unique_ptr<Screen> make_screen(GLFWwindow* window) { return std::make_unique<gl::GlScreen>(window); }

} // namespace carom::viewer
