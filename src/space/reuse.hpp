/// \file
/// Lists that are filled anew in each window.
#pragma once

#include <cstddef>

namespace carom::core {

/// Room for the odd entry.
inline constexpr std::size_t few_entries = 16;

/// More than what a count in a steady state rises to, if it was `size` once.
inline std::size_t with_spare(std::size_t size) { return 2 * size + 4 * few_entries; }

/// Empties a list that is to become about as long again, and leaves it so much room that a world in a steady state
/// allocates no memory. `peak`: how long such lists became at most, if there are several like it.
template <class List>
void clear_for_reuse(List& list, std::size_t peak) {
    list.clear();
    if (peak > 0 && list.capacity() < peak + peak / 8 + few_entries) list.reserve(with_spare(peak));
}
template <class List>
void clear_for_reuse(List& list) {
    clear_for_reuse(list, list.size());
}

} // namespace carom::core
