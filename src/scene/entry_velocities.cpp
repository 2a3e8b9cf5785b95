#include "scene/entry_velocities.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace carom::scene {

namespace {

void read_listed(Entry& entry, const ValueReader& value) {
    if (!value.is_array()) {
        value.fail("must be [vx, vy, vz], an array of one such per body, or a table { distribution = ... }");
    }
    if (!value.is_list_of_arrays()) {
        entry.bodies.velocity.assign(entry.count, value.vec3(speed_range));
        return;
    }
    const std::vector<ValueReader> list = value.elements();
    if (list.size() != entry.count) {
        value.fail(fmt::format("must be one velocity or {}, one per body, got {}", entry.count, list.size()));
    }
    for (std::size_t i = 0; i < list.size(); ++i) entry.bodies.velocity[i] = list[i].vec3(speed_range);
}

void draw_uniform(Entry& entry, TableReader& table, Random& random) {
    const double low = table.need("min").number(speed_range);
    const double high = table.need("max").number(speed_range);
    if (high < low) table.fail("max", fmt::format("must be at least min, {}, got {}", low, high));
    entry.bodies.velocity = uniform_velocities(entry.count, low, high, random);
}

void draw_maxwell(Entry& entry, TableReader& table, Random& random) {
    entry.bodies.velocity = maxwell_velocities(entry.bodies.mass, table.need("kT").number(not_negative), random);
}

void draw_radial(Entry& entry, TableReader& table, const std::vector<NamedAttractor>& attractors, Random& random) {
    if (!entry.centre) read_centre(entry, attractors);
    const double speed = table.need("speed").number(speed_range);
    double spread = 0;
    table.read("spread", spread, zero_to_one);
    entry.bodies.velocity = radial_velocities(entry.bodies.position, *entry.centre, speed, spread, random);
}

/// m/s: of the body that carries the attractor, if one does.
Vec3 drift_of(const NamedAttractor& attractor, const Entry& entry, const std::vector<Entry>& entries) {
    if (!attractor.entry) return {};
    const Entry& carrier = entries[*attractor.entry];
    if (!carrier.has_velocities) {
        entry.table.fail(fmt::format("must stand after the entry '{}' that it is around", carrier.name));
    }
    return carrier.bodies.velocity[0];
}

void draw_orbits(Entry& entry, TableReader& table, const NamedAttractor& attractor, const Vec3& drift, Random& random) {
    constexpr NumberRange eccentricities{0, 0.7, false, false, "must be in [0, 0.7]"};
    constexpr NumberRange angles{0, std::numbers::pi, false, false, "must be in [0, pi] rad"};
    Orbit orbit{.centre = attractor.spec.position,
                .drift = drift,
                .strength = attractor.spec.strength,
                .softening = attractor.spec.softening,
                .normal = entry.normal};
    if (!(orbit.strength > 0)) entry.table.fail("around", "must be an attractor with strength > 0");
    table.read("eccentricity", orbit.eccentricity, eccentricities);
    if (const auto normal = table.find("normal")) orbit.normal = normal->direction();
    if (const auto inclination = table.find("inclination")) {
        orbit.inclination = inclination->number(angles);
        if (!orbit.normal) inclination->fail("needs the normal of the plane that it is measured from");
    }
    for (std::size_t i = 0; i < entry.count; ++i) {
        entry.bodies.velocity[i] = orbit_velocity(entry.bodies.position[i], orbit, random);
    }
}

void draw(Entry& entry, TableReader table, const std::vector<NamedAttractor>& attractors,
          const std::vector<Entry>& entries, Random random) {
    constexpr std::array<std::string_view, 4> names{"uniform", "maxwell", "radial", "orbit"};
    switch (table.need("distribution").choice(names)) {
    case 0:
        draw_uniform(entry, table, random);
        break;
    case 1:
        draw_maxwell(entry, table, random);
        break;
    case 2:
        draw_radial(entry, table, attractors, random);
        break;
    default: {
        const NamedAttractor* attractor = find_around(entry, attractors);
        if (attractor == nullptr) entry.table.fail("around", "is missing: orbits need the name of an [[attractor]]");
        draw_orbits(entry, table, *attractor, drift_of(*attractor, entry, entries), random);
    }
    }
    Vec3 drift;
    table.read("drift", drift, speed_range);
    for (Vec3& velocity : entry.bodies.velocity) velocity += drift;
    table.finish();
}

void refuse_moving_static_bodies(const Entry& entry) {
    for (std::size_t i = 0; i < entry.count; ++i) {
        if (std::isinf(entry.bodies.mass[i]) && entry.bodies.velocity[i] != Vec3{}) {
            entry.table.fail("velocity", "must be 0 for a static body (mass = inf)");
        }
    }
}

} // namespace

void read_velocities(Entry& entry, const std::vector<NamedAttractor>& attractors, const std::vector<Entry>& entries,
                     std::uint64_t seed) {
    constexpr std::array<std::string_view, 3> columns{"vx", "vy", "vz"};
    for (const std::string_view column : columns) entry.find_unless_in_csv("velocity", column);
    const auto value = entry.table.find("velocity");
    if (value && value->is_table()) {
        draw(entry, value->table(), attractors, entries, entry.random_for(seed, Purpose::velocities));
    } else if (value) {
        read_listed(entry, *value);
    }
    refuse_moving_static_bodies(entry);
    entry.has_velocities = true;
}

} // namespace carom::scene
