#include "space/neighbours.hpp"

#include <algorithm>

namespace carom::core {

void Neighbours::make_lists(std::size_t bodies) {
    first_.assign(bodies + 1, 0);
    for (const auto& [a, b] : pairs_.pairs()) {
        ++first_[a];
        ++first_[b];
    }
    std::uint32_t end = 0;
    for (std::uint32_t& first : first_) first = end += first;
    asks_list_.assign(bodies, 1);
    list_.resize(2 * pairs_.pairs().size());
    // From the ends down: afterwards each entry is where its list begins.
    for (const auto& [a, b] : pairs_.pairs()) {
        list_[--first_[a]] = b;
        list_[--first_[b]] = a;
    }
    newest_link_.assign(bodies, nothing);
    links_.clear();
}

void Neighbours::link(Index body, Index other) {
    links_.push_back({other, newest_link_[body]});
    newest_link_[body] = static_cast<std::uint32_t>(links_.size() - 1);
}

bool Neighbours::knows(Index body, Index other) const {
    for (std::uint32_t k = newest_link_[body]; k != nothing; k = links_[k].next) {
        if (links_[k].other == other) return true;
    }
    if (asks_list_[body] == 0) return false;
    const auto first = list_.begin() + first_[other];
    const auto end = list_.begin() + first_[other + 1];
    return std::find(first, end, body) != end;
}
} // namespace carom::core
