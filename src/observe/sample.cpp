#include <carom/observers.hpp>

namespace carom {

void Sample::read(const World& world) {
    time = world.time();
    const std::vector<BodyId> ids = world.ids();
    position.resize(ids.size());
    velocity.resize(ids.size());
    mass.resize(ids.size());
    radius.resize(ids.size());
    world.get(ids, {.position = position, .velocity = velocity, .mass = mass, .radius = radius});
    const Region region = world.region();
    const auto* bounds = std::get_if<Box>(&region);
    box = bounds != nullptr ? std::optional(*bounds) : std::nullopt;
}

} // namespace carom
