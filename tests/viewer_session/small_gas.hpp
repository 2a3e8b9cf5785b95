/// \file
/// A world to watch.
#pragma once

#include "viewer/drawings.hpp"

#include <carom/world.hpp>

namespace carom::viewer {

inline World small_gas() {
    World world({.region = Box{{0, 0, 0}, {6, 6, 6}}, .interpolation = true});
    for (int i = 0; i < 27; ++i) {
        world.add({.position = site(i, 3) * 2 + Vec3{1, 1, 1}, .velocity = {1.0 + i % 5, 2.0 - i % 7, 0.5 * i - 6}});
    }
    return world;
}

} // namespace carom::viewer
