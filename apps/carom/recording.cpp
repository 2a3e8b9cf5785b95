#include "recording.hpp"

#include "options.hpp"
#include "scene/atomic_file.hpp"
#include "scene/checkpoint.hpp"
#include "scene/impact_log.hpp"
#include "scene/summary.hpp"
#include "scene/timeline.hpp"

#include <carom/base.hpp>
#include <carom/body.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <string_view>

namespace carom::cli {

namespace {

Table table_of(std::string_view text) {
    Table table;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        table.lines.emplace_back(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return table;
}

/// Takes one file by what it holds, whatever its name.
void read_into(Recording& recording, const std::filesystem::path& file) {
    const std::vector<std::byte> bytes = scene::read_file(file);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (text.starts_with(scene::timeline_header()))
        recording.timeline = table_of(text);
    else if (text.starts_with(scene::impact_log_header()))
        recording.impacts = table_of(text);
    else if (scene::looks_like_checkpoint(bytes))
        recording.state = scene::load_checkpoint(bytes).world;
    else
        recording.state = World::load(bytes);
}

/// One field of a body with its value in either state.
struct FieldDifference {
    std::string field;
    std::string a;
    std::string b;
};

std::optional<FieldDifference> compare(const char* field, double a, double b) {
    if (std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b)) return std::nullopt;
    return FieldDifference{field, fmt::format("{}", a), fmt::format("{}", b)};
}

std::optional<FieldDifference> compare(const char* field, std::uint64_t a, std::uint64_t b) {
    if (a == b) return std::nullopt;
    return FieldDifference{field, std::to_string(a), std::to_string(b)};
}

/// The first field in which two bodies differ.
std::optional<FieldDifference> first_difference(const Body& a, const Body& b) {
    const std::array fields{
        compare("position.x", a.position.x, b.position.x),
        compare("position.y", a.position.y, b.position.y),
        compare("position.z", a.position.z, b.position.z),
        compare("velocity.x", a.velocity.x, b.velocity.x),
        compare("velocity.y", a.velocity.y, b.velocity.y),
        compare("velocity.z", a.velocity.z, b.velocity.z),
        compare("mass", a.mass, b.mass),
        compare("radius", a.radius, b.radius),
        compare("restitution", a.restitution, b.restitution),
        compare("friction", a.friction, b.friction),
        compare("material", std::uint64_t{a.material}, std::uint64_t{b.material}),
        compare("user_data", a.user_data, b.user_data),
    };
    for (const auto& field : fields) {
        if (field) return field;
    }
    return std::nullopt;
}

/// What is compared before the bodies.
std::optional<std::string> compare_outlines(const World& a, const World& b) {
    const auto say = [](const char* what, const auto& in_a, const auto& in_b) {
        return fmt::format("{} is {} and {}", what, in_a, in_b);
    };
    if (a.options().precision != b.options().precision) {
        return say("precision", scene::name_of(a.options().precision), scene::name_of(b.options().precision));
    }
    if (a.resolution() != b.resolution()) return say("resolution", a.resolution(), b.resolution());
    if (a.size() != b.size()) return say("the number of bodies", a.size(), b.size());
    return std::nullopt;
}

/// The bodies of two states of equal size, side by side in the order of their ids.
std::optional<std::string> compare_bodies(const World& a, const World& b) {
    const std::vector<BodyId> ids_a = a.ids();
    const std::vector<BodyId> ids_b = b.ids();
    std::string first;
    std::size_t different = 0;
    double farthest = 0;
    for (std::size_t i = 0; i < ids_a.size(); ++i) {
        if (ids_a[i].slot != ids_b[i].slot || ids_a[i].generation != ids_b[i].generation) {
            return fmt::format("body {} is only in one of them", std::min(ids_a[i].slot, ids_b[i].slot));
        }
        const Body body_a = a.get(ids_a[i]);
        const Body body_b = b.get(ids_b[i]);
        auto field = first_difference(body_a, body_b);
        if (!field) field = compare("held", std::uint64_t{a.held(ids_a[i])}, std::uint64_t{b.held(ids_b[i])});
        if (!field) continue;
        if (++different == 1)
            first = fmt::format("body {}: {} is {} and {}", ids_a[i].slot, field->field, field->a, field->b);
        farthest = std::max(farthest, length(body_b.position - body_a.position));
    }
    if (different == 0) return std::nullopt;
    return fmt::format("{}; {} of {} bodies differ, in their places by at most {:.3g} m", first, different,
                       ids_a.size(), farthest);
}

std::vector<std::string_view> cells_of(std::string_view line) {
    std::vector<std::string_view> cells;
    for (;;) {
        const std::size_t comma = line.find(',');
        cells.push_back(line.substr(0, comma));
        if (comma == std::string_view::npos) return cells;
        line.remove_prefix(comma + 1);
    }
}

/// "row 12 (time 0.2): kinetic is 1 and 2"; `header` names the columns.
std::string describe_rows(const std::string& name, std::string_view header, std::string_view row_a,
                          std::string_view row_b) {
    const std::vector<std::string_view> columns = cells_of(header);
    const std::vector<std::string_view> a = cells_of(row_a);
    const std::vector<std::string_view> b = cells_of(row_b);
    if (a.size() != columns.size() || b.size() != columns.size()) return name + ": a row is not complete";
    std::string where;
    for (std::size_t i = 0; i < columns.size(); ++i) {
        if ((columns[i] == "time" || columns[i] == "a" || columns[i] == "b" || columns[i] == "face") && !a[i].empty()) {
            where += fmt::format("{}{} {}", where.empty() ? "" : ", ", columns[i], a[i]);
        }
    }
    const auto different = static_cast<std::size_t>(std::mismatch(a.begin(), a.end(), b.begin()).first - a.begin());
    return fmt::format("{} ({}): {} is {} and {}", name, where, columns[different], a[different], b[different]);
}

} // namespace

Recording read_recording(const std::filesystem::path& path) {
    Recording recording;
    try {
        if (!std::filesystem::is_directory(path)) {
            read_into(recording, path);
            return recording;
        }
        for (const char* name : {"checkpoint.carom", "timeline.csv", "impacts.csv"}) {
            if (std::filesystem::exists(path / name)) read_into(recording, path / name);
        }
    } catch (const Error& error) {
        throw UsageError(fmt::format("{} cannot be compared: {}; allowed are snapshots, checkpoints, timeline.csv, "
                                     "impacts.csv and folders of a run",
                                     path.string(), error.what()));
    }
    if (recording.state || recording.timeline || recording.impacts) return recording;
    throw UsageError(fmt::format("{} holds no checkpoint.carom, timeline.csv or impacts.csv", path.string()));
}

std::optional<std::string> difference(const World& a, const World& b) {
    if (auto found = compare_outlines(a, b)) return found;
    if (auto found = compare_bodies(a, b)) return found;
    if (const auto field = compare("time", a.time(), b.time())) {
        return fmt::format("time is {} and {}", field->a, field->b);
    }
    if (a.hash() == b.hash()) return std::nullopt;
    return fmt::format("the bodies are equal, but not what they have been through (impacts in a row, what they rest "
                       "on, time within a step): hash is {} and {}",
                       scene::hash_text(a.hash()), scene::hash_text(b.hash()));
}

std::optional<std::string> difference(const Table& a, const Table& b, const std::string& row_name) {
    const auto [row_a, row_b] = std::mismatch(a.lines.begin(), a.lines.end(), b.lines.begin(), b.lines.end());
    const auto number = row_a - a.lines.begin();
    if (row_a != a.lines.end() && row_b != b.lines.end()) {
        return describe_rows(fmt::format("{} {}", row_name, number), a.lines.front(), *row_a, *row_b);
    }
    if (a.lines.size() == b.lines.size()) return std::nullopt;
    return fmt::format("there are {} and {} rows; the first {} are equal", a.lines.size() - 1, b.lines.size() - 1,
                       number - 1);
}

} // namespace carom::cli
