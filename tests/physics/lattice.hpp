/// \file
/// Where tests put many bodies.
#pragma once

#include <carom/base.hpp>

#include <cstddef>

namespace carom::test {

/// Place k of a cubic lattice of edge 1, `row` places along x and along y, layer by layer.
inline Vec3 lattice(std::size_t k, std::size_t row) {
    const std::size_t y = k / row % row;
    const std::size_t z = k / (row * row);
    return {static_cast<double>(k % row), static_cast<double>(y), static_cast<double>(z)};
}

} // namespace carom::test
