#include "viewer/stage/moment.hpp"

#include "viewer/stage/bounds.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>

namespace carom::viewer {

namespace {

/// Another number for all bodies of all worlds of this process.
std::uint64_t next_version() {
    static std::atomic<std::uint64_t> last{0};
    return ++last;
}

} // namespace

Vec3 Moment::position_at(std::size_t i, double time) const {
    const double back = end > begin ? std::clamp((end - time) / (end - begin), 0.0, 1.0) : 0;
    const Vec3f& w = way[i];
    return position[i] - Vec3{static_cast<double>(w.x), static_cast<double>(w.y), static_cast<double>(w.z)} * back;
}

void Spectator::read_bodies(const World& world) {
    if (ids_ && ids_->size() == world.size()) return;
    ids_ = std::make_shared<const std::vector<BodyId>>(world.ids());
    const std::size_t count = ids_->size();
    std::vector<double> radius(count);
    mass_.resize(count);
    material_.resize(count);
    world.get(*ids_, {.mass = mass_, .radius = radius, .material = material_});
    radii_ = std::make_shared<const std::vector<float>>(radius.begin(), radius.end());
    version_ = next_version();
}

void Spectator::watch_step(const World& world) {
    read_bodies(world);
    colouring_.count_impacts(world, *ids_);
}

void Spectator::find_ways(const World& world, Moment& moment) {
    const std::size_t count = ids_->size();
    if (!world.options().interpolation) {
        const double seconds = moment.end - moment.begin;
        for (std::size_t i = 0; i < count; ++i) moment.way[i] = narrow(velocity_[i] * seconds);
        return;
    }
    before_.resize(count);
    world.positions_at(moment.begin, *ids_, before_);
    const Vec3 periods = periods_of(world.options().region);
    for (std::size_t i = 0; i < count; ++i) {
        moment.way[i] = narrow(shortest(moment.position[i] - before_[i], periods));
    }
}

std::shared_ptr<Moment> Spectator::look(const World& world, bool with_contacts, std::shared_ptr<Moment> old) {
    read_bodies(world);
    const std::shared_ptr<Moment> moment = old ? std::move(old) : std::make_shared<Moment>();
    const std::size_t count = ids_->size();
    moment->end = world.time();
    moment->begin = world.time() - world.report().advanced;
    moment->ids = ids_;
    moment->radii = radii_;
    moment->version = version_;
    moment->position.resize(count);
    moment->way.resize(count);
    velocity_.resize(count);
    world.get(*ids_, {.position = moment->position, .velocity = velocity_});
    find_ways(world, *moment);
    moment->attractors.assign(world.attractors().begin(), world.attractors().end());
    colouring_.paint({*ids_, moment->position, velocity_, mass_, material_}, moment->attractors, moment->end,
                     moment->looks);
    moment->lowest = colouring_.lowest();
    moment->highest = colouring_.highest();
    moment->contacts = with_contacts ? world.contacts() : std::vector<Contact>{};
    return moment;
}

} // namespace carom::viewer
