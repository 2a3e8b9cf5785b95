#include "observe/checks.hpp"

#include <carom/observers.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace carom {

Speeds::Speeds(double most, std::size_t bins) : width_(most / static_cast<double>(bins)) {
    observe::check_positive("most", most);
    observe::check_count("bins", bins);
    histogram_.resize(bins);
    counts_.resize(bins);
}

void Speeds::observe(const Sample& sample) {
    std::fill(counts_.begin(), counts_.end(), 0.0);
    double bodies = 0;
    double energy = 0;
    std::array<double, 4> sums{};
    for (std::size_t i = 0; i < sample.velocity.size(); ++i) {
        if (sample.mass[i] == infinite_mass) continue;
        const double square = length_squared(sample.velocity[i]);
        const double speed = std::sqrt(square);
        const double bin = speed / width_;
        if (bin < static_cast<double>(counts_.size())) ++counts_[static_cast<std::size_t>(bin)];
        ++bodies;
        energy += sample.mass[i] * square;
        sums[0] += speed;
        sums[1] += square;
        sums[2] += square * speed;
        sums[3] += square * square;
    }
    if (bodies == 0) return;
    for (std::size_t i = 0; i < counts_.size(); ++i) histogram_[i].add(counts_[i] / (bodies * width_));
    for (std::size_t i = 0; i < sums.size(); ++i) moments_[i].add(sums[i] / bodies);
    temperature_.add(energy / (3 * bodies));
    if (sums[1] > 0) a2_.add(0.6 * sums[3] * bodies / (sums[1] * sums[1]) - 1);
}

double Speeds::speed(std::size_t bin) const { return (static_cast<double>(bin) + 0.5) * width_; }

Estimate Speeds::moment(std::size_t power) const {
    if (power >= 1 && power <= moments_.size()) return moments_[power - 1].estimate();
    throw Error(ErrorCode::out_of_range, "power", "must be 1 to 4, got " + std::to_string(power));
}

Estimate mean_free_path(const Speeds& speeds, const ImpactStatistics& impacts) {
    const Estimate speed = speeds.moment(1);
    const Estimate rate = impacts.collision_rate();
    if (!(rate.value > 0)) return {.value = std::numeric_limits<double>::infinity()};
    const double path = speed.value / rate.value;
    const double of_speed = speed.standard_error / speed.value;
    const double of_rate = rate.standard_error / rate.value;
    return {path, path * std::sqrt(of_speed * of_speed + of_rate * of_rate)};
}

} // namespace carom
