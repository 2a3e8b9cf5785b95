/// \file
/// Pictures that somebody has looked at, to compare with.
#pragma once

#include "scene/atomic_file.hpp"
#include "viewer/film/png.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace carom::viewer {

/// The picture is like tests/data/pictures/NAME: drivers round differently, so one pixel in a hundred, those at edges,
/// may be another one, and all together may differ by one step of 255 on average. With CAROM_NEW_PICTURES set the
/// reference is written instead; look at it.
inline void expect_like_reference(const Image& image, const std::string& name) {
    const std::filesystem::path file = "tests/data/pictures/" + name;
    if (std::getenv("CAROM_NEW_PICTURES") != nullptr) return scene::write_file(file, to_png(image));
    const Image reference = from_png(scene::read_file(file));
    ASSERT_EQ(image.width, reference.width);
    ASSERT_EQ(image.height, reference.height);
    std::size_t other_pixels = 0;
    double sum = 0;
    for (std::size_t i = 0; i < image.pixels.size(); i += 3) {
        int largest = 0;
        for (std::size_t k = i; k < i + 3; ++k) {
            const int difference = std::abs(image.pixels[k] - reference.pixels[k]);
            largest = std::max(largest, difference);
            sum += difference;
        }
        if (largest > 16) ++other_pixels;
    }
    const bool alike = other_pixels <= image.pixels.size() / 300 && sum <= static_cast<double>(image.pixels.size());
    EXPECT_TRUE(alike) << name << ": " << other_pixels << " other pixels, mean difference "
                       << sum / static_cast<double>(image.pixels.size());
    if (!alike) scene::write_file("/tmp/carom-" + name, to_png(image));
}

} // namespace carom::viewer
