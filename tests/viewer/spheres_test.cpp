// What the renderer draws of spheres is what rays meet that are computed one by one: silhouettes and depths.
#include "drawings.hpp"
#include "viewer/render/renderer.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

namespace carom::viewer {
namespace {

/// A ray of the camera, and how much longer it is than its depth.
struct Ray {
    Vec3 direction{}; ///< unit
    double per_depth = 1;
};

/// The basis of a camera, by the definition of it: back, right and up.
class Eye {
public:
    Eye(const Camera& camera, int width, int height) : camera_(camera), width_(width), height_(height) {
        back_ = unit(camera.position - camera.target);
        right_ = unit(cross(camera.up, back_));
        up_ = cross(back_, right_);
    }
    /// Through the middle of a pixel, counted from the upper left.
    [[nodiscard]] Ray ray(int x, int y) const {
        const double half = std::tan(camera_.field_of_view * std::numbers::pi / 360);
        const double across = (2 * (x + 0.5) / width_ - 1) * half * width_ / height_;
        const double along = (1 - 2 * (y + 0.5) / height_) * half;
        const Vec3 way = right_ * across + up_ * along - back_;
        return {unit(way), length(way)};
    }

private:
    Camera camera_;
    int width_;
    int height_;
    Vec3 back_, right_, up_;
};

struct Hit {
    double depth = std::numeric_limits<double>::infinity();
    double tolerance = 0;
    bool at_edge = false; ///< single precision cannot tell whether the ray meets a sphere there
};

/// The nearest point of the spheres that is in front of the camera. Single precision keeps the camera's coordinates of
/// a centre to a few roundings of its distance D, so the square of half the chord to 2 r D 2^-21, and half the chord
/// itself to the change that this makes of its root; a few more roundings are those of the sum of the distances.
Hit nearest(const Ray& ray, const Vec3& eye, const std::vector<Sphere>& spheres) {
    Hit hit;
    for (const Sphere& sphere : spheres) {
        const Vec3 centre = sphere.centre - eye;
        const double middle = dot(centre, ray.direction);
        const double half_chord2 = sphere.radius * sphere.radius - length_squared(centre - ray.direction * middle);
        const double error2 = 2 * sphere.radius * length(centre) * 0x1p-21;
        const bool edge = std::abs(half_chord2) < error2;
        if (half_chord2 < 0 && !edge) continue;
        const double half_chord = std::sqrt(std::max(half_chord2, 0.0));
        const double travel = middle > half_chord ? middle - half_chord : middle + half_chord;
        if (travel <= 0) continue;
        const double error =
            std::sqrt(half_chord * half_chord + error2) - half_chord + (length(centre) + travel) * 0x1p-21;
        const double depth = travel / ray.per_depth;
        if (edge && depth < hit.depth + hit.tolerance) hit.at_edge = true;
        if (edge || depth >= hit.depth) continue;
        hit = {depth, error / ray.per_depth, hit.at_edge};
    }
    return hit;
}

void expect_spheres(Renderer& renderer, const std::vector<Sphere>& spheres, const Camera& camera) {
    constexpr int width = 160;
    constexpr int height = 120;
    TestDrawing drawing(spheres, camera);
    drawing.picture.smallest = 0;
    renderer.draw(drawing.finished(), {width, height, 1});
    const std::vector<float> depths = renderer.depths();
    const Eye eye(camera, width, height);
    int covered = 0;
    int unclear = 0;
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            const Hit hit = nearest(eye.ray(x, y), camera.position, spheres);
            const double depth = depths[static_cast<std::size_t>(y * width + x)];
            if (hit.at_edge) {
                ++unclear;
            } else if (std::isinf(hit.depth)) {
                ASSERT_TRUE(std::isinf(depth)) << x << " " << y;
            } else {
                ASSERT_NEAR(depth, hit.depth, hit.tolerance) << x << " " << y;
                ++covered;
            }
        }
    }
    EXPECT_GT(covered, 100);
    EXPECT_LT(unclear, covered / 20);
    EXPECT_EQ(renderer.errors(), 0U);
}

class Spheres : public testing::Test {
protected:
    std::unique_ptr<Renderer> renderer_ = make_offscreen_renderer();
};

