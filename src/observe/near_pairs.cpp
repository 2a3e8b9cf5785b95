#include "observe/near_pairs.hpp"

#include "collision/portable_math.hpp"
#include "observe/checks.hpp"

#include <algorithm>
#include <cmath>

namespace carom::observe {

namespace {

/// The way across the nearer periodic face.
double wrapped(double d, double size) {
    if (d > 0.5 * size) return d - size;
    return d < -0.5 * size ? d + size : d;
}

/// The cells beside a place on an axis, itself included, each once.
std::vector<std::size_t> beside(std::size_t place, std::size_t cells, bool is_periodic) {
    std::vector<std::size_t> found;
    for (const std::size_t step : {cells - 1, cells, cells + 1}) {
        const std::size_t sum = place + step;
        const bool is_inside = sum >= cells && sum < 2 * cells;
        const std::size_t other = sum % cells;
        if ((is_inside || is_periodic) && std::find(found.begin(), found.end(), other) == found.end()) {
            found.push_back(other);
        }
    }
    return found;
}

} // namespace

NearPairs::NearPairs(const Sample& sample, double reach) : reach_(reach) {
    for (std::size_t k = 0; k < 3; ++k) lay_axis(sample, k);
    sort_bodies(sample);
}

void NearPairs::lay_axis(const Sample& sample, std::size_t k) {
    Axis& axis = axes_[k];
    axis.is_periodic = sample.box && sample.box->faces[2 * k].kind == FaceKind::periodic;
    double high = 0;
    if (axis.is_periodic) {
        axis.low = component(sample.box->min, k);
        high = component(sample.box->max, k);
    } else if (!sample.position.empty()) {
        const auto less = [k](const Vec3& a, const Vec3& b) { return component(a, k) < component(b, k); };
        const auto ends = std::minmax_element(sample.position.begin(), sample.position.end(), less);
        axis.low = component(*ends.first, k);
        high = component(*ends.second, k);
    }
    axis.size = high > axis.low ? high - axis.low : reach_;
    // About as many cells as bodies at most: visiting empty ones costs as well.
    const double most = 1 + detail::pow(static_cast<double>(sample.position.size()), 1.0 / 3);
    axis.cells = static_cast<std::size_t>(std::max(1.0, std::min(axis.size / reach_, most)));
    for (std::size_t place = 0; place < axis.cells; ++place) {
        axis.beside.push_back(beside(place, axis.cells, axis.is_periodic));
    }
}

void NearPairs::sort_bodies(const Sample& sample) {
    std::vector<std::size_t> cell(sample.position.size());
    for (std::size_t i = 0; i < cell.size(); ++i) {
        const Vec3& x = sample.position[i];
        cell[i] = number_of({place(axes_[0], x.x), place(axes_[1], x.y), place(axes_[2], x.z)});
    }
    first_.assign(axes_[0].cells * axes_[1].cells * axes_[2].cells + 1, 0);
    for (const std::size_t c : cell) ++first_[c + 1];
    for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
    std::vector<std::size_t> next(first_.begin(), first_.end() - 1);
    bodies_.resize(cell.size());
    places_.resize(cell.size());
    for (std::size_t i = 0; i < cell.size(); ++i) {
        const std::size_t k = next[cell[i]]++;
        bodies_[k] = static_cast<std::uint32_t>(i);
        places_[k] = sample.position[i];
    }
}

std::size_t NearPairs::place(const Axis& axis, double x) const {
    const double cell = (x - axis.low) / axis.size * static_cast<double>(axis.cells);
    return std::min(static_cast<std::size_t>(std::max(cell, 0.0)), axis.cells - 1);
}

bool NearPairs::may_wrap(const Cell& a, const Cell& b) const {
    for (std::size_t k = 0; k < 3; ++k) {
        const bool is_beside = a[k] <= b[k] + 1 && b[k] <= a[k] + 1;
        if (axes_[k].is_periodic && (axes_[k].cells < 3 || !is_beside)) return true;
    }
    return false;
}

Vec3 NearPairs::short_way(Vec3 d) const {
    if (axes_[0].is_periodic) d.x = wrapped(d.x, axes_[0].size);
    if (axes_[1].is_periodic) d.y = wrapped(d.y, axes_[1].size);
    if (axes_[2].is_periodic) d.z = wrapped(d.z, axes_[2].size);
    return d;
}

} // namespace carom::observe
