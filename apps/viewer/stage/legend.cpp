#include "viewer/stage/legend.hpp"

#include "viewer/stage/palette.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>

namespace carom::viewer {

namespace {

constexpr std::array<const char*, scene::colour_names.size()> titles{"", "speed in m/s", "mass in kg, logarithmic",
                                                                     "impacts per second", "temperature in J"};

} // namespace

std::optional<Legend> legend_of(scene::ColourBy by, double lowest, double highest) {
    if (by == scene::ColourBy::material) return std::nullopt;
    const bool decades = by == scene::ColourBy::mass;
    const auto number = [&](double end) { return fmt::format("{:.3g}", decades ? std::pow(10, end) : end); };
    Legend legend{titles[static_cast<std::size_t>(by)], number(lowest), ""};
    if (highest > lowest) legend.high = number(highest) + (decades ? "" : " and more");
    return legend;
}

void draw_legend(const Legend& legend, float left, float bottom, float scale, Canvas& canvas) {
    const float pad = 8 * scale;
    const float width = 220 * scale;
    const float bar = 10 * scale;
    constexpr int parts = 44;
    const float title_top = bottom - legend_height * scale + 0.75F * pad;
    const float bar_top = title_top + (line_height + 4) * scale;
    const float numbers_top = bar_top + bar + 4 * scale;
    canvas.rectangle(left, bottom - legend_height * scale, width + 2 * pad, legend_height * scale, legend_colour);
    canvas.text(left + pad, title_top, legend.title);
    for (int i = 0; i < parts; ++i) {
        canvas.rectangle(left + pad + width / parts * static_cast<float>(i), bar_top, width / parts, bar,
                         scale_colour((static_cast<float>(i) + 0.5F) / parts));
    }
    canvas.text(left + pad, numbers_top, legend.low);
    canvas.text(left + pad + width - canvas.width_of(legend.high), numbers_top, legend.high);
}

} // namespace carom::viewer
