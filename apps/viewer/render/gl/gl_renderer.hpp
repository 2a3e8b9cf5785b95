/// \file
/// The renderer in OpenGL 4.5 core: bodies as ray-traced spheres on triangles, lit after all surfaces are known.
#pragma once

#include "viewer/render/gl/context.hpp"
#include "viewer/render/gl/frame_block.hpp"
#include "viewer/render/gl/program.hpp"
#include "viewer/render/gl/targets.hpp"
#include "viewer/render/renderer.hpp"

#include <memory>
#include <optional>
#include <vector>

namespace carom::viewer::gl {

class GlRenderer final : public Renderer {
public:
    /// Takes the context, which is current. Throws carom::Error{not_available} if it is not 4.5 core.
    explicit GlRenderer(std::unique_ptr<Context> context);

    [[nodiscard]] std::string device() const override;
    [[nodiscard]] int largest_side() const override;
    void draw(const Drawing& drawing, const PictureSize& size) override;
    [[nodiscard]] Image picture() override;
    [[nodiscard]] std::vector<float> depths() override;
    [[nodiscard]] std::uint64_t errors() const override { return errors_; }
    [[nodiscard]] std::uint64_t bytes_of_frames() const override { return bytes_of_frames_; }
    [[nodiscard]] std::uint64_t bytes_that_stay() const override { return bytes_that_stay_; }
    /// Copies the last picture to a framebuffer of this size.
    void copy_picture(GLuint framebuffer, int width, int height);
    void count_errors();
    Context& context() { return *context_; }

private:
    struct Programs {
        Programs();
        ProgramHandle shadow;
        ProgramHandle sphere;
        ProgramHandle planet;
        ProgramHandle panel;
        ProgramHandle hollow;
        ProgramHandle shape_shadow;
        ProgramHandle shape;
        ProgramHandle glass;
        ProgramHandle occlusion;
        ProgramHandle blur;
        ProgramHandle light;
        ProgramHandle line;
        ProgramHandle resolve;
    };
    /// A buffer that only ever grows.
    struct Buffer {
        BufferHandle handle;
        std::size_t capacity = 0;
        void update(const void* data, std::size_t bytes);
    };

    void upload(const Drawing& drawing);
    void upload_shapes(const Shapes& shapes);
    void draw_shadows(const Drawing& drawing);
    void draw_surfaces(const Drawing& drawing);
    void draw_panels(const Drawing& drawing);
    void draw_hollow(const Hollow& hollow);
    void draw_shapes(const Shapes& shapes);
    void draw_glass(const Shapes& shapes);
    void find_occlusion();
    void light_surfaces();
    void begin_blending();
    void draw_lines(const std::vector<Line>& lines, float scale);
    void draw_screen(const ProgramHandle& program, const FramebufferHandle& target, int width, int height);

    std::unique_ptr<Context> context_; ///< ends last
    VertexArrayHandle no_vertices_;
    Programs programs_;
    Buffer frame_;
    Buffer bodies_;
    Buffer radii_;
    Buffer lines_;
    Buffer corners_;
    std::optional<std::uint64_t> radii_version_;
    std::optional<std::uint64_t> palette_version_;
    std::optional<std::uint64_t> shapes_version_;
    TextureHandle palette_;
    std::unique_ptr<Targets> targets_;
    float near_ = 0; ///< of the last picture
    std::uint64_t errors_ = 0;
    std::uint64_t bytes_of_frames_ = 0;
    std::uint64_t bytes_that_stay_ = 0;
};

/// The pixels of a framebuffer, from the top.
Image read_pixels(GLuint framebuffer, int width, int height);

} // namespace carom::viewer::gl
