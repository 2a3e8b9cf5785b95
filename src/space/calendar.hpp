/// \file
/// What is due in which window of an epoch.
#pragma once

#include "space/bodies.hpp"
#include "space/parallel.hpp"

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
        for (auto& window : pages_) {
            for (Page& page : window) page.clear();
        }
    }

    void add_pair(std::size_t part, std::uint32_t window, Index a, Index b) {
        pages_[window][part].pairs.emplace_back(a, b);
    }
    void add_wall(std::size_t part, std::uint32_t window, Index body) { pages_[window][part].walls.push_back(body); }
    void add_exit(std::size_t part, std::uint32_t window, Index body) { pages_[window][part].exits.push_back(body); }

    /// Moves what is due in a window to the ends of the lists.
    void take_pairs(std::uint32_t window, std::vector<Pair>& pairs) { take(window, &Page::pairs, pairs); }
    void take_walls(std::uint32_t window, std::vector<Index>& bodies) { take(window, &Page::walls, bodies); }
    void take_exits(std::uint32_t window, std::vector<Index>& bodies) { take(window, &Page::exits, bodies); }

private:
    struct Page {
        std::vector<Pair> pairs;
        std::vector<Index> walls; ///< bodies that may come to a wall
        std::vector<Index> exits; ///< bodies that may leave their covers

        void clear() {
            pairs.clear();
            walls.clear();
            exits.clear();
        }
    };

    template <class T>
    void take(std::uint32_t window, std::vector<T> Page::* list, std::vector<T>& out) {
        for (Page& page : pages_[window]) {
            out.insert(out.end(), (page.*list).begin(), (page.*list).end());
            (page.*list).clear();
        }
    }

    std::array<std::array<Page, most_parts>, most_windows> pages_{};
};

} // namespace carom::core
