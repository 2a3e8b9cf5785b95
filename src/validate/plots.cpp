#include "validate/plots.hpp"

#include "scene/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace carom::validate {

namespace {

constexpr double width = 560;
constexpr double height = 360;
constexpr double left = 62;
constexpr double right = 544;
constexpr double top = 44;
constexpr double bottom = 308;
constexpr std::size_t colours = 5; ///< classes c0 to c4 of the page

constexpr std::array styles{
    PlotStyle{"state", "Equation of state", "Line: modified Kolafa-Labik-Malijevsky equation. Dots: carom.",
              "packing fraction", "Z = P V / N kT"},
    PlotStyle{"residual", "Equation of state: deviation",
              "Measured Z less the reference with its 1/N term, with standard errors.", "packing fraction",
              "deviation, %"},
    PlotStyle{"g", "Radial distribution function",
              "Lines: carom. Dots: contact value (Z - 1) / 4 eta of the reference.", "distance, diameters", "g(r)"},
    PlotStyle{"speeds", "Speeds in equilibrium", "Line: Maxwell's distribution. Dots: carom.", "speed, sqrt(kT / m)",
              "probability density"},
    PlotStyle{"a2", "Relaxation from equal speeds", "Line: carom. Dots: independent computation.",
              "collisions per body", "a2"},
    PlotStyle{"haff", "Cooling by inelastic impacts", "Lines: Haff's law. Dots: carom, one run each.",
              "time, diameters / initial thermal speed", "T / T(0)", true},
    PlotStyle{"viscoelastic_gas", "A gas of viscoelastic spheres cools",
              "Line: kinetic theory with e by the approach speed. Dots: carom, one run.",
              "time, diameters / initial thermal speed", "T / T(0)"},
    PlotStyle{"restitution", "Restitution of viscoelastic spheres",
              "Line: carom, impacts of two spheres. Dots: solutions of the equation of motion.",
              "x = (3/2) A (rho / m)^(2/5) v^(1/5)", "e"},
    PlotStyle{"heights", "A gas under gravity",
              "Lines: balance of weight and pressure, with and without the size of the spheres. Dots: carom.",
              "height, diameters", "packing", true},
    PlotStyle{"packing", "Poured spheres",
              "Packing in slabs of a tenth of a diameter, and the range of random close packing.", "height, diameters",
              "packing"},
    PlotStyle{"apexes", "A bouncing ball", "Lines: H e^2n for several e. Dots: carom.", "bounce", "h / H", true},
};

struct Range {
    double low = std::numeric_limits<double>::infinity();
    double high = -std::numeric_limits<double>::infinity();

    void add(double value) {
        low = std::min(low, value);
        high = std::max(high, value);
    }
};

struct Axes {
    scene::Scale x;
    scene::Scale y;
};

Axes axes_of(const PlotStyle& style, const std::vector<const Curve*>& curves) {
    Range x;
    Range y;
    for (const Curve* curve : curves) {
        for (const Point& point : curve->points) {
            x.add(point.x);
            y.add(point.y - point.error);
            y.add(point.y + point.error);
        }
    }
    return {scene::round_scale(std::min(x.low, style.name == "g" ? 1.0 : 0.0), x.high, 6, left, right),
            style.log_y ? scene::logarithmic_scale(y.low, y.high, bottom, top)
                        : scene::round_scale(std::min(y.low, 0.0), y.high, 6, bottom, top)};
}

void draw(scene::Picture& picture, const Axes& axes, const Curve& curve, std::string_view colour) {
    std::vector<std::array<double, 2>> line;
    for (const Point& point : curve.points) {
        const double x = axes.x.at(point.x);
        const double y = axes.y.at(point.y);
        line.push_back({x, y});
        if (curve.mark == Mark::line) continue;
        const double high = axes.y.at(point.y + point.error);
        if (std::abs(high - y) > 1) {
            picture.line(fmt::format("line {}", colour), x, axes.y.at(point.y - point.error), x, high);
        }
        picture.dot(fmt::format("dot {}", colour), x, y, 3.2);
    }
    if (curve.mark == Mark::line) picture.curve(colour, line);
}

} // namespace

std::span<const PlotStyle> plot_styles() { return styles; }

std::string plot(const PlotStyle& style, std::span<const Curve> curves) {
    std::vector<const Curve*> shown;
    for (const Curve& curve : curves) {
        if (curve.plot == style.name) shown.push_back(&curve);
    }
    if (shown.empty()) return {};
    const Axes axes = axes_of(style, shown);
    scene::Picture picture(width, height, "");
    scene::draw_x_axis(picture, axes.x, top, bottom, true);
    scene::draw_y_axis(picture, axes.y, left, right);
    std::vector<std::string> names;
    for (const Curve* curve : shown) {
        const auto found = std::find(names.begin(), names.end(), curve->name);
        const auto number = static_cast<std::size_t>(found - names.begin());
        if (found == names.end()) names.push_back(curve->name);
        draw(picture, axes, *curve, fmt::format("c{}", number % colours));
    }
    double end = right;
    for (std::size_t i = names.size(); i-- > 0 && names.size() > 1;) {
        end = picture.legend(end, top - 14, fmt::format("c{}", i % colours), scene::escaped(names[i]), false);
    }
    picture.text(left - 54, top - 14, "head", scene::escaped(style.y_label));
    picture.text((left + right) / 2, bottom + 42, "middle", scene::escaped(style.x_label));
    return picture.take();
}

} // namespace carom::validate
