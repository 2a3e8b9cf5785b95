// Numbers are read and written with a point, and states have the same bits, whatever locale the program around has.

#include "scene/csv.hpp"
#include "scene/energy_plot.hpp"
#include "scene/impact_log.hpp"
#include "scene/scene.hpp"
#include "scene/summary.hpp"
#include "scene/timeline.hpp"

#include <carom/base.hpp>

#include <gtest/gtest.h>

#include <array>
#include <clocale>
#include <cstdio>
#include <cstdlib>
#include <locale>
#include <string>
#include <vector>

namespace carom::scene {
namespace {

/// As in Germany: 1.234,5.
class GermanNumbers : public std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
};

/// A locale of the C++ library for the length of a scope.
class CppLocale {
public:
    // Deleted by the locale.
    CppLocale() : former_(std::locale::global(std::locale(std::locale::classic(), new GermanNumbers))) {}
    ~CppLocale() { std::locale::global(former_); }
    CppLocale(const CppLocale&) = delete;
    CppLocale& operator=(const CppLocale&) = delete;

private:
    std::locale former_;
};

/// The message of the error that a call throws; empty if it throws none.
template <class Call>
std::string message_of(Call&& call) {
    try {
        call();
    } catch (const std::exception& error) {
        return error.what();
    }
    return {};
}

constexpr const char* scene_text = R"(
[world]
gravity = [0, 0, -9.81]
drag = { linear = 0.125, quadratic = 1.5e-2 }
resolution = "2^-30"
[run]
dt = "1/60"
steps = 40
[region]
kind = "box"
min = [-0.5, -0.5, -0.5]
max = [10.25, 10.25, 10.25]
[[bodies]]
generator = "random"
count = 1_200
radius = { distribution = "uniform", min = 0.05, max = 0.15 }
density = 1234.5
restitution = 0.75
friction = 0.25
velocity = { distribution = "maxwell", kT = 12.5 }
)";

/// Whatever is written: by a run, and by everything that refuses something.
std::vector<std::string> everything_written() {
    Scene scene = parse_scene(scene_text, "s.toml");
    scene.options.record_impacts = true;
    World world = make_world(scene);
    Summary summary;
    summary.bodies = world.size();
    summary.steps = scene.run.steps.value();
    summary.dt = scene.run.dt;
    summary.wall_seconds = 1234.5;
    summary.start = read_books(world);
    std::vector<TimelineRow> rows{timeline_row(world, 0)};
    std::string impacts;
    for (std::uint64_t step = 1; step <= summary.steps; ++step) {
        world.step(scene.run.dt);
        rows.push_back(timeline_row(world, step));
        append_impacts(impacts, step, world.impacts());
    }
    summary.end = read_books(world);
    summary.hash = world.hash();

    const CsvBodies table = parse_csv("x,y,z,mass\n0.5,1.25,-2e-3,1234.5\n", "s.csv", 10);
    return {file_text(to_json(summary)),
            to_text(summary),
            to_csv(rows),
            impacts,
            energy_plot(rows, "title", "subtitle"),
            table.table.position.at(0) == Vec3{0.5, 1.25, -2e-3} ? "read" : "",
            message_of([] { parse_scene("[run]\ndt = -1234.5\n", "s.toml"); }),
            message_of([] { parse_scene("[run]\ndt = \"1,5\"\n", "s.toml"); }),
            message_of([] { parse_csv("x,y,z\n0.5,1.5,1;5\n", "s.csv", 10); }),
            message_of([&world] { world.step(-1234.5); }),
            message_of([&world] { world.add({.position = {1e30, 0, 0}}); })};
}

TEST(Locale, OfTheCppLibraryChangesNothing) {
    const std::vector<std::string> expected = everything_written();
    for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NE(expected[i], "") << i;
    const CppLocale other;
    ASSERT_EQ(std::use_facet<std::numpunct<char>>(std::locale()).decimal_point(), ',');
    EXPECT_EQ(everything_written(), expected);
}

#ifdef CAROM_TEST_LOCALES
TEST(Locale, OfTheCLibraryChangesNothing) {
    const std::vector<std::string> expected = everything_written();
    ASSERT_EQ(::setenv("LOCPATH", CAROM_TEST_LOCALES, 1), 0);
    ASSERT_NE(std::setlocale(LC_ALL, "de_DE.UTF-8"), nullptr);
    std::array<char, 16> text{};
    std::snprintf(text.data(), text.size(), "%.1f", 0.5);
    EXPECT_STREQ(text.data(), "0,5");
    EXPECT_EQ(everything_written(), expected);
    std::setlocale(LC_ALL, "C");
}
#endif

} // namespace
} // namespace carom::scene
