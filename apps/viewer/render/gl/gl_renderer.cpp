#include "viewer/render/gl/gl_renderer.hpp"

#include "viewer/render/gl/shaders.hpp"

#include <carom/base.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <utility>

namespace carom::viewer {

namespace gl {

namespace {

/// \name Numbers of the shaders' buffers
/// @{
constexpr GLuint bodies_binding = 0;
constexpr GLuint radii_binding = 1;
constexpr GLuint lines_binding = 2;
constexpr GLuint corners_binding = 3;
/// @}

/// A line as the shader reads it.
struct LineBlock {
    std::array<float, 4> from; ///< and width
    std::array<float, 4> to;
    std::array<float, 4> colour_from; ///< linear
    std::array<float, 4> colour_to;
};

/// A corner as the shader reads it.
struct CornerBlock {
    std::array<float, 4> place;
    std::array<float, 4> normal;
};

void check_version() {
    constexpr int least = 45;
    if (epoxy_gl_version() >= least) return;
    throw Error(ErrorCode::not_available, "OpenGL",
                "drawing needs version 4.5 core, but the driver has " +
                    std::string(reinterpret_cast<const char*>(glGetString(GL_VERSION))));
}

/// Row by row from the top, where OpenGL begins at the bottom.
template <class T>
void turn_over(std::vector<T>& rows, int height) {
    const std::size_t row = rows.size() / static_cast<std::size_t>(height);
    for (std::size_t low = 0, high = static_cast<std::size_t>(height) - 1; low < high; ++low, --high) {
        std::swap_ranges(rows.begin() + static_cast<std::ptrdiff_t>(low * row),
                         rows.begin() + static_cast<std::ptrdiff_t>((low + 1) * row),
                         rows.begin() + static_cast<std::ptrdiff_t>(high * row));
    }
}

} // namespace

Image read_pixels(GLuint framebuffer, int width, int height) {
    Image image{width, height,
                std::vector<std::uint8_t>(3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height))};
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, image.pixels.data());
    turn_over(image.pixels, height);
    return image;
}

GlRenderer::Programs::Programs()
    : shadow(make_program("shadow", {shaders::frame, "#define SHADOW\n", shaders::sphere_vertex},
                          {shaders::frame, "#define SHADOW\n", shaders::sphere_fragment})),
      sphere(make_program("sphere", {shaders::frame, "#define PLANET 0\n", shaders::sphere_vertex},
                          {shaders::frame, "#define PLANET 0\n", shaders::sphere_fragment})),
      planet(make_program("planet", {shaders::frame, "#define PLANET 1\n", shaders::sphere_vertex},
                          {shaders::frame, "#define PLANET 1\n", shaders::sphere_fragment})),
      panel(make_program("panel", {shaders::frame, shaders::panel_vertex}, {shaders::frame, shaders::panel_fragment})),
      hollow(
          make_program("hollow", {shaders::frame, shaders::screen_vertex}, {shaders::frame, shaders::hollow_fragment})),
      shape_shadow(make_program("shape_shadow", {shaders::frame, "#define SHADOW\n", shaders::shape_vertex},
                                {shaders::frame, shaders::depth_fragment})),
      shape(make_program("shape", {shaders::frame, shaders::shape_vertex}, {shaders::frame, shaders::shape_fragment})),
      glass(make_program("glass", {shaders::frame, shaders::shape_vertex}, {shaders::frame, shaders::glass_fragment})),
      occlusion(make_program("occlusion", {shaders::frame, shaders::screen_vertex},
                             {shaders::frame, shaders::occlusion_fragment})),
      blur(make_program("blur", {shaders::frame, shaders::screen_vertex}, {shaders::frame, shaders::blur_fragment})),
      light(make_program("light", {shaders::frame, shaders::screen_vertex}, {shaders::frame, shaders::light_fragment})),
      line(make_program("line", {shaders::frame, shaders::line_vertex}, {shaders::frame, shaders::line_fragment})),
      resolve(make_program("resolve", {shaders::frame, shaders::screen_vertex},
                           {shaders::frame, shaders::resolve_fragment})) {}

