// How pictures look: light, shadows, haze, lines and surfaces; against a picture that was looked at, with a tolerance.
#include "drawings.hpp"
#include "reference.hpp"
#include "viewer/film/png.hpp"
#include "viewer/render/gl/context.hpp"
#include "viewer/render/gl/program.hpp"
#include "viewer/render/renderer.hpp"
#include "viewer/stage/obstacle_shapes.hpp"

#include <carom/base.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace carom::viewer {
namespace {

int brightness(const Image& image, int x, int y) {
    const std::uint8_t* pixel = image.at(x, y);
    return pixel[0] + pixel[1] + pixel[2];
}

/// A floor that is seen from straight above, with the light from above too.
TestDrawing floor_seen_from_above(std::vector<Sphere> spheres) {
    TestDrawing drawing(std::move(spheres), {{0, 0, 20}, {0, 0, 0}, {0, 1, 0}, 40});
    drawing.picture.panels.push_back({{-9, -9, 0}, {18, 0, 0}, {0, 18, 0}, panel_colour, 100, false});
    drawing.picture.to_light = {0, 0, 1};
    drawing.picture.extent = 12;
    return drawing;
}

class Pictures : public testing::Test {
protected:
    Image draw(const Drawing& drawing, const PictureSize& size = {100, 100, 1}) {
        renderer_->draw(drawing, size);
        EXPECT_EQ(renderer_->errors(), 0U);
        return renderer_->picture();
    }

