#include "memory.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

#ifdef __GLIBC__
#    include <malloc.h>
#endif

namespace carom::cli {

void release_freed_memory() {
#ifdef __GLIBC__
    ::malloc_trim(0);
#endif
}

std::uint64_t resident_bytes() {
    release_freed_memory();
    std::ifstream statm("/proc/self/statm");
    std::uint64_t all_pages = 0;
    std::uint64_t resident_pages = 0;
    statm >> all_pages >> resident_pages;
    return resident_pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
}

std::uint64_t peak_resident_bytes() {
    rusage usage{};
    if (::getrusage(RUSAGE_SELF, &usage) != 0) return 0;
    return static_cast<std::uint64_t>(usage.ru_maxrss) * 1024;
}

double bytes_per_body(std::uint64_t before, std::uint64_t bodies) {
    const std::uint64_t now = resident_bytes();
    if (bodies == 0 || now <= before) return 0;
    return static_cast<double>(now - before) / static_cast<double>(bodies);
}

} // namespace carom::cli
