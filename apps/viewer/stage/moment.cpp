#include "viewer/stage/moment.hpp"

#include "viewer/stage/bounds.hpp"
#include "viewer/stage/version.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <variant>

namespace carom::viewer {

double Moment::part_left(double time) const {
    return end > begin ? std::clamp((end - time) / (end - begin), 0.0, 1.0) : 0;
}

Vec3 Moment::position_at(std::size_t i, double time) const {
    const Vec3f& w = way[i];
    return position[i] -
           Vec3{static_cast<double>(w.x), static_cast<double>(w.y), static_cast<double>(w.z)} * part_left(time);
}

Region Moment::region_at(double time) const {
    const double left = part_left(time);
    Region now = region;
    if (auto* const box = std::get_if<Box>(&now)) {
        const auto& before = std::get<Box>(region_before);
        box->min += (before.min - box->min) * left;
        box->max += (before.max - box->max) * left;
    } else if (auto* const planes = std::get_if<std::vector<Plane>>(&now)) {
        const auto& before = std::get<std::vector<Plane>>(region_before);
        for (std::size_t i = 0; i < planes->size(); ++i) {
            Vec3& point = planes->at(i).point;
            point += (before.at(i).point - point) * left;
        }
    }
    return now;
}

void Spectator::read_bodies(const World& world) {
    if (ids_ && ids_->size() == world.size()) return;
    ids_ = std::make_shared<const std::vector<BodyId>>(world.ids());
    const std::size_t count = ids_->size();
    std::vector<double> growth(count);
    mass_.resize(count);
    material_.resize(count);
    world.get(*ids_, {.mass = mass_, .material = material_, .growth = growth});
    growing_ = std::any_of(growth.begin(), growth.end(), [](double rate) { return rate != 0; });
    read_radii(world);
}

void Spectator::read_radii(const World& world) {
    std::vector<double> radius(ids_->size());
    world.get(*ids_, {.radius = radius});
    radii_ = std::make_shared<const std::vector<float>>(radius.begin(), radius.end());
    version_ = next_version();
}

void Spectator::bodies_changed() {
    ids_ = nullptr;
    region_ = region_before_ = std::nullopt;
}

void Spectator::watch_step(const World& world) {
    read_bodies(world);
    region_before_ = std::exchange(region_, world.region());
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
    if (growing_) read_radii(world);
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
    if (!region_) region_ = world.region();
    moment->region = *region_;
    moment->region_before = region_before_ ? *region_before_ : moment->region;
    moment->contacts = with_contacts ? world.contacts() : std::vector<Contact>{};
    return moment;
}

} // namespace carom::viewer
