// Single precision means rounded to float: a compiler that keeps more changes the bits of a state.

#include <gtest/gtest.h>

namespace {

struct Floats {
    float x, y, z;
};
struct Doubles {
    double x, y, z;
};

[[gnu::noinline]] Doubles through_float(const Doubles& v) {
    const Floats rounded{static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
    return {static_cast<double>(rounded.x), static_cast<double>(rounded.y), static_cast<double>(rounded.z)};
}

TEST(Rounding, ToFloatAndBackIsNotDropped) {
    const Doubles v = through_float({0.1, 0.2, 0.3});
    EXPECT_EQ(v.x, static_cast<double>(0.1F));
    EXPECT_EQ(v.y, static_cast<double>(0.2F));
    EXPECT_EQ(v.z, static_cast<double>(0.3F));
}

} // namespace
