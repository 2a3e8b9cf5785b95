#include "scene/generators.hpp"

#include "collision/portable_math.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <type_traits>
#include <variant>

namespace carom::scene {

namespace {

/// Packing of the densest arrangement of equal spheres (Hales 2005).
constexpr double densest_packing = 0.7405;
/// Where random sequential addition of equal spheres stops: 0.3841 (Torquato et al. 2006), rounded up.
constexpr double random_packing_limit = 0.39;

double per_axis(double side, double spacing) { return std::floor(side / spacing); }

/// The largest spacing for which `sites(spacing)`, which falls with it, is at least `count`.
template <class CountSites>
double largest_spacing(double upper, std::size_t count, const CountSites& sites) {
    constexpr int enough = 200;
    double low = 0;
    double high = upper;
    for (int i = 0; i < enough; ++i) {
        const double middle = low + 0.5 * (high - low);
        if (middle <= low || middle >= high) break;
        (sites(middle) >= static_cast<double>(count) ? low : high) = middle;
    }
    return low;
}

double longest_side(const Vec3& size) { return std::max({size.x, size.y, size.z}); }

double at_least_one(double value) { return std::max(1.0, value); }

Vec3 normalised(const Vec3& vector) { return vector / length(vector); }

/// Refuses what no arrangement, or no random one, can reach.
void check_packing(std::span<const double> radii, double volume) {
    double filled = 0;
    for (const double radius : radii) filled += ball_volume(radius);
    const auto [smallest, largest] = std::minmax_element(radii.begin(), radii.end());
    const bool equal = *smallest == *largest;
    const double limit = equal ? random_packing_limit : densest_packing;
    if (filled <= limit * volume) return;
    throw GeneratorError(fmt::format(
        "{} bodies fill {:.3g} m^3 of {:.3g} m^3, a packing of {:.3g}; random places without overlap exist only up to "
        "about {}{}: fewer or smaller bodies, or a larger space",
        radii.size(), filled, volume, filled / volume, limit, equal ? " (the generator \"fcc\" reaches 0.74)" : ""));
}

/// Indices of the radii, the largest first, equal ones in their order.
std::vector<std::size_t> largest_first(std::span<const double> radii) {
    std::vector<std::size_t> order(radii.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return radii[a] > radii[b]; });
    return order;
}

/// A random direction perpendicular to one of length 1.
Vec3 random_perpendicular(const Vec3& unit, Random& random) {
    const Vec3 first = any_perpendicular(unit);
    const Vec3 point = random.on_circle();
    return point.x * first + point.y * cross(unit, first);
}

/// The direction of flight on a circle through the point in direction `up` from the centre.
Vec3 circular_direction(const Vec3& up, const Orbit& orbit, Random& random) {
    if (!orbit.normal) return random_perpendicular(up, random);
    const Vec3 along = cross(*orbit.normal, up);
    constexpr double nearly_polar = 1e-6;
    if (length(along) < nearly_polar) return random_perpendicular(up, random);
    const Vec3 flat = normalised(along);
    const double side = random.unit() < 0.5 ? -1 : 1;
    const double tilt = side * random.rayleigh(orbit.inclination);
    return detail::cos(tilt) * flat + detail::sin(tilt) * cross(up, flat);
}

double random_eccentricity(double root_mean_square, Random& random) {
    constexpr double largest = 0.95; // beyond it orbits reach far out of any scene
    for (;;) {
        const double eccentricity = random.rayleigh(root_mean_square);
        if (eccentricity <= largest) return eccentricity;
    }
}

bool is_inside_box(const Box& box, const Vec3& position, double radius) {
    const auto fits = [&](std::size_t axis, double x, double min, double max) {
        const auto margin = [&](const Face& face) { return face.kind == FaceKind::periodic ? 0 : radius; };
        const Face& low = box.faces[2 * axis];
        const Face& high = box.faces[2 * axis + 1];
        return (low.kind == FaceKind::open || x - margin(low) >= min) &&
               (high.kind == FaceKind::open || x + margin(high) <= max);
    };
    return fits(0, position.x, box.min.x, box.max.x) && fits(1, position.y, box.min.y, box.max.y) &&
           fits(2, position.z, box.min.z, box.max.z);
}

bool is_inside_planes(const std::vector<Plane>& planes, const Vec3& position, double radius) {
    return std::all_of(planes.begin(), planes.end(), [&](const Plane& plane) {
        return dot(position - plane.point, plane.normal) >= radius * length(plane.normal);
    });
}

} // namespace

Vec3 any_perpendicular(const Vec3& unit) {
    const Vec3 axis = std::abs(unit.x) < 0.5 ? Vec3{1, 0, 0} : Vec3{0, 1, 0};
    return normalised(cross(unit, axis));
}

