/// \file
/// The colours of pictures.
#pragma once

#include "viewer/render/drawing.hpp"

#include <cstdint>
#include <span>

namespace carom::viewer {

/// What Drawing::palette takes: a scale from little to much, materials, what never moves, and planets.
std::span<const Colour> palette();

/// Where the colour of a material is in its row; bodies of one material differ a little by `seed`.
float place_of_material(std::uint32_t material, std::uint32_t seed);

/// Of the scale from little (0) to much (1).
Colour scale_colour(float place);

inline constexpr Colour sky_colour{0.205F, 0.230F, 0.270F, 1};
inline constexpr Colour ground_colour{0.085F, 0.095F, 0.115F, 1};
inline constexpr Colour space_sky_colour{0.055F, 0.065F, 0.095F, 1}; ///< where nothing bounds the world
inline constexpr Colour space_ground_colour{0.020F, 0.022F, 0.035F, 1};
inline constexpr Colour panel_colour{0.36F, 0.38F, 0.41F, 1};
inline constexpr Colour obstacle_colour{0.47F, 0.46F, 0.43F, 1};
inline constexpr Colour obstacle_edge_colour{0.86F, 0.84F, 0.76F, 0.55F};
inline constexpr Colour outline_colour{0.75F, 0.80F, 0.88F, 0.45F};
inline constexpr Colour periodic_colour{0.45F, 0.75F, 1.0F, 0.55F};
inline constexpr Colour force_colour{1.0F, 0.80F, 0.35F, 0.9F};
inline constexpr Colour trail_colour{0.95F, 0.93F, 0.85F, 0.7F};
inline constexpr Colour text_colour{0.86F, 0.88F, 0.91F, 1};
inline constexpr Colour legend_colour{0.07F, 0.08F, 0.10F, 0.6F}; ///< behind text
inline constexpr Colour attractor_colour{1.0F, 0.85F, 0.45F, 0.9F};

} // namespace carom::viewer
