#include "viewer/stage/palette.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace carom::viewer {

namespace {

/// Colours at equal distances.
template <std::size_t Count>
using Ramp = std::array<Colour, Count>;

constexpr Ramp<6> scale{{{0.20F, 0.36F, 0.66F, 1},
                         {0.20F, 0.58F, 0.74F, 1},
                         {0.45F, 0.76F, 0.62F, 1},
                         {0.93F, 0.82F, 0.42F, 1},
                         {0.93F, 0.55F, 0.25F, 1},
                         {0.84F, 0.25F, 0.18F, 1}}};
constexpr std::size_t material_count = 8;
constexpr Ramp<material_count> materials{{{0.84F, 0.82F, 0.77F, 1},
                                          {0.38F, 0.60F, 0.76F, 1},
                                          {0.87F, 0.56F, 0.37F, 1},
                                          {0.52F, 0.70F, 0.43F, 1},
                                          {0.79F, 0.36F, 0.28F, 1},
                                          {0.58F, 0.51F, 0.74F, 1},
                                          {0.89F, 0.70F, 0.32F, 1},
                                          {0.38F, 0.66F, 0.64F, 1}}};
constexpr Ramp<2> still{{{0.50F, 0.52F, 0.55F, 1}, {0.68F, 0.60F, 0.46F, 1}}}; // static, kinematic
constexpr Ramp<5> planet{{{0.20F, 0.17F, 0.16F, 1},
                          {0.34F, 0.27F, 0.23F, 1},
                          {0.55F, 0.45F, 0.36F, 1},
                          {0.72F, 0.62F, 0.50F, 1},
                          {0.88F, 0.82F, 0.72F, 1}}};

Colour mixed(const Colour& a, const Colour& b, float part) {
    return {std::lerp(a.red, b.red, part), std::lerp(a.green, b.green, part), std::lerp(a.blue, b.blue, part), 1};
}

template <std::size_t Count>
Colour at(const Ramp<Count>& ramp, float place) {
    const float position = std::clamp(place, 0.0F, 1.0F) * static_cast<float>(Count - 1);
    const auto index = std::min(static_cast<std::size_t>(position), Count - 2);
    return mixed(ramp[index], ramp[index + 1], position - static_cast<float>(index));
}

Colour shaded(const Colour& colour, float brightness) {
    return {colour.red * brightness, colour.green * brightness, colour.blue * brightness, 1};
}

constexpr std::size_t columns_of_material = palette_columns / material_count;
/// How much darker than the brightest body of a material the darkest one is.
constexpr float darkest = 0.80F;

std::array<Colour, palette_rows * palette_columns> make_palette() {
    std::array<Colour, palette_rows * palette_columns> colours;
    for (std::size_t column = 0; column < palette_columns; ++column) {
        const float place = static_cast<float>(column) / static_cast<float>(palette_columns - 1);
        const float shade =
            static_cast<float>(column % columns_of_material) / static_cast<float>(columns_of_material - 1);
        const auto cell = [&](PaletteRow row) -> Colour& {
            return colours[static_cast<std::size_t>(row) * palette_columns + column];
        };
        cell(PaletteRow::scale) = at(scale, place);
        cell(PaletteRow::materials) = shaded(materials[column / columns_of_material], std::lerp(darkest, 1.0F, shade));
        cell(PaletteRow::still) = at(still, place);
        cell(PaletteRow::planet) = at(planet, place);
    }
    return colours;
}

} // namespace

std::span<const Colour> palette() {
    static const std::array colours = make_palette();
    return colours;
}

float place_of_material(std::uint32_t material, std::uint32_t seed) {
    // The outermost columns of a material would be mixed with those of its neighbours.
    constexpr std::size_t shades = columns_of_material - 2;
    const std::uint32_t scattered = seed * 2654435769U >> 16U; // Fibonacci hashing
    const std::size_t column = (material % material_count) * columns_of_material + 1 + scattered % shades;
    return static_cast<float>(column) / static_cast<float>(palette_columns - 1);
}

Colour scale_colour(float place) { return at(scale, place); }

} // namespace carom::viewer
