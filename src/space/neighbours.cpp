#include "space/neighbours.hpp"

#include <algorithm>
#include <new>

namespace carom::core {

void Neighbours::start_lists(std::size_t bodies) {
    known_.assign(bodies, {});
    clear_for_reuse(links_);
    extending_ = false;
    clear_for_bursts(extended_, std::max(extended_.size(), 16 * few_entries));
    extensions_from_ = 0;
    for (Part& part : parts_) part.used = 0;
}

void Neighbours::make_list(Part& part, std::uint32_t number, std::size_t k) {
    const std::size_t place = part.used;
    if (part.lists.size() <= place) part.lists.resize(place + place / 8 + simd_padding);
    ++part.used;
    cells_.find_neighbours(static_cast<std::uint32_t>(k), part.searcher, part.lists, part.used);
    if (part.used > place_mask) throw std::bad_alloc();
    part.lists[place] = static_cast<Index>(part.used - place - 1);
    known_[cells_.spatial_order()[k]].list = number << place_bits | static_cast<std::uint32_t>(place);
}

std::size_t Neighbours::found() const {
    std::size_t sum = 0;
    for (const Part& part : parts_) sum += part.used;
    return sum - std::min(sum, known_.size());
}

void Neighbours::get_ready(std::size_t parts) {
    constexpr std::size_t spare = 4;
    constexpr std::size_t many_entries = 512;
    if (parts <= ready_) return;
    const std::size_t wanted = std::min(2 * parts + spare, parts_of(batch, link_grain));
    for (; ready_ < wanted; ++ready_) {
        parts_[ready_].searcher.get_ready();
        parts_[ready_].meeting.reserve(many_entries);
        parts_[ready_].meetings.reserve(few_entries * link_grain);
    }
}

void Neighbours::find_meeting(Part& part, std::span<const Index> bodies) const {
    part.searcher.start();
    for (const Index body : bodies) {
        cells_.find_meeting(cells_.ball_of(body), body, part.searcher, part.meeting);
        for (const Index other : part.meeting) part.meetings.push_back({body, other});
    }
}

void Neighbours::drop_extensions() {
    if (!extending_) return;
    extending_ = false;
    cells_.undo(extensions_from_);
    for (; !extended_.empty(); extended_.pop_back(), links_.pop_back()) {
        known_[extended_.back()].newest_link = links_.back().next;
    }
}

void Neighbours::link(Index body, Index other) {
    if (extending_) extended_.push_back(body);
    links_.push_back({other, known_[body].newest_link});
    known_[body].newest_link = static_cast<std::uint32_t>(links_.size() - 1);
}

bool Neighbours::is_linked(Index body, Index other) const {
    for (std::uint32_t k = known_[body].newest_link; k != nothing; k = links_[k].next) {
        if (links_[k].other == other) return true;
    }
    return false;
}

} // namespace carom::core
