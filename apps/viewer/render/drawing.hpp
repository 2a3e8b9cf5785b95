/// \file
/// What a renderer draws: a description of one picture that knows of no graphics interface.
#pragma once

#include "viewer/render/matrix.hpp"

#include <carom/base.hpp>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace carom::viewer {

/// Red, green, blue and opacity, 0 to 1, as a screen shows them (sRGB).
struct Colour {
    float red = 1;
    float green = 1;
    float blue = 1;
    float opacity = 1;
};

struct Camera {
    Vec3 position{0, -1, 0}; ///< m
    Vec3 target{};           ///< m, differs from position
    Vec3 up{0, 0, 1};
    double field_of_view = 40; ///< degrees from the lower to the upper edge
};

/// How the last 32 bits of a PackedBody choose its colour: a row of Drawing::palette, and the place in it.
enum class PaletteRow : std::uint8_t { scale, materials, still, planet };
inline constexpr std::size_t palette_rows = 4;
inline constexpr std::size_t palette_columns = 256;

/// All that goes to the graphics card for a body in each frame.
struct PackedBody {
    float x = 0; ///< m, from Drawing::origin
    float y = 0;
    float z = 0;
    std::uint32_t look = 0; ///< of look_of()
};
static_assert(sizeof(PackedBody) == 16);

/// `place` in the palette's row and `glow` are from 0 to 1; what is beyond counts as the nearest of these.
inline std::uint32_t look_of(PaletteRow row, float place, float glow = 0) {
    const auto whole = [](float part, float most) {
        return static_cast<std::uint32_t>(std::clamp(part, 0.0F, 1.0F) * most);
    };
    return whole(place, 65535) | static_cast<std::uint32_t>(row) << 16U | whole(glow, 255) << 24U;
}

/// A line that is equally thick wherever it is.
struct Line {
    Vec3f from{}; ///< m, from Drawing::origin
    Vec3f to{};
    float width = 1; ///< in pixels of the picture
    Colour colour_from{};
    Colour colour_to{};
};

/// A rectangle of which one side is seen, with a grid on it.
struct Panel {
    Vec3f corner{}; ///< m, from Drawing::origin
    Vec3f side_u{}; ///< m; side_u x side_v points to the side that is seen
    Vec3f side_v{};
    Colour colour{};
    float grid = 0;      ///< m between the lines of its grid
    bool fading = false; ///< towards its edges: part of something without end
};

/// The inside of a sphere.
struct Hollow {
    Vec3f centre{}; ///< m, from Drawing::origin
    float radius = 1;
    Colour colour{};
};

/// A corner of a triangle.
struct Corner {
    Vec3f place{};  ///< m, from Shapes::anchor
    Vec3f normal{}; ///< of length 1, to the outside
};

/// Surfaces made of triangles: three corners each, counterclockwise as seen from outside.
struct Shapes {
    Vec3f anchor{};                  ///< m, from Drawing::origin
    std::span<const Corner> plain{}; ///< seen from both sides; throw shadows
    std::span<const Corner> glass{}; ///< seen from inside; from outside one looks through it, and so does the light
    std::uint64_t version = 0;       ///< another number whenever corners differ from those of the picture before
    Colour colour{};
};

/// One picture. Coordinates are relative to `origin`, so that single precision will do anywhere in the world.
struct Drawing {
    Camera camera{};
    Vec3 origin{}; ///< m, in the world
    std::span<const PackedBody> bodies{};
    std::span<const float> radii{};    ///< m, one for each body
    std::uint64_t radii_version = 0;   ///< another number whenever radii differ from those of the picture before
    bool planets = true;               ///< some bodies may be of PaletteRow::planet
    std::span<const Colour> palette{}; ///< palette_rows times palette_columns
    std::uint64_t palette_version = 0; ///< the same for the palette
    std::vector<Line> lines{};         ///< hidden by what is in front of them
    std::vector<Line> lines_on_top{};  ///< seen through everything
    float line_scale = 1;              ///< that widths of lines are multiplied by
    std::vector<Panel> panels{};
    std::optional<Hollow> hollow{};
    Shapes shapes{};
    Vec3f centre{};   ///< m, from Drawing::origin: a ball around all that throws shadows
    float extent = 1; ///< m, its radius
    Vec3f to_light{0.4F, -0.5F, 0.8F};
    float occlusion_distance = 1; ///< m, within which bodies keep the light of the sky from each other
    float smallest = 0.6F;        ///< pixels: bodies that would be smaller are drawn with this radius
    bool shadows = true;
    bool occlusion = true;
    Colour sky{};    ///< background at the upper edge
    Colour ground{}; ///< and at the lower one; what is far away fades into the background
};

} // namespace carom::viewer
