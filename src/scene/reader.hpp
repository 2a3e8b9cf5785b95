/// \file
/// Typed reading of a scene file: every refusal names file, line and key, and says what is allowed.
#pragma once

#include "scene/toml_value.hpp"

#include <carom/base.hpp>

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace carom::scene {

/// The numbers that a key takes, and how to say it.
struct NumberRange {
    double min;
    double max;
    bool min_excluded;
    bool infinity_allowed;
    const char* allowed; ///< "must be > 0"

    [[nodiscard]] bool contains(double value) const;
};

inline constexpr double largest_double = std::numeric_limits<double>::max();
inline constexpr NumberRange any_number{-largest_double, largest_double, false, false, "must be finite"};
inline constexpr NumberRange positive{0, largest_double, true, false, "must be > 0 and finite"};
inline constexpr NumberRange not_negative{0, largest_double, false, false, "must be >= 0 and finite"};
inline constexpr NumberRange zero_to_one{0, 1, false, false, "must be in [0, 1]"};
/// Coordinates and lengths: far beyond any world, and their cubes are numbers still.
inline constexpr NumberRange coordinate_range{-1e30, 1e30, false, false, "must be in [-1e30, 1e30] m"};
inline constexpr NumberRange length_range{0, 1e30, true, false, "must be > 0 and at most 1e30 m"};
inline constexpr NumberRange radius_range{0, 1e30, false, false, "must be >= 0 and at most 1e30 m"};
inline constexpr NumberRange rate_range{-1e30, 1e30, false, false, "must be in [-1e30, 1e30] rad/s"};
inline constexpr NumberRange speed_range{-1e30, 1e30, false, false, "must be in [-1e30, 1e30] m/s"};
inline constexpr NumberRange mass_range{0, largest_double, true, true, "must be > 0; inf makes a body static"};

class TableReader;

/// One value of the file with the path of keys that leads to it.
class ValueReader {
public:
    ValueReader(const TomlValue& value, std::string path, const std::string& file)
        : value_(&value), path_(std::move(path)), file_(&file) {}

    [[nodiscard]] bool is_array() const;
    [[nodiscard]] bool is_table() const;
    [[nodiscard]] bool is_text() const;
    [[nodiscard]] bool is_number() const;
    /// True for an array whose first element is an array.
    [[nodiscard]] bool is_list_of_arrays() const;

    /// An integer is a number too.
    [[nodiscard]] double number(const NumberRange& range) const;
    [[nodiscard]] std::uint64_t count(std::uint64_t min, std::uint64_t max) const;
    [[nodiscard]] std::int64_t integer() const;
    [[nodiscard]] bool boolean() const;
    [[nodiscard]] std::string text() const;
    /// The place of a text in a list of allowed ones.
    [[nodiscard]] std::size_t choice(std::span<const std::string_view> allowed) const;
    /// An array of three numbers.
    [[nodiscard]] Vec3 vec3(const NumberRange& range = any_number) const;
    /// An array of three numbers, not all 0, scaled to length 1.
    [[nodiscard]] Vec3 direction() const;
    [[nodiscard]] std::vector<ValueReader> elements() const;
    /// An array of exactly `size` values; `what` names them in the refusal, for example "[x, y, z]".
    [[nodiscard]] std::vector<ValueReader> elements(std::size_t size, const char* what) const;
    [[nodiscard]] TableReader table() const;

    [[noreturn]] void fail(const std::string& reason) const;
    [[nodiscard]] int line() const { return value_->line; }
    [[nodiscard]] const std::string& path() const { return path_; }
    [[nodiscard]] const std::string& file() const { return *file_; }

private:
    [[noreturn]] void fail_type(const char* wanted) const;

    const TomlValue* value_;
    std::string path_;
    const std::string* file_; ///< outlives the reader
};

/// A table of the file. It remembers which keys were asked for, so that finish() can refuse the others.
class TableReader {
public:
    /// `value` holds a table.
    TableReader(const TomlValue& value, std::string path, const std::string& file);

    /// The value of a key, if the file has it. The text of a key asked for must outlive the reader: a literal.
    std::optional<ValueReader> find(std::string_view key);
    /// The value of a key that must be there.
    ValueReader need(std::string_view key);
    /// The tables of `[[key]]`, or of `key = [{...}, ...]`; none if the key is not there.
    std::vector<TableReader> tables(std::string_view key);

    /// \name Overwrite `target` if the file has the key
    /// @{
    void read(std::string_view key, double& target, const NumberRange& range);
    void read(std::string_view key, bool& target);
    void read(std::string_view key, std::string& target);
    void read(std::string_view key, Vec3& target, const NumberRange& range = any_number);
    /// @}

    /// Refuses the first key in the file that nobody asked for, with the nearest of those that were.
    void finish() const;

    [[noreturn]] void fail(const std::string& reason) const { self_.fail(reason); }
    /// Refuses a key, at its line if it is in the file, else at the table's.
    [[noreturn]] void fail(std::string_view key, const std::string& reason) const;
    [[nodiscard]] bool has(std::string_view key) const;
    /// Each key of the table and its line.
    [[nodiscard]] std::vector<std::pair<std::string, int>> lines() const;
    [[nodiscard]] int line() const { return self_.line(); }
    [[nodiscard]] const std::string& path() const { return self_.path(); }
    [[nodiscard]] const std::string& file() const { return self_.file(); }

private:
    [[nodiscard]] const TomlValue* value_of(std::string_view key) const;
    [[nodiscard]] std::string path_of(std::string_view key) const;

    ValueReader self_;
    const TomlTable* entries_;
    std::vector<std::string_view> known_; ///< keys asked for
};

/// The number that a text is from its first to its last character, whatever the locale; nothing if it is none.
std::optional<double> number_of_text(std::string_view text);

/// The same, also of two such numbers with a slash between them: "1/60".
std::optional<double> quotient_of_text(std::string_view text);

/// "; did you mean 'x'?", or nothing where no word is near.
std::string hint(std::string_view got, std::span<const std::string_view> words);

/// "must be one of a, b, c, got 'x'", with the nearest of them if there is a likely one.
std::string not_one_of(std::string_view got, std::span<const std::string_view> allowed);

} // namespace carom::scene
