/// \file
/// Vectors by the number of an axis.
#pragma once

#include <carom/base.hpp>

#include <concepts>

namespace carom::detail {

/// The component of a vector along an axis, 0 to 2.
template <std::integral Axis>
constexpr double component(const Vec3& v, Axis axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}
template <std::integral Axis>
constexpr double& component(Vec3& v, Axis axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

} // namespace carom::detail