void GlRenderer::Buffer::update(const void* data, std::size_t bytes) {
    if (handle.get() == 0 || bytes > capacity) {
        // An eighth more, so that a world that grows body by body does not have it made anew in each frame.
        capacity = std::max<std::size_t>(bytes + bytes / 8, 256);
        handle = make_buffer();
        glNamedBufferStorage(handle.get(), static_cast<GLsizeiptr>(capacity), nullptr, GL_DYNAMIC_STORAGE_BIT);
    } else {
        glInvalidateBufferData(handle.get());
    }
    if (bytes > 0) glNamedBufferSubData(handle.get(), 0, static_cast<GLsizeiptr>(bytes), data);
}

GlRenderer::GlRenderer(std::unique_ptr<Context> context)
    : context_((check_version(), std::move(context))), no_vertices_(make_vertex_array()),
      palette_(make_texture(GL_SRGB8_ALPHA8, palette_columns, palette_rows, GL_LINEAR)) {
    // With the near edge at depth 1 and 0 at infinity, floating point is as exact far away as it is near.
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
}

std::string GlRenderer::device() const {
    const auto text = [](GLenum name) { return std::string(reinterpret_cast<const char*>(glGetString(name))); };
    return text(GL_RENDERER) + ", OpenGL " + text(GL_VERSION);
}

int GlRenderer::largest_side() const {
    GLint side = 0;
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &side);
    return side;
}

void GlRenderer::upload(const Drawing& drawing) {
    const FrameBlock frame = frame_block(drawing, *targets_);
    near_ = frame.lens[2];
    frame_.update(&frame, sizeof(frame));
    glBindBufferBase(GL_UNIFORM_BUFFER, 0, frame_.handle.get());

    bodies_.update(drawing.bodies.data(), drawing.bodies.size_bytes());
    bytes_of_frames_ += drawing.bodies.size_bytes();
    if (radii_version_ != drawing.radii_version) {
        radii_.update(drawing.radii.data(), drawing.radii.size_bytes());
        radii_version_ = drawing.radii_version;
        bytes_that_stay_ += drawing.radii.size_bytes();
    }
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, bodies_binding, bodies_.handle.get());
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, radii_binding, radii_.handle.get());
    if (palette_version_ != drawing.palette_version) {
        glTextureSubImage2D(palette_.get(), 0, 0, 0, palette_columns, palette_rows, GL_RGBA, GL_FLOAT,
                            drawing.palette.data());
        palette_version_ = drawing.palette_version;
    }
    upload_shapes(drawing.shapes);
}

/// Those that are plain, then those of glass.
void GlRenderer::upload_shapes(const Shapes& shapes) {
    if (shapes.plain.empty() && shapes.glass.empty()) return;
    if (shapes_version_ != shapes.version) {
        std::vector<CornerBlock> blocks;
        blocks.reserve(shapes.plain.size() + shapes.glass.size());
        for (const auto& corners : {shapes.plain, shapes.glass}) {
            for (const Corner& corner : corners) {
                blocks.push_back({{corner.place.x, corner.place.y, corner.place.z, 1},
                                  {corner.normal.x, corner.normal.y, corner.normal.z, 0}});
            }
        }
        corners_.update(blocks.data(), blocks.size() * sizeof(CornerBlock));
        shapes_version_ = shapes.version;
    }
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, corners_binding, corners_.handle.get());
}

void GlRenderer::draw(const Drawing& drawing, const PictureSize& size) {
    if (size.width < 1 || size.height < 1 || size.supersample < 1 ||
        std::max(size.width, size.height) > largest_side() / size.supersample) {
        throw Error(ErrorCode::out_of_range, "size",
                    "must be from 1 to " + std::to_string(largest_side() / std::max(size.supersample, 1)) +
                        " pixels with this driver");
    }
    if (!targets_ || targets_->size != size) {
        targets_.reset(); // before others are made: pictures may be large
        targets_ = std::make_unique<Targets>(size);
    }
    glBindVertexArray(no_vertices_.get());
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_CULL_FACE);
    upload(drawing);
    if (drawing.shadows) draw_shadows(drawing);
    draw_surfaces(drawing);
    if (drawing.occlusion) find_occlusion();
    light_surfaces();
    glEnable(GL_DEPTH_TEST);
    draw_glass(drawing.shapes);
    draw_lines(drawing.lines, drawing.line_scale);
    glDisable(GL_DEPTH_TEST);
    draw_lines(drawing.lines_on_top, drawing.line_scale);
    glBindTextureUnit(0, targets_->light.get());
    draw_screen(programs_.resolve, targets_->resolving, size.width, size.height);
    count_errors();
}

