/// \file
/// What is under the mouse.
#pragma once

#include "viewer/render/drawing.hpp"
#include "viewer/stage/moment.hpp"

#include <optional>

namespace carom::viewer {

/// A place in a picture of this size, in pixels from the upper left.
struct Place {
    double x;
    double y;
    double width;
    double height;
};

/// The direction of what is seen there, of length 1.
Vec3 direction_through(const Camera& camera, const Place& place);

/// The nearest body that is seen there at `time` (s); one that is very small may be missed by two pixels.
std::optional<BodyId> body_at(const Moment& moment, double time, const Camera& camera, const Place& place);

} // namespace carom::viewer
