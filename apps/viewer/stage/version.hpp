/// \file
/// Numbers that tell what has changed since the picture before.
#pragma once

#include <atomic>
#include <cstdint>

namespace carom::viewer {

/// Another number at each call, in all of this process.
inline std::uint64_t next_version() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

} // namespace carom::viewer
