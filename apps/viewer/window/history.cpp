#include "viewer/window/history.hpp"

#include <utility>

namespace carom::viewer {

History::History(const World& world, std::size_t most_bytes, std::uint64_t steps_between)
    : start_(world.save()), bytes_(start_.size()), most_bytes_(most_bytes), steps_between_(steps_between) {
    snapshots_.push_back({world.step_count(), start_});
}

void History::keep(const World& world) {
    snapshots_.push_back({world.step_count(), world.save()});
    bytes_ += snapshots_.back().world.size();
    while (bytes_ > most_bytes_ && snapshots_.size() > 1) {
        bytes_ -= snapshots_.front().world.size();
        snapshots_.pop_front();
    }
}

void History::stepped(const World& world) {
    if (world.step_count() >= snapshots_.back().step + steps_between_) keep(world);
}

void History::changed(const World& world) {
    if (snapshots_.size() > 1 && snapshots_.back().step == world.step_count()) {
        bytes_ -= snapshots_.back().world.size();
        snapshots_.pop_back();
    }
    keep(world);
}

World History::back_to(std::uint64_t step, double dt) {
    while (snapshots_.size() > 1 && snapshots_.back().step > step) {
        bytes_ -= snapshots_.back().world.size();
        snapshots_.pop_back();
    }
    World world = World::load(snapshots_.back().world);
    while (world.step_count() < step) world.step(dt);
    return world;
}

World History::start() const { return World::load(start_); }

} // namespace carom::viewer
