/// \file
/// Lists that are filled anew in each window.
#pragma once

#include <cmath>
#include <cstddef>

namespace carom::core {

/// Room for the odd entry.
inline constexpr std::size_t few_entries = 16;

/// By how much a count of independent events may differ from another time: so many standard deviations.
inline std::size_t fluctuation(std::size_t count, unsigned deviations) {
    return static_cast<std::size_t>(deviations * std::sqrt(static_cast<double>(count))) + few_entries;
}

/// More than what a count in a steady state rises to, if it was `size` once.
inline std::size_t with_spare(std::size_t size) { return size + size / 2 + fluctuation(size, 8); }

/// Empties a list that is to become about as long again, and leaves it so much room that a world in a steady state
/// allocates no memory. `peak`: how long such lists became at most, if there are several like it.
template <class List>
void clear_for_reuse(List& list, std::size_t peak) {
    list.clear();
    if (peak > 0 && list.capacity() < peak + fluctuation(peak, 2)) list.reserve(with_spare(peak));
}
template <class List>
void clear_for_reuse(List& list) {
    clear_for_reuse(list, list.size());
}

/// The same for a list that is short most of the time, and then many times as long.
template <class List>
void clear_for_bursts(List& list, std::size_t peak) {
    list.clear();
    if (peak > 0 && list.capacity() < peak + peak / 2) list.reserve(3 * (peak + few_entries));
}
template <class List>
void clear_for_bursts(List& list) {
    clear_for_bursts(list, list.size());
}

} // namespace carom::core
