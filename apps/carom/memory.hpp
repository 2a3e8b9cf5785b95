/// \file
/// How much memory this process uses.
#pragma once

#include <cstdint>

namespace carom::cli {

/// Bytes that are in memory now. What was freed before is given back first, so that differences of two readings
/// count what is in use. 0 where the system does not tell.
std::uint64_t resident_bytes();

/// The most bytes that were ever in memory.
std::uint64_t peak_resident_bytes();

/// Gives memory that was freed back to the system.
void release_freed_memory();

/// Bytes that were added since `before`, for each of `bodies`.
double bytes_per_body(std::uint64_t before, std::uint64_t bodies);

} // namespace carom::cli
