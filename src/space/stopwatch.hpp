/// \file
/// Wall-clock time of phases, for reports only: no result depends on it.
#pragma once

#include <chrono>

namespace carom::core {

class Stopwatch {
public:
    /// Seconds since the last lap, or since the watch was made.
    double lap() {
        const auto now = std::chrono::steady_clock::now();
        const std::chrono::duration<double> passed = now - last_;
        last_ = now;
        return passed.count();
    }

private:
    std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

} // namespace carom::core
