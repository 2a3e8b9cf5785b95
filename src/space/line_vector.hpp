/// \file
/// Arrays that begin where a cache line does.
#pragma once

#include <cstddef>
#include <new>
#include <vector>

namespace carom::core {

/// Memory in whole cache lines: elements of 16, 32 or 64 bytes never lie in two of them.
template <class T>
struct LineAllocator {
    using value_type = T; // NOLINT(readability-identifier-naming): std::vector asks for it
    static constexpr std::align_val_t line{64};

    LineAllocator() = default;
    template <class U>
    explicit LineAllocator(const LineAllocator<U>& /*other*/) {}

    T* allocate(std::size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), line)); }
    void deallocate(T* memory, std::size_t /*count*/) { ::operator delete(memory, line); }

    friend bool operator==(const LineAllocator&, const LineAllocator&) { return true; }
};

template <class T>
using LineVector = std::vector<T, LineAllocator<T>>;

} // namespace carom::core
