/// \file
/// Text and rectangles on a picture.
#pragma once

#include "viewer/render/image.hpp"
#include "viewer/stage/legend.hpp"

namespace carom::viewer {

/// Draws `legend` into the lower left corner of `image`, larger in larger pictures.
void add_legend(const Legend& legend, Image& image);

} // namespace carom::viewer