void GlRenderer::draw_shadows(const Drawing& drawing) {
    glBindFramebuffer(GL_FRAMEBUFFER, targets_->shadowing.get());
    glViewport(0, 0, targets_->shadow_side, targets_->shadow_side);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_DEPTH_CLAMP);
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_TRUE);
    constexpr float farthest = 0;
    glClearBufferfv(GL_DEPTH, 0, &farthest);
    glUseProgram(programs_.shadow.get());
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(3 * drawing.bodies.size()));
    const Shapes& shapes = drawing.shapes;
    if (shapes.plain.empty()) return;
    glUseProgram(programs_.shape_shadow.get());
    glUniform3fv(0, 1, &shapes.anchor.x);
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(shapes.plain.size()));
}

void GlRenderer::draw_surfaces(const Drawing& drawing) {
    glBindFramebuffer(GL_FRAMEBUFFER, targets_->surfaces.get());
    glViewport(0, 0, targets_->width, targets_->height);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_DEPTH_CLAMP);
    glEnable(GL_FRAMEBUFFER_SRGB);
    glDepthFunc(GL_GREATER);
    glDepthMask(GL_TRUE);
    constexpr float farthest = 0;
    constexpr std::array<float, 4> nothing{};
    glClearBufferfv(GL_DEPTH, 0, &farthest);
    glClearBufferfv(GL_COLOR, 0, nothing.data());
    glClearBufferfv(GL_COLOR, 1, nothing.data());
    glBindTextureUnit(0, palette_.get());
    glUseProgram(programs_.sphere.get());
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(3 * drawing.bodies.size()));
    if (drawing.planets) {
        glUseProgram(programs_.planet.get());
        glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(3 * drawing.bodies.size()));
    }
    draw_panels(drawing);
    draw_shapes(drawing.shapes);
    if (drawing.hollow) draw_hollow(*drawing.hollow);
    glDisable(GL_FRAMEBUFFER_SRGB);
    glDisable(GL_DEPTH_CLAMP);
}

void GlRenderer::draw_panels(const Drawing& drawing) {
    glUseProgram(programs_.panel.get());
    glEnable(GL_CULL_FACE);
    for (const Panel& panel : drawing.panels) {
        const std::array<float, 4> colour = linear(panel.colour);
        glUniform3fv(0, 1, &panel.corner.x);
        glUniform3fv(1, 1, &panel.side_u.x);
        glUniform3fv(2, 1, &panel.side_v.x);
        glUniform4fv(3, 1, colour.data());
        glUniform2f(4, panel.grid, panel.fading ? 1.0F : 0.0F);
        glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
    }
    glDisable(GL_CULL_FACE);
}

