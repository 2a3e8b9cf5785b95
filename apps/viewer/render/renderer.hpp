/// \file
/// What draws a Drawing. The rest of the viewer knows this interface and no graphics interface behind it.
#pragma once

#include "viewer/render/drawing.hpp"
#include "viewer/render/image.hpp"

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

struct GLFWwindow;

namespace carom::viewer {

/// How large a picture is drawn.
struct PictureSize {
    int width = 0;       ///< pixels, >= 1
    int height = 0;      ///< pixels, >= 1
    int supersample = 1; ///< each pixel is the mean of so many in each direction, >= 1

    friend bool operator==(const PictureSize&, const PictureSize&) = default;
};

/// Draws pictures. All calls must come from the thread that made it. Throws carom::Error{not_available} with what the
/// driver says.
class Renderer {
public:
    Renderer() = default;
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;
    virtual ~Renderer() = default;

    /// What draws: driver and version.
    [[nodiscard]] virtual std::string device() const = 0;
    /// The largest side of a picture, supersampling included.
    [[nodiscard]] virtual int largest_side() const = 0;
    virtual void draw(const Drawing& drawing, const PictureSize& size) = 0;
    /// The last picture drawn.
    [[nodiscard]] virtual Image picture() = 0;
    /// m along the camera's direction to what the last picture shows at each of its pixels, supersampled ones
    /// included, row by row from the top; infinity for the background.
    [[nodiscard]] virtual std::vector<float> depths() = 0;
    /// Mistakes that the driver has reported so far.
    [[nodiscard]] virtual std::uint64_t errors() const = 0;
    /// Bytes that draw() has sent to the graphics card for bodies alone: those of each frame, and those that stay.
    [[nodiscard]] virtual std::uint64_t bytes_of_frames() const = 0;
    [[nodiscard]] virtual std::uint64_t bytes_that_stay() const = 0;
};

/// A renderer without window or display. Throws carom::Error{not_available} saying what is missing.
std::unique_ptr<Renderer> make_offscreen_renderer();

/// A window that shows the pictures of a renderer, and the user interface (Dear ImGui) over them.
class Screen {
public:
    Screen() = default;
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;
    virtual ~Screen() = default;

    [[nodiscard]] virtual Renderer& renderer() = 0;
    /// Begins a frame of the interface. Dear ImGui's context must be set.
    virtual void begin_interface() = 0;
    /// Shows the renderer's last picture, and over it what ImGui::Render() has made of the interface; waits for the
    /// monitor.
    virtual void present(int width, int height) = 0;
    /// The window as the last present() showed it.
    [[nodiscard]] virtual Image shown(int width, int height) = 0;
    /// An image for the interface to draw (an ImTextureID); it stays as long as the screen.
    virtual void* add_texture(const Image& image) = 0;
};

/// Tells GLFW what kind of window the renderer needs: to be called before the window is made.
void prepare_window();
/// Takes over the window, which must outlive it. Dear ImGui's context must be set.
std::unique_ptr<Screen> make_screen(GLFWwindow* window);

} // namespace carom::viewer
