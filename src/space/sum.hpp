/// \file
/// Compensated sums.
#pragma once

#include <carom/vec3.hpp>

#include <cmath>

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

} // namespace carom::core
