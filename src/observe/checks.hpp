/// \file
/// What observers refuse.
#pragma once

#include "collision/component.hpp"

#include <carom/base.hpp>

#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>
#include <string>

namespace carom::observe {

/// With a point, whatever the locale.
inline std::string shown(double value) {
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
    return {text.data(), end};
}

/// Throws unless `value` is a finite number > 0.
inline void check_positive(const char* field, double value) {
    if (!std::isfinite(value)) throw Error(ErrorCode::not_finite, field, "must be finite, got " + shown(value));
    if (!(value > 0)) throw Error(ErrorCode::out_of_range, field, "must be > 0, got " + shown(value));
}

/// Throws unless `count` is at least one.
inline void check_count(const char* field, std::size_t count) {
    if (count == 0) throw Error(ErrorCode::out_of_range, field, "must be at least 1, got 0");
}

inline void check_axis(std::size_t axis) {
    if (axis > 2) throw Error(ErrorCode::out_of_range, "axis", "must be 0, 1 or 2, got " + std::to_string(axis));
}

/// Throws unless both are finite and `low` < `high`.
inline void check_interval(double low, double high) {
    if (!std::isfinite(low)) throw Error(ErrorCode::not_finite, "low", "must be finite, got " + shown(low));
    if (!std::isfinite(high)) throw Error(ErrorCode::not_finite, "high", "must be finite, got " + shown(high));
    if (!(low < high)) throw Error(ErrorCode::out_of_range, "high", "must be greater than low, got " + shown(high));
}

using detail::component;

} // namespace carom::observe
