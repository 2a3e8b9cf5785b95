/// \file
/// A small table from bodies to places.
#pragma once

#include "space/bodies.hpp"

#include <bit>
#include <utility>
#include <vector>

namespace carom::core {

/// Finds a body's place in a short list. Open addressing with linear probing; cleared in the time of its entries.
class IndexMap {
public:
    IndexMap() { keys_.reserve(entries_.size() / 2); }

    /// no_index if the key is not there.
    [[nodiscard]] std::uint32_t find(Index key) const {
        for (std::size_t k = home(key);; k = next(k)) {
            if (entries_[k].key == key) return entries_[k].value;
            if (entries_[k].key == no_index) return no_index;
        }
    }
    /// The key must not be there yet.
    void insert(Index key, std::uint32_t value) {
        if (2 * (keys_.size() + 1) > entries_.size()) grow();
        put(key, value);
        keys_.push_back(key);
    }
    void clear() {
        for (const Index key : keys_) {
            // Whatever stands between a key's home and its place is a key as well, and goes, too.
            for (std::size_t k = home(key); entries_[k].key != no_index; k = next(k)) entries_[k] = {};
        }
        keys_.clear();
    }

private:
    struct Entry {
        Index key = no_index;
        std::uint32_t value = no_index;
    };

    [[nodiscard]] std::size_t next(std::size_t k) const { return (k + 1) & (entries_.size() - 1); }
    [[nodiscard]] std::size_t home(Index key) const {
        // Fibonacci hashing: Knuth, The Art of Computer Programming 3, section 6.4.
        return (key * 0x9e3779b97f4a7c15U) >> (64 - std::bit_width(entries_.size() - 1));
    }
    void put(Index key, std::uint32_t value) {
        std::size_t k = home(key);
        while (entries_[k].key != no_index) k = next(k);
        entries_[k] = {key, value};
    }
    void grow() {
        const std::vector<Entry> old = std::exchange(entries_, std::vector<Entry>(2 * entries_.size()));
        keys_.reserve(entries_.size() / 2);
        for (const Entry& entry : old) {
            if (entry.key != no_index) put(entry.key, entry.value);
        }
    }

    std::vector<Entry> entries_ = std::vector<Entry>(64);
    std::vector<Index> keys_;
};

} // namespace carom::core
