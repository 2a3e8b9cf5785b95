#include "collision/portable_math.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace carom::detail {

namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr int mantissa_bits = 52;
constexpr int exponent_bias = 1023;

// ---------------------------------------------------------------------------------------------------------------------
// Numbers of twice the precision
// ---------------------------------------------------------------------------------------------------------------------

/// The unevaluated sum of a number and what its rounding left over.
struct Precise {
    double high;
    double low;
};

/// a + b exactly (Knuth).
Precise exact_sum(double a, double b) {
    const double sum = a + b;
    const double of_b = sum - a;
    return {sum, (a - (sum - of_b)) + (b - of_b)};
}

/// The upper 26 bits of a number and the rest (Veltkamp).
Precise halves(double a) {
    constexpr double splitter = 0x1p27 + 1;
    const double scaled = splitter * a;
    const double high = scaled - (scaled - a);
    return {high, a - high};
}

/// a * b exactly (Dekker).
Precise exact_product(double a, double b) {
    const double product = a * b;
    const Precise p = halves(a);
    const Precise q = halves(b);
    return {product, ((p.high * q.high - product) + p.high * q.low + p.low * q.high) + p.low * q.low};
}

Precise operator+(const Precise& a, const Precise& b) {
    const Precise sum = exact_sum(a.high, b.high);
    return exact_sum(sum.high, sum.low + (a.low + b.low));
}

Precise operator*(const Precise& a, const Precise& b) {
    const Precise product = exact_product(a.high, b.high);
    return exact_sum(product.high, product.low + (a.high * b.low + a.low * b.high));
}

Precise operator*(const Precise& a, double b) { return a * Precise{b, 0}; }

constexpr Precise half_pi{0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};
constexpr Precise one_third{0x1.5555555555555p-2, 0x1.5555555555555p-56};
constexpr Precise one_fifth{0x1.999999999999ap-3, -0x1.999999999999ap-57};
/// ln 2 with 42 bits in the upper part, so that its product with an exponent is exact.
constexpr Precise ln_2{0x1.62e42fefa38p-1, 0x1.ef35793c7673p-45};

/// c[0] + c[1] x + c[2] x^2 + ...
template <std::size_t N>
double polynomial(const std::array<double, N>& c, double x) {
    double sum = c[N - 1];
    for (std::size_t i = N - 1; i-- > 0;) {
        sum = sum * x + c[i];
    }
    return sum;
}

/// 2^n for -1022 <= n <= 1023.
double power_of_two(int n) {
    return std::bit_cast<double>(static_cast<std::uint64_t>(n + exponent_bias) << mantissa_bits);
}

// ---------------------------------------------------------------------------------------------------------------------
// Exponential and logarithm
// ---------------------------------------------------------------------------------------------------------------------

/// value * 2^n for a value near 1, rounded once where the result is below the normal numbers.
double scaled_by_power_of_two(double value, int n) {
    if (n > exponent_bias) {
        return value * power_of_two(exponent_bias) * power_of_two(n - exponent_bias);
    }
    constexpr int shift = 128;
    return n < 1 - exponent_bias ? value * power_of_two(n + shift) * power_of_two(-shift) : value * power_of_two(n);
}

/// e^(x.high + x.low): the multiple of ln 2 nearest to x becomes the exponent, a Taylor series does the rest.
double exp_of(const Precise& x) {
    constexpr double overflow = 709.79;
    constexpr double underflow = -745.14;
    if (x.high > overflow) {
        return infinity;
    }
    if (x.high < underflow) {
        return 0;
    }
    const double quotient = x.high / ln_2.high;
    const int n = static_cast<int>(quotient < 0 ? quotient - 0.5 : quotient + 0.5);
    const Precise r = exact_sum(x.high - n * ln_2.high, x.low - n * ln_2.low);
    // 1/2!, 1/3!, ...: the first term left out is below 2^-58 of the sum for |r| < 0.35.
    constexpr std::array series{1.0 / 2,       1.0 / 6,        1.0 / 24,        1.0 / 120,
                                1.0 / 720,     1.0 / 5040,     1.0 / 40320,     1.0 / 362880,
                                1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800};
    const double rest = r.low + r.high * r.low + r.high * r.high * polynomial(series, r.high);
    const Precise head = exact_sum(1, r.high);
    return scaled_by_power_of_two(head.high + (head.low + rest), n);
}

