/// \file
/// The textures that a picture goes through, and the framebuffers that draw into them.
#pragma once

#include "viewer/render/gl/handles.hpp"
#include "viewer/render/renderer.hpp"

#include <initializer_list>

namespace carom::viewer::gl {

/// A framebuffer over textures; a depth of 0 means none.
FramebufferHandle make_target(std::initializer_list<GLuint> colours, GLuint depth);

/// For pictures of one size.
struct Targets {
    explicit Targets(const PictureSize& size);

    PictureSize size;
    int width;       ///< samples
    int height;      ///< samples
    int shadow_side; ///< texels

    TextureHandle shadows; ///< a square map of depths as seen from the light
    TextureHandle albedo;
    TextureHandle normal;
    TextureHandle depth;
    TextureHandle rough_occlusion; ///< by pixels, like the next
    TextureHandle occlusion;
    TextureHandle light; ///< linear
    TextureHandle shown; ///< by pixels, as a screen takes it

    FramebufferHandle shadowing;
    FramebufferHandle surfaces;
    FramebufferHandle occluding;
    FramebufferHandle blurring;
    FramebufferHandle lighting;
    FramebufferHandle resolving;
};

} // namespace carom::viewer::gl
