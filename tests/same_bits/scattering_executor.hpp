/// \file
/// An executor for ThreadSanitizer, which sees a race only between parts that run on different threads. The executors
/// of the library do not promise that: one thread is often through before others are awake.
#pragma once

#include <carom/executor.hpp>

#include <algorithm>
#include <cstddef>
#include <thread>
#include <vector>

namespace carom::test {

/// Runs the parts of a loop by turns on threads that are new each time: nothing but the loop's ends puts what two of
/// them do into an order.
class ScatteringExecutor : public Executor {
public:
    [[nodiscard]] unsigned threads() const noexcept override { return 3; }
    void run(std::size_t parts, Task task, void* context) override {
        const std::size_t count = std::min<std::size_t>(parts, threads());
        std::vector<std::thread> helpers;
        helpers.reserve(count);
        for (std::size_t first = 0; first < count; ++first) {
            helpers.emplace_back([=] {
                for (std::size_t part = first; part < parts; part += count) task(context, part);
            });
        }
        for (std::thread& helper : helpers) helper.join();
    }
};

} // namespace carom::test
