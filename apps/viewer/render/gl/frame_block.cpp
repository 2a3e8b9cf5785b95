#include "viewer/render/gl/frame_block.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace carom::viewer::gl {

namespace {

/// Of a matrix that turns and moves.
Matrix4 inverse(const Matrix4& m) {
    const Vec3f moved{m[12], m[13], m[14]};
    const auto back = [&](std::size_t axis) {
        return -dot(Vec3f{m[4 * axis], m[4 * axis + 1], m[4 * axis + 2]}, moved);
    };
    return {m[0], m[4], m[8], 0, m[1], m[5], m[9], 0, m[2], m[6], m[10], 0, back(0), back(1), back(2), 1};
}

std::array<float, 4> turned(const Matrix4& m, const Vec3f& v, float w) {
    return {m[0] * v.x + m[4] * v.y + m[8] * v.z, m[1] * v.x + m[5] * v.y + m[9] * v.z,
            m[2] * v.x + m[6] * v.y + m[10] * v.z, w};
}

/// What is behind the scene has lost so much of its colour to the background.
constexpr float most_haze = 0.75F;
constexpr float haze_through_scene = 0.5F;

} // namespace

float linear(float value) { return value <= 0.04045F ? value / 12.92F : std::pow((value + 0.055F) / 1.055F, 2.4F); }

std::array<float, 4> linear(const Colour& colour) {
    return {linear(colour.red), linear(colour.green), linear(colour.blue), colour.opacity};
}

FrameBlock frame_block(const Drawing& drawing, const Targets& targets) {
    FrameBlock block{};
    const Vec3f eye = narrow(drawing.camera.position - drawing.origin);
    const Vec3f up = unit(narrow(drawing.camera.up));
    block.view = look_at(eye, narrow(drawing.camera.target - drawing.origin), up);

    const auto width = static_cast<float>(targets.width);
    const auto height = static_cast<float>(targets.height);
    const float field_of_view = static_cast<float>(drawing.camera.field_of_view) * std::numbers::pi_v<float> / 180;
    const float half_height = std::tan(field_of_view / 2);
    const float away = length(eye - drawing.centre);
    const float near = 1e-6F * (away + drawing.extent);
    block.projection = perspective(field_of_view, width / height, near);

    const Vec3f to_light = unit(drawing.to_light);
    block.light_view = look_at(drawing.centre, drawing.centre - to_light, up);
    block.light_projection = orthographic(drawing.extent);
    block.to_shadows = block.light_projection * block.light_view * inverse(block.view);
    block.to_light = turned(block.view, to_light, drawing.shadows ? 1.0F : 0.0F);
    block.up = turned(block.view, up, drawing.occlusion ? 1.0F : 0.0F);
    block.sky = linear(drawing.sky);
    block.ground = linear(drawing.ground);

    const float sample = 2 * half_height / height;
    const auto supersample = static_cast<float>(targets.size.supersample);
    block.size = {width, height, 1 / width, 1 / height};
    block.lens = {half_height * width / height, half_height, near, supersample};
    block.haze = {std::max(away - drawing.extent, 0.0F), haze_through_scene / (2 * drawing.extent), most_haze, 0};
    block.measure = {sample, drawing.smallest * supersample * sample, drawing.occlusion_distance,
                     2 * drawing.extent / static_cast<float>(targets.shadow_side)};
    return block;
}

} // namespace carom::viewer::gl