    std::unique_ptr<Renderer> renderer_ = make_offscreen_renderer();
};

TEST_F(Pictures, NothingIsTheBackground) {
    const Image image = draw(TestDrawing({}, {}).finished());
    EXPECT_NEAR(image.at(50, 0)[2], 255 * sky_colour.blue, 2);
    EXPECT_NEAR(image.at(50, 99)[2], 255 * ground_colour.blue, 2);
}

TEST_F(Pictures, ShadowsFallOnTheFloor) {
    // A sphere five metres up, and light that comes aslant: its shadow lies five metres to the side.
    TestDrawing drawing = floor_seen_from_above({{{0, 0, 5}, 1}});
    drawing.picture.to_light = {-1, 0, 1};
    const Image without = draw(drawing.finished());
    drawing.picture.shadows = true;
    const Image with = draw(drawing.finished());
    const int in_shadow = 50 + static_cast<int>(5 / (20 * std::tan(0.349066)) * 50);
    EXPECT_LT(brightness(with, in_shadow, 50), 0.7 * brightness(without, in_shadow, 50));
    EXPECT_EQ(brightness(with, 100 - in_shadow, 50), brightness(without, 100 - in_shadow, 50));
}

TEST_F(Pictures, CornersAreDarker) {
    TestDrawing drawing = floor_seen_from_above({{{-1, 0, 1}, 1}, {{1, 0, 1}, 1}});
    drawing.picture.camera = {{0, -14, 12}, {0, 0, 0}, {0, 0, 1}, 30};
    const Image without = draw(drawing.finished());
    drawing.picture.occlusion = true;
    drawing.picture.occlusion_distance = 2;
    const Image with = draw(drawing.finished());
    const auto loss = [&](int x, int y) { return 1.0 - 1.0 * brightness(with, x, y) / brightness(without, x, y); };
    // Where the spheres turn to the floor; single pixels are grainy.
    const auto mean_loss = [&](int x) {
        return (loss(x, 51) + loss(x + 1, 51) + loss(x + 2, 51) + loss(x + 3, 51)) / 4;
    };
    EXPECT_GT(mean_loss(40), 0.15);
    EXPECT_GT(mean_loss(58), 0.15);
    EXPECT_LT(loss(40, 35), 0.03); // the top of a sphere
    // The floor away from them, but for a rounding of each colour.
    EXPECT_NEAR(brightness(with, 50, 90), brightness(without, 50, 90), 3);
}

TEST_F(Pictures, WhatIsFarFadesIntoTheBackground) {
    TestDrawing drawing({{{-2, -9, 0}, 1}, {{5, 9, 0}, 1}}, {{0, -25, 0}, {0, 0, 0}});
    const Image image = draw(drawing.finished());
    EXPECT_GT(brightness(image, 34, 46), brightness(image, 67, 48) + 60);
}

TEST_F(Pictures, LinesAreHiddenUnlessTheyAreOnTop) {
    const Colour red{1, 0, 0, 1};
    TestDrawing drawing({{{0, 0, 0}, 1}}, {{0, -5, 0}, {0, 0, 0}});
    drawing.picture.lines.push_back({{-3, 2, 0.01F}, {3, 2, 0.01F}, 3, red, red});
    const auto redness = [&](const Image& image, int x) { return image.at(x, 49)[0] - image.at(x, 49)[2]; };
    Image image = draw(drawing.finished());
    EXPECT_LT(redness(image, 50), 60);
    EXPECT_GT(redness(image, 3), 100);
    std::swap(drawing.picture.lines, drawing.picture.lines_on_top);
    image = draw(drawing.finished());
    EXPECT_GT(redness(image, 50), 100);
    drawing.picture.line_scale = 0.5F;
    drawing.picture.lines_on_top.front().width = 6;
    EXPECT_EQ(draw(drawing.finished()).pixels, image.pixels);
    // Behind the camera, and across its plane.
    drawing.picture.lines_on_top = {{{0, -9, 0}, {1, -12, 0}, 3, red, red},
                                    {{0.2F, -12, 0}, {0.2F, 3, 0}, 3, red, red}};
    draw(drawing.finished());
}

TEST_F(Pictures, LookAsTheyDid) {
    TestDrawing drawing({}, {{5, -9, 5.5}, {0, 0, 0}, {0, 0, 1}, 35});
    for (int i = 0; i < 27; ++i) {
        drawing.spheres.push_back(
            {site(i, 3) + Vec3{-1.5, -1, 0.5}, 0.5, PaletteRow::scale, static_cast<float>(i) / 26});
    }
    for (int i = 0; i < 8; ++i) {
        drawing.spheres.push_back({{0.7 * i - 2.5, -2.2, 0.3},
                                   0.3,
                                   PaletteRow::materials,
                                   place_of_material(static_cast<std::uint32_t>(i), 1)});
    }
    drawing.spheres.push_back({{2.6, 0.5, 1}, 1, PaletteRow::planet});
    Drawing& picture = drawing.picture;
    picture.shadows = true;
    picture.occlusion = true;
    picture.occlusion_distance = 1;
    picture.extent = 6;
    picture.panels.push_back({{-4, -4, 0}, {8, 0, 0}, {0, 8, 0}, panel_colour, 1, true});
    picture.panels.push_back({{-4, 3, 0}, {8, 0, 0}, {0, 0, 3}, panel_colour, 1, false});
    picture.lines.push_back({{-4, -3, 1}, {4, 3, 1}, 2, trail_colour, {1, 1, 1, 0}});
    picture.lines_on_top.push_back({{0, 0, 0}, {0, 0, 2.5F}, 3, force_colour, force_colour});
    expect_like_reference(draw(drawing.finished(), {240, 160, 2}), "renderer.png");
}

TEST_F(Pictures, ShellsAreSeenFromInsideAndOutside) {
    TestDrawing drawing({{{0, 0, -3}, 1}}, {{0, -14, 3}, {0, 0, 0}});
    drawing.picture.hollow = Hollow{{0, 0, 0}, 4, panel_colour};
    expect_like_reference(draw(drawing.finished(), {120, 80, 2}), "shell.png");
    drawing.picture.camera.position = {0, -3, 0};
    draw(drawing.finished());
    for (const float depth : renderer_->depths()) EXPECT_LT(depth, 7.01F);
}

/// A tube of glass along z, from -2 to 2.
std::vector<Corner> tube() {
    constexpr int sides = 360;
    std::vector<Corner> corners;
    const auto at = [](int i, float z) {
        const auto angle = static_cast<float>(i) * 0.0174532925F;
        const Vec3f out{std::cos(angle), std::sin(angle), 0};
        return Corner{out + Vec3f{0, 0, z}, out};
    };
    for (int i = 0; i < sides; ++i) {
        for (const Corner& corner : {at(i, -2), at(i + 1, -2), at(i + 1, 2), at(i, -2), at(i + 1, 2), at(i, 2)}) {
            corners.push_back(corner);
        }
    }
    return corners;
}

TEST_F(Pictures, GlassIsLookedThroughFromOutsideAndSeenFromInside) {
    const std::vector<Corner> corners = tube();
    TestDrawing drawing({{{0, 0, 0}, 0.5}}, {{0, -6, 0}, {0, 0, 0}});
    const Image alone = draw(drawing.finished());
    drawing.picture.shapes = {{0, 0, 0}, {}, corners, 1, obstacle_colour};
    const Image in_tube = draw(drawing.finished());
    const std::vector<float> depths = renderer_->depths();
    const auto depth = [&](int x, int y) { return depths.at(static_cast<std::size_t>(100 * y + x)); };
    // Half the height is 6 tan 20 degrees = 2.18 m at the middle; of the tube the wall behind is seen.
    EXPECT_NEAR(depth(50, 50), 5.5, 0.01);
    EXPECT_NEAR(depth(50, 80), 7, 0.01);
    EXPECT_TRUE(std::isinf(depth(5, 50)));
    // Through it the ball is nearly as bright as without.
    EXPECT_NEAR(brightness(in_tube, 50, 50), brightness(alone, 50, 50), 40);
    EXPECT_NE(in_tube.pixels, alone.pixels);
    drawing.picture.camera = {{0, -0.8, 0}, {0, 0, 0}};
    draw(drawing.finished());
    for (const float seen : renderer_->depths()) EXPECT_LT(seen, 1.81F);
}

TEST_F(Pictures, PlainShapesHideFromBothSidesAndComeAnewWithTheirVersion) {
    const std::vector<Corner> wall{{{-9, 0, -9}, {0, -1, 0}}, {{9, 0, -9}, {0, -1, 0}}, {{0, 0, 12}, {0, -1, 0}}};
    std::vector<Corner> nearer = wall;
    for (Corner& corner : nearer) corner.place.y = -1;
    TestDrawing drawing({{{0, 2, 0}, 0.5}}, {{0, -6, 0}, {0, 0, 0}});
    drawing.picture.shapes = {{0, 0.5F, 0}, wall, {}, 1, obstacle_colour};
    draw(drawing.finished());
    EXPECT_NEAR(renderer_->depths().at(5050), 6.5, 0.01);
    drawing.picture.shapes = {{0, 0.5F, 0}, nearer, {}, 2, obstacle_colour};
    const Image before = draw(drawing.finished());
    EXPECT_NEAR(renderer_->depths().at(5050), 5.5, 0.01);
    drawing.picture.camera.position = {0, 4, 0};
    drawing.picture.to_light = {0.4F, 0.5F, 0.8F}; // as from the other side
    const Image behind = draw(drawing.finished());
    EXPECT_NEAR(renderer_->depths().at(5050), 1.5, 0.01); // the ball, which is before the wall now
    EXPECT_NEAR(brightness(behind, 10, 50), brightness(before, 89, 50), 12);
}

/// A square of 2 m around the origin, tilted by `slope` (rad) about y.
std::vector<Corner> plate(float slope) {
    const Vec3f u{std::cos(slope), 0, std::sin(slope)};
    const Vec3f normal{-u.z, 0, u.x};
    const auto at = [&](float x, float y) { return Corner{u * x + Vec3f{0, y, 0}, normal}; };
    return {at(-1, -1), at(1, -1), at(1, 1), at(-1, -1), at(1, 1), at(-1, 1)};
}

TEST_F(Pictures, PlainShapesThrowShadowsAndGlassThrowsNone) {
    TestDrawing drawing = floor_seen_from_above({});
    drawing.picture.to_light = {-1, 0, 1};
    const int in_shadow = 50 + static_cast<int>(5 / (20 * std::tan(0.349066)) * 50);
    std::uint64_t version = 0;
    for (const float slope : {-1.2F, -0.4F, 0.0F, 0.4F, 0.7F}) {
        const std::vector<Corner> corners = plate(slope);
        for (const bool glass : {false, true}) {
            drawing.picture.shapes = {{0, 0, 5}, corners, {}, ++version, obstacle_colour};
            if (glass) std::swap(drawing.picture.shapes.plain, drawing.picture.shapes.glass);
            drawing.picture.shadows = false;
            const Image without = draw(drawing.finished());
            drawing.picture.shadows = true;
            const Image with = draw(drawing.finished());
            if (glass) {
                EXPECT_EQ(with.pixels, without.pixels);
                continue;
            }
            EXPECT_LT(brightness(with, in_shadow, 50), 0.7 * brightness(without, in_shadow, 50)) << slope;
            // It throws none onto itself.
            for (int x = 0; x < in_shadow - 20; ++x) {
                EXPECT_EQ(brightness(with, x, 50), brightness(without, x, 50)) << slope << " " << x;
            }
        }
    }
}

TEST_F(Pictures, ObstaclesLookAsTheyDid) {
    const std::vector<Obstacle> obstacles{
        Frustum{{0, 0, 0.6}, {0, 0, 1}, 1, 0.4, 1.5}, Frustum{{0, 0, 1.6}, {0, 0, 1}, 1.2, 1.5, 1.5},
        Mesh{{{-3, -3, 0}, {3, -3, 0}, {3, 1, 0}, {-3, 1, 0}, {-3, 3, 1.5}, {3, 3, 1.5}},
             {{{0, 1, 2}}, {{0, 2, 3}}, {{3, 2, 5}}, {{3, 5, 4}}}}};
    const ObstacleShapes shapes(obstacles);
    TestDrawing drawing({}, {{3.5, -8, 5}, {0, 0, 1}, {0, 0, 1}, 35});
    for (int i = 0; i < 60; ++i) {
        drawing.spheres.push_back({site(i, 4) * 0.4 + Vec3{-0.6, -0.6, 1.4}, 0.2});
    }
    Drawing& picture = drawing.picture;
    picture.shadows = picture.occlusion = true;
    picture.occlusion_distance = 0.5;
    picture.extent = 6;
    picture.shapes = shapes.shapes(picture.origin);
    for (const auto& edges : {shapes.edges(), shapes.meridians(0)}) {
        for (const auto& [from, to] : edges) {
            picture.lines.push_back({narrow(from - picture.origin), narrow(to - picture.origin), 1.2F,
                                     obstacle_edge_colour, obstacle_edge_colour});
        }
    }
    expect_like_reference(draw(drawing.finished(), {240, 160, 2}), "obstacles.png");
}

TEST_F(Pictures, SizesFromOnePixelToTheLargest) {
    TestDrawing drawing({{{0, 0, 0}, 1}}, {{0, -5, 0}, {0, 0, 0}});
    drawing.picture.shadows = drawing.picture.occlusion = true;
    EXPECT_EQ(draw(drawing.finished(), {1, 1, 1}).pixels.size(), 3U);
    EXPECT_EQ(draw(drawing.finished(), {1, 70, 3}).height, 70);
    EXPECT_EQ(draw(drawing.finished(), {33, 1, 8}).width, 33);
    for (const PictureSize size : {PictureSize{0, 1, 1},
                                   {1, -1, 1},
                                   {1, 1, 0},
                                   {renderer_->largest_side() + 1, 1, 1},
                                   {1, renderer_->largest_side() / 2 + 1, 2}}) {
        EXPECT_THROW(renderer_->draw(drawing.finished(), size), Error);
    }
}

TEST_F(Pictures, TheSameDrawingGivesTheSamePixels) {
    TestDrawing drawing({{{0, 0, 0}, 1}, {{1, 0.5, 0.5}, 1}}, {{0, -5, 0}, {0, 0, 0}});
    drawing.picture.shadows = drawing.picture.occlusion = true;
    const Image first = draw(drawing.finished());
    EXPECT_EQ(draw(drawing.finished()).pixels, first.pixels);
    renderer_ = nullptr;
    renderer_ = make_offscreen_renderer();
    EXPECT_EQ(draw(drawing.finished()).pixels, first.pixels);
}

TEST(Shaders, ThatDoNotCompileOrFitAreNamed) {
    const auto context = gl::make_surfaceless_context();
    constexpr const char* vertex = "#version 450 core\nvoid main() { gl_Position = vec4(0); }";
    const auto refused = [&](const char* fragment) -> std::string {
        try {
            gl::make_program("marble", {vertex}, {fragment});
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::not_available);
            return error.what();
        }
        return "";
    };
    const std::string broken = refused("#version 450 core\nvoid main() { nonsense; }");
    EXPECT_NE(broken.find("does not compile the fragment shader 'marble'"), std::string::npos) << broken;
    EXPECT_NE(broken.find("nonsense"), std::string::npos) << broken;
    const std::string unfit =
        refused("#version 450 core\nin vec3 missing; out vec4 colour; void main() { colour = missing.xyzz; }");
    EXPECT_NE(unfit.find("does not link the shader 'marble'"), std::string::npos) << unfit;
}

TEST(Png, ComesBackAsItWas) {
    Image image{3, 2, {}};
    for (int i = 0; i < 18; ++i) image.pixels.push_back(static_cast<std::uint8_t>(14 * i));
    const Image back = from_png(to_png(image));
    EXPECT_EQ(back.width, 3);
    EXPECT_EQ(back.pixels, image.pixels);
    EXPECT_THROW(from_png({}), Error);
    std::vector<std::byte> cut = to_png(image);
    cut.resize(cut.size() / 2);
    EXPECT_THROW(from_png(cut), Error);
}

} // namespace
} // namespace carom::viewer
