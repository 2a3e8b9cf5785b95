/// \file
/// What a TOML file says, with the line of each value: all that the rest of the code sees of the parser.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace carom::scene {

struct TomlValue;
struct TomlEntry;
using TomlArray = std::vector<TomlValue>;
using TomlTable = std::vector<TomlEntry>;

/// A date or a time; no key of a scene takes one.
struct TomlDate {};

/// One value of the file and the line where it begins.
struct TomlValue {
    std::variant<TomlDate, bool, std::int64_t, double, std::string, TomlArray, TomlTable> data;
    int line = 0;
};

/// A key of a table and its value.
struct TomlEntry {
    std::string key;
    TomlValue value;
};

/// Parses TOML 1.0. Throws SceneError with the line in `file` where the text is no TOML.
TomlValue parse_toml(std::string_view text, const std::string& file);

} // namespace carom::scene
