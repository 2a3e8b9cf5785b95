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

/// Asks for all cache lines of an object.
template <class T>
void prefetch_object(const T* object) {
    constexpr std::size_t line = 64;
    for (std::size_t k = 0; k < sizeof(T); k += line) prefetch(reinterpret_cast<const std::byte*>(object) + k);
}

/// To be called in a loop over an array with much work per element: asks for the element that is some turns away. Such
/// a loop alone keeps too few of them on the way.
template <class T>
void prefetch_ahead(const T* element) {
    constexpr int turns = 16;
    prefetch(element + turns);
}

} // namespace carom::core
