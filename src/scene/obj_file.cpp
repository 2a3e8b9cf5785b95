#include "scene/obj_file.hpp"

#include "collision/triangle.hpp"
#include "scene/reader.hpp"
#include "scene/scene_error.hpp"
#include "scene/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <vector>

namespace carom::scene {

namespace {

/// What a mesh has no use for.
constexpr std::array<std::string_view, 11> passed_over{"vn", "vt", "vp",     "g",      "o", "s",
                                                       "l",  "p",  "usemtl", "mtllib", "#"};

std::vector<std::string_view> words_of(std::string_view line) {
    constexpr std::string_view blanks = " \t\r";
    std::vector<std::string_view> words;
    for (;;) {
        line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
        if (line.empty()) return words;
        words.push_back(line.substr(0, line.find_first_of(blanks)));
        line.remove_prefix(words.back().size());
    }
}

class ObjParser {
public:
    explicit ObjParser(const std::string& file) : file_(file) {}

    Mesh parse(std::string_view text) {
        while (!text.empty()) {
            ++line_;
            const std::size_t end = text.find('\n');
            read_line(words_of(text.substr(0, end)));
            text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
        }
        line_ = 0;
        if (mesh_.triangles.empty()) fail("", "has no faces: lines that begin with f");
        return std::move(mesh_);
    }

private:
    void read_line(const std::vector<std::string_view>& words) {
        if (words.empty() || words[0].starts_with('#')) return;
        if (words[0] == "v") {
            read_vertex(words);
        } else if (words[0] == "f") {
            read_face(words);
        } else if (std::find(passed_over.begin(), passed_over.end(), words[0]) == passed_over.end()) {
            fail(words[0].substr(0, 40),
                 "is no line of an OBJ file that carom knows: v and f count, comments are passed over");
        }
    }

    void read_vertex(const std::vector<std::string_view>& words) {
        // A fourth number would be a weight.
        if (words.size() != 4 && words.size() != 5) fail("v", "must have three numbers, x y z");
        std::array<double, 3> place{};
        for (std::size_t k = 0; k < 3; ++k) {
            const auto number = number_of_text(words[k + 1]);
            if (!number || !coordinate_range.contains(*number)) {
                fail("v", fmt::format("{}, got '{}'", coordinate_range.allowed, words[k + 1].substr(0, 40)));
            }
            place[k] = *number;
        }
        mesh_.vertices.push_back({place[0], place[1], place[2]});
    }

    void read_face(const std::vector<std::string_view>& words) {
        constexpr std::size_t fewest = 3;
        if (words.size() - 1 < fewest) fail("f", "must have three corners or more");
        std::vector<std::uint32_t> corners;
        for (std::size_t k = 1; k < words.size(); ++k) corners.push_back(vertex_of(words[k]));
        for (std::size_t k = 1; k + 1 < corners.size(); ++k) {
            add_triangle({corners[0], corners[k], corners[k + 1]});
        }
    }

    void add_triangle(const std::array<std::uint32_t, 3>& corners) {
        const auto& [a, b, c] = corners;
        if (detail::is_degenerate(mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c])) {
            fail("f", fmt::format("must have corners that are not in one line, got vertices {}, {} and {}", a + 1,
                                  b + 1, c + 1));
        }
        mesh_.triangles.push_back(corners);
    }

    /// The vertex of a corner: what stands before the first slash.
    std::uint32_t vertex_of(std::string_view corner) {
        const std::string_view text = corner.substr(0, corner.find('/'));
        std::int64_t number = 0;
        const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), number);
        const auto count = static_cast<std::int64_t>(mesh_.vertices.size());
        const bool is_number = error == std::errc{} && rest == text.data() + text.size() && !text.empty();
        if (!is_number || number == 0 || number > count || number < -count) {
            fail("f", fmt::format("must name vertices above it, 1 to {} or -1 to -{}, got '{}'", count, count,
                                  corner.substr(0, 40)));
        }
        return static_cast<std::uint32_t>(number > 0 ? number - 1 : count + number);
    }

    [[noreturn]] void fail(std::string_view key, const std::string& reason) const {
        throw SceneError(file_, line_, std::string(key), reason);
    }

    const std::string& file_;
    int line_ = 0;
    Mesh mesh_;
};

} // namespace

Mesh read_obj(const std::filesystem::path& file) { return parse_obj(read_text_file(file), file.string()); }

Mesh parse_obj(std::string_view text, const std::string& file) { return ObjParser(file).parse(text); }

} // namespace carom::scene
