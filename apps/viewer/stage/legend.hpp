/// \file
/// What the colours of a picture stand for, written beside it.
#pragma once

#include "scene/view.hpp"
#include "viewer/render/drawing.hpp"

#include <optional>
#include <string>

namespace carom::viewer {

/// A scale of colours from `low` to `high`.
struct Legend {
    std::string title; ///< the quantity and its unit
    std::string low;
    std::string high; ///< empty where all bodies have the value `low`
};

/// For a scale whose ends stand for these values, as Colouring has them; nothing where colours are no scale.
std::optional<Legend> legend_of(scene::ColourBy by, double lowest, double highest);

/// What a legend is drawn on. Places are in pixels from the upper left.
class Canvas {
public:
    Canvas() = default;
    Canvas(const Canvas&) = delete;
    Canvas& operator=(const Canvas&) = delete;
    virtual ~Canvas() = default;

    virtual void rectangle(float left, float top, float width, float height, const Colour& colour) = 0;
    virtual void text(float left, float top, const std::string& line) = 0;
    [[nodiscard]] virtual float width_of(const std::string& line) const = 0;
};

inline constexpr float line_height = 13;   ///< pixels, of text on a canvas of scale 1
inline constexpr float legend_height = 62; ///< pixels, for scale 1

/// Draws the legend with its lower left corner at this place, `scale` times its usual size.
void draw_legend(const Legend& legend, float left, float bottom, float scale, Canvas& canvas);

} // namespace carom::viewer
