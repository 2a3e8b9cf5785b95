#include "scene/entry_values.hpp"

#include <fmt/format.h>

namespace carom::scene {

namespace {

/// One number for all bodies of the entry, or an array with one per body.
void read_numbers(const Entry& entry, const ValueReader& value, const NumberRange& range, std::vector<double>& target) {
    if (value.is_number()) {
        std::fill(target.begin(), target.end(), value.number(range));
        return;
    }
    if (!value.is_array()) value.fail("must be a number, or an array with one number per body");
    const std::vector<ValueReader> list = value.elements();
    if (list.size() != entry.count) {
        value.fail(fmt::format("must be one number or {}, one per body, got {}", entry.count, list.size()));
    }
    for (std::size_t i = 0; i < list.size(); ++i) target[i] = list[i].number(range);
}

} // namespace

void read_radii(Entry& entry, std::uint64_t seed) {
    if (const auto growth = entry.find_unless_in_csv("growth", "growth")) {
        read_numbers(entry, *growth, speed_range, entry.bodies.growth);
    }
    const auto value = entry.find_unless_in_csv("radius", "radius");
    if (!value) return;
    if (!value->is_table()) return read_numbers(entry, *value, radius_range, entry.bodies.radius);
    constexpr std::array<std::string_view, 2> names{"uniform", "log_uniform"};
    TableReader table = value->table();
    const bool uniform = table.need("distribution").choice(names) == 0;
    const double low = table.need("min").number(uniform ? radius_range : length_range);
    const double high = table.need("max").number(length_range);
    if (high < low) table.fail("max", fmt::format("must be at least min, {}, got {}", low, high));
    table.finish();
    Random random = entry.random_for(seed, Purpose::radii);
    for (double& radius : entry.bodies.radius) {
        radius = uniform ? random.uniform(low, high) : random.log_uniform(low, high);
    }
}

void read_surfaces(Entry& entry, const std::vector<Material>& materials) {
    BodyTable& bodies = entry.bodies;
    if (const auto value = entry.table.find("material")) {
        std::vector<std::string_view> names;
        names.reserve(materials.size());
        for (const Material& material : materials) names.push_back(material.name);
        if (names.empty()) value->fail("must be the name of a [[material]], but the scene has none");
        const std::size_t number = value->choice(names);
        bodies.material.assign(entry.count, static_cast<std::uint32_t>(number + 1));
        if (!entry.is_in_csv("restitution")) bodies.restitution.assign(entry.count, materials[number].restitution);
        if (!entry.is_in_csv("friction")) bodies.friction.assign(entry.count, materials[number].friction);
        const bool has_own = entry.table.has("restitution") || entry.is_in_csv("restitution");
        if (has_own && materials[number].law) {
            value->fail("has a law of restitution: its bodies must have no restitution of their own");
        }
    }
    if (const auto value = entry.find_unless_in_csv("restitution", "restitution")) {
        read_numbers(entry, *value, zero_to_one, bodies.restitution);
    }
    if (const auto value = entry.find_unless_in_csv("friction", "friction")) {
        read_numbers(entry, *value, not_negative, bodies.friction);
    }
}

void read_masses(Entry& entry) {
    if (const auto value = entry.find_unless_in_csv("mass", "mass")) {
        read_numbers(entry, *value, mass_range, entry.bodies.mass);
    }
    const auto density = entry.find_unless_in_csv("density", "mass");
    if (!density) return;
    if (entry.table.has("mass")) density->fail("must not stand beside mass: give one of them");
    const double value = density->number(positive);
    for (std::size_t i = 0; i < entry.count; ++i) {
        entry.bodies.mass[i] = value * ball_volume(entry.bodies.radius[i]);
        if (!positive.contains(entry.bodies.mass[i])) {
            density->fail(fmt::format("gives body {} of the entry, radius {} m, a mass of {} kg", i,
                                      entry.bodies.radius[i], entry.bodies.mass[i]));
        }
    }
}

} // namespace carom::scene
