#include "scene/text_file.hpp"

#include "scene/atomic_file.hpp"
#include "scene/scene_error.hpp"

#include <carom/base.hpp>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

namespace carom::scene {

namespace {

std::vector<std::byte> bytes_of(const std::filesystem::path& file) {
    try {
        return read_file(file);
    } catch (const Error& error) {
        throw SceneError(file.string(), 0, "", reason_of(error));
    }
}

} // namespace

std::string read_text_file(const std::filesystem::path& file) {
    std::error_code ignored; // what is not there is reported by reading it
    const auto status = std::filesystem::status(file, ignored);
    if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status)) {
        throw SceneError(file.string(), 0, "", "is no regular file");
    }
    const std::vector<std::byte> bytes = bytes_of(file);
    std::string text;
    text.reserve(bytes.size());
    std::transform(bytes.begin(), bytes.end(), std::back_inserter(text),
                   [](std::byte byte) { return static_cast<char>(byte); });
    return text;
}

} // namespace carom::scene
