#include "scene/csv.hpp"

#include "scene/reader.hpp"
#include "scene/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <span>

namespace carom::scene {

namespace {

/// One kind of column: its name, what it takes, and where its values are.
struct Column {
    std::string_view name;
    NumberRange range;
    double& (*cell)(BodyTable& table, std::size_t body);
};

const std::array<Column, 11> columns{{
    {"x", coordinate_range, [](BodyTable& t, std::size_t i) -> double& { return t.position[i].x; }},
    {"y", coordinate_range, [](BodyTable& t, std::size_t i) -> double& { return t.position[i].y; }},
    {"z", coordinate_range, [](BodyTable& t, std::size_t i) -> double& { return t.position[i].z; }},
    {"vx", speed_range, [](BodyTable& t, std::size_t i) -> double& { return t.velocity[i].x; }},
    {"vy", speed_range, [](BodyTable& t, std::size_t i) -> double& { return t.velocity[i].y; }},
    {"vz", speed_range, [](BodyTable& t, std::size_t i) -> double& { return t.velocity[i].z; }},
    {"mass", mass_range, [](BodyTable& t, std::size_t i) -> double& { return t.mass[i]; }},
    {"radius", radius_range, [](BodyTable& t, std::size_t i) -> double& { return t.radius[i]; }},
    {"restitution", zero_to_one, [](BodyTable& t, std::size_t i) -> double& { return t.restitution[i]; }},
    {"friction", not_negative, [](BodyTable& t, std::size_t i) -> double& { return t.friction[i]; }},
    {"growth", speed_range, [](BodyTable& t, std::size_t i) -> double& { return t.growth[i]; }},
}};

/// What tells one table of a run from another, and one of its bodies: no part of a body's state.
constexpr std::array<std::string_view, 2> labels{"time", "id"};

std::string_view trimmed(std::string_view text) {
    constexpr std::string_view blanks = " \t\r";
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// Takes the part before the next separator off the front of `rest`.
std::string_view take_until(char separator, std::string_view& rest) {
    const std::size_t end = rest.find(separator);
    const std::string_view part = rest.substr(0, end);
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    return part;
}

std::vector<std::string_view> cells_of(std::string_view line) {
    std::vector<std::string_view> cells;
    const auto separators = std::count(line.begin(), line.end(), ',');
    for (std::ptrdiff_t i = 0; i <= separators; ++i) cells.push_back(trimmed(take_until(',', line)));
    return cells;
}

class CsvParser {
public:
    CsvParser(const std::string& file, std::uint64_t max_bodies) : file_(file), max_bodies_(max_bodies) {}

    CsvBodies parse(std::string_view text) {
        constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF"; // spreadsheets write one
        if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
        while (!text.empty()) {
            ++line_;
            const std::string_view content = trimmed(take_until('\n', text));
            if (content.empty() || content.front() == '#') continue;
            if (columns_.empty()) {
                read_header(cells_of(content));
            } else {
                rows_.push_back({content, line_});
            }
        }
        if (columns_.empty()) fail("", "the first line must name the columns, for example x,y,z,vx,vy,vz");
        if (rows_.empty()) fail("", "there are no bodies below the names of the columns");
        if (rows_.size() > max_bodies_) {
            fail("", fmt::format("has {} bodies; at most {} more are allowed", rows_.size(), max_bodies_));
        }
        return read_rows();
    }

private:
    struct Row {
        std::string_view content;
        int line;
    };

    [[noreturn]] void fail(std::string_view column, const std::string& reason) const {
        throw SceneError(file_, line_, column.empty() ? "" : fmt::format("column '{}'", column), reason);
    }

    void read_header(const std::vector<std::string_view>& names) {
        for (auto name = names.begin(); name != names.end(); ++name) {
            if (std::find(names.begin(), name, *name) != name) fail(*name, "is there twice");
            columns_.push_back(column_of(*name));
        }
        for (const std::string_view needed : {"x", "y", "z"}) {
            if (std::find(names.begin(), names.end(), needed) == names.end()) fail(needed, "is missing");
        }
    }

    /// Null for a column that is passed over.
    [[nodiscard]] const Column* column_of(std::string_view name) const {
        if (std::find(labels.begin(), labels.end(), name) != labels.end()) return nullptr;
        std::vector<std::string_view> allowed;
        std::transform(columns.begin(), columns.end(), std::back_inserter(allowed),
                       [](const Column& column) { return column.name; });
        const auto found = std::find(allowed.begin(), allowed.end(), name);
        if (found == allowed.end()) fail(name, not_one_of(name, allowed));
        return &columns[static_cast<std::size_t>(found - allowed.begin())];
    }

    CsvBodies read_rows() {
        CsvBodies bodies;
        bodies.table = BodyTable::of(rows_.size());
        for (const Column* column : columns_) {
            if (column != nullptr) bodies.given.emplace_back(column->name);
        }
        for (std::size_t i = 0; i < rows_.size(); ++i) {
            line_ = rows_[i].line;
            const std::vector<std::string_view> cells = cells_of(rows_[i].content);
            if (cells.size() != columns_.size()) {
                fail("", fmt::format("must have {} values, got {}", columns_.size(), cells.size()));
            }
            for (std::size_t c = 0; c < cells.size(); ++c) {
                if (columns_[c] != nullptr) columns_[c]->cell(bodies.table, i) = number(*columns_[c], cells[c]);
            }
        }
        return bodies;
    }

    double number(const Column& column, std::string_view text) const {
        const std::optional<double> value = number_of_text(text);
        if (!value) {
            constexpr std::size_t longest = 40;
            fail(column.name, fmt::format("must be a number, got '{}'", text.substr(0, longest)));
        }
        if (!column.range.contains(*value)) fail(column.name, fmt::format("{}, got {}", column.range.allowed, *value));
        return *value;
    }

    const std::string& file_;
    std::uint64_t max_bodies_;
    int line_ = 0;
    std::vector<const Column*> columns_; ///< of the file, in its order; null where one is passed over
    std::vector<Row> rows_;
};

BodyTable table_of(const World& world, std::span<const BodyId> ids) {
    BodyTable table = BodyTable::of(ids.size());
    world.get(ids, {.position = table.position,
                    .velocity = table.velocity,
                    .mass = table.mass,
                    .radius = table.radius,
                    .restitution = table.restitution,
                    .friction = table.friction,
                    .growth = table.growth});
    return table;
}

} // namespace

CsvBodies parse_csv(std::string_view text, const std::string& file, std::uint64_t max_bodies) {
    return CsvParser(file, max_bodies).parse(text);
}

CsvBodies read_csv(const std::filesystem::path& file, std::uint64_t max_bodies) {
    return parse_csv(read_text_file(file), file.string(), max_bodies);
}

std::string to_csv(const World& world) {
    const std::vector<BodyId> ids = world.ids();
    BodyTable table = table_of(world, ids);
    fmt::memory_buffer text;
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "{}", fmt::join(labels, ","));
    for (const Column& column : columns) fmt::format_to(out, ",{}", column.name);
    for (std::size_t i = 0; i < ids.size(); ++i) {
        fmt::format_to(out, "\n{},{}", world.time(), ids[i].slot);
        for (const Column& column : columns) fmt::format_to(out, ",{}", column.cell(table, i));
    }
    text.push_back('\n');
    return fmt::to_string(text);
}

} // namespace carom::scene
