#include "scene/energy_plot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace carom::test {
namespace {

using scene::energy_plot;
using scene::TimelineRow;

/// A ball that falls, with an impact now and then.
std::vector<TimelineRow> rows(std::size_t count, double scale = 1) {
    std::vector<TimelineRow> rows;
    for (std::uint64_t i = 0; i < count; ++i) {
        const double potential = scale * (10 - 0.001 * static_cast<double>(i));
        const double kinetic = scale * 0.0005 * static_cast<double>(i);
        rows.push_back({.time = static_cast<double>(i) / 60,
                        .step = i,
                        .kinetic = kinetic,
                        .potential = potential,
                        .total = kinetic + potential,
                        .lost = 10 * scale - kinetic - potential,
                        .impacts = i / 7,
                        .face_impacts = i / 11});
    }
    return rows;
}

std::size_t count_of(const std::string& text, const std::string& part) {
    std::size_t count = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
    return count;
}

/// True if every element that is opened is closed, in the right order.
bool is_well_formed(const std::string& svg) {
    std::vector<std::string> open;
    for (std::size_t at = svg.find('<'); at != std::string::npos; at = svg.find('<', at + 1)) {
        const std::size_t end = svg.find('>', at);
        if (end == std::string::npos) return false;
        const std::string tag = svg.substr(at + 1, end - at - 1);
        if (tag.front() == '/') {
            if (open.empty() || open.back() != tag.substr(1)) return false;
            open.pop_back();
        } else if (tag.back() != '/') {
            open.push_back(tag.substr(0, tag.find(' ')));
        }
    }
    return open.empty();
}

TEST(EnergyPlot, ShowsWhatItPromises) {
    const std::string svg = energy_plot(rows(601), "Title", "600 steps");
    EXPECT_TRUE(is_well_formed(svg));
    for (const char* part :
         {">Title<", ">600 steps<", ">energy, J<", ">time, s<", ">kinetic<", ">potential<", ">total<",
          ">total + booked losses<", "impacts per 0.1 s", ">85 between bodies<", ">54 with walls<"}) {
        EXPECT_EQ(count_of(svg, part), 1U) << part;
    }
    EXPECT_EQ(count_of(svg, "<path"), 4U);
}

TEST(EnergyPlot, LeavesOutWhatIsNotThere) {
    std::vector<TimelineRow> plain = rows(10);
    for (TimelineRow& row : plain) {
        row.potential = row.lost = 0;
        row.face_impacts = 0;
    }
    const std::string svg = energy_plot(plain, "", "");
    for (const char* part : {">potential<", "booked losses", "with walls"}) EXPECT_EQ(count_of(svg, part), 0U) << part;
}

TEST(EnergyPlot, SameRowsGiveTheSameBytes) {
    EXPECT_EQ(energy_plot(rows(601), "Title", "x"), energy_plot(rows(601), "Title", "x"));
}

TEST(EnergyPlot, TextIsNoMarkup) {
    const std::string svg = energy_plot(rows(10), "<script>a & b", "\x01 < 3");
    EXPECT_TRUE(is_well_formed(svg));
    EXPECT_EQ(count_of(svg, "<script"), 0U);
    EXPECT_EQ(count_of(svg, "&lt;script&gt;a &amp; b"), 1U);
    EXPECT_EQ(count_of(svg, "\x01"), 0U);
}

TEST(EnergyPlot, StaysSmallHoweverLongTheRun) { EXPECT_LT(energy_plot(rows(200'000), "", "").size(), 120'000U); }

TEST(EnergyPlot, DrawsAnySize) {
    for (const double scale : {1e-30, 1e-7, 1.0, 1e4, 1e21, 1e300}) {
        const std::string svg = energy_plot(rows(50, scale), "", "");
        EXPECT_TRUE(is_well_formed(svg)) << scale;
        EXPECT_EQ(count_of(svg, "nan") + count_of(svg, "inf"), 0U) << scale;
        EXPECT_LT(count_of(svg, "<line"), 60U) << scale;
    }
}

TEST(EnergyPlot, WithoutStepsItSaysSo) {
    for (const std::size_t count : {0U, 1U}) {
        const std::string svg = energy_plot(rows(count), "Title", "");
        EXPECT_TRUE(is_well_formed(svg));
        EXPECT_EQ(count_of(svg, "nothing happened"), 1U);
    }
}

TEST(EnergyPlot, RowsThatAreNotFiniteAreLeftOut) {
    std::vector<TimelineRow> broken = rows(100);
    broken[40].kinetic = std::numeric_limits<double>::quiet_NaN();
    broken[50].total = std::numeric_limits<double>::infinity();
    const std::string svg = energy_plot(broken, "", "");
    EXPECT_TRUE(is_well_formed(svg));
    EXPECT_EQ(count_of(svg, "nan") + count_of(svg, "inf"), 0U);
}

} // namespace
} // namespace carom::test
