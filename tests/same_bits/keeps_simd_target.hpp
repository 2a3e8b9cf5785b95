/// \file
/// Instruction sets are the whole program's: a test that uses another one puts the first one back.
#pragma once

#include <carom/executor.hpp>

#include <string>

namespace carom::test {

class KeepsSimdTarget {
public:
    KeepsSimdTarget() = default;
    KeepsSimdTarget(const KeepsSimdTarget&) = delete;
    KeepsSimdTarget& operator=(const KeepsSimdTarget&) = delete;
    ~KeepsSimdTarget() { use_simd_target(name_); }

private:
    std::string name_{simd_target()};
};

} // namespace carom::test
