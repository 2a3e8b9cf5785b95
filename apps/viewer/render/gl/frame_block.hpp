/// \file
/// What all programs of a frame share: the block "Frame" of the shaders.
#pragma once

#include "viewer/render/gl/targets.hpp"
#include "viewer/render/matrix.hpp"
#include "viewer/render/renderer.hpp"

#include <array>

namespace carom::viewer::gl {

/// As std140 lays it out; shaders.cpp says what the members are.
struct FrameBlock {
    Matrix4 view;
    Matrix4 projection;
    Matrix4 light_view;
    Matrix4 light_projection;
    Matrix4 to_shadows;
    std::array<float, 4> to_light;
    std::array<float, 4> up;
    std::array<float, 4> sky;
    std::array<float, 4> ground;
    std::array<float, 4> size;
    std::array<float, 4> lens;
    std::array<float, 4> haze;
    std::array<float, 4> measure;
};
static_assert(sizeof(FrameBlock) == 5 * 64 + 8 * 16);

/// The linear value of what a screen shows as `value`.
float linear(float value);
std::array<float, 4> linear(const Colour& colour);

FrameBlock frame_block(const Drawing& drawing, const Targets& targets);

} // namespace carom::viewer::gl
