/// \file
/// Asking for memory some time before it is needed.
#pragma once

namespace carom::core {

/// Asks for the cache line at an address.
inline void prefetch(const void* address) {
    __builtin_prefetch(address);
    // g++ 12 takes functions that only prefetch for ones that do nothing, and drops calls of them.
    asm volatile("" : : "r"(address));
}

/// To be called in a loop over an array with much work per element: asks for the element that is some turns away. Such
/// a loop alone keeps too few of them on the way.
template <class T>
void prefetch_ahead(const T* element) {
    constexpr int turns = 16;
    prefetch(element + turns);
}

} // namespace carom::core
