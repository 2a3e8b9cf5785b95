#include "viewer/film/image_legend.hpp"

#include "viewer/stage/palette.hpp"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace carom::viewer {

namespace {

/// Letters are those of Dear ImGui's font, as in the window.
class ImageCanvas final : public Canvas {
public:
    ImageCanvas(Image& image, float scale) : image_(image) {
        ImFontConfig config;
        config.SizePixels = line_height * scale;
        config.OversampleH = config.OversampleV = 1;
        config.PixelSnapH = true;
        font_ = atlas_.AddFontDefault(&config);
        atlas_.GetTexDataAsAlpha8(&coverage_, &coverage_width_, &coverage_height_);
    }

    void rectangle(float left, float top, float width, float height, const Colour& colour) override {
        const int right = rounded(left + width);
        const int bottom = rounded(top + height);
        for (int y = rounded(top); y < bottom; ++y) {
            for (int x = rounded(left); x < right; ++x) blend(x, y, colour, colour.opacity);
        }
    }

    void text(float left, float top, const std::string& line) override {
        for (const char letter : line) {
            const ImFontGlyph& glyph = *font_->FindGlyph(static_cast<ImWchar>(letter));
            draw(glyph, rounded(left + glyph.X0), rounded(top + glyph.Y0));
            left += glyph.AdvanceX;
        }
    }

    [[nodiscard]] float width_of(const std::string& line) const override {
        float width = 0;
        for (const char letter : line) width += font_->FindGlyph(static_cast<ImWchar>(letter))->AdvanceX;
        return width;
    }

private:
    static int rounded(float value) { return static_cast<int>(std::lround(value)); }

    void draw(const ImFontGlyph& glyph, int left, int top) {
        const int u = rounded(glyph.U0 * static_cast<float>(coverage_width_));
        const int v = rounded(glyph.V0 * static_cast<float>(coverage_height_));
        const int width = rounded(glyph.U1 * static_cast<float>(coverage_width_)) - u;
        const int height = rounded(glyph.V1 * static_cast<float>(coverage_height_)) - v;
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                const int place = (v + y) * coverage_width_ + u + x;
                blend(left + x, top + y, text_colour, static_cast<float>(coverage_[place]) / 255);
            }
        }
    }

    /// What is beyond the picture is left out.
    void blend(int x, int y, const Colour& colour, float opacity) {
        if (x < 0 || y < 0 || x >= image_.width || y >= image_.height) return;
        std::uint8_t* pixel = &image_.pixels[3 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(image_.width) +
                                                  static_cast<std::size_t>(x))];
        const auto mix = [&](std::uint8_t& below, float above) {
            below = static_cast<std::uint8_t>(std::lround(std::lerp(static_cast<float>(below), 255 * above, opacity)));
        };
        mix(pixel[0], colour.red);
        mix(pixel[1], colour.green);
        mix(pixel[2], colour.blue);
    }

    Image& image_;
    ImFontAtlas atlas_;
    ImFont* font_ = nullptr;
    unsigned char* coverage_ = nullptr; ///< of the letters, the atlas's
    int coverage_width_ = 0;
    int coverage_height_ = 0;
};

} // namespace

void add_legend(const Legend& legend, Image& image) {
    constexpr int usual_height = 720; // pixels
    // Whole numbers keep the letters sharp.
    const auto scale = static_cast<float>(std::max(image.height / usual_height, 1));
    const float margin = 10 * scale;
    ImageCanvas canvas(image, scale);
    draw_legend(legend, margin, static_cast<float>(image.height) - margin, scale, canvas);
}

} // namespace carom::viewer
