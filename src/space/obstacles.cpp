#include "space/obstacles.hpp"

#include "collision/triangle.hpp"
#include "space/checks.hpp"

#include <carom/collision.hpp>

#include <cmath>
#include <string>
#include <tuple>

namespace carom::core {

namespace {

void check_surface(const Surface& surface, const std::string& name) {
    if (surface.restitution) check_fraction(*surface.restitution, name + ".surface.restitution");
    if (surface.friction) check_not_negative(*surface.friction, name + ".surface.friction");
}

void check_frustum(const Frustum& frustum, const std::string& name) {
    check_finite(frustum.axis, name + ".axis");
    if (frustum.axis == Vec3{}) throw Error(ErrorCode::out_of_range, name + ".axis", "must not be zero");
    check_not_negative(frustum.height, name + ".height");
    check_not_negative(frustum.base_radius, name + ".base_radius");
    check_not_negative(frustum.top_radius, name + ".top_radius");
    if (frustum.height == 0 && frustum.base_radius == frustum.top_radius) {
        throw Error(ErrorCode::out_of_range, name + ".height", "must be > 0 where the two radii are the same");
    }
    if (frustum.base_radius == 0 && frustum.top_radius == 0) {
        throw Error(ErrorCode::out_of_range, name + ".base_radius", "must be > 0, or top_radius must be");
    }
    check_surface(frustum.surface, name);
    check_finite(frustum.angular_velocity, name + ".angular_velocity");
}

void check_triangles(const Mesh& mesh, const std::string& name) {
    if (mesh.triangles.empty()) throw Error(ErrorCode::out_of_range, name + ".triangles", "must not be empty");
    for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
        for (const std::uint32_t vertex : mesh.triangles[k]) {
            if (vertex < mesh.vertices.size()) continue;
            throw Error(ErrorCode::out_of_range, name + ".triangles",
                        "must be indices of the " + std::to_string(mesh.vertices.size()) + " vertices, got " +
                            std::to_string(vertex),
                        k);
        }
        const auto& [a, b, c] = mesh.triangles[k];
        if (!detail::is_degenerate(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c])) continue;
        throw Error(ErrorCode::out_of_range, name + ".triangles", "must have corners that are not in one line", k);
    }
}

Vec3 least(const Vec3& a, const Vec3& b) { return {std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)}; }
Vec3 greatest(const Vec3& a, const Vec3& b) { return {std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)}; }

} // namespace

// ---------------------------------------------------------------------------------------------------------------------
// Making them
// ---------------------------------------------------------------------------------------------------------------------

Obstacles::Obstacles(const std::vector<Obstacle>& obstacles, const Resolution& resolution, const Int3& origin)
    : resolution_(resolution) {
    std::vector<Item> items;
    for (std::size_t k = 0; k < obstacles.size(); ++k) {
        const std::string name = "obstacles[" + std::to_string(k) + "]";
        firsts_.push_back(facets_);
        solids_.push_back({.first = facets_});
        std::visit([&](const auto& shape) { add(shape, name, origin, items); }, obstacles[k]);
        // Codes of contacts and events have one bit less than this, and count the region's walls too.
        constexpr std::uint32_t most = 0x7fffff00U;
        if (items.size() >= most / meridians) throw Error(ErrorCode::out_of_range, name, "has too many triangles");
    }
    nodes_.reserve(items.size());
    build(items);
}

void Obstacles::add(const Frustum& frustum, const std::string& name, const Int3& origin, std::vector<Item>& items) {
    check_frustum(frustum, name);
    const Vec3 axis = detail::direction(frustum.axis);
    const double largest = std::max(frustum.base_radius, frustum.top_radius);
    const Vec3 top = axis * frustum.height;
    const Vec3 around{largest, largest, largest};
    static_cast<void>(position_units(frustum.base + greatest({}, top) + around, resolution_, origin, name));
    static_cast<void>(position_units(frustum.base + least({}, top) - around, resolution_, origin, name));
    Solid& solid = solids_.back();
    solid.anchor = position_units(frustum.base, resolution_, origin, name + ".base");
    solid.surface = frustum.surface;
    solid.spin = axis * frustum.angular_velocity;
    any_turns_ = any_turns_ || frustum.angular_velocity != 0;
    solid.shape = detail::Frustum({}, axis, frustum.height, frustum.base_radius, frustum.top_radius);
    Item item = box_of(solid.anchor, least({}, top) - around, greatest({}, top) + around);
    item.facet = facets_;
    items.push_back(item);
    facets_ += meridians;
}

