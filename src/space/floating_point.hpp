/// \file
/// The floating-point environment that results are defined in.
#pragma once

#include <cfenv>

namespace carom::core {

/// Rounding to nearest, denormals kept: whatever the caller has set is restored at the end of the scope.
class DefaultFloatingPoint {
public:
    DefaultFloatingPoint() {
        std::fegetenv(&callers_);
        std::fesetenv(FE_DFL_ENV);
    }
    ~DefaultFloatingPoint() { std::fesetenv(&callers_); }
    DefaultFloatingPoint(const DefaultFloatingPoint&) = delete;
    DefaultFloatingPoint& operator=(const DefaultFloatingPoint&) = delete;

private:
    std::fenv_t callers_{};
};

} // namespace carom::core