/// Logarithm of a positive finite number to about 2^-65: `x = 2^n m` with m in [1/sqrt 2, sqrt 2) and
/// `log m = 2 s (1 + s^2/3 + s^4/5 + ...)` with `s = (m-1) / (m+1)`, whose first terms need the double precision.
Precise log_of(double x) {
    constexpr int lift = 54;
    int n = 0;
    if (x < std::numeric_limits<double>::min()) {
        x *= power_of_two(lift);
        n = -lift;
    }
    constexpr double sqrt_2 = 0x1.6a09e667f3bcdp+0;
    const auto bits = std::bit_cast<std::uint64_t>(x);
    n += static_cast<int>(bits >> mantissa_bits) - exponent_bias;
    constexpr std::uint64_t mantissa_mask = (std::uint64_t{1} << mantissa_bits) - 1;
    double m = std::bit_cast<double>((bits & mantissa_mask) | (std::uint64_t{exponent_bias} << mantissa_bits));
    if (m > sqrt_2) {
        m /= 2;
        ++n;
    }
    const Precise denominator = exact_sum(m, 1);
    const double s_high = (m - 1) / denominator.high;
    const Precise back = exact_product(s_high, denominator.high);
    const Precise s{s_high, (((m - 1) - back.high) - back.low - s_high * denominator.low) / denominator.high};
    const Precise z = s * s;
    constexpr std::array series{1.0 / 7, 1.0 / 9, 1.0 / 11, 1.0 / 13, 1.0 / 15, 1.0 / 17, 1.0 / 19, 1.0 / 21, 1.0 / 23};
    const Precise tail = one_fifth + Precise{z.high * polynomial(series, z.high), 0};
    const Precise twice_s{2 * s.high, 2 * s.low};
    const Precise log_m = twice_s + twice_s * (z * (one_third + z * tail));
    return Precise{n * ln_2.high, n * ln_2.low} + log_m;
}

// ---------------------------------------------------------------------------------------------------------------------
// Power
// ---------------------------------------------------------------------------------------------------------------------

bool is_odd_integer(double y) {
    constexpr double all_even_above = 0x1p53;
    const double size = std::abs(y);
    if (!(size < all_even_above)) {
        return false;
    }
    const auto whole = static_cast<std::int64_t>(size);
    return static_cast<double>(whole) == size && whole % 2 != 0;
}

bool is_integer(double y) {
    constexpr double all_integers_above = 0x1p52;
    const double size = std::abs(y);
    return size >= all_integers_above || static_cast<double>(static_cast<std::int64_t>(size)) == size;
}

/// pow(x, y) for x > 0 or infinite, x != 1, and y != 0.
double positive_power(double x, double y) {
    // Beyond this the result is 0 or infinite for every x but 1.
    constexpr double huge = 0x1p65;
    if (x == 0 || x == infinity || std::abs(y) > huge) {
        return (x > 1) == (y > 0) ? infinity : 0;
    }
    return exp_of(log_of(x) * y);
}

// ---------------------------------------------------------------------------------------------------------------------
// Sine and cosine
// ---------------------------------------------------------------------------------------------------------------------

/// An angle as a number of quarter turns and a rest in [-pi/4, pi/4].
struct Angle {
    unsigned quarter_turns;
    Precise rest;
};

/// The product of two 64-bit numbers, upper and lower half.
struct Product {
    std::uint64_t high;
    std::uint64_t low;
};

Product full_product(std::uint64_t a, std::uint64_t b) {
    constexpr std::uint64_t lower = 0xffffffff;
    const std::uint64_t low = (a & lower) * (b & lower);
    const std::uint64_t middle = (a >> 32) * (b & lower) + (low >> 32);
    const std::uint64_t other = (a & lower) * (b >> 32) + (middle & lower);
    return {(a >> 32) * (b >> 32) + (middle >> 32) + (other >> 32), (other << 32) | (low & lower)};
}

/// A fraction of 192 bits, the most significant word first.
using Fraction = std::array<std::uint64_t, 3>;

/// 192 bits of 2/pi, from the given bit on; its first 64 bits here are zeros before the binary point.
Fraction two_over_pi_from(std::size_t bit) {
    constexpr std::array<std::uint64_t, 20> digits{0,
                                                   0xa2f9836e4e441529,
                                                   0xfc2757d1f534ddc0,
                                                   0xdb6295993c439041,
                                                   0xfe5163abdebbc561,
                                                   0xb7246e3a424dd2e0,
                                                   0x06492eea09d1921c,
                                                   0xfe1deb1cb129a73e,
                                                   0xe88235f52ebb4484,
                                                   0xe99c7026b45f7e41,
                                                   0x3991d639835339f4,
                                                   0x9c845f8bbdf9283b,
                                                   0x1ff897ffde05980f,
                                                   0xef2f118b5a0a6d1f,
                                                   0x6d367ecf27cb09b7,
                                                   0x4f463f669e5fea2d,
                                                   0x7527bac7ebe5f17b,
                                                   0x3d0739f78a5292ea,
                                                   0x6bfb5fb11f8d5d08,
                                                   0x56033046fc7b6bab};
    const std::size_t word = bit / 64;
    const std::size_t shift = bit % 64;
    Fraction window{};
    for (std::size_t i = 0; i < window.size(); ++i) {
        window[i] = digits[word + i] << shift;
        if (shift > 0) {
            window[i] |= digits[word + i + 1] >> (64 - shift);
        }
    }
    return window;
}

/// factor * value, without what overflows at the top.
Fraction product(std::uint64_t factor, const Fraction& value) {
    const Product last = full_product(factor, value[2]);
    const Product middle = full_product(factor, value[1]);
    const std::uint64_t second = middle.low + last.high;
    const std::uint64_t carry = second < last.high ? 1 : 0;
    return {factor * value[0] + middle.high + carry, second, last.low};
}