void GlRenderer::draw_hollow(const Hollow& hollow) {
    const std::array<float, 4> colour = linear(hollow.colour);
    glUseProgram(programs_.hollow.get());
    glUniform4f(0, hollow.centre.x, hollow.centre.y, hollow.centre.z, hollow.radius);
    glUniform4fv(1, 1, colour.data());
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void GlRenderer::draw_shapes(const Shapes& shapes) {
    const std::array<float, 4> colour = linear(shapes.colour);
    const auto plain = static_cast<GLsizei>(shapes.plain.size());
    glUseProgram(programs_.shape.get());
    glUniform3fv(0, 1, &shapes.anchor.x);
    glUniform4fv(1, 1, colour.data());
    glDrawArrays(GL_TRIANGLES, 0, plain);
    glEnable(GL_CULL_FACE);
    glCullFace(GL_FRONT);
    glDrawArrays(GL_TRIANGLES, plain, static_cast<GLsizei>(shapes.glass.size()));
    glCullFace(GL_BACK);
    glDisable(GL_CULL_FACE);
}

void GlRenderer::draw_glass(const Shapes& shapes) {
    if (shapes.glass.empty()) return;
    const std::array<float, 4> colour = linear(shapes.colour);
    begin_blending();
    glEnable(GL_CULL_FACE);
    glUseProgram(programs_.glass.get());
    glUniform3fv(0, 1, &shapes.anchor.x);
    glUniform4fv(1, 1, colour.data());
    glDrawArrays(GL_TRIANGLES, static_cast<GLint>(shapes.plain.size()), static_cast<GLsizei>(shapes.glass.size()));
    glDisable(GL_CULL_FACE);
    glDisable(GL_BLEND);
}

/// What follows is seen through, and hidden by what is in front of it.
void GlRenderer::begin_blending() {
    glBindFramebuffer(GL_FRAMEBUFFER, targets_->lighting.get());
    glViewport(0, 0, targets_->width, targets_->height);
    glDepthFunc(GL_GEQUAL);
    glDepthMask(GL_FALSE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
}

void GlRenderer::draw_screen(const ProgramHandle& program, const FramebufferHandle& target, int width, int height) {
    glBindFramebuffer(GL_FRAMEBUFFER, target.get());
    glViewport(0, 0, width, height);
    glDisable(GL_DEPTH_TEST);
    glUseProgram(program.get());
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

void GlRenderer::find_occlusion() {
    const PictureSize& size = targets_->size;
    glBindTextureUnit(0, targets_->depth.get());
    glBindTextureUnit(1, targets_->normal.get());
    draw_screen(programs_.occlusion, targets_->occluding, size.width, size.height);
    glBindTextureUnit(0, targets_->rough_occlusion.get());
    glBindTextureUnit(1, targets_->depth.get());
    draw_screen(programs_.blur, targets_->blurring, size.width, size.height);
}

void GlRenderer::light_surfaces() {
    glBindTextureUnit(0, targets_->albedo.get());
    glBindTextureUnit(1, targets_->normal.get());
    glBindTextureUnit(2, targets_->depth.get());
    glBindTextureUnit(3, targets_->occlusion.get());
    glBindTextureUnit(4, targets_->shadows.get());
    glDepthMask(GL_FALSE); // it reads the depths that hide lines later
    draw_screen(programs_.light, targets_->lighting, targets_->width, targets_->height);
}

void GlRenderer::draw_lines(const std::vector<Line>& lines, float scale) {
    if (lines.empty()) return;
    std::vector<LineBlock> blocks;
    blocks.reserve(lines.size());
    for (const Line& line : lines) {
        blocks.push_back({{line.from.x, line.from.y, line.from.z, line.width * scale},
                          {line.to.x, line.to.y, line.to.z, 0},
                          linear(line.colour_from),
                          linear(line.colour_to)});
    }
    lines_.update(blocks.data(), blocks.size() * sizeof(LineBlock));
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, lines_binding, lines_.handle.get());
    begin_blending();
    glUseProgram(programs_.line.get());
    glDrawArrays(GL_TRIANGLES, 0, static_cast<GLsizei>(6 * lines.size()));
    glDisable(GL_BLEND);
}

Image GlRenderer::picture() {
    return read_pixels(targets_->resolving.get(), targets_->size.width, targets_->size.height);
}

std::vector<float> GlRenderer::depths() {
    std::vector<float> values(static_cast<std::size_t>(targets_->width) * static_cast<std::size_t>(targets_->height));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, targets_->surfaces.get());
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, targets_->width, targets_->height, GL_DEPTH_COMPONENT, GL_FLOAT, values.data());
    turn_over(values, targets_->height);
    for (float& value : values) value = value > 0 ? near_ / value : std::numeric_limits<float>::infinity();
    return values;
}

void GlRenderer::count_errors() {
    while (glGetError() != GL_NO_ERROR) ++errors_;
}

void GlRenderer::copy_picture(GLuint framebuffer, int width, int height) {
    glDisable(GL_SCISSOR_TEST);
    glBlitNamedFramebuffer(targets_->resolving.get(), framebuffer, 0, 0, targets_->size.width, targets_->size.height, 0,
                           0, width, height, GL_COLOR_BUFFER_BIT, GL_LINEAR);
}

} // namespace gl

std::unique_ptr<Renderer> make_offscreen_renderer() {
    return std::make_unique<gl::GlRenderer>(gl::make_surfaceless_context());
}

} // namespace carom::viewer
