/// \file
/// What a triangle must be to have a normal.
#pragma once

#include <carom/base.hpp>

#include <algorithm>

namespace carom::detail {

/// Whether the corners lie in one line, or so nearly that the normal would have no good digit.
inline bool is_degenerate(const Vec3& a, const Vec3& b, const Vec3& c) {
    constexpr double thinnest = 1e-12;
    const Vec3 ab = b - a;
    const Vec3 ac = c - a;
    const double longest = std::max({length_squared(ab), length_squared(ac), length_squared(ac - ab)});
    return !(length(cross(ab, ac)) > thinnest * longest);
}

} // namespace carom::detail
