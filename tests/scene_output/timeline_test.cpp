#include "scene/impact_log.hpp"
#include "scene/timeline.hpp"

#include <carom/world.hpp>

#include <gtest/gtest.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace carom::test {
namespace {

using scene::TimelineRow;

std::vector<std::vector<std::string>> cells_of(const std::string& csv) {
    std::vector<std::vector<std::string>> rows(1, {""});
    for (const char c : csv) {
        if (c == '\n')
            rows.push_back({""});
        else if (c == ',')
            rows.back().emplace_back();
        else
            rows.back().back() += c;
    }
    rows.pop_back();
    return rows;
}

double number(const std::string& text) {
    double value = std::numeric_limits<double>::quiet_NaN();
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    EXPECT_EQ(error, std::errc{}) << text;
    EXPECT_EQ(end, text.data() + text.size()) << text;
    return value;
}

TEST(Timeline, NumbersReadBackExactly) {
    const std::vector<double> values{0.1,
                                     -0.0,
                                     1.0 / 3,
                                     5e-324,
                                     std::numeric_limits<double>::max(),
                                     -std::numeric_limits<double>::min(),
                                     123456789012345678.0,
                                     std::nextafter(1.0, 2.0)};
    for (const double value : values) {
        const TimelineRow row{.time = value, .kinetic = value, .momentum = {value, -value, value}};
        const auto cells = cells_of(to_csv(std::vector{row})).at(1);
        for (const std::size_t column : {0U, 2U, 6U, 8U}) {
            EXPECT_EQ(number(cells.at(column)), value);
            EXPECT_EQ(std::signbit(number(cells.at(column))), std::signbit(value));
        }
        EXPECT_EQ(number(cells.at(7)), -value);
    }
}

TEST(Timeline, HasANameForEachColumn) {
    const TimelineRow row{.time = 1,
                          .step = 2,
                          .kinetic = 3,
                          .potential = 4,
                          .total = 7,
                          .lost = 5,
                          .momentum = {6, 8, 9},
                          .impacts = std::numeric_limits<std::uint64_t>::max(),
                          .face_impacts = 11,
                          .contacts = 12};
    const std::string csv = to_csv(std::vector{row});
    EXPECT_EQ(csv, std::string(scene::timeline_header()) + "1,2,3,4,7,5,6,8,9,18446744073709551615,11,12\n");
    EXPECT_EQ(cells_of(csv).at(0).size(), cells_of(csv).at(1).size());
}

TEST(Timeline, RowIsTheStateOfTheWorld) {
    World world({.gravity = {0, 0, -10}, .region = std::vector<Plane>{{.normal = {0, 0, 1}}}});
    world.add({.position = {0, 0, 1}, .velocity = {0, 0, -1}, .radius = 0.5, .restitution = 0.5});
    world.step(0.5);
    const TimelineRow row = scene::timeline_row(world, 7);
    EXPECT_EQ(row.time, 0.5);
    EXPECT_EQ(row.step, 7U);
    EXPECT_EQ(row.total, row.kinetic + row.potential);
    EXPECT_EQ(row.impacts, 0U);
    EXPECT_GE(row.face_impacts, 1U);
    EXPECT_NEAR(row.total + row.lost, 10.5, 1e-9);
}

TEST(ImpactLog, HasANameForEachColumn) {
    std::string log(scene::impact_log_header());
    const Impact pair{.time = 0.1, .offset = 0.05, .a = {3, 0, 1}, .b = {4, 0, 1}, .impulse = 1.5};
    Impact wall = pair;
    wall.b = {};
    wall.face = 5;
    scene::append_impacts(log, 12, std::vector{pair, wall});
    const auto rows = cells_of(log);
    ASSERT_EQ(rows.size(), 3U);
    for (const auto& row : rows) EXPECT_EQ(row.size(), rows[0].size());
    EXPECT_EQ((std::vector(rows[1].begin(), rows[1].begin() + 6)),
              (std::vector<std::string>{"12", "0.1", "0.05", "3", "4", ""}));
    EXPECT_EQ((std::vector(rows[2].begin(), rows[2].begin() + 6)),
              (std::vector<std::string>{"12", "0.1", "0.05", "3", "", "5"}));
}

} // namespace
} // namespace carom::test
