/// \file
/// What the work of a step runs on: carom's own threads or the job system of a game, and which vector instructions.
#pragma once

#include <cstddef>
#include <memory>
#include <string_view>
#include <vector>

namespace carom {

/// Runs the parts of a piece of work. No result depends on how many threads it has, or in which order parts run.
class Executor {
public:
    /// `context` is handed on as it is.
    using Task = void (*)(void* context, std::size_t part);

    Executor() = default;
    Executor(const Executor&) = delete;
    Executor& operator=(const Executor&) = delete;
    virtual ~Executor() = default;

    /// Threads that may run parts at the same time, the caller's included, >= 1.
    [[nodiscard]] virtual unsigned threads() const noexcept = 0;
    /// Calls task(context, part) once for each part in [0, parts), in any order and on any threads, and returns when
    /// all are done. What a task throws is thrown again here, once the others have ended. The worlds that share an
    /// executor may be stepped by different threads at the same time only if it allows that; carom's own do.
    virtual void run(std::size_t parts, Task task, void* context) = 0;
};

/// More threads than any machine has: more are refused, with Error{out_of_range} naming `threads`.
inline constexpr unsigned most_threads = 4096;

/// Everything in the caller's thread.
std::shared_ptr<Executor> make_serial_executor();
/// oneTBB, or plain threads where carom was built without it. `threads` = 0: one for each core.
std::shared_ptr<Executor> make_default_executor(unsigned threads = 0);
/// Threads of its own, from the standard library, kept until the executor goes. `threads` = 0: one for each core.
/// Error{not_available} naming `threads` where the system does not give so many.
std::shared_ptr<Executor> make_thread_executor(unsigned threads = 0);

/// \name Instruction sets of the vectorised parts; no result depends on them
/// @{

/// Names of the instruction sets that this machine has and carom was built for, the best first: some of "avx512",
/// "avx2", "sse4", "ssse3", "neon", "sve", and always "scalar".
std::vector<std::string_view> simd_targets();

/// The one in use: the best, unless the environment variable CAROM_SIMD names another when it is first needed.
std::string_view simd_target();

/// Uses another from now on, in all worlds. Not to be called while a world steps. Throws Error{not_available} naming
/// those there are.
void use_simd_target(std::string_view name);
/// @}

} // namespace carom
