/// \file
/// Vectors and matrices in single precision, as graphics cards take them.
#pragma once

#include <carom/base.hpp>

#include <array>

namespace carom::viewer {

using Vec3f = Vector3<float>;

inline Vec3f narrow(const Vec3& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
}

/// Of length 1; `fallback` for the zero vector.
template <class T>
Vector3<T> unit(const Vector3<T>& v, const Vector3<T>& fallback = {0, 0, 1}) {
    const T size = length(v);
    return size > 0 ? v / size : fallback;
}

/// Column by column, to be multiplied with columns.
using Matrix4 = std::array<float, 16>;

Matrix4 operator*(const Matrix4& a, const Matrix4& b);

/// From the coordinates that `eye` is given in to those of a camera that sees along -z, with y up. `target` differs
/// from `eye`; any `up` will do.
Matrix4 look_at(const Vec3f& eye, const Vec3f& target, const Vec3f& up);

/// Depth is 1 at `near` and falls to 0 at infinity: so floating point tells apart what is far away.
Matrix4 perspective(float field_of_view, float aspect, float near);

/// A box that is `radius` to all sides of the origin; depth 1 towards the camera, 0 away from it.
Matrix4 orthographic(float radius);

} // namespace carom::viewer
