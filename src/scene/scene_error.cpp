#include "scene/scene_error.hpp"

#include <fmt/format.h>

#include <utility>

namespace carom::scene {

namespace {

std::string message(const std::string& file, int line, const std::string& key, const std::string& reason) {
    std::string text = file;
    if (line > 0) text += fmt::format(":{}", line);
    if (!text.empty()) text += ": ";
    if (!key.empty()) text += key + ": ";
    return text + reason;
}

} // namespace

SceneError::SceneError(std::string file, int line, std::string key, std::string reason)
    : std::runtime_error(message(file, line, key, reason)), file_(std::move(file)), line_(line), key_(std::move(key)),
      reason_(std::move(reason)) {}

std::string reason_of(const Error& error) {
    const std::string text = error.what();
    const std::string field =
        error.index() == Error::no_index ? error.field() + ": " : fmt::format("{}[{}]: ", error.field(), error.index());
    return text.starts_with(field) ? text.substr(field.size()) : text;
}

} // namespace carom::scene
