#include "scene/reader.hpp"

#include "scene/scene_error.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>

namespace carom::scene {

namespace {

/// How many letters must be added, removed or replaced to make one text of the other (Levenshtein).
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::vector<std::size_t> row(b.size() + 1);
    std::iota(row.begin(), row.end(), std::size_t{0});
    for (std::size_t i = 0; i < a.size(); ++i) {
        std::size_t diagonal = row[0];
        row[0] = i + 1;
        for (std::size_t j = 0; j < b.size(); ++j) {
            const std::size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
            diagonal = row[j + 1];
            row[j + 1] = std::min({row[j] + 1, diagonal + 1, replaced});
        }
    }
    return row.back();
}

/// A text of the file, shortened to what fits a message.
std::string shown(std::string_view text) {
    constexpr std::size_t longest = 60;
    if (text.size() <= longest) return fmt::format("'{}'", text);
    return fmt::format("'{}...'", text.substr(0, longest));
}

const char* type_name(const TomlValue& value) {
    constexpr std::array<const char*, 7> names{"a date or time", "a truth value", "an integer", "a number",
                                               "a text",         "an array",      "a table"};
    return names[value.data.index()];
}

} // namespace

std::string hint(std::string_view got, std::span<const std::string_view> words) {
    constexpr std::size_t longest = 40; // longer texts are no slips of the pen
    if (words.empty() || got.size() > longest) return {};
    const auto nearest = std::min_element(words.begin(), words.end(), [got](std::string_view a, std::string_view b) {
        return edit_distance(got, a) < edit_distance(got, b);
    });
    const std::size_t distance = edit_distance(got, *nearest);
    // Words that begin alike may differ by one letter more: body and bodies.
    const std::size_t farthest = got.substr(0, 3) == nearest->substr(0, 3) ? 3 : 2;
    if (distance > farthest || distance >= nearest->size()) return {};
    return fmt::format("; did you mean '{}'?", *nearest);
}

std::string not_one_of(std::string_view got, std::span<const std::string_view> allowed) {
    return fmt::format("must be one of {}, got {}{}", fmt::join(allowed, ", "), shown(got), hint(got, allowed));
}

std::optional<double> number_of_text(std::string_view text) {
    double value = 0;
    const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || rest != text.data() + text.size()) return std::nullopt;
    return value;
}

std::optional<double> quotient_of_text(std::string_view text) {
    const std::size_t slash = text.find('/');
    const auto above = number_of_text(text.substr(0, slash));
    if (slash == std::string_view::npos || !above) return above;
    const auto below = number_of_text(text.substr(slash + 1));
    return below ? std::optional(*above / *below) : std::nullopt;
}

bool NumberRange::contains(double value) const {
    if (std::isnan(value)) return false;
    if (std::isinf(value)) return infinity_allowed && value > 0;
    return (min_excluded ? value > min : value >= min) && value <= max;
}

bool ValueReader::is_array() const { return std::holds_alternative<TomlArray>(value_->data); }
bool ValueReader::is_table() const { return std::holds_alternative<TomlTable>(value_->data); }
bool ValueReader::is_text() const { return std::holds_alternative<std::string>(value_->data); }
bool ValueReader::is_number() const {
    return std::holds_alternative<double>(value_->data) || std::holds_alternative<std::int64_t>(value_->data);
}

bool ValueReader::is_list_of_arrays() const {
    const auto* array = std::get_if<TomlArray>(&value_->data);
    return array != nullptr && !array->empty() && std::holds_alternative<TomlArray>(array->front().data);
}

double ValueReader::number(const NumberRange& range) const {
    if (!is_number()) fail_type("a number");
    const auto* integer = std::get_if<std::int64_t>(&value_->data);
    const double value = integer != nullptr ? static_cast<double>(*integer) : std::get<double>(value_->data);
    if (!range.contains(value)) fail(fmt::format("{}, got {}", range.allowed, value));
    return value;
}

std::int64_t ValueReader::integer() const {
    const auto* value = std::get_if<std::int64_t>(&value_->data);
    if (value == nullptr) fail_type("an integer");
    return *value;
}

std::uint64_t ValueReader::count(std::uint64_t min, std::uint64_t max) const {
    const std::int64_t value = integer();
    if (std::cmp_less(value, min) || std::cmp_greater(value, max)) {
        fail(fmt::format("must be an integer in [{}, {}], got {}", min, max, value));
    }
    return static_cast<std::uint64_t>(value);
}

bool ValueReader::boolean() const {
    const auto* value = std::get_if<bool>(&value_->data);
    if (value == nullptr) fail_type("true or false");
    return *value;
}

std::string ValueReader::text() const {
    const auto* value = std::get_if<std::string>(&value_->data);
    if (value == nullptr) fail_type("a text in quotes");
    return *value;
}

