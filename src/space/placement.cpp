#include "space/placement.hpp"

namespace carom::core {

template <class Real>
SweptBox Placement<Real>::box_of(Index i) const {
    return ticks_.box(state_.bodies.motion[i].x, {}, {}, static_cast<double>(state_.bodies.motion[i].radius));
}

template <class Real>
void Placement<Real>::rebuild() {
    const Census census = take_census(state_.bodies);
    ticks_ = Ticks(state_.bounds, state_.resolution, std::max(2 * census.mean_radius, state_.resolution.metres));
    std::vector<SweptBox> boxes(state_.bodies.size());
    for (Index i = 0; i < boxes.size(); ++i) boxes[i] = box_of(i);
    cells_.build(boxes, ticks_.axes(census));
    valid_ = true;
}

template <class Real>
void Placement<Real>::put(Index i) {
    // Bodies that came late are found more slowly: build anew when they are as many as the sorted ones.
    constexpr std::size_t few = 64;
    if (!valid_ || 2 * cells_.late() > cells_.size() + few || i > cells_.size() + few) {
        rebuild();
        return;
    }
    for (auto k = static_cast<Index>(std::min<std::size_t>(i, cells_.size())); k <= i; ++k) cells_.update(k, box_of(k));
}

template <class Real>
std::optional<Index> Placement<Real>::overlapping(Index i, Index end) {
    const Bodies<Real>& bodies = state_.bodies;
    const auto radius = static_cast<double>(bodies.motion[i].radius);
    std::optional<Index> first;
    cells_.for_each_meeting(box_of(i), [&](Index other) {
        if (other == i || other >= end || (first && *first <= other)) return;
        if (bodies.kind[i] == Kind::fixed && bodies.kind[other] == Kind::fixed) return;
        const auto other_radius = static_cast<double>(bodies.motion[other].radius);
        const double gap = length(separation(state_, i, other, {}, {})) - (radius + other_radius);
        if (gap < -touching_tolerance(state_, 2 * std::min(radius, other_radius))) first = other;
    });
    return first;
}

template class Placement<float>;
template class Placement<double>;

} // namespace carom::core
