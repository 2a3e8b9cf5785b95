#include "scene/entry_places.hpp"

#include <fmt/format.h>

#include <numbers>
#include <variant>

namespace carom::scene {

namespace {

/// 1 along the axes along which bodies keep inside the box with their surfaces; 0 where it is periodic there.
Vec3 inset_of(const Cuboid& box, const Region& region) {
    const Box* bounds = std::get_if<Box>(&region);
    if (bounds == nullptr) return {1, 1, 1};
    const auto inset = [&](std::size_t axis, double min, double max, double from, double to) {
        return bounds->faces[2 * axis].kind == FaceKind::periodic && min == from && max == to ? 0.0 : 1.0;
    };
    return {inset(0, box.min.x, box.max.x, bounds->min.x, bounds->max.x),
            inset(1, box.min.y, box.max.y, bounds->min.y, bounds->max.y),
            inset(2, box.min.z, box.max.z, bounds->min.z, bounds->max.z)};
}

Periods periods_of(const Region& region) {
    const Box* bounds = std::get_if<Box>(&region);
    if (bounds == nullptr) return {};
    const Vec3 all = Vec3{1, 1, 1} - inset_of({bounds->min, bounds->max}, region);
    const Vec3 size = bounds->max - bounds->min;
    return {bounds->min, {all.x * size.x, all.y * size.y, all.z * size.z}};
}

/// What reading a room needs to know of the rest of the scene.
struct Surroundings {
    const std::vector<NamedAttractor>& attractors;
    const Region& region;
};

/// Takes only places inside the region, which outlives it.
template <class Place>
Sampler sampler(const Region& region, const Place& place) {
    return [place, &region](double radius, Random& random) -> std::optional<Vec3> {
        const Vec3 position = place(radius, random);
        if (!is_inside(region, position, radius)) return std::nullopt;
        return position;
    };
}

Room read_box_room(Entry& entry, const Surroundings& around) {
    const Cuboid box = read_cuboid(entry.table, around.region);
    const Vec3 inset = inset_of(box, around.region);
    const double radius = entry.largest_radius();
    const Vec3 free = box.size() - (2 * radius) * inset;
    if (!(free.x >= 0 && free.y >= 0 && free.z >= 0)) {
        entry.table.fail("radius", fmt::format("must fit the box from min to max, got up to {} m", radius));
    }
    return {sampler(around.region, [box, inset](double r, Random& random) { return in_cuboid(box, r, inset, random); }),
            box.volume()};
}

/// Reads `outer` and, where it may or must be given, `inner`.
void read_radial_range(Entry& entry, double& inner, double& outer) {
    outer = entry.table.need("outer").number(length_range);
    if (entry.generator == Generator::shell) inner = entry.table.need("inner").number(radius_range);
    if (entry.generator == Generator::disc) entry.table.read("inner", inner, radius_range);
    if (inner > outer) entry.table.fail("inner", fmt::format("must be at most outer, {}, got {}", outer, inner));
}

Room read_ball_room(Entry& entry, const Surroundings& around) {
    read_centre(entry, around.attractors);
    Ball ball{.centre = *entry.centre};
    read_radial_range(entry, ball.inner, ball.outer);
    const double radius = entry.largest_radius();
    const double outer = ball.outer + radius;
    const double inner = std::max(0.0, ball.inner - radius);
    return {sampler(around.region, [ball](double, Random& random) { return in_ball(ball, random); }),
            ball_volume(outer) - ball_volume(inner)};
}

Room read_disc_room(Entry& entry, const Surroundings& around) {
    read_centre(entry, around.attractors);
    Disc disc{.centre = *entry.centre};
    if (const auto normal = entry.table.find("normal")) disc.normal = normal->direction();
    entry.normal = disc.normal;
    read_radial_range(entry, disc.inner, disc.outer);
    entry.table.read("thickness", disc.thickness, radius_range);
    const double radius = entry.largest_radius();
    const double outer = disc.outer + radius;
    const double inner = std::max(0.0, disc.inner - radius);
    return {sampler(around.region, [disc](double, Random& random) { return in_disc(disc, random); }),
            std::numbers::pi * (outer * outer - inner * inner) * (disc.thickness + 2 * radius)};
}

Room read_room(Entry& entry, const Surroundings& around) {
    switch (entry.generator) {
    case Generator::random:
        return read_box_room(entry, around);
    case Generator::disc:
        return read_disc_room(entry, around);
    default:
        return read_ball_room(entry, around);
    }
}

} // namespace

bool is_placed_at_random(Generator generator) {
    return generator == Generator::random || generator == Generator::cloud || generator == Generator::shell ||
           generator == Generator::disc;
}

Cuboid read_cuboid(TableReader& table, const Region& region) {
    Cuboid box;
    const Box* bounds = std::get_if<Box>(&region);
    if (bounds != nullptr) box = {bounds->min, bounds->max};
    const auto read = [&](std::string_view key, Vec3& target) {
        const auto value = table.find(key);
        if (value) target = value->vec3(coordinate_range);
        if (!value && bounds == nullptr)
            table.fail(key, "is missing: without a region of kind \"box\" it must be given");
    };
    read("min", box.min);
    read("max", box.max);
    const Vec3 size = box.size();
    if (!(size.x > 0 && size.y > 0 && size.z > 0)) table.fail("max", "must be greater than min in every component");
    return box;
}

void place_on_lattice(Entry& entry, const Cuboid& box, const Sites& sites, std::uint64_t seed) {
    const Vec3 most = generated(entry, "radius", [&] { return largest_jitter(box, sites, entry.largest_radius()); });
    Vec3 amount = entry.generator == Generator::lattice ? Vec3{} : most;
    if (const auto value = entry.table.find("jitter")) {
        amount = value->is_array() ? value->vec3(radius_range) : value->number(radius_range) * Vec3{1, 1, 1};
        if (amount.x > most.x || amount.y > most.y || amount.z > most.z) {
            value->fail(fmt::format("must be at most [{:.6g}, {:.6g}, {:.6g}] m, or bodies could overlap", most.x,
                                    most.y, most.z));
        }
    }
    entry.bodies.position = lattice(box, sites, entry.count);
    Random random = entry.random_for(seed, Purpose::positions);
    jitter(entry.bodies.position, amount, random);
}

void place_on_fcc(Entry& entry, const Cuboid& box) {
    entry.bodies.position = generated(entry, "count", [&] { return fcc(box, entry.count, entry.largest_radius()); });
}

void place_at_random(std::vector<Entry>& entries, const std::vector<NamedAttractor>& attractors, const Region& region,
                     std::uint64_t seed) {
    const auto at_random = [](const Entry& entry) { return is_placed_at_random(entry.generator); };
    if (std::none_of(entries.begin(), entries.end(), at_random)) return;
    Occupancy occupancy(periods_of(region));
    for (const Entry& entry : entries) {
        if (at_random(entry)) continue;
        for (std::size_t i = 0; i < entry.count; ++i) occupancy.add(entry.bodies.position[i], entry.bodies.radius[i]);
    }
    for (Entry& entry : entries) {
        if (!at_random(entry)) continue;
        const Room room = read_room(entry, {attractors, region});
        Random random = entry.random_for(seed, Purpose::positions);
        entry.bodies.position =
            generated(entry, "count", [&] { return place_randomly(entry.bodies.radius, room, occupancy, random); });
    }
}

} // namespace carom::scene