TEST_F(Spheres, InTheMiddleAtTheSideAndNear) {
    expect_spheres(*renderer_, {{{0, 0, 0}, 1}}, {{0, -5, 0}, {0, 0, 0}});
    expect_spheres(*renderer_, {{{2.5, 0, 1.2}, 1}, {{-3, 1, -1}, 0.7}}, {{0, -5, 0}, {0, 0, 0}, {0, 0, 1}, 70});
    expect_spheres(*renderer_, {{{0, 0, 0}, 1}}, {{0.3, -1.0001, 0.1}, {0, 0, 0}, {0, 0, 1}, 90});
}

TEST_F(Spheres, ThatReachBehindTheCamera) {
    expect_spheres(*renderer_, {{{3, 0, 0}, 2.9}}, {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 100});
    expect_spheres(*renderer_, {{{0, 2, -50}, 49.5}}, {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}, 60});
}

TEST_F(Spheres, FromInside) { expect_spheres(*renderer_, {{{0.2, 0.1, 0}, 3}}, {{0, 0, 0}, {1, 1, 0}, {0, 0, 1}, 60}); }

TEST_F(Spheres, ThatHideAndCutEachOther) {
    std::mt19937 random(20101127);
    const auto between = [&](double low, double high) {
        return low + (high - low) * static_cast<double>(random()) / 4294967295.0;
    };
    std::vector<Sphere> spheres;
    spheres.reserve(300);
    for (int i = 0; i < 300; ++i) {
        spheres.push_back({{between(-5, 5), between(-5, 5), between(-5, 5)}, between(0.1, 0.9)});
    }
    expect_spheres(*renderer_, spheres, {{9, -11, 6}, {0, 0, 0}, {0, 0, 1}, 45});
}

TEST_F(Spheres, OfAllSizesAtOnce) {
    expect_spheres(*renderer_,
                   {{{0, 0, -1000.5}, 1000}, {{0, 0, 0}, 0.5}, {{0.7, 0.1, 0}, 0.01}, {{0, 4000, 300}, 900}},
                   {{1.5, -4, 1}, {0, 0, 0.3}, {0, 0, 1}, 50});
}

TEST_F(Spheres, FarFromTheOriginOfTheWorld) {
    const Vec3 there{3e6, -2e6, 1e6};
    expect_spheres(*renderer_, {{there, 1}, {there + Vec3{1.5, 0, 0.5}, 0.5}}, {there + Vec3{0, -6, 2}, there});
}

TEST_F(Spheres, AMillionGoToTheCardAs16BytesEach) {
    constexpr std::size_t count = 1'000'000;
    Moment moment;
    moment.begin = 0;
    moment.end = 1;
    std::vector<float> radii(count, 0.4F);
    for (std::size_t i = 0; i < count; ++i) {
        const auto at = [&](std::size_t part) { return static_cast<double>(i / part % 100) - 49.5; };
        moment.position.push_back({at(1), at(100), at(10000)});
        moment.way.push_back({0.1F, 0, 0});
        moment.looks.push_back(look_of(PaletteRow::scale, static_cast<float>(i) / count));
    }
    std::vector<PackedBody> packed;
    pack(moment, 0.5, {}, std::nullopt, packed); // makes room
    const auto start = std::chrono::steady_clock::now();
    pack(moment, 0.5, {}, std::nullopt, packed);
    const auto packing = std::chrono::steady_clock::now() - start;

    TestDrawing drawing({}, {{0, -200, 100}, {0, 0, 0}});
    drawing.picture.bodies = packed;
    drawing.picture.radii = radii;
    constexpr std::uint64_t frames = 2;
    for (std::uint64_t frame = 0; frame < frames; ++frame) renderer_->draw(drawing.picture, {160, 90, 1});
    EXPECT_EQ(renderer_->bytes_of_frames(), frames * 16 * count);
    EXPECT_EQ(renderer_->bytes_that_stay(), sizeof(float) * count);
    EXPECT_EQ(renderer_->errors(), 0U);
    std::printf("figure: 1 000 000 bodies for a frame: packed in %.1f ns and sent in 16 bytes each\n",
                std::chrono::duration<double, std::nano>(packing).count() / count);
}

TEST_F(Spheres, BodiesTooSmallToSeeAreDots) {
    TestDrawing drawing({{{0, 0, 0}, 1e-6}}, {{0, -5, 0}, {0, 0, 0}});
    drawing.picture.smallest = 0.75F;
    renderer_->draw(drawing.finished(), {64, 64, 1});
    const std::vector<float> depths = renderer_->depths();
    EXPECT_EQ(std::count_if(depths.begin(), depths.end(), [](float depth) { return !std::isinf(depth); }), 4);
}

} // namespace
} // namespace carom::viewer
