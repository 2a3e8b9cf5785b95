#include "collision/portable_math.hpp"
#include "viewer/sound/sound_stage.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace carom::sound {

namespace {

/// What the sound asks of bodies.
struct Bodies {
    std::vector<Vec3> position;
    std::vector<Vec3> velocity;
    std::vector<double> mass;
    std::vector<double> radius;
    std::vector<double> restitution;
};

Bodies read(const World& world, std::span<const BodyId> ids) {
    const std::size_t count = ids.size();
    Bodies bodies{std::vector<Vec3>(count), std::vector<Vec3>(count), std::vector<double>(count),
                  std::vector<double>(count), std::vector<double>(count)};
    world.get(ids, {.position = bodies.position,
                    .velocity = bodies.velocity,
                    .mass = bodies.mass,
                    .radius = bodies.radius,
                    .restitution = bodies.restitution});
    return bodies;
}

bool moves(double mass) { return mass < infinite_mass; }

struct Extent {
    Vec3 min{};
    Vec3 max{};

    [[nodiscard]] double size() const { return std::max({max.x - min.x, max.y - min.y, max.z - min.z}); }
};

Extent extent_of(const Bodies& bodies) {
    Extent extent;
    for (std::size_t i = 0; i < bodies.position.size(); ++i) {
        const Vec3 half{bodies.radius[i], bodies.radius[i], bodies.radius[i]};
        const Vec3 low = bodies.position[i] - half;
        const Vec3 high = bodies.position[i] + half;
        if (i == 0) extent = {low, high};
        extent.min = {std::min(extent.min.x, low.x), std::min(extent.min.y, low.y), std::min(extent.min.z, low.z)};
        extent.max = {std::max(extent.max.x, high.x), std::max(extent.max.y, high.y), std::max(extent.max.z, high.z)};
    }
    return extent;
}

/// m: a world of points, or of nothing, counts as one metre large.
double size_of(const Extent& extent) { return extent.size() > 0 ? extent.size() : 1; }

/// m/s: the root mean square, or what a fall through half the extent gives, or 1.
double usual_speed(const World& world, const Bodies& bodies, double size) {
    double square = 0;
    std::size_t moving = 0;
    for (std::size_t i = 0; i < bodies.mass.size(); ++i) {
        if (!moves(bodies.mass[i])) continue;
        square += length_squared(bodies.velocity[i]);
        ++moving;
    }
    if (moving > 0) square /= static_cast<double>(moving);
    const double speed = std::sqrt(std::max(square, length(world.options().gravity) * size));
    return speed > 0 ? speed : 1;
}

double usual_mass(const Bodies& bodies) {
    double logarithms = 0;
    std::size_t moving = 0;
    for (const double mass : bodies.mass) {
        if (!moves(mass)) continue;
        logarithms += detail::log(mass);
        ++moving;
    }
    return moving > 0 ? detail::exp(logarithms / static_cast<double>(moving)) : 1;
}

} // namespace

SoundSettings settings_for(const World& world) {
    const Bodies bodies = read(world, world.ids());
    const double size = size_of(extent_of(bodies));
    SoundSettings settings;
    settings.reference_mass = usual_mass(bodies);
    settings.reference_impulse = settings.reference_mass * usual_speed(world, bodies, size);
    settings.reference_distance = size / 2;
    return settings;
}

Listener overview(const World& world) {
    const Extent extent = extent_of(read(world, world.ids()));
    const Vec3 middle = (extent.min + extent.max) / 2;
    const Vec3 forward{0, 1, -0.25};
    return {.position = middle - forward * size_of(extent), .forward = forward};
}

std::vector<Strike> strikes_of(const World& world) {
    std::vector<BodyId> struck;
    for (const Impact& impact : world.impacts()) {
        struck.push_back(impact.a);
        if (impact.b.is_set()) struck.push_back(impact.b);
    }
    const Bodies bodies = read(world, struck);
    std::vector<Strike> strikes;
    std::size_t next = 0;
    for (const Impact& impact : world.impacts()) {
        for (const std::size_t end = next + (impact.b.is_set() ? 2 : 1); next < end; ++next) {
            if (!moves(bodies.mass[next])) continue;
            strikes.push_back({.delay = impact.offset,
                               .position = impact.position,
                               .velocity = bodies.velocity[next],
                               .mass = bodies.mass[next],
                               .restitution = bodies.restitution[next],
                               .impulse = impact.impulse});
        }
    }
    return strikes;
}

} // namespace carom::sound
