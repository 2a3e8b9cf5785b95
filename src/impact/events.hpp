/// \file
/// The queue of predicted impacts.
#pragma once

#include "space/bodies.hpp"

#include <algorithm>
#include <vector>

namespace carom::core {

/// A predicted impact; outdated as soon as one of its bodies has another version.
struct Event {
    double time = 0; ///< s since the start of the step
    Index a = no_index;
    std::uint32_t b = no_index; ///< the other body, or wall_bit | index of a wall
    std::uint32_t version_a = 0;
    std::uint32_t version_b = 0; ///< 0 for a wall

    static constexpr std::uint32_t wall_bit = 0x80000000U;
    [[nodiscard]] bool at_wall() const { return (b & wall_bit) != 0; }
    [[nodiscard]] std::uint32_t wall() const { return b & ~wall_bit; }
};

/// What orders events of one time: the slots of the bodies, or of the body and the wall.
using EventIds = std::pair<std::uint32_t, std::uint32_t>;

template <class Real>
EventIds ids_of(const Bodies<Real>& bodies, const Event& event) {
    const std::uint32_t a = bodies.slot[event.a];
    if (event.at_wall()) return {a, event.b};
    return std::minmax(a, bodies.slot[event.b]);
}

/// Events by (time, ids): the order is a function of the state alone, never of the order of discovery.
template <class Real>
class EventQueue {
public:
    explicit EventQueue(const Bodies<Real>& bodies) : bodies_(&bodies) {}

    void reserve(std::size_t events) { heap_.reserve(events); }
    void clear() { heap_.clear(); }
    [[nodiscard]] bool empty() const { return heap_.empty(); }
    [[nodiscard]] const Event& top() const { return heap_.front(); }

    /// An event that may come right after the top; none if the queue is short.
    [[nodiscard]] const Event* candidate(std::size_t k) const { return k < heap_.size() ? &heap_[k] : nullptr; }

    void push(const Event& event) {
        heap_.push_back(event);
        std::push_heap(heap_.begin(), heap_.end(), Later{bodies_});
    }
    void pop() {
        std::pop_heap(heap_.begin(), heap_.end(), Later{bodies_});
        heap_.pop_back();
    }

    [[nodiscard]] bool outdated(const Event& event) const {
        return outdated_for_a(event) || (!event.at_wall() && bodies_->course[event.b].version != event.version_b);
    }
    /// Whether body a has had another impact since.
    [[nodiscard]] bool outdated_for_a(const Event& event) const {
        return bodies_->course[event.a].version != event.version_a;
    }

private:
    struct Later {
        const Bodies<Real>* bodies;
        bool operator()(const Event& x, const Event& y) const {
            return x.time > y.time || (x.time == y.time && ids_of(*bodies, x) > ids_of(*bodies, y));
        }
    };

    const Bodies<Real>* bodies_;
    std::vector<Event> heap_;
};

} // namespace carom::core
