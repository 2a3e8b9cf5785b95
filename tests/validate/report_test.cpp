// What makes a row pass or fail, and the theory that rows are compared with.

#include "validate/gas.hpp"
#include "validate/plots.hpp"
#include "validate/report.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace carom::validate {
namespace {

const Claim claim{"length, m", "a ruler", "its label"};

TEST(Rows, ExactOnesPassWithinWhatTheyAdmit) {
    EXPECT_TRUE(exact_row(claim, 2, 2.25, 0.25).passed);
    EXPECT_FALSE(exact_row(claim, 2, 2.375, 0.25).passed);
    EXPECT_FALSE(exact_row(claim, 2, 1.625, 0.25).passed);
    EXPECT_FALSE(exact_row(claim, 2, std::nan(""), 0.25).passed);
    EXPECT_TRUE(exact_row(claim, 4, 4, 0).passed);
    EXPECT_FALSE(exact_row(claim, 4, 5, 0).passed);
    EXPECT_EQ(exact_row(claim, -2, -3, 5).percent(), -50);
    EXPECT_FALSE(exact_row(claim, 0, 1, 5).percent().has_value());
}

TEST(Rows, StatisticalOnesNeedFewStandardErrorsAndSmallOnes) {
    const Estimate reference{10, 0.03};
    const Row row = statistical_row(claim, reference, {10.15, 0.04}, 0.2);
    EXPECT_TRUE(row.passed);
    EXPECT_DOUBLE_EQ(row.standard_error, 0.05);
    EXPECT_NEAR(*row.sigmas, 3, 1e-12);
    EXPECT_FALSE(statistical_row(claim, reference, {10.21, 0.04}, 1).passed);   // 4.2 standard errors
    EXPECT_FALSE(statistical_row(claim, reference, {10.15, 0.04}, 0.1).passed); // more than it admits
    EXPECT_FALSE(statistical_row(claim, reference, {10.01, 0.3}, 0.2).passed);  // not sure enough
    EXPECT_FALSE(statistical_row(claim, reference, {.value = 10}, 0.2).passed); // not sure at all
    EXPECT_FALSE(statistical_row(claim, reference, {std::nan(""), 0.04}, 0.2).passed);
}

TEST(Rows, ErrorBarsAreJudgedTogether) {
    const auto with_sigmas = [](double sigmas) { return statistical_row(claim, {0, 0}, {sigmas, 1}, 100); };
    const std::vector<Row> honest{with_sigmas(1.2), exact_row(claim, 0, 50, 1), with_sigmas(-0.8)};
    EXPECT_TRUE(error_bar_row(honest).passed);
    EXPECT_NEAR(error_bar_row(honest).measured, std::sqrt((1.44 + 0.64) / 2), 1e-12);
    EXPECT_FALSE(error_bar_row(std::vector<Row>{with_sigmas(0.1), with_sigmas(0.2)}).passed);
    EXPECT_FALSE(error_bar_row(std::vector<Row>{with_sigmas(2), with_sigmas(-1.5)}).passed);
}

TEST(Rows, MeansOfIndependentValues) {
    const Estimate mean = mean_of(std::array{1.0, 2.0, 3.0, 6.0});
    EXPECT_DOUBLE_EQ(mean.value, 3);
    EXPECT_DOUBLE_EQ(mean.standard_error, std::sqrt(14.0 / 12));
}

TEST(Reports, KeepTheOrderAndTurnErrorsIntoRows) {
    const Group group{"mixed", [](Extent) {
                          const auto one = [](double value) {
                              return [value] { return Findings{{exact_row(claim, 1, value, 0)}, {}}; };
                          };
                          return std::vector<Task>{{1, one(1)},
                                                   {3, []() -> Findings { throw std::runtime_error("no <disk>"); }},
                                                   {2, one(2)}};
                      }};
    std::size_t calls = 0;
    const Report report = make_report(std::span(&group, 1), Extent::quick, [&](std::size_t done, std::size_t tasks) {
        EXPECT_EQ(done, ++calls);
        EXPECT_EQ(tasks, 3U);
    });
    ASSERT_EQ(report.rows.size(), 3U);
    EXPECT_TRUE(report.rows[0].passed);
    EXPECT_FALSE(report.rows[1].passed);
    EXPECT_EQ(report.rows[1].claim.setup, "no <disk>");
    EXPECT_EQ(report.rows[2].measured, 2);
    EXPECT_FALSE(report.passed());
    EXPECT_NE(to_text(report).find("3 rows, 2 failed"), std::string::npos);
    EXPECT_NE(to_json(report).find("\"verdict\": \"fail\""), std::string::npos);
}

/// Figures of VALIDATION 2: packing, Z, collision rate, and Z by an independent event-driven simulation with its error.
TEST(Theory, EquationOfStateAndCollisionRate) {
    struct Figure {
        double packing, z, rate, simulated, error;
    };
    for (const Figure& f :
         {Figure{0.05, 1.227485, 0.770069, 1.227523, 3.0e-5}, Figure{0.10, 1.521647, 1.765845, 1.521708, 8.5e-5},
          Figure{0.20, 2.409403, 4.771023, 2.40967, 2.0e-4}, Figure{0.40, 6.945460, 20.126198, 6.9471, 1.7e-3}}) {
        EXPECT_NEAR(compressibility(f.packing), f.z, 6e-7);
        EXPECT_NEAR(collision_rate(f.packing), f.rate, 6e-7);
        EXPECT_NEAR(compressibility(f.packing), f.simulated, 4 * f.error);
    }
}

/// At low density Z_N - 1 is (1 - 1/N) 4 eta exactly: each body meets N - 1 others.
TEST(Theory, FiniteNumbersOfBodies) {
    const double packing = 1e-2;
    const double bodies = 100;
    const double infinite = compressibility(packing);
    EXPECT_NEAR((compressibility(packing, bodies) - infinite) / (-4 * packing / bodies), 1, 0.1);
    EXPECT_NEAR(compressibility(0.4, 1e12), compressibility(0.4), 1e-10);
    EXPECT_NEAR(collision_rate(0.4, 1e12), collision_rate(0.4), 1e-9);
}

TEST(Theory, GasesStartWithoutMomentumAtTheirTemperature) {
    for (const bool equal_speeds : {true, false}) {
        const World world = make_gas({.packing = 0.3, .per_axis = 6, .equal_speeds = equal_speeds});
        EXPECT_EQ(world.size(), 216U);
        EXPECT_NEAR(length(world.momentum()), 0, 1e-12);
        EXPECT_NEAR(temperature(world), 1, 1e-12);
    }
}

TEST(Plots, ShowEachNameOnce) {
    const PlotStyle style{"p", "title", "caption", "x", "a < b"};
    const std::vector<Curve> curves{{"p", "law", Mark::line, {{0, 1}, {1, 2}}},
                                    {"other", "hidden", Mark::line, {{0, 1}}},
                                    {"p", "law", Mark::points, {{0.5, 1.5, 0.3}}},
                                    {"p", "second", Mark::points, {{1, 1}}}};
    const std::string svg = plot(style, curves);
    EXPECT_EQ(svg.find("hidden"), std::string::npos);
    EXPECT_EQ(svg.find(">law<"), svg.rfind(">law<"));
    EXPECT_NE(svg.find(">law<"), std::string::npos);
    EXPECT_NE(svg.find("a &lt; b"), std::string::npos);
    EXPECT_NE(svg.find("dot c1"), std::string::npos);
    EXPECT_EQ(plot({"nothing", "", "", "", ""}, curves), "");
}

} // namespace
} // namespace carom::validate
