/// \file
/// Pictures as pixels.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace carom::viewer {

/// Red, green, blue: a byte each, row by row from the top.
struct Image {
    int width = 0;
    int height = 0;
    std::vector<std::uint8_t> pixels{};

    [[nodiscard]] const std::uint8_t* at(int x, int y) const {
        return &pixels[3 *
                       (static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x))];
    }
};

} // namespace carom::viewer
