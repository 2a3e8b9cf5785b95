#include <carom/observers.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace carom {

namespace {

constexpr std::size_t most_blocks = 64;

} // namespace

void detail::refuse_index(const char* name, std::size_t index, std::size_t size) {
    throw Error(ErrorCode::out_of_range, name,
                "must be less than " + std::to_string(size) + ", got " + std::to_string(index));
}

void BlockAverage::add(double value, double weight) {
    if (in_last_ == 0) {
        if (blocks_.size() == most_blocks) merge_pairs();
        blocks_.push_back({});
    }
    blocks_.back().weight += weight;
    blocks_.back().sum += weight * value;
    ++samples_;
    if (++in_last_ == block_size_) in_last_ = 0;
}

void BlockAverage::merge_pairs() {
    for (std::size_t i = 0; i < most_blocks / 2; ++i) {
        const Block& first = blocks_[2 * i];
        const Block& second = blocks_[2 * i + 1];
        blocks_[i] = {first.weight + second.weight, first.sum + second.sum};
    }
    blocks_.resize(most_blocks / 2);
    block_size_ *= 2;
}

Estimate BlockAverage::estimate() const {
    double weight = 0;
    double sum = 0;
    for (const Block& block : blocks_) {
        weight += block.weight;
        sum += block.sum;
    }
    if (!(weight > 0)) return {};
    const double mean = sum / weight;
    // An unfinished block counts in the mean; in the error it would weigh too much.
    const std::size_t finished = blocks_.size() - (in_last_ > 0 ? 1 : 0);
    double squares = 0;
    double finished_weight = 0;
    for (std::size_t i = 0; i < finished; ++i) {
        const double deviation = blocks_[i].sum - blocks_[i].weight * mean;
        squares += deviation * deviation;
        finished_weight += blocks_[i].weight;
    }
    if (finished < 2 || !(finished_weight > 0)) return {.value = mean};
    const auto count = static_cast<double>(finished);
    return {mean, std::sqrt(squares * count / (count - 1)) / finished_weight};
}

} // namespace carom
