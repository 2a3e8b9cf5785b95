#include <carom/observers.hpp>

namespace carom {

void Sample::read(const World& world) {
    time = world.time();
    if (ids_.size() != world.size() || (!ids_.empty() && !world.contains(ids_.back()))) ids_ = world.ids();
    position.resize(ids_.size());
    velocity.resize(ids_.size());
    mass.resize(ids_.size());
    radius.resize(ids_.size());
    world.get(ids_, {.position = position, .velocity = velocity, .mass = mass, .radius = radius});
    const auto* bounds = std::get_if<Box>(&world.options().region);
    box = bounds != nullptr ? std::optional(*bounds) : std::nullopt;
}

} // namespace carom
