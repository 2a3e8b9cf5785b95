/// \file
/// Sets that grow together: a forest in which each element knows a parent nearer to the root of its set.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <vector>

namespace carom::core {

class DisjointSets {
public:
    /// `count` sets of one element each.
    void start(std::size_t count) {
        parents_.resize(count);
        std::iota(parents_.begin(), parents_.end(), 0U);
    }
    /// The element that stands for the set; shortens the way to it.
    [[nodiscard]] std::uint32_t root(std::uint32_t element) {
        while (parents_[element] != element) {
            parents_[element] = parents_[parents_[element]];
            element = parents_[element];
        }
        return element;
    }
    void unite(std::uint32_t a, std::uint32_t b) {
        const std::uint32_t root_a = root(a);
        const std::uint32_t root_b = root(b);
        parents_[std::max(root_a, root_b)] = std::min(root_a, root_b);
    }

private:
    std::vector<std::uint32_t> parents_;
};

} // namespace carom::core
