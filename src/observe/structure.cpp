// What neighbours look like: g(r), coordination, and the volume that bodies fill.

#include "observe/checks.hpp"
#include "observe/near_pairs.hpp"

#include <carom/observers.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace carom {

namespace {

/// Throws unless distances up to `most` (m) are unambiguous across the periodic faces.
void check_reach(const Box& box, double most) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double side = observe::component(box.max - box.min, axis);
        if (box.faces[2 * axis].kind == FaceKind::periodic && most > 0.5 * side) {
            throw Error(ErrorCode::out_of_range, "most",
                        "must be at most half of a periodic side, " + observe::shown(0.5 * side) + ", got " +
                            observe::shown(most));
        }
    }
}

/// Whether a ball about `x` reaches through no face that is not periodic.
bool is_clear_of_faces(const Box& box, const Vec3& x, double radius) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (box.faces[2 * axis].kind == FaceKind::periodic) continue;
        const double at = observe::component(x, axis);
        if (at - radius < observe::component(box.min, axis) || at + radius > observe::component(box.max, axis)) {
            return false;
        }
    }
    return true;
}

/// m^3: the part of a ball about 0 that lies below `height`.
double volume_below(double radius, double height) {
    const double h = std::clamp(height, -radius, radius) + radius;
    return std::numbers::pi * h * h * (3 * radius - h) / 3;
}

double ball_volume(double radius) { return 4 * std::numbers::pi / 3 * (radius * radius * radius); }

} // namespace

RadialDistribution::RadialDistribution(double most, std::size_t shells) : most_(most) {
    observe::check_positive("most", most);
    observe::check_count("shells", shells);
    counts_.resize(shells);
    g_.resize(shells);
}

void RadialDistribution::observe(const Sample& sample) {
    if (!sample.box) throw Error(ErrorCode::not_available, "region", "g(r) needs a world bounded by a box");
    check_reach(*sample.box, most_);
    const std::size_t bodies = sample.position.size();
    std::vector<char> is_reference(bodies);
    double references = 0;
    for (std::size_t i = 0; i < bodies; ++i) {
        is_reference[i] = is_clear_of_faces(*sample.box, sample.position[i], most_) ? 1 : 0;
        references += is_reference[i];
    }
    if (bodies < 2 || references == 0) return;
    std::fill(counts_.begin(), counts_.end(), 0.0);
    const double width = most_ / static_cast<double>(counts_.size());
    const double shells_per_metre = 1 / width;
    observe::NearPairs(sample, most_).visit([&](std::uint32_t i, std::uint32_t j, double square) {
        const auto shell = static_cast<std::size_t>(std::sqrt(square) * shells_per_metre);
        if (shell < counts_.size()) counts_[shell] += is_reference[i] + is_reference[j];
    });
    const Vec3 size = sample.box->max - sample.box->min;
    const double density = static_cast<double>(bodies - 1) / (size.x * size.y * size.z);
    for (std::size_t k = 0; k < counts_.size(); ++k) {
        const auto inner = static_cast<double>(k) * width;
        const double volume = ball_volume(inner + width) - ball_volume(inner);
        g_[k].add(counts_[k] / (references * density * volume), references);
    }
}

double RadialDistribution::distance(std::size_t shell) const {
    return (static_cast<double>(shell) + 0.5) * most_ / static_cast<double>(g_.size());
}

Coordination::Coordination(double gap) : gap_(gap) {
    if (!std::isfinite(gap)) throw Error(ErrorCode::not_finite, "gap", "must be finite, got " + observe::shown(gap));
    if (gap < 0) throw Error(ErrorCode::out_of_range, "gap", "must be >= 0, got " + observe::shown(gap));
}

void Coordination::observe(const Sample& sample) {
    if (sample.radius.empty()) return;
    contacts_.assign(sample.radius.size(), 0);
    const double largest = *std::max_element(sample.radius.begin(), sample.radius.end());
    // A little more, so that what touches exactly at the limit is seen.
    const double reach = 2 * largest * (1 + gap_) * (1 + 1e-9);
    if (!(reach > 0)) return;
    observe::NearPairs(sample, reach).visit([&](std::uint32_t i, std::uint32_t j, double square) {
        const double limit = (sample.radius[i] + sample.radius[j]) * (1 + gap_);
        if (square > limit * limit) return;
        ++contacts_[i];
        ++contacts_[j];
    });
    double bodies = 0;
    double settled = 0;
    double all_contacts = 0;
    double settled_contacts = 0;
    std::array<double, most_contacts + 1> counts{};
    for (std::size_t i = 0; i < contacts_.size(); ++i) {
        if (sample.mass[i] == infinite_mass) continue;
        ++bodies;
        all_contacts += contacts_[i];
        ++counts[std::min<std::size_t>(contacts_[i], most_contacts)];
        if (contacts_[i] < 4) continue;
        ++settled;
        settled_contacts += contacts_[i];
    }
    if (bodies == 0) return;
    mean_.add(all_contacts / bodies);
    without_rattlers_.add(settled > 0 ? settled_contacts / settled : 0, settled);
    for (std::size_t k = 0; k < counts.size(); ++k) shares_[k].add(counts[k] / bodies);
}

SlabPacking::SlabPacking(std::size_t axis, double low, double high, double area)
    : axis_(axis), low_(low), high_(high), area_(area) {
    observe::check_axis(axis);
    observe::check_interval(low, high);
    observe::check_positive("area", area);
}

void SlabPacking::observe(const Sample& sample) {
    double volume = 0;
    for (std::size_t i = 0; i < sample.position.size(); ++i) {
        const double at = observe::component(sample.position[i], axis_);
        const double r = sample.radius[i];
        volume += volume_below(r, high_ - at) - volume_below(r, low_ - at);
    }
    fraction_.add(volume / (area_ * (high_ - low_)));
}

} // namespace carom
