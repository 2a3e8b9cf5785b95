/// \file
/// What is said about a scene that is refused.
#pragma once

#include "scene/scene.hpp"

#include <string>

namespace carom::scene {

/// What is said about a scene.
template <class Read>
std::string refusal(const Read& read) {
    try {
        read();
    } catch (const SceneError& error) {
        return error.what();
    }
    return "nothing was refused";
}

} // namespace carom::scene
