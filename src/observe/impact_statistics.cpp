#include "observe/checks.hpp"

#include <carom/observers.hpp>

#include <algorithm>

namespace carom {

namespace {

constexpr std::uint64_t kinetic_every = 8; // steps: the sum over all bodies costs more than the impacts

double volume_of(const Box& box) {
    const Vec3 size = box.max - box.min;
    return size.x * size.y * size.z;
}

void check_recording(const WorldOptions& options) {
    if (!options.record_impacts) {
        throw Error(ErrorCode::not_available, "record_impacts", "must be true to observe impacts, got false");
    }
    if (options.least_recorded_impulse > 0) {
        throw Error(ErrorCode::not_available, "least_recorded_impulse",
                    "must be 0 to observe impacts, got " + observe::shown(options.least_recorded_impulse));
    }
}

} // namespace

void Energies::observe(const World& world) {
    const Energy energy = world.energy();
    const Vec3 p = world.momentum();
    kinetic_.add(energy.kinetic);
    potential_.add(energy.potential);
    total_.add(energy.total());
    for (std::size_t axis = 0; axis < 3; ++axis) momentum_[axis].add(observe::component(p, axis));
}

ImpactStatistics::ImpactStatistics(const World& world) {
    check_recording(world.options());
    const std::vector<BodyId> ids = world.ids();
    std::vector<double> mass(ids.size());
    std::vector<double> radius(ids.size());
    world.get(ids, {.mass = mass, .radius = radius});
    radius_.resize(ids.empty() ? 0 : ids.back().slot + std::size_t{1});
    for (std::size_t i = 0; i < ids.size(); ++i) radius_[ids[i].slot] = radius[i];
    bodies_ = static_cast<double>(std::count_if(mass.begin(), mass.end(), [](double m) { return m < infinite_mass; }));
    const Region region = world.region();
    if (const auto* box = std::get_if<Box>(&region)) volume_ = volume_of(*box);
    face_force_.resize(world.face_forces().size());
    impulse_.resize(face_force_.size());
}

void ImpactStatistics::observe(const World& world) {
    check_recording(world.options());
    const double dt = world.report().advanced;
    if (!(dt > 0 && bodies_ > 0)) return;
    impulse_ = world.face_forces();
    for (double& impulse : impulse_) impulse *= dt;
    Vec3 virial{};
    std::uint64_t pairs = 0;
    const auto radius_of = [this](BodyId id) { return detail::element(radius_, id.slot, "body"); };
    for (const Impact& impact : world.impacts()) {
        if (impact.face >= 0) {
            impulse_[static_cast<std::size_t>(impact.face)] += impact.impulse;
            continue;
        }
        ++pairs;
        const Vec3& n = impact.normal;
        const double strength = impact.impulse * (radius_of(impact.a) + radius_of(impact.b));
        virial += strength * Vec3{n.x * n.x, n.y * n.y, n.z * n.z};
    }
    count_ += pairs;
    duration_ += dt;
    rate_.add(2 * static_cast<double>(pairs) / (bodies_ * dt), dt);
    for (std::size_t axis = 0; axis < 3; ++axis) virial_[axis].add(observe::component(virial, axis) / dt, dt);
    for (std::size_t face = 0; face < impulse_.size(); ++face) face_force_[face].add(impulse_[face] / dt, dt);
    if (volume_) {
        if (rate_.samples() % kinetic_every == 1) kinetic_ = world.energy().kinetic;
        const double sum = virial.x + virial.y + virial.z;
        pressure_.add((2 * kinetic_ + sum / dt) / (3 * *volume_), dt);
    }
}

Estimate ImpactStatistics::pressure() const {
    if (!volume_) throw Error(ErrorCode::not_available, "region", "a pressure needs a world bounded by a box");
    return pressure_.estimate();
}

Estimate ImpactStatistics::face_force(std::size_t face) const {
    if (face < face_force_.size()) return face_force_[face].estimate();
    throw Error(ErrorCode::out_of_range, "face", "the region has no face " + std::to_string(face));
}

} // namespace carom
