#include "space/placement.hpp"

namespace carom::core {

template <class Real>
Ball Placement<Real>::ball_of(Index i) const {
    return ticks_.ball(state_.bodies.motion[i].x, {}, static_cast<double>(state_.bodies.motion[i].radius));
}

template <class Real>
void Placement<Real>::build() {
    const Census census = take_census(state_.bodies);
    ticks_ = Ticks(state_.bounds, state_.resolution, std::max(2 * census.mean_radius, state_.resolution.metres));
    cells_.build(*loops_, state_.bodies.size(), ticks_.axes(census), [this](Index i) { return ball_of(i); });
    valid_ = true;
}

template <class Real>
void Placement<Real>::note(Index first, Index last) {
    if (!valid_) return;
    // Bodies that came late are found more slowly: build anew when they are as many as the sorted ones.
    constexpr std::size_t few = 64;
    if (2 * (cells_.late() + (last - first)) > cells_.size() + few) {
        forget();
        return;
    }
    for (Index i = first; i <= last; ++i) cells_.update(i, ball_of(i));
}

template <class Real>
std::optional<Index> Placement<Real>::overlapping(Index i, Index end) {
    if (!valid_) build();
    const Bodies<Real>& bodies = state_.bodies;
    const auto radius = static_cast<double>(bodies.motion[i].radius);
    std::optional<Index> first;
    cells_.for_each_meeting(ball_of(i), [&](Index other) {
        if (other == i || other >= end || (first && bodies.slot[*first] <= bodies.slot[other])) return;
        if (is_prescribed(bodies.kind[i]) && is_prescribed(bodies.kind[other])) return;
        const auto other_radius = static_cast<double>(bodies.motion[other].radius);
        const double gap = length(separation(state_, state_.bodies.motion[i], state_.bodies.motion[other], {}, {})) -
                           (radius + other_radius);
        if (gap < -touching_tolerance(state_, 2 * std::min(radius, other_radius))) first = other;
    });
    return first;
}

template class Placement<float>;
template class Placement<double>;

} // namespace carom::core