void Obstacles::add(const Mesh& mesh, const std::string& name, const Int3& origin, std::vector<Item>& items) {
    for (std::size_t k = 0; k < mesh.vertices.size(); ++k) {
        static_cast<void>(position_units(mesh.vertices[k], resolution_, origin, name + ".vertices", k));
    }
    check_triangles(mesh, name);
    check_surface(mesh.surface, name);
    const Vec3 zero = mesh.vertices.front();
    Solid& solid = solids_.back();
    solid.anchor = position_units(zero, resolution_, origin, name + ".vertices", 0);
    solid.surface = mesh.surface;
    Surfaces surfaces;
    for (const auto& [a, b, c] : mesh.triangles) {
        const detail::Triangle& triangle =
            surfaces.triangles.emplace_back(mesh.vertices[a] - zero, mesh.vertices[b] - zero, mesh.vertices[c] - zero);
        const auto& [p, q, r] = triangle.corners();
        Item item = box_of(solid.anchor, least(least(p, q), r), greatest(greatest(p, q), r));
        item.facet = facets_++;
        items.push_back(item);
    }
    surfaces.join();
    solid.shape = std::move(surfaces);
}

/// Gives corners at the same place the same number, and lists the triangles of each.
void Obstacles::Surfaces::join() {
    struct Corner {
        Vec3 place{};
        std::uint32_t triangle = 0;
        std::uint32_t corner = 0;
    };
    std::vector<Corner> all;
    for (std::uint32_t t = 0; t < triangles.size(); ++t) {
        for (std::uint32_t k = 0; k < 3; ++k) all.push_back({triangles[t].corners()[k], t, k});
    }
    std::sort(all.begin(), all.end(), [](const Corner& a, const Corner& b) {
        return std::tuple(a.place.x, a.place.y, a.place.z, a.triangle, a.corner) <
               std::tuple(b.place.x, b.place.y, b.place.z, b.triangle, b.corner);
    });
    corners.resize(triangles.size());
    for (std::uint32_t k = 0; k < all.size(); ++k) {
        if (k == 0 || all[k].place != all[k - 1].place) first_at.push_back(k);
        corners[all[k].triangle][all[k].corner] = static_cast<std::uint32_t>(first_at.size() - 1);
        at_corner.push_back(all[k].triangle);
    }
    first_at.push_back(static_cast<std::uint32_t>(all.size()));
}

/// A box in units around one in metres from an anchor.
auto Obstacles::box_of(const Int3& anchor, const Vec3& low, const Vec3& high) const -> Item {
    const Int3 unit{1, 1, 1};
    return {anchor + round_to_units(low, resolution_) - unit, anchor + round_to_units(high, resolution_) + unit};
}

/// Halves the items along the longest side of the box around them, until few are left.
void Obstacles::build(std::span<Item> items) {
    constexpr std::size_t few = 4;
    if (items.empty()) return;
    const std::size_t place = nodes_.size();
    Node node{.low = items.front().low, .high = items.front().high};
    for (const Item& item : items) {
        for (int axis = 0; axis < 3; ++axis) {
            component(node.low, axis) = std::min(component(node.low, axis), component(item.low, axis));
            component(node.high, axis) = std::max(component(node.high, axis), component(item.high, axis));
        }
    }
    if (items.size() <= few) {
        node.other = static_cast<std::uint32_t>(leaves_.size());
        node.items = static_cast<std::uint32_t>(items.size());
        for (const Item& item : items) leaves_.push_back(item.facet);
        nodes_.push_back(node);
        return;
    }
    nodes_.push_back(node);
    const auto side = [&node](int axis) {
        return static_cast<double>(component(node.high, axis)) - static_cast<double>(component(node.low, axis));
    };
    const int axis = side(0) >= std::max(side(1), side(2)) ? 0 : (side(1) >= side(2) ? 1 : 2);
    const auto middle = [axis](const Item& item) {
        return static_cast<double>(component(item.low, axis)) + static_cast<double>(component(item.high, axis));
    };
    const std::size_t half = items.size() / 2;
    std::nth_element(items.begin(), items.begin() + static_cast<std::ptrdiff_t>(half), items.end(),
                     [&middle](const Item& a, const Item& b) {
                         return std::pair(middle(a), a.facet) < std::pair(middle(b), b.facet);
                     });
    build(items.first(half));
    nodes_[place].other = static_cast<std::uint32_t>(nodes_.size());
    build(items.subspan(half));
}