Fraction shifted_left(const Fraction& value, int bits) {
    if (bits == 0) {
        return value;
    }
    const auto joined = [bits](std::uint64_t word, std::uint64_t next) { return word << bits | next >> (64 - bits); };
    return {joined(value[0], value[1]), joined(value[1], value[2]), value[2] << bits};
}

/// value / 2^192 to 106 bits.
Precise to_precise(Fraction value) {
    double scale = 1;
    if (value[0] == 0) {
        value = {value[1], value[2], 0};
        scale = 0x1p-64;
    }
    const int zeros = std::countl_zero(value[0]);
    value = shifted_left(value, zeros);
    scale *= power_of_two(-zeros);
    const std::uint64_t upper = value[0] >> 11;
    const std::uint64_t lower = (value[0] & 0x7ff) << 42 | value[1] >> 22;
    return {static_cast<double>(upper) * 0x1p-53 * scale, static_cast<double>(lower) * 0x1p-106 * scale};
}

/// Takes the quarter turns off a finite angle >= 0 exactly (Payne and Hanek): of x = M 2^e times 2/pi only those bits
/// count that are below 4 whole quarter turns, and as many behind the point as no double can cancel.
Angle reduced(double x) {
    constexpr double quarter_pi = half_pi.high / 2;
    if (x <= quarter_pi) {
        return {0, {x, 0}};
    }
    constexpr std::uint64_t hidden_bit = std::uint64_t{1} << mantissa_bits;
    const auto bits = std::bit_cast<std::uint64_t>(x);
    const std::uint64_t mantissa = (bits & (hidden_bit - 1)) | hidden_bit;
    const int exponent = static_cast<int>(bits >> mantissa_bits) - exponent_bias - mantissa_bits;
    // The bit of 2/pi that counts 2 quarter turns in the product is the first one that is needed.
    const Fraction turns = product(mantissa, two_over_pi_from(static_cast<std::size_t>(62 + exponent)));
    auto quarter_turns = static_cast<unsigned>(turns[0] >> 62);
    Fraction rest = shifted_left(turns, 2);
    double sign = 1;
    if (rest[0] >> 63 != 0) {
        // More than half a quarter turn: what is missing to the next one, to within the last bit.
        rest = {~rest[0], ~rest[1], ~rest[2]};
        ++quarter_turns;
        sign = -1;
    }
    return {quarter_turns % 4, half_pi * to_precise(rest) * sign};
}

/// Sine of an angle in [-pi/4, pi/4], by its Taylor series.
double sin_near_zero(const Precise& x) {
    constexpr std::array series{-1.0 / 6,        1.0 / 120,        -1.0 / 5040,          1.0 / 362880,
                                -1.0 / 39916800, 1.0 / 6227020800, -1.0 / 1307674368000, 1.0 / 355687428096000};
    const double square = x.high * x.high;
    return x.high + (x.high * square * polynomial(series, square) + x.low * (1 - square / 2));
}

/// Cosine of an angle in [-pi/4, pi/4], by its Taylor series.
double cos_near_zero(const Precise& x) {
    constexpr std::array series{1.0 / 24,        -1.0 / 720,         1.0 / 40320,         -1.0 / 3628800,
                                1.0 / 479001600, -1.0 / 87178291200, 1.0 / 20922789888000};
    const Precise square = exact_product(x.high, x.high);
    const Precise head = exact_sum(1, -square.high / 2);
    const double rest = square.high * square.high * polynomial(series, square.high) - x.high * x.low - square.low / 2;
    return head.high + (head.low + rest);
}

/// Sine of an angle after some quarter turns more.
double sin_of(const Angle& angle, unsigned more_quarter_turns) {
    const unsigned quadrant = (angle.quarter_turns + more_quarter_turns) % 4;
    const double value = quadrant % 2 == 0 ? sin_near_zero(angle.rest) : cos_near_zero(angle.rest);
    return quadrant < 2 ? value : -value;
}

} // namespace

double exp(double x) { return std::isnan(x) ? x : exp_of({x, 0}); }

double log(double x) {
    if (x > 0) {
        return x == infinity ? infinity : log_of(x).high;
    }
    return x == 0 ? -infinity : not_a_number;
}

double pow(double x, double y) {
    if (y == 0 || x == 1) {
        return 1;
    }
    if (std::isnan(x) || std::isnan(y)) {
        return not_a_number;
    }
    const double size = std::abs(x);
    if (x < 0 && size != infinity && !is_integer(y)) {
        return not_a_number;
    }
    const double value = size == 1 ? 1 : positive_power(size, y);
    return std::signbit(x) && is_odd_integer(y) ? -value : value;
}

double sin(double x) {
    if (!std::isfinite(x)) {
        return not_a_number;
    }
    const double value = sin_of(reduced(std::abs(x)), 0);
    return std::signbit(x) ? -value : value;
}

double cos(double x) { return std::isfinite(x) ? sin_of(reduced(std::abs(x)), 1) : not_a_number; }

} // namespace carom::detail