bool is_inside(const Region& region, const Vec3& position, double radius) {
    return std::visit(
        [&](const auto& bounds) {
            using Bounds = std::decay_t<decltype(bounds)>;
            if constexpr (std::is_same_v<Bounds, Box>) return is_inside_box(bounds, position, radius);
            if constexpr (std::is_same_v<Bounds, std::vector<Plane>>) return is_inside_planes(bounds, position, radius);
            if constexpr (std::is_same_v<Bounds, Shell>) {
                return length(position - bounds.centre) + radius <= bounds.radius;
            }
            return true;
        },
        region);
}

Sites lattice_sites(const Cuboid& box, std::size_t count) {
    const Vec3 size = box.size();
    const auto along = [](double side, double spacing) { return at_least_one(per_axis(side, spacing)); };
    const double spacing = largest_spacing(2 * longest_side(size), count, [&](double s) {
        return along(size.x, s) * along(size.y, s) * along(size.z, s);
    });
    return {static_cast<std::uint64_t>(along(size.x, spacing)), static_cast<std::uint64_t>(along(size.y, spacing)),
            static_cast<std::uint64_t>(along(size.z, spacing))};
}

std::vector<Vec3> lattice(const Cuboid& box, const Sites& sites, std::size_t count) {
    const Vec3 size = box.size();
    const std::uint64_t total = sites.x * sites.y * sites.z;
    const auto coordinate = [](double min, double side, std::uint64_t index, std::uint64_t cells) {
        return min + side * ((static_cast<double>(index) + 0.5) / static_cast<double>(cells));
    };
    std::vector<Vec3> positions;
    positions.reserve(count);
    for (std::uint64_t i = 0; i < count; ++i) {
        const std::uint64_t site = i * total / count;
        positions.push_back({coordinate(box.min.x, size.x, site % sites.x, sites.x),
                             coordinate(box.min.y, size.y, site / sites.x % sites.y, sites.y),
                             coordinate(box.min.z, size.z, site / sites.x / sites.y, sites.z)});
    }
    return positions;
}

Vec3 largest_jitter(const Cuboid& box, const Sites& sites, double radius) {
    const Vec3 size = box.size();
    const Vec3 cell{size.x / static_cast<double>(sites.x), size.y / static_cast<double>(sites.y),
                    size.z / static_cast<double>(sites.z)};
    const double spacing = std::min({cell.x, cell.y, cell.z});
    if (spacing >= 2 * radius) return 0.5 * cell - Vec3{radius, radius, radius};
    throw GeneratorError(
        fmt::format("{} x {} x {} sites leave {:.6g} m per body, but a radius of {:.6g} m takes {:.6g} m: fewer or "
                    "smaller bodies, a larger box, or the denser generator \"fcc\"",
                    sites.x, sites.y, sites.z, spacing, radius, 2 * radius));
}

void jitter(std::span<Vec3> positions, const Vec3& most, Random& random) {
    for (Vec3& position : positions) {
        const double dx = random.uniform(-most.x, most.x);
        const double dy = random.uniform(-most.y, most.y);
        const double dz = random.uniform(-most.z, most.z);
        position += {dx, dy, dz};
    }
}

std::vector<Vec3> fcc(const Cuboid& box, std::size_t count, double radius) {
    // Sites are those points of a simple lattice of half the constant whose three indices have an even sum.
    const Vec3 room = box.size() - Vec3{2 * radius, 2 * radius, 2 * radius};
    const auto too_dense = [&](double spacing) {
        throw GeneratorError(
            fmt::format("{} bodies of radius {:.6g} m do not fit into {:.6g} x {:.6g} x {:.6g} m: their "
                        "centres would be {:.6g} m apart; fewer or smaller bodies, or a larger box",
                        count, radius, box.size().x, box.size().y, box.size().z, spacing));
    };
    if (!(room.x >= 0 && room.y >= 0 && room.z >= 0)) too_dense(0);
    const auto sites = [&](double half) {
        const double points =
            (per_axis(room.x, half) + 1) * (per_axis(room.y, half) + 1) * (per_axis(room.z, half) + 1);
        return std::ceil(0.5 * points);
    };
    const double half = largest_spacing(2 * longest_side(box.size()), count, sites);
    // What rounding of the spacing may take away at most is far below what counts as an overlap.
    constexpr double rounding = 1 - 1e-14;
    if (count > 1 && half * std::numbers::sqrt2 < 2 * radius * rounding) too_dense(half * std::numbers::sqrt2);

    const auto last = [half](double side) { return static_cast<std::uint64_t>(per_axis(side, half)); };
    const Vec3 start{box.min.x + 0.5 * (box.size().x - half * static_cast<double>(last(room.x))),
                     box.min.y + 0.5 * (box.size().y - half * static_cast<double>(last(room.y))),
                     box.min.z + 0.5 * (box.size().z - half * static_cast<double>(last(room.z)))};
    std::vector<Vec3> positions;
    positions.reserve(count);
    for (std::uint64_t z = 0; z <= last(room.z); ++z) {
        for (std::uint64_t y = 0; y <= last(room.y); ++y) {
            for (std::uint64_t x = (y + z) % 2; x <= last(room.x) && positions.size() < count; x += 2) {
                const Vec3 indices{static_cast<double>(x), static_cast<double>(y), static_cast<double>(z)};
                positions.push_back(start + half * indices);
            }
        }
    }
    return positions;
}