// ---------------------------------------------------------------------------------------------------------------------
// Touching them
// ---------------------------------------------------------------------------------------------------------------------

/// Calls f(other) for the triangles that share with one the corners (bits) of an edge, or a single one.
template <class F>
void Obstacles::Surfaces::for_each_neighbour(std::uint32_t triangle, unsigned shared, F&& f) const {
    const std::array<std::uint32_t, 3>& own = corners[triangle];
    const std::size_t first = (shared & 1U) != 0 ? 0 : ((shared & 2U) != 0 ? 1 : 2);
    for (const std::uint32_t other : triangles_at(own[first])) {
        const std::array<std::uint32_t, 3>& theirs = corners[other];
        bool shares_all = other != triangle;
        for (std::size_t k = 0; k < 3; ++k) {
            const bool is_theirs = std::find(theirs.begin(), theirs.end(), own[k]) != theirs.end();
            shares_all = shares_all && ((shared >> k & 1U) == 0 || is_theirs);
        }
        if (shares_all) f(other);
    }
}

namespace {

/// m, more than the distances of a point from two triangles at a common edge differ by rounding.
double tolerance_at(double distance, const Vec3& p) { return 0x1p-40 * distance + 0x1p-48 * length(p); }

} // namespace

/// Whether a neighbour, or the same point of one that counts first, is nearer.
bool Obstacles::Surfaces::is_hidden(std::uint32_t triangle, const detail::Triangle::Sight& sight, const Vec3& p) const {
    if (sight.corners == detail::Triangle::face) return false;
    const double tolerance = tolerance_at(sight.distance, p);
    bool is_hidden = false;
    for_each_neighbour(triangle, sight.corners, [&](std::uint32_t other) {
        const auto theirs = triangles[other].sight(p);
        const bool counts_first = theirs.corners == detail::Triangle::face || other < triangle;
        const double limit = sight.distance + (counts_first ? tolerance : -tolerance);
        is_hidden = is_hidden || theirs.distance < limit;
    });
    return is_hidden;
}

struct Obstacles::Facet {
    const Surfaces& all;
    std::uint32_t index;

    [[nodiscard]] detail::Triangle::Sight sight(const Vec3& p) const { return all.triangles[index].sight(p); }
    [[nodiscard]] double bending(const detail::Triangle::Sight& sight, const Vec3& v) const {
        return all.triangles[index].bending(sight, v);
    }
    static double sag(const detail::Triangle::Sight& sight, const detail::Parabola& path, double duration) {
        return detail::Triangle::sag(sight, path, duration);
    }
    static double trusted_time(const detail::Triangle::Sight& sight, const detail::Parabola& path) {
        return detail::Triangle::trusted_time(sight, path);
    }
    [[nodiscard]] double hidden_by(const detail::Triangle::Sight& sight, const Vec3& p) const {
        if (sight.corners == detail::Triangle::face) return 0;
        double nearest = sight.distance;
        all.for_each_neighbour(index, sight.corners, [&](std::uint32_t other) {
            nearest = std::min(nearest, all.triangles[other].sight(p).distance);
        });
        const double hidden = sight.distance - nearest;
        return hidden > tolerance_at(sight.distance, p) ? hidden : 0;
    }
};

