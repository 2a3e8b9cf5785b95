/// \file
/// Which instruction set the vectorised parts use. No result depends on it.
#pragma once

#include <string_view>
#include <vector>

namespace carom {

/// Names of the instruction sets that this machine has and carom was built for, the best first: some of "avx512",
/// "avx2", "sse4", "ssse3", "neon", "sve", and always "scalar".
std::vector<std::string_view> simd_targets();

/// The one in use: the best, unless the environment variable CAROM_SIMD names another when it is first needed.
std::string_view simd_target();

/// Uses another from now on, in all worlds. Not to be called while a world steps. Throws Error{not_available} naming
/// those there are.
void use_simd_target(std::string_view name);

} // namespace carom
