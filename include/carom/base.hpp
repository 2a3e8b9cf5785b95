/// \file
/// What everything else stands on: the one vector type and the one exception type of the public API.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

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

/// What kind of mistake an Error reports.
enum class ErrorCode : std::uint8_t {
    not_finite,    ///< NaN or infinity where a finite number is needed
    out_of_range,  ///< a finite number outside the domain of its field
    overlap,       ///< a body would overlap another body, or reach through a face of the region
    unknown_body,  ///< an id that is stale, was never given out or belongs to another world
    size_mismatch, ///< arrays of one call have different lengths
    out_of_world,  ///< a body leaves the range that the world's resolution can represent
    bad_data,      ///< a snapshot that is truncated, altered, foreign or of another version
    not_available, ///< the call needs something that the world was not created with
    input_output,  ///< a file could not be read or written
};

/// The name of a code, as it stands in this header ("out_of_range").
const char* to_string(ErrorCode code) noexcept;

/// Thrown by every public function on bad input, before any state has changed.
class Error : public std::runtime_error {
public:
    /// `index` value of an error that is about no element of an array.
    static constexpr std::size_t no_index = static_cast<std::size_t>(-1);

    /// The message of what() reads "field[index]: reason", or "field: reason" without an index.
    Error(ErrorCode code, std::string field, const std::string& reason, std::size_t index = no_index);

    [[nodiscard]] ErrorCode code() const noexcept { return code_; }
    /// The name of the argument or member that was refused, for example "radius".
    [[nodiscard]] const std::string& field() const noexcept { return field_; }
    /// Position in the caller's array, or no_index.
    [[nodiscard]] std::size_t index() const noexcept { return index_; }

private:
    ErrorCode code_;
    std::string field_;
    std::size_t index_;
};

} // namespace carom
