// The portable functions against the C library's in long double, and their special values.

#include "collision/portable_math.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <limits>
#include <random>

namespace carom::test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double smallest = std::numeric_limits<double>::denorm_min();
constexpr double largest = std::numeric_limits<double>::max();
constexpr int trials = 200'000;

class Numbers {
public:
    /// Any finite number, each exponent as likely as the other.
    double any() {
        double x = infinity;
        while (!std::isfinite(x)) {
            x = std::bit_cast<double>(engine_());
        }
        return x;
    }
    double between(double low, double high) {
        return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
    }

private:
    std::mt19937_64 engine_{20101127};
};

/// Largest error of f over numbers that `draw` gives, in ulp.
template <class Draw, class Function, class Exact>
double largest_error(Draw draw, Function f, Exact exact) {
    double worst = 0;
    for (int i = 0; i < trials; ++i) {
        const double x = draw();
        const long double expected = exact(x);
        const double result = f(x);
        int exponent = 0;
        static_cast<void>(std::frexp(expected, &exponent));
        const long double ulp = std::ldexp(1.0L, std::max(exponent - 53, -1074));
        if (std::abs(expected) <= static_cast<long double>(largest)) {
            worst = std::max(worst, static_cast<double>(std::abs(static_cast<long double>(result) - expected) / ulp));
        }
    }
    return worst;
}

void report(const char* what, double error) {
    std::cout << "figure: largest error of " << what << ": " << error << " ulp\n";
}

TEST(PortableMath, ExpIsRightToOneUlp) {
    Numbers numbers;
    const auto exact = [](long double x) { return std::exp(x); };
    for (const double range : {1e-10, 1.0, 745.2}) {
        const double error = largest_error([&] { return numbers.between(-range, range); }, detail::exp, exact);
        report("exp", error);
        EXPECT_LT(error, 0.8);
    }
}

TEST(PortableMath, LogIsRightToHalfAnUlp) {
    Numbers numbers;
    const auto exact = [](long double x) { return std::log(x); };
    const double near_one = largest_error([&] { return numbers.between(0.5, 2); }, detail::log, exact);
    const double anywhere = largest_error([&] { return std::abs(numbers.any()); }, detail::log, exact);
    report("log", std::max(near_one, anywhere));
    EXPECT_LT(near_one, 0.51);
    EXPECT_LT(anywhere, 0.51);
}

TEST(PortableMath, SineAndCosineAreRightToOneUlp) {
    Numbers numbers;
    const auto sine = [](long double x) { return std::sin(x); };
    const auto cosine = [](long double x) { return std::cos(x); };
    const auto small = [&] { return numbers.between(-7, 7); };
    const auto any = [&] { return numbers.any(); };
    for (const double error : {largest_error(small, detail::sin, sine), largest_error(any, detail::sin, sine),
                               largest_error(small, detail::cos, cosine), largest_error(any, detail::cos, cosine)}) {
        report("sin or cos", error);
        EXPECT_LT(error, 0.8);
    }
}

// The double nearest to a multiple of pi/2, relative to its size (Muller, "Elementary functions"): most bits cancel.
TEST(PortableMath, HardestArgumentOfTheCosine) {
    const double x = 0x1.6ac5b262ca1ffp+849;
    EXPECT_LT(largest_error([&] { return x; }, detail::cos, [](long double y) { return std::cos(y); }), 0.8);
    EXPECT_EQ(std::abs(detail::sin(x)), 1);
}

TEST(PortableMath, PowIsRightToOneUlp) {
    Numbers numbers;
    double worst = 0;
    for (const double range : {1.0, 1070.0}) {
        double exponent = 0;
        const auto draw = [&] {
            const double x = std::abs(numbers.any());
            exponent = numbers.between(-range, range) / std::max(1.0, std::abs(std::log2(x)));
            return x;
        };
        worst = std::max(worst, largest_error(
                                    draw, [&](double x) { return detail::pow(x, exponent); },
                                    [&](long double x) { return std::pow(x, static_cast<long double>(exponent)); }));
    }
    report("pow", worst);
    EXPECT_LT(worst, 0.8);
}

/// The same number, or both NaN: zeros with the same sign.
void expect_same(double result, double expected, double x, double y = 0) {
    if (std::isnan(expected)) {
        EXPECT_TRUE(std::isnan(result)) << x << " " << y;
    } else {
        EXPECT_EQ(std::bit_cast<std::uint64_t>(result), std::bit_cast<std::uint64_t>(expected)) << x << " " << y;
    }
}

constexpr std::array specials{0.0, -0.0, 1.0, -1.0, infinity, -infinity, not_a_number};

TEST(PortableMath, SpecialValuesAreThoseOfC) {
    for (const double x : specials) {
        expect_same(detail::log(x), std::log(x), x);
        if (!(std::abs(x) == 1)) {
            expect_same(detail::exp(x), std::exp(x), x);
            expect_same(detail::sin(x), std::sin(x), x);
            expect_same(detail::cos(x), std::cos(x), x);
        }
    }
    expect_same(detail::log(-smallest), not_a_number, -smallest);
    expect_same(detail::exp(1000), infinity, 1000);
    expect_same(detail::exp(-1000), 0, -1000);
    expect_same(detail::sin(smallest), smallest, smallest);
    expect_same(detail::cos(smallest), 1, smallest);
}

TEST(PortableMath, SpecialPowersAreThoseOfC) {
    constexpr std::array exponents{0.0,    -0.0,  0.5,      -0.5,      1.0,         -1.0,
                                   2.0,    -2.0,  3.0,      -3.0,      1e16,        9007199254740993.0,
                                   -1e300, 1e300, infinity, -infinity, not_a_number};
    for (const double y : exponents) {
        for (const double x : specials) {
            expect_same(detail::pow(x, y), std::pow(x, y), x, y);
        }
        for (const double x : {0.5, 2.0, -0.5, -2.0}) {
            expect_same(detail::pow(x, y), static_cast<double>(std::pow(static_cast<long double>(x), y)), x, y);
        }
    }
    expect_same(detail::pow(smallest, 0.5), 0x1p-537, smallest, 0.5);
    expect_same(detail::pow(largest, 2), infinity, largest, 2);
    expect_same(detail::pow(largest, -2), 0, largest, -2);
    expect_same(detail::pow(10, 22), 1e22, 10, 22);
}

TEST(PortableMath, SineIsOddAndCosineEvenToTheBit) {
    Numbers numbers;
    for (int i = 0; i < 1000; ++i) {
        const double x = numbers.any();
        expect_same(detail::sin(-x), -detail::sin(x), x);
        expect_same(detail::cos(-x), detail::cos(x), x);
    }
}

// The bits of a few thousand results, as one number (FNV-1a): a machine or a compiler on which it differs breaks the
// promise of this file.
TEST(PortableMath, BitsAreTheSameEverywhere) {
    Numbers numbers;
    std::uint64_t hash = 0xcbf29ce484222325;
    const auto add = [&hash](double x) { hash = (hash ^ std::bit_cast<std::uint64_t>(x)) * 0x100000001b3; };
    for (int i = 0; i < 1000; ++i) {
        const double x = numbers.any();
        const double exponent = numbers.between(-100, 100);
        add(detail::exp(numbers.between(-700, 700)));
        add(detail::log(std::abs(x)));
        add(detail::sin(x));
        add(detail::cos(x));
        add(detail::pow(numbers.between(0, 2), exponent));
    }
    EXPECT_EQ(hash, 1989861915490716900U);
}

} // namespace
} // namespace carom::test
