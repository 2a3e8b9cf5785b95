/// \file
/// An executor for tests: whatever depends on the order of tasks shows.
#pragma once

#include <carom/executor.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <random>
#include <vector>

namespace carom::test {

enum class Disorder : std::uint8_t { reversed, shuffled };

/// Runs parts in the caller's thread, from the last to the first or in the order of a fixed shuffle.
class DisorderlyExecutor : public Executor {
public:
    explicit DisorderlyExecutor(Disorder disorder) : disorder_(disorder) {}
    [[nodiscard]] unsigned threads() const noexcept override { return 3; }
    void run(std::size_t parts, Task task, void* context) override {
        std::vector<std::size_t> order(parts);
        for (std::size_t k = 0; k < parts; ++k) order[k] = parts - 1 - k;
        if (disorder_ == Disorder::shuffled) std::shuffle(order.begin(), order.end(), random_);
        for (const std::size_t part : order) task(context, part);
        ++loops_;
    }
    /// Loops run so far.
    [[nodiscard]] std::size_t loops() const { return loops_; }

private:
    Disorder disorder_;
    std::size_t loops_ = 0;
    std::mt19937 random_{5}; // NOLINT(cert-msc51-cpp): fixed
};

} // namespace carom::test
