/// \file
/// What a scene that is refused must be told.
#pragma once

#include <string_view>

namespace carom::scene {

/// A scene with a mistake, how the message must begin (with the line and the key) and what else it must contain.
struct Mistake {
    std::string_view text;
    std::string_view message;
    std::string_view also;
};

} // namespace carom::scene
