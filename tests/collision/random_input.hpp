/// Random input for the properties of two bodies. Every number is drawn through RapidCheck, so that a failure is
/// reported and shrunk.
#pragma once

#include <carom/collision.hpp>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iostream>
#include <limits>
#include <numbers>
#include <string>

namespace carom::test {

/// Uniform in [0, 1), whatever size RapidCheck is at.
inline double unit() {
    constexpr std::int64_t steps = std::int64_t{1} << 53;
    return static_cast<double>(*rc::gen::resize(rc::kNominalSize, rc::gen::inRange<std::int64_t>(0, steps))) /
           static_cast<double>(steps);
}

inline double between(double low, double high) { return low + (high - low) * unit(); }

/// Log-uniform over [10^low, 10^high).
inline double decades(double low, double high) { return std::pow(10.0, between(low, high)); }

inline bool chance(double probability) { return unit() < probability; }

inline Vec3 direction() {
    const double z = between(-1, 1);
    const double angle = between(0, 2 * std::numbers::pi);
    const double radius = std::sqrt(1 - z * z);
    return {radius * std::cos(angle), radius * std::sin(angle), z};
}

/// Not inlined: gcc 12 -O2 keeps the doubles of two neighbouring components that are rounded to float and widened
/// again.
template <class T>
[[gnu::noinline]] Vector3<T> rounded_to(const Vec3& a) {
    return {static_cast<T>(a.x), static_cast<T>(a.y), static_cast<T>(a.z)};
}

using Real = long double;
using Wide = Vector3<Real>;

template <class T>
Wide widened(const Vector3<T>& a) {
    return {a.x, a.y, a.z};
}

template <class T>
constexpr T eps = std::numeric_limits<T>::epsilon();

/// Checks a property that returns how large an error was, and prints the largest.
template <class Property>
void measure(const std::string& what, Property property) {
    double largest = 0;
    const bool holds = rc::check([&] {
        const auto error = static_cast<double>(property());
        largest = std::max(largest, error);
    });
    EXPECT_TRUE(holds);
    std::cout << "figure: " << ::testing::UnitTest::GetInstance()->current_test_info()->test_suite_name() << ": "
              << what << ": " << largest << " at most\n";
}

/// A mirror: each component flips its sign or keeps it.
struct Mirror {
    int x, y, z;

    static Mirror random() { return {chance(0.5) ? -1 : 1, chance(0.5) ? -1 : 1, chance(0.5) ? -1 : 1}; }

    template <class T>
    Vector3<T> operator()(const Vector3<T>& a) const {
        return {a.x * static_cast<T>(x), a.y * static_cast<T>(y), a.z * static_cast<T>(z)};
    }
};

/// Two bodies that approach each other along n.
template <class T>
struct Encounter {
    Vector3<T> n;
    T m_a, m_b;
    Vector3<T> v_a, v_b;
    T e, mu;

    [[nodiscard]] Real largest_speed() const { return std::max(length(widened(v_a)), length(widened(v_b))); }
    Response<T> respond() { return carom::respond(n, m_a, v_a, m_b, v_b, e, mu); }
};

/// Masses 1 : 10^12 either way, speeds over 12 decades and independent of each other.
template <class T>
Encounter<T> random_encounter() {
    const T m_a = static_cast<T>(decades(-6, 6));
    const T m_b = static_cast<T>(decades(-6, 6));
    Encounter<T> met{rounded_to<T>(direction()),
                     m_a,
                     m_b,
                     rounded_to<T>(direction() * decades(-6, 6)),
                     rounded_to<T>(direction() * decades(-6, 6)),
                     static_cast<T>(unit()),
                     static_cast<T>(chance(0.5) ? 0 : decades(-3, 1))};
    if (dot(met.v_a - met.v_b, met.n) < 0) {
        met.n = -met.n;
    }
    return met;
}

} // namespace carom::test
