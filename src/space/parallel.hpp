/// \file
/// Loops cut into parts that may run in any order and on any thread.
#pragma once

#include "space/floating_point.hpp"

#include <carom/executor.hpp>

#include <algorithm>

namespace carom::core {

/// A loop has at most so many parts, whatever the threads: what belongs to a part does not depend on them.
inline constexpr std::size_t most_parts = 32;

/// How many parts a loop of `count` turns has, each of at least `grain`.
constexpr std::size_t parts_of(std::size_t count, std::size_t grain) {
    return std::clamp<std::size_t>(count / grain, 1, most_parts);
}

/// Calls f(part, begin, end) for the parts of [0, count).
template <class F>
void for_parts(Executor& executor, std::size_t count, std::size_t grain, F&& f) {
    const std::size_t parts = parts_of(count, grain);
    if (parts == 1) {
        f(std::size_t{0}, std::size_t{0}, count);
        return;
    }
    struct Loop {
        F& f;
        std::size_t count;
        std::size_t parts;
    } loop{f, count, parts};
    executor.run(
        parts,
        [](void* context, std::size_t part) {
            const DefaultFloatingPoint environment;
            const Loop& l = *static_cast<Loop*>(context);
            l.f(part, part * l.count / l.parts, (part + 1) * l.count / l.parts);
        },
        &loop);
}

/// Calls f(part, k) for every k in [0, count).
template <class F>
void for_each_in_parts(Executor& executor, std::size_t count, std::size_t grain, F&& f) {
    for_parts(executor, count, grain, [&f](std::size_t part, std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k) f(part, k);
    });
}

} // namespace carom::core
