/// \file
/// Compensated sums, and exact ones.
#pragma once

#include <carom/base.hpp>

#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace carom::core {

/// Adds numbers with the rounding of each addition carried along: Neumaier, "Rundungsfehleranalyse einiger Verfahren
/// zur Summation endlicher Summen", Z. Angew. Math. Mech. 54 (1974), algorithm IV.
struct Sum {
    double main = 0;
    double carry = 0;

    void add(double value) {
        const double sum = main + value;
        carry += std::abs(main) >= std::abs(value) ? (main - sum) + value : (value - sum) + main;
        main = sum;
    }
    /// The sum; once it has overflowed, infinite.
    [[nodiscard]] double value() const { return std::isfinite(main) ? main + carry : main; }
};

struct VectorSum {
    Sum x, y, z;

    void add(const Vec3& v) {
        x.add(v.x);
        y.add(v.y);
        z.add(v.z);
    }
    [[nodiscard]] Vec3 value() const { return {x.value(), y.value(), z.value()}; }
};

/// Adds numbers without any rounding: the same whatever their order, in parts or not. A small superaccumulator: Neal,
/// "Fast exact summation using small and large superaccumulators", arXiv:1505.05571 (2015).
class ExactSum {
public:
    void add(double value) {
        constexpr std::uint64_t fraction_mask = (std::uint64_t{1} << 52U) - 1;
        const auto bits = std::bit_cast<std::uint64_t>(value);
        const auto exponent = static_cast<std::uint32_t>(bits >> 52U) & 0x7ffU;
        if (exponent == 0x7ffU) {
            unbounded_ += value;
            return;
        }
        const std::uint64_t hidden = exponent == 0 ? 0 : std::uint64_t{1} << 52U;
        const std::uint64_t mantissa = (bits & fraction_mask) | hidden;
        // In units of 2^-1074 the value is the mantissa shifted left by so many bits.
        const std::uint32_t shift = exponent == 0 ? 0 : exponent - 1;
        const std::uint64_t low = (mantissa & digit_mask) << (shift % digit_bits);
        const std::uint64_t high = (mantissa >> digit_bits) << (shift % digit_bits);
        const std::int64_t sign = (bits >> 63U) != 0 ? -1 : 1;
        std::int64_t* const digit = digits_.data() + shift / digit_bits;
        digit[0] += sign * static_cast<std::int64_t>(low & digit_mask);
        digit[1] += sign * static_cast<std::int64_t>((low >> digit_bits) + (high & digit_mask));
        digit[2] += sign * static_cast<std::int64_t>(high >> digit_bits);
        if (++additions_ == most_additions) carry();
    }
    void add(const ExactSum& other) {
        ExactSum carried = other;
        carried.carry();
        carry();
        for (std::size_t k = 0; k < digits_.size(); ++k) digits_[k] += carried.digits_[k];
        unbounded_ += other.unbounded_;
        carry();
    }

    /// The sum, rounded once or twice; infinite or no number if a summand was.
    [[nodiscard]] double value() const {
        ExactSum carried = *this;
        carried.carry();
        const bool is_negative = carried.digits_.back() < 0;
        if (is_negative) carried.negate();
        double sum = 0;
        for (std::size_t k = digits_.size(); k-- > 0;) {
            sum += std::ldexp(static_cast<double>(carried.digits_[k]), static_cast<int>(digit_bits * k) - 1074);
        }
        if (unbounded_ != 0 || std::isnan(unbounded_)) return unbounded_;
        return is_negative ? -sum : sum;
    }

private:
    static constexpr std::uint32_t digit_bits = 32;
    static constexpr std::uint64_t digit_mask = 0xffffffffU;
    static constexpr std::uint32_t most_additions = 1U << 28U;

    /// Leaves every digit but the last in [0, 2^32): the same digits for the same sum.
    void carry() {
        for (std::size_t k = 0; k + 1 < digits_.size(); ++k) {
            digits_[k + 1] += digits_[k] >> digit_bits;
            digits_[k] &= static_cast<std::int64_t>(digit_mask);
        }
        additions_ = 0;
    }

    void negate() {
        for (std::int64_t& digit : digits_) digit = -digit;
        carry();
    }

    std::array<std::int64_t, 68> digits_{};
    double unbounded_ = 0;
    std::uint32_t additions_ = 0;
};

struct ExactVectorSum {
    ExactSum x, y, z;

    void add(const Vec3& v) {
        x.add(v.x);
        y.add(v.y);
        z.add(v.z);
    }
    void add(const ExactVectorSum& other) {
        x.add(other.x);
        y.add(other.y);
        z.add(other.z);
    }
    [[nodiscard]] Vec3 value() const { return {x.value(), y.value(), z.value()}; }
};

} // namespace carom::core
