/// \file
/// Vectors by the number of an axis.
#pragma once

#include <carom/base.hpp>

#include <cstddef>

namespace carom::detail {

/// The component of a vector along an axis, 0 to 2.
inline double component(const Vec3& v, std::size_t axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }
inline double& component(Vec3& v, std::size_t axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

} // namespace carom::detail
