#include "scene/picture.hpp"

#include <gtest/gtest.h>

namespace carom::scene {
namespace {

TEST(Picture, RoundScales) {
    const Scale scale = round_scale(0.13, 9.4, 5, 100, 200);
    EXPECT_DOUBLE_EQ(scale.low, 0);
    EXPECT_DOUBLE_EQ(scale.high, 10);
    EXPECT_EQ(scale.ticks().size(), 6U);
    EXPECT_DOUBLE_EQ(scale.at(2.5), 125);
}

TEST(Picture, LogarithmicScales) {
    const Scale scale = logarithmic_scale(0.02, 30, 0, 400);
    EXPECT_DOUBLE_EQ(scale.low, 0.01);
    EXPECT_DOUBLE_EQ(scale.high, 100);
    EXPECT_EQ(scale.ticks().size(), 5U);
    EXPECT_NEAR(scale.at(1), 200, 1e-9);
    EXPECT_NEAR(scale.at(10), 300, 1e-9);
    const Scale one_power = logarithmic_scale(1, 1, 0, 1);
    EXPECT_DOUBLE_EQ(one_power.high, 10);
}

} // namespace
} // namespace carom::scene
