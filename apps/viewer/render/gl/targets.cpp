#include "viewer/render/gl/targets.hpp"

#include <carom/base.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

namespace carom::viewer::gl {

namespace {

/// A power of two: more texels than the picture has samples from side to side, up to where they would cost too much.
int shadow_side_for(int samples) {
    constexpr unsigned least = 256;
    constexpr unsigned most = 2048;
    return static_cast<int>(std::clamp(std::bit_ceil(static_cast<unsigned>(samples) * 3 / 2), least, most));
}

TextureHandle make_shadow_map(int side) {
    TextureHandle map = make_texture(GL_DEPTH_COMPONENT32F, side, side, GL_LINEAR);
    glTextureParameteri(map.get(), GL_TEXTURE_COMPARE_MODE, GL_COMPARE_REF_TO_TEXTURE);
    glTextureParameteri(map.get(), GL_TEXTURE_COMPARE_FUNC, GL_GEQUAL);
    // Beyond its edges all is in the light.
    constexpr std::array<float, 4> farthest{};
    glTextureParameteri(map.get(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_BORDER);
    glTextureParameteri(map.get(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_BORDER);
    glTextureParameterfv(map.get(), GL_TEXTURE_BORDER_COLOR, farthest.data());
    return map;
}

} // namespace

FramebufferHandle make_target(std::initializer_list<GLuint> colours, GLuint depth) {
    FramebufferHandle target = make_framebuffer();
    std::vector<GLenum> attachments;
    for (const GLuint colour : colours) {
        attachments.push_back(GL_COLOR_ATTACHMENT0 + static_cast<GLenum>(attachments.size()));
        glNamedFramebufferTexture(target.get(), attachments.back(), colour, 0);
    }
    if (depth != 0) glNamedFramebufferTexture(target.get(), GL_DEPTH_ATTACHMENT, depth, 0);
    if (attachments.empty()) attachments.push_back(GL_NONE);
    glNamedFramebufferDrawBuffers(target.get(), static_cast<GLsizei>(attachments.size()), attachments.data());
    if (glCheckNamedFramebufferStatus(target.get(), GL_DRAW_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
        throw Error(ErrorCode::not_available, "OpenGL", "the driver does not draw into the textures of the picture");
    }
    return target;
}

Targets::Targets(const PictureSize& asked_for)
    : size(asked_for), width(size.width * size.supersample), height(size.height * size.supersample),
      shadow_side(shadow_side_for(std::max(width, height))), shadows(make_shadow_map(shadow_side)),
      albedo(make_texture(GL_SRGB8_ALPHA8, width, height, GL_NEAREST)),
      normal(make_texture(GL_RGBA16F, width, height, GL_NEAREST)),
      depth(make_texture(GL_DEPTH_COMPONENT32F, width, height, GL_NEAREST)),
      rough_occlusion(make_texture(GL_R8, size.width, size.height, GL_NEAREST)),
      occlusion(make_texture(GL_R8, size.width, size.height, GL_LINEAR)),
      light(make_texture(GL_RGBA16F, width, height, GL_NEAREST)),
      shown(make_texture(GL_RGBA8, size.width, size.height, GL_LINEAR)), shadowing(make_target({}, shadows.get())),
      surfaces(make_target({albedo.get(), normal.get()}, depth.get())),
      occluding(make_target({rough_occlusion.get()}, 0)), blurring(make_target({occlusion.get()}, 0)),
      lighting(make_target({light.get()}, depth.get())), resolving(make_target({shown.get()}, 0)) {}

} // namespace carom::viewer::gl