std::size_t ValueReader::choice(std::span<const std::string_view> allowed) const {
    const std::string value = text();
    const auto found = std::find(allowed.begin(), allowed.end(), value);
    if (found == allowed.end()) fail(not_one_of(value, allowed));
    return static_cast<std::size_t>(found - allowed.begin());
}

Vec3 ValueReader::vec3(const NumberRange& range) const {
    const std::vector<ValueReader> parts = elements(3, "three numbers [x, y, z]");
    return {parts[0].number(range), parts[1].number(range), parts[2].number(range)};
}

Vec3 ValueReader::direction() const {
    const Vec3 vector = vec3(coordinate_range);
    const double size = length(vector);
    if (!(size > 0)) fail("must have a direction: not all components 0");
    return vector / size;
}

std::vector<ValueReader> ValueReader::elements() const {
    const auto* array = std::get_if<TomlArray>(&value_->data);
    if (array == nullptr) fail_type("an array");
    std::vector<ValueReader> readers;
    readers.reserve(array->size());
    for (const TomlValue& value : *array) {
        readers.emplace_back(value, fmt::format("{}[{}]", path_, readers.size()), *file_);
    }
    return readers;
}

std::vector<ValueReader> ValueReader::elements(std::size_t size, const char* what) const {
    if (!is_array()) fail_type(what);
    std::vector<ValueReader> readers = elements();
    if (readers.size() != size) fail(fmt::format("must be {}, got an array of {}", what, readers.size()));
    return readers;
}

TableReader ValueReader::table() const {
    if (!is_table()) fail_type("a table");
    return {*value_, path_, *file_};
}

void ValueReader::fail(const std::string& reason) const { throw SceneError(*file_, value_->line, path_, reason); }

void ValueReader::fail_type(const char* wanted) const {
    fail(fmt::format("must be {}, got {}", wanted, type_name(*value_)));
}

TableReader::TableReader(const TomlValue& value, std::string path, const std::string& file)
    : self_(value, std::move(path), file), entries_(&std::get<TomlTable>(value.data)) {}

const TomlValue* TableReader::value_of(std::string_view key) const {
    const auto found =
        std::find_if(entries_->begin(), entries_->end(), [key](const TomlEntry& entry) { return entry.key == key; });
    return found == entries_->end() ? nullptr : &found->value;
}

std::string TableReader::path_of(std::string_view key) const {
    return path().empty() ? std::string(key) : fmt::format("{}.{}", path(), key);
}

bool TableReader::has(std::string_view key) const { return value_of(key) != nullptr; }

std::vector<std::pair<std::string, int>> TableReader::lines() const {
    std::vector<std::pair<std::string, int>> result;
    for (const TomlEntry& entry : *entries_) result.emplace_back(entry.key, entry.value.line);
    return result;
}

std::optional<ValueReader> TableReader::find(std::string_view key) {
    known_.push_back(key);
    const TomlValue* value = value_of(key);
    if (value == nullptr) return std::nullopt;
    return ValueReader(*value, path_of(key), file());
}

ValueReader TableReader::need(std::string_view key) {
    if (const auto value = find(key)) return *value;
    fail(key, "is missing");
}

std::vector<TableReader> TableReader::tables(std::string_view key) {
    std::vector<TableReader> readers;
    const auto value = find(key);
    if (!value) return readers;
    if (!value->is_array()) value->fail(fmt::format("must be an array of tables; write [[{}]]", path_of(key)));
    for (const ValueReader& element : value->elements()) readers.push_back(element.table());
    return readers;
}

void TableReader::read(std::string_view key, double& target, const NumberRange& range) {
    if (const auto value = find(key)) target = value->number(range);
}

void TableReader::read(std::string_view key, bool& target) {
    if (const auto value = find(key)) target = value->boolean();
}

void TableReader::read(std::string_view key, std::string& target) {
    if (const auto value = find(key)) target = value->text();
}

void TableReader::read(std::string_view key, Vec3& target, const NumberRange& range) {
    if (const auto value = find(key)) target = value->vec3(range);
}

void TableReader::fail(std::string_view key, const std::string& reason) const {
    const TomlValue* value = value_of(key);
    throw SceneError(file(), value != nullptr ? value->line : line(), path_of(key), reason);
}

void TableReader::finish() const {
    const TomlEntry* unknown = nullptr;
    for (const TomlEntry& entry : *entries_) {
        if (std::find(known_.begin(), known_.end(), entry.key) != known_.end()) continue;
        if (unknown == nullptr || entry.value.line < unknown->value.line) unknown = &entry;
    }
    if (unknown == nullptr) return;
    std::vector<std::string_view> allowed = known_;
    std::sort(allowed.begin(), allowed.end());
    allowed.erase(std::unique(allowed.begin(), allowed.end()), allowed.end());
    fail(unknown->key,
         fmt::format("unknown key{}; allowed here: {}", hint(unknown->key, allowed), fmt::join(allowed, ", ")));
}

} // namespace carom::scene
