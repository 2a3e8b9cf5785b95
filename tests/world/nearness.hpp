/// \file
/// How near a number may be to what it is to be.
#pragma once

#include <carom/base.hpp>

#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace carom::test {

inline constexpr double eps = std::numeric_limits<double>::epsilon();

inline void expect_near(const Vec3& actual, const Vec3& expected, double tolerance, const std::string& what) {
    EXPECT_NEAR(actual.x, expected.x, tolerance) << what;
    EXPECT_NEAR(actual.y, expected.y, tolerance) << what;
    EXPECT_NEAR(actual.z, expected.z, tolerance) << what;
}

} // namespace carom::test
