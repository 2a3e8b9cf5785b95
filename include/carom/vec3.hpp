/// \file
/// Three-component vectors: the one vector type of the public API.
#pragma once

#include <cmath>

namespace carom {

/// A vector of three numbers of type T; its unit is whatever the field or function that holds it says.
template <class T>
struct Vector3 {
    T x{};
    T y{};
    T z{};

    friend constexpr bool operator==(const Vector3&, const Vector3&) = default;

    constexpr Vector3& operator+=(const Vector3& o) { return *this = *this + o; }
    constexpr Vector3& operator-=(const Vector3& o) { return *this = *this - o; }
    constexpr Vector3& operator*=(T s) { return *this = *this * s; }

    friend constexpr Vector3 operator+(const Vector3& a, const Vector3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr Vector3 operator-(const Vector3& a, const Vector3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend constexpr Vector3 operator-(const Vector3& a) { return {-a.x, -a.y, -a.z}; }
    friend constexpr Vector3 operator*(const Vector3& a, T s) { return {a.x * s, a.y * s, a.z * s}; }
    friend constexpr Vector3 operator*(T s, const Vector3& a) { return a * s; }
    friend constexpr Vector3 operator/(const Vector3& a, T s) { return {a.x / s, a.y / s, a.z / s}; }
};

/// Vector in double precision: SI units throughout the public API.
using Vec3 = Vector3<double>;

/// Scalar product, summed in the order (x + y) + z, so that mirrored input gives mirrored bits.
template <class T>
constexpr T dot(const Vector3<T>& a, const Vector3<T>& b) {
    return (a.x * b.x + a.y * b.y) + a.z * b.z;
}

/// Vector product, right-handed.
template <class T>
constexpr Vector3<T> cross(const Vector3<T>& a, const Vector3<T>& b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

/// Square of the Euclidean length. Overflows above about 1e154 (double).
template <class T>
constexpr T length_squared(const Vector3<T>& a) {
    return dot(a, a);
}

/// Euclidean length.
template <class T>
T length(const Vector3<T>& a) {
    return std::sqrt(length_squared(a));
}

} // namespace carom
