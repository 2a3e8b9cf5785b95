/// \file
/// Asking for memory some time before it is needed.
#pragma once

#include <cstddef>

namespace carom::core {

/// Asks for the cache line at an address.
inline void prefetch(const void* address) {
    __builtin_prefetch(address);
    // g++ 12 takes functions that only prefetch for ones that do nothing, and drops calls of them.
    asm volatile("" : : "r"(address));
}

/// Asks for all cache lines of an object. One whose size divides that of a line is taken to lie in a single one.
template <class T>
void prefetch_object(const T* object) {
    constexpr std::size_t line = 64;
    const auto* const bytes = reinterpret_cast<const std::byte*>(object);
    for (std::size_t k = 0; k < sizeof(T); k += line) prefetch(bytes + k);
    if constexpr (line % sizeof(T) != 0) prefetch(bytes + sizeof(T) - 1);
}

/// To be called in a loop over an array with much work per element: asks for the element that is some turns away. Such
/// a loop alone keeps too few of them on the way.
template <class T>
void prefetch_ahead(const T* element) {
    constexpr int turns = 16;
    prefetch_object(element + turns);
}

} // namespace carom::core
