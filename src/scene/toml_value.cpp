#include "scene/toml_value.hpp"

#include "scene/scene_error.hpp"

// Where the parser is compiled in here, its assertions fail on some malformed text ("[[[") that it would refuse
// properly.
#define TOML_ASSERT(expression) static_assert(true)
#include <toml++/toml.h>

namespace carom::scene {

namespace {

TomlValue converted(const toml::node& node);

TomlTable converted_entries(const toml::table& table) {
    TomlTable entries;
    entries.reserve(table.size());
    for (const auto& [key, value] : table) entries.push_back({std::string(key.str()), converted(value)});
    return entries;
}

TomlArray converted_elements(const toml::array& array) {
    TomlArray elements;
    elements.reserve(array.size());
    for (const toml::node& element : array) elements.push_back(converted(element));
    return elements;
}

// Recursion ends: the parser refuses values nested deeper than 256 levels.
TomlValue converted(const toml::node& node) {
    TomlValue value;
    value.line = static_cast<int>(node.source().begin.line);
    if (const auto* table = node.as_table()) {
        value.data = converted_entries(*table);
    } else if (const auto* array = node.as_array()) {
        value.data = converted_elements(*array);
    } else if (const auto* text = node.as_string()) {
        value.data = text->get();
    } else if (const auto* integer = node.as_integer()) {
        value.data = integer->get();
    } else if (const auto* number = node.as_floating_point()) {
        value.data = number->get();
    } else if (const auto* boolean = node.as_boolean()) {
        value.data = boolean->get();
    }
    return value;
}

} // namespace

TomlValue parse_toml(std::string_view text, const std::string& file) {
    try {
        return converted(toml::parse(text));
    } catch (const toml::parse_error& error) {
        throw SceneError(file, static_cast<int>(error.source().begin.line), "", std::string(error.description()));
    }
}

} // namespace carom::scene