double Obstacles::time_to(std::uint32_t facet, const Int3& x, const Vec3& v, const Vec3& a, double distance,
                          double growth, double horizon) const {
    const Solid& solid = solids_[obstacle_of(facet)];
    const detail::Parabola path{place_in(solid, x, {}), v, a};
    if (const auto* frustum = std::get_if<detail::Frustum>(&solid.shape)) {
        return detail::time_to_surface(*frustum, path, distance, growth, horizon);
    }
    return detail::time_to_surface(Facet{std::get<Surfaces>(solid.shape), facet - solid.first}, path, distance, growth,
                                   horizon);
}

Touch Obstacles::impact(std::uint32_t facet, const Int3& x, const Vec3& d, double radius) const {
    const Solid& solid = solids_[obstacle_of(facet)];
    const Vec3 p = place_in(solid, x, d);
    const double contact = contact_distance(radius);
    if (const auto* frustum = std::get_if<detail::Frustum>(&solid.shape)) {
        const auto sight = frustum->sight(p);
        return {sight.distance - contact, -detail::renormalised(sight.normal)};
    }
    const auto sight = std::get<Surfaces>(solid.shape).triangles[facet - solid.first].sight(p);
    return {sight.distance - contact, -detail::renormalised(sight.normal)};
}

Touch Obstacles::contact(std::uint32_t facet, const Int3& x, double radius) const {
    const Solid& solid = solids_[obstacle_of(facet)];
    const Vec3 p = place_in(solid, x, {});
    const double contact = contact_distance(radius);
    if (const auto* frustum = std::get_if<detail::Frustum>(&solid.shape)) {
        const Vec3 towards = frustum->nearest_on_meridian(p, static_cast<int>(facet - solid.first)) - p;
        const double distance = length(towards);
        if (distance == 0) return impact(facet, x, {}, radius);
        return {distance - contact, detail::renormalised(towards / distance)};
    }
    const auto& surfaces = std::get<Surfaces>(solid.shape);
    const auto sight = surfaces.triangles[facet - solid.first].sight(p);
    if (surfaces.is_hidden(facet - solid.first, sight, p)) return {};
    return {sight.distance - contact, -detail::renormalised(sight.normal)};
}

double Obstacles::bend(std::uint32_t facet, const Int3& x, const Vec3& d, const Vec3& v) const {
    const Solid& solid = solids_[obstacle_of(facet)];
    const Vec3 p = place_in(solid, x, d);
    const auto bend_of = [&](const auto& shape) {
        const auto sight = shape.sight(p);
        const double across = dot(v, sight.normal);
        const double along_squared = length_squared(v) - across * across;
        return along_squared > 0 ? -shape.bending(sight, v) / along_squared : 0;
    };
    if (const auto* frustum = std::get_if<detail::Frustum>(&solid.shape)) return bend_of(*frustum);
    return bend_of(std::get<Surfaces>(solid.shape).triangles[facet - solid.first]);
}

Vec3 Obstacles::surface_velocity(std::uint32_t facet, const Int3& x, const Vec3& d, double radius,
                                 const Vec3& normal) const {
    const Solid& solid = solids_[obstacle_of(facet)];
    if (solid.spin == Vec3{}) return {};
    return cross(solid.spin, place_in(solid, x, d) + normal * contact_distance(radius));
}

double Obstacles::distance_to(std::uint32_t facet, const Int3& x) const {
    const Solid& solid = solids_[obstacle_of(facet)];
    const Vec3 p = place_in(solid, x, {});
    if (const auto* frustum = std::get_if<detail::Frustum>(&solid.shape)) return frustum->sight(p).distance;
    return std::get<Surfaces>(solid.shape).triangles[facet - solid.first].sight(p).distance;
}

bool Obstacles::may_touch(const Int3& x, double reach) const {
    const double most = reach_with_margin(reach);
    return distance(x, most) < most;
}

double Obstacles::distance(const Int3& x, double most) const {
    double nearest = most;
    for_each_leaf(x, nearest, [&](std::uint32_t facet) { nearest = std::min(nearest, distance_to(facet, x)); });
    return nearest;
}

} // namespace carom::core
