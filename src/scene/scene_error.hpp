/// \file
/// The one exception type of scene files and what they name.
#pragma once

#include <carom/base.hpp>

#include <stdexcept>
#include <string>

namespace carom::scene {

/// A scene was refused. what() reads "FILE:LINE: KEY: REASON"; the parts that are not known are left out.
class SceneError : public std::runtime_error {
public:
    /// `line` 0 and an empty `key` mean: not known.
    SceneError(std::string file, int line, std::string key, std::string reason);

    [[nodiscard]] const std::string& file() const noexcept { return file_; }
    /// Line in the file, from 1; 0 where the mistake is in no line.
    [[nodiscard]] int line() const noexcept { return line_; }
    /// The key as a path, for example "bodies[0].radius".
    [[nodiscard]] const std::string& key() const noexcept { return key_; }
    /// What is wrong, and what is allowed.
    [[nodiscard]] const std::string& reason() const noexcept { return reason_; }

private:
    std::string file_;
    int line_;
    std::string key_;
    std::string reason_;
};

/// The text of an engine's error without the "field[index]: " that it begins with.
std::string reason_of(const Error& error);

} // namespace carom::scene