Vec3 in_cuboid(const Cuboid& box, double radius, const Vec3& inset, Random& random) {
    const Vec3 margin = radius * inset;
    const double x = random.uniform(box.min.x + margin.x, box.max.x - margin.x);
    const double y = random.uniform(box.min.y + margin.y, box.max.y - margin.y);
    const double z = random.uniform(box.min.z + margin.z, box.max.z - margin.z);
    return {x, y, z};
}

Vec3 in_ball(const Ball& ball, Random& random) {
    for (;;) {
        // The number of points at a distance grows with its square.
        const double distance = random.uniform(ball.inner, ball.outer);
        const double share = distance / ball.outer;
        if (random.unit() >= share * share) continue;
        return ball.centre + distance * random.on_sphere();
    }
}

Vec3 in_disc(const Disc& disc, Random& random) {
    const double inner = disc.inner * disc.inner;
    const double outer = disc.outer * disc.outer;
    const double distance = std::sqrt(random.uniform(inner, outer));
    const Vec3 point = random.on_circle();
    const double height = random.uniform(-0.5 * disc.thickness, 0.5 * disc.thickness);
    const Vec3 first = any_perpendicular(disc.normal);
    const Vec3 flat = point.x * first + point.y * cross(disc.normal, first);
    return disc.centre + distance * flat + height * disc.normal;
}

std::vector<Vec3> place_randomly(std::span<const double> radii, const Room& room, Occupancy& occupancy,
                                 Random& random) {
    if (radii.empty()) return {};
    check_packing(radii, room.volume);
    const std::size_t most_tries = 100'000 + 200 * radii.size();
    std::size_t tries = 0;
    std::size_t placed = 0;
    std::vector<Vec3> positions(radii.size());
    for (const std::size_t body : largest_first(radii)) {
        std::optional<Vec3> place;
        while (!place || !occupancy.is_free(*place, radii[body])) {
            if (tries++ == most_tries) {
                throw GeneratorError(
                    fmt::format("found room for only {} of {} bodies in {} tries: fewer or smaller bodies, or a "
                                "larger space",
                                placed, radii.size(), most_tries));
            }
            place = room.sample(radii[body], random);
        }
        occupancy.add(*place, radii[body]);
        positions[body] = *place;
        ++placed;
    }
    return positions;
}

std::vector<Vec3> uniform_velocities(std::size_t count, double low, double high, Random& random) {
    std::vector<Vec3> velocities(count);
    for (Vec3& velocity : velocities) {
        velocity.x = random.uniform(low, high);
        velocity.y = random.uniform(low, high);
        velocity.z = random.uniform(low, high);
    }
    return velocities;
}

std::vector<Vec3> maxwell_velocities(std::span<const double> masses, double kt, Random& random) {
    std::vector<Vec3> velocities;
    velocities.reserve(masses.size());
    for (const double mass : masses) velocities.push_back(std::sqrt(kt / mass) * random.normal_vector());
    return velocities;
}

std::vector<Vec3> radial_velocities(std::span<const Vec3> positions, const Vec3& centre, double speed, double spread,
                                    Random& random) {
    std::vector<Vec3> velocities;
    velocities.reserve(positions.size());
    for (const Vec3& position : positions) {
        const Vec3 offset = position - centre;
        const double distance = length(offset);
        const Vec3 away = distance > 0 ? offset / distance : Vec3{1, 0, 0};
        // Of all points of a ball of radius `spread` about the tip of a unit vector none is more than that off it.
        // Drawn one after the other: compilers differ in which operand of a product they evaluate first.
        const Vec3 direction = random.on_sphere();
        const Vec3 turned = away + (spread * random.unit()) * direction;
        const double size = length(turned);
        velocities.push_back(speed * (size > 0 ? turned / size : away));
    }
    return velocities;
}

Vec3 orbit_velocity(const Vec3& position, const Orbit& orbit, Random& random) {
    const Vec3 offset = position - orbit.centre;
    const double distance = length(offset);
    if (distance == 0) return orbit.drift;
    const Vec3 up = offset / distance;
    const double softened = distance * distance + orbit.softening * orbit.softening;
    const double circular_speed = std::sqrt(orbit.strength / std::sqrt(softened)) * (distance / std::sqrt(softened));

    const Vec3 along = circular_direction(up, orbit, random);
    const double eccentricity = random_eccentricity(orbit.eccentricity, random);
    const Vec3 phase = random.on_circle(); // cosine and sine of the true anomaly
    const double swing = 1 + eccentricity * phase.x;
    const double scale = circular_speed / std::sqrt(swing);
    return orbit.drift + (scale * swing) * along + (scale * eccentricity * phase.y) * up;
}

double ball_volume(double radius) { return 4 * std::numbers::pi / 3 * (radius * radius * radius); }

} // namespace carom::scene
