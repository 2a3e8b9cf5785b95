// What a frame costs: packed, sent and drawn, as the window does it.
#include "drawings.hpp"
#include "viewer/render/renderer.hpp"
#include "viewer/stage/version.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace carom::viewer {
namespace {

/// `count` balls that fill a cube and fly on.
Moment crowd(int count) {
    const int side = static_cast<int>(std::ceil(std::cbrt(count)));
    std::vector<float> radii(static_cast<std::size_t>(count), 0.4F);
    std::vector<BodyId> ids;
    Moment moment;
    moment.end = 1;
    for (int i = 0; i < count; ++i) {
        ids.push_back({.slot = static_cast<std::uint32_t>(i)});
        moment.position.push_back(site(i, side) - Vec3{1, 1, 1} * (0.5 * (side - 1)));
        moment.way.push_back({0.1F, 0, 0});
        moment.looks.push_back(look_of(PaletteRow::scale, static_cast<float>(i) / static_cast<float>(count)));
    }
    moment.ids = std::make_shared<const std::vector<BodyId>>(std::move(ids));
    moment.radii = std::make_shared<const std::vector<float>>(std::move(radii));
    moment.version = next_version();
    return moment;
}

TEST(Frames, CostSoMuch) {
    using Clock = std::chrono::steady_clock;
    const auto renderer = make_offscreen_renderer();
    constexpr PictureSize size{1280, 720, 1};
    for (const int count : {1'000, 100'000, 1'000'000}) {
        const Moment moment = crowd(count);
        Stage stage;
        const Ball ball = stage.to_see(moment);
        const Camera camera{ball.centre + unit(Vec3{0.45, -0.85, 0.38}) * (3 * ball.radius), ball.centre};
        // The first frame also makes what stays; reading a pixel of the picture waits until it is drawn.
        const auto frame = [&](double time) {
            renderer->draw(stage.draw(moment, time, camera), size);
            return renderer->picture();
        };
        const Image first = frame(0);
        const std::uint64_t sent = renderer->bytes_of_frames();
        const std::uint64_t kept = renderer->bytes_that_stay();
        Image last;
        int frames = 0;
        const auto start = Clock::now();
        while (frames == 0 || (frames < 60 && Clock::now() - start < std::chrono::seconds(1))) {
            last = frame(0.01 * ++frames);
        }
        const double seconds = std::chrono::duration<double>(Clock::now() - start).count() / frames;
        EXPECT_EQ(renderer->bytes_of_frames() - sent, 16U * static_cast<std::uint64_t>(count * frames));
        EXPECT_EQ(renderer->bytes_that_stay(), kept);
        EXPECT_NE(last.pixels, first.pixels);
        EXPECT_EQ(renderer->errors(), 0U);
        std::printf("figure: a frame of %d bodies at %dx%d takes %.1f ms with %s\n", count, size.width, size.height,
                    1e3 * seconds, renderer->device().c_str());
    }
}

} // namespace
} // namespace carom::viewer
