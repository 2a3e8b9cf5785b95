/// \file
/// energy.svg: energies and impacts of a run over time, as a picture.
#pragma once

#include "scene/timeline.hpp"

#include <span>
#include <string>
#include <string_view>

namespace carom::scene {

/// Kinetic, potential and total energy over time, and below them how many impacts there were, as an SVG document
/// with light colours, and dark ones for viewers that ask for them. The same rows give the same bytes.
/// `title` and `subtitle` stand above it. Rows that are not finite are left out.
std::string energy_plot(std::span<const TimelineRow> rows, std::string_view title, std::string_view subtitle);

} // namespace carom::scene
