/// \file
/// PNG files.
#pragma once

#include "viewer/render/image.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace carom::viewer {

/// The bytes of a PNG file.
std::vector<std::byte> to_png(const Image& image);
/// Throws carom::Error{bad_data} for what is no PNG.
Image from_png(std::span<const std::byte> bytes);

} // namespace carom::viewer
