/// \file
/// The world's time: a step count and an offset, so that long runs lose no resolution.
#pragma once

#include "space/sum.hpp"

#include <cmath>
#include <cstdint>
#include <initializer_list>

namespace carom::core {

class Clock {
public:
    /// s, a step's limit: far from where the products below overflow.
    static constexpr double longest_interval = 1e100;

    /// A step of `dt` seconds was done.
    void advance(double dt) {
        if (dt != interval_) {
            past_ = product_added(past_, interval_, repeats_);
            interval_ = dt;
            repeats_ = 0;
        }
        ++repeats_;
        ++steps_;
    }
    [[nodiscard]] double seconds() const { return product_added(past_, interval_, repeats_).value(); }
    [[nodiscard]] std::uint64_t steps() const { return steps_; }

    /// False for what no sequence of steps leads to.
    [[nodiscard]] bool is_sound() const {
        return interval_ >= 0 && interval_ <= longest_interval && std::isfinite(seconds()) && seconds() >= 0;
    }

    template <class Archive>
    void transfer(Archive& archive) {
        archive(past_.main, past_.carry, interval_, repeats_, steps_);
    }

private:
    /// sum + interval * repeats, the product in two exact halves: 26 bits of the interval times 26 bits of the count.
    static Sum product_added(Sum sum, double interval, std::uint64_t repeats) {
        constexpr double splitter = 134217729; // 2^27 + 1: Veltkamp's split
        const double big = splitter * interval;
        const double head = big - (big - interval);
        const double tail = interval - head;
        constexpr std::uint64_t low_bits = (std::uint64_t{1} << 26U) - 1;
        for (const std::uint64_t part : {repeats & ~low_bits, repeats & low_bits}) {
            sum.add(head * static_cast<double>(part));
            sum.add(tail * static_cast<double>(part));
        }
        return sum;
    }

    Sum past_;            ///< s, before the present run of equal steps
    double interval_ = 0; ///< s, of the present run
    std::uint64_t repeats_ = 0;
    std::uint64_t steps_ = 0;
};

} // namespace carom::core
