/// \file
/// The plots of the report.
#pragma once

#include "validate/findings.hpp"

#include <span>
#include <string>
#include <string_view>

namespace carom::validate {

/// How curves of one name are shown.
struct PlotStyle {
    std::string_view name; ///< as in Curve::plot
    std::string_view title;
    std::string_view caption;
    std::string_view x_label;
    std::string_view y_label;
    bool log_y = false;
};

/// In the order of the page.
std::span<const PlotStyle> plot_styles();

/// An SVG element, without colours: the page's style sheet has those; empty where no curve has that name. Curves of one
/// name share a colour.
std::string plot(const PlotStyle& style, std::span<const Curve> curves);

} // namespace carom::validate
