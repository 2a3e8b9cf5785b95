#include "viewer/film/png.hpp"

#include <carom/base.hpp>

#include <png.h>

#include <string>

namespace carom::viewer {

namespace {

png_image description(const Image& image) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(image.width);
    png.height = static_cast<png_uint_32>(image.height);
    png.format = PNG_FORMAT_RGB;
    return png;
}

} // namespace

std::vector<std::byte> to_png(const Image& image) {
    png_image png = description(image);
    std::vector<std::byte> bytes(PNG_IMAGE_PNG_SIZE_MAX(png));
    png_alloc_size_t size = bytes.size();
    if (png_image_write_to_memory(&png, bytes.data(), &size, 0, image.pixels.data(), 0, nullptr) == 0) {
        throw Error(ErrorCode::input_output, "PNG", png.message);
    }
    bytes.resize(size);
    return bytes;
}

Image from_png(std::span<const std::byte> bytes) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0) {
        throw Error(ErrorCode::bad_data, "PNG", png.message);
    }
    png.format = PNG_FORMAT_RGB;
    Image image{static_cast<int>(png.width), static_cast<int>(png.height), {}};
    image.pixels.resize(PNG_IMAGE_SIZE(png));
    if (png_image_finish_read(&png, nullptr, image.pixels.data(), 0, nullptr) == 0) {
        png_image_free(&png);
        throw Error(ErrorCode::bad_data, "PNG", png.message);
    }
    return image;
}

} // namespace carom::viewer
