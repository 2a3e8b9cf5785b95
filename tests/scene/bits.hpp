/// \file
/// One number for many: pins down every bit of what a generator makes.
#pragma once

#include <carom/base.hpp>

#include <bit>
#include <cstdint>
#include <span>

namespace carom::scene {

/// FNV-1a over the bits of numbers, in their order.
class BitHash {
public:
    void add(std::uint64_t bits) {
        constexpr std::uint64_t prime = 0x100000001b3U;
        for (unsigned shift = 0; shift < 64; shift += 8) value_ = (value_ ^ ((bits >> shift) & 0xffU)) * prime;
    }
    void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
    void add(const Vec3& vector) {
        add(vector.x);
        add(vector.y);
        add(vector.z);
    }
    [[nodiscard]] std::uint64_t value() const { return value_; }

private:
    std::uint64_t value_ = 0xcbf29ce484222325U;
};

template <class T>
std::uint64_t hash_of(std::span<const T> values) {
    BitHash hash;
    for (const T& value : values) hash.add(value);
    return hash.value();
}

} // namespace carom::scene
