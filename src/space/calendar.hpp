/// \file
/// What is due in which window of an epoch.
#pragma once

#include "space/bodies.hpp"
#include "space/parallel.hpp"
#include "space/reuse.hpp"

#include <array>
#include <utility>
#include <vector>

namespace carom::core {

/// For each window of an epoch the pairs and bodies to look at, no earlier. Parts of a loop write to pages of their
/// own, so that they need no lock and leave the same behind whatever the threads.
class Calendar {
public:
    using Pair = std::pair<Index, Index>;

    static constexpr std::uint32_t most_windows = 64;

    void clear() {
        // A window more than ever may come to be used.
        const std::size_t used = used_windows_ + 1;
        for (std::size_t window = 0; window < most_windows; ++window) {
            for (std::size_t part = 0; part < most_parts; ++part) {
                pages_[window][part].clear(window < used ? peaks_[part] : Peaks{});
            }
        }
    }

    void add_pair(std::size_t part, std::uint32_t window, Index a, Index b) {
        pages_[window][part].pairs.emplace_back(a, b);
    }
    void add_wall(std::size_t part, std::uint32_t window, Index body) { pages_[window][part].walls.push_back(body); }
    void add_exit(std::size_t part, std::uint32_t window, Index body) { pages_[window][part].exits.push_back(body); }

    /// Moves what is due in a window to the ends of the lists.
    void take_pairs(std::uint32_t window, std::vector<Pair>& pairs) {
        take(window, &Page::pairs, &Peaks::pairs, pairs);
    }
    void take_walls(std::uint32_t window, std::vector<Index>& bodies) {
        take(window, &Page::walls, &Peaks::walls, bodies);
    }
    void take_exits(std::uint32_t window, std::vector<Index>& bodies) {
        take(window, &Page::exits, &Peaks::exits, bodies);
    }

private:
    /// Lengths of the longest lists of a part so far.
    struct Peaks {
        std::size_t pairs = 0;
        std::size_t walls = 0;
        std::size_t exits = 0;
    };
    struct Page {
        std::vector<Pair> pairs;
        std::vector<Index> walls; ///< bodies that may come to a wall
        std::vector<Index> exits; ///< bodies that may leave their covers

        void clear(const Peaks& peaks) {
            clear_for_reuse(pairs, peaks.pairs);
            clear_for_reuse(walls, peaks.walls);
            clear_for_reuse(exits, peaks.exits);
        }
    };

    template <class T>
    void take(std::uint32_t window, std::vector<T> Page::* list, std::size_t Peaks::* peak, std::vector<T>& out) {
        used_windows_ = std::max(used_windows_, window + 1);
        for (std::size_t part = 0; part < most_parts; ++part) {
            std::vector<T>& entries = pages_[window][part].*list;
            std::size_t& longest = peaks_[part].*peak;
            longest = std::max(longest, entries.size());
            out.insert(out.end(), entries.begin(), entries.end());
            clear_for_reuse(entries, longest);
        }
    }

    std::array<std::array<Page, most_parts>, most_windows> pages_{};
    std::array<Peaks, most_parts> peaks_{};
    std::uint32_t used_windows_ = 0; ///< by the longest epoch so far
};

} // namespace carom::core
