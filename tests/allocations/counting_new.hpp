/// \file
/// Every operator new of the process, counted.
#pragma once

#include <cstdint>

namespace carom::test {

/// Allocations since the program began, on all threads.
std::uint64_t allocations() noexcept;

} // namespace carom::test
