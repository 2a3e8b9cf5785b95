// How fast this machine copies memory that is in no cache, with one thread and with two: what a step that moves so many
// bytes per body cannot be faster than. Bytes read and bytes written both count. Prints JSON.
#include <algorithm>
#include <barrier>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <thread>
#include <vector>

namespace {

constexpr std::size_t words = std::size_t{1} << 26U; ///< 512 MiB in each array: more than the largest caches
constexpr int repeats = 8;

/// A part of both arrays, for one thread.
struct Part {
    const std::uint64_t* from;
    std::uint64_t* to;
    std::size_t size;

    /// Not a plain copy: that would become a call of memcpy, whose stores may bypass the caches.
    void copy() const {
        for (std::size_t i = 0; i < size; ++i) to[i] = from[i] + 1;
    }
};

/// GB/s in the fastest repeat.
double copy_bandwidth(const std::vector<std::uint64_t>& from, std::vector<std::uint64_t>& to, std::size_t threads) {
    std::barrier<> together(static_cast<std::ptrdiff_t>(threads));
    double least_seconds = 1e300;
    const auto work = [&](std::size_t thread) {
        const std::size_t size = words / threads;
        const Part part{from.data() + thread * size, to.data() + thread * size, size};
        for (int repeat = 0; repeat < repeats; ++repeat) {
            together.arrive_and_wait();
            const auto begin = std::chrono::steady_clock::now();
            part.copy();
            together.arrive_and_wait();
            const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
            if (thread == 0) least_seconds = std::min(least_seconds, taken.count());
        }
    };
    std::vector<std::thread> others;
    for (std::size_t thread = 1; thread < threads; ++thread) others.emplace_back(work, thread);
    work(0);
    for (std::thread& other : others) other.join();
    return 2.0 * sizeof(std::uint64_t) * words / least_seconds / 1e9;
}

} // namespace

int main() {
    const std::vector<std::uint64_t> from(words);
    std::vector<std::uint64_t> to(words);
    const double one = copy_bandwidth(from, to, 1);
    const double two = copy_bandwidth(from, to, 2);
    std::printf("{\"copy_gb_per_s_1_thread\": %.3g, \"copy_gb_per_s_2_threads\": %.3g}\n", one, two);
}
