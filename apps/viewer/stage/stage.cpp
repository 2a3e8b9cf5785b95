#include "viewer/stage/stage.hpp"

#include "viewer/stage/palette.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <variant>

namespace carom::viewer {

namespace {

/// Bodies with trails: more would hide each other.
constexpr std::size_t most_trails = 400;

/// The number 1, 2 or 5 times a power of ten next to `value` > 0.
double round_number(double value) {
    const double power = std::pow(10, std::floor(std::log10(value)));
    const double digit = value / power;
    return power * (digit < 1.5 ? 1 : digit < 3.5 ? 2 : digit < 7.5 ? 5 : 10);
}

std::optional<std::size_t> place_of(const std::vector<BodyId>& ids, BodyId id) {
    const auto found = std::lower_bound(ids.begin(), ids.end(), id);
    if (found == ids.end() || *found != id) return std::nullopt;
    return static_cast<std::size_t>(found - ids.begin());
}

Colour faded(Colour colour, double part) {
    colour.opacity *= static_cast<float>(part);
    return colour;
}

double median_radius(const std::vector<float>& radii) {
    if (radii.empty()) return 1;
    std::vector<float> sorted = radii;
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    return static_cast<double>(*middle);
}

} // namespace

void pack(const Moment& moment, double time, const Vec3& origin, std::optional<BodyId> highlight,
          std::vector<PackedBody>& bodies) {
    const std::size_t count = moment.position.size();
    const double span = moment.end - moment.begin;
    const auto back = static_cast<float>(span > 0 ? std::clamp((moment.end - time) / span, 0.0, 1.0) : 0);
    bodies.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3f place = narrow(moment.position[i] - origin) - moment.way[i] * back;
        bodies[i] = {place.x, place.y, place.z, moment.looks[i]};
    }
    if (!highlight) return;
    if (const auto place = place_of(*moment.ids, *highlight)) bodies[*place].look |= 0xff000000U;
}

void Stage::restart() {
    bodies_.reset();
    forget_trails();
}

void Stage::follow_bodies(const Moment& moment) {
    constexpr double follow = 0.1; // of the difference, in each frame
    const Ball now = ball_around(moment.position, *moment.radii);
    if (!bodies_) {
        bodies_ = now;
    } else {
        bodies_->centre += (now.centre - bodies_->centre) * follow;
        bodies_->radius += (now.radius - bodies_->radius) * follow;
    }
}

Ball Stage::to_see(const Moment& moment) const {
    return ball_to_see(moment.region, ball_around(moment.position, *moment.radii), obstacles_.ball());
}

const Drawing& Stage::draw(const Moment& moment, double time, const Camera& camera) {
    follow_bodies(moment);
    drawing_.camera = camera;
    drawing_.origin = camera.target;
    pack(moment, time, drawing_.origin, highlight_, packed_);
    drawing_.bodies = packed_;
    if (drawing_.radii_version != moment.version) {
        drawing_.occlusion_distance = static_cast<float>(2.2 * median_radius(*moment.radii));
    }
    drawing_.radii = *moment.radii;
    drawing_.radii_version = moment.version;
    drawing_.planets = std::any_of(moment.attractors.begin(), moment.attractors.end(),
                                   [](const Attractor& attractor) { return attractor.body.is_set(); });
    drawing_.palette = palette();
    drawing_.palette_version = 1;
    const Region region = moment.region_at(time);
    const bool open = std::holds_alternative<OpenSpace>(region);
    drawing_.sky = open ? space_sky_colour : sky_colour;
    drawing_.ground = open ? space_ground_colour : ground_colour;

    const Ball seen = ball_to_light(region, *bodies_, obstacles_.ball());
    drawing_.centre = local(seen.centre);
    drawing_.extent = static_cast<float>(1.1 * seen.radius);
    const Vec3f up = unit(narrow(camera.up));
    const Vec3f aside = unit(cross(up, std::abs(up.x) < 0.9F ? Vec3f{1, 0, 0} : Vec3f{0, 1, 0}));
    drawing_.to_light = up * 0.85F - aside * 0.45F - cross(aside, up) * 0.55F;

    drawing_.lines.clear();
    drawing_.lines_on_top.clear();
    drawing_.panels.clear();
    drawing_.hollow.reset();
    draw_region(region, seen);
    draw_obstacles(time);
    draw_attractors(moment);
    draw_forces(moment, time);
    remember_trails(moment, time);
    draw_trails(time, periods_of(region));
    return drawing_;
}

void Stage::add_outline(const Vec3& from, const Vec3& to, const Colour& colour) {
    drawing_.lines.push_back({local(from), local(to), 1.2F, colour, colour});
}

void Stage::draw_region(const Region& region, const Ball& bodies) {
    if (const auto* box = std::get_if<Box>(&region)) draw_box(*box);
    if (const auto* shell = std::get_if<Shell>(&region)) draw_shell(*shell);
    if (const auto* planes = std::get_if<std::vector<Plane>>(&region)) {
        for (const Plane& plane : *planes) draw_plane(plane, bodies);
    }
}

/// Reflecting faces are panels, seen from inside only; edges are drawn where a face is that is not open.
void Stage::draw_box(const Box& box) {
    const std::array<double, 3> low{box.min.x, box.min.y, box.min.z};
    const std::array<double, 3> high{box.max.x, box.max.y, box.max.z};
    const Vec3 size = box.max - box.min;
    const double grid = round_number(std::max({size.x, size.y, size.z}) / 10);
    const auto axis_vector = [](std::size_t axis, double value) {
        return Vec3{axis == 0 ? value : 0, axis == 1 ? value : 0, axis == 2 ? value : 0};
    };
    for (std::size_t face = 0; face < 6; ++face) {
        const std::size_t axis = face / 2;
        const std::size_t u = (axis + 1) % 3;
        const std::size_t v = (axis + 2) % 3;
        if (box.faces[face].kind == FaceKind::open) continue;
        const bool upper = face % 2 == 1;
        const Vec3 corner = box.min + axis_vector(axis, upper ? high[axis] - low[axis] : 0);
        const Vec3 side_u = axis_vector(u, high[u] - low[u]);
        const Vec3 side_v = axis_vector(v, high[v] - low[v]);
        const bool periodic = box.faces[face].kind == FaceKind::periodic;
        const Colour& colour = periodic ? periodic_colour : outline_colour;
        add_outline(corner, corner + side_u, colour);
        add_outline(corner, corner + side_v, colour);
        add_outline(corner + side_u, corner + side_u + side_v, colour);
        add_outline(corner + side_v, corner + side_u + side_v, colour);
        if (periodic) continue;
        drawing_.panels.push_back({local(corner), narrow(upper ? side_v : side_u), narrow(upper ? side_u : side_v),
                                   panel_colour, static_cast<float>(grid), false});
    }
}

/// A square of the plane below the bodies, fading towards its edges.
void Stage::draw_plane(const Plane& plane, const Ball& bodies) {
    const Vec3 normal = unit(plane.normal);
    const Vec3 u = unit(cross(std::abs(normal.x) < 0.9 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}, normal));
    const Vec3 v = cross(normal, u);
    const Vec3 middle = bodies.centre - normal * dot(bodies.centre - plane.point, normal);
    const double half = 5 * bodies.radius;
    const double grid = round_number(bodies.radius / 4);
    // Its lines stand at multiples of their distance from the plane's point, wherever the bodies are.
    const auto snapped = [&](const Vec3& axis) {
        return std::round(dot(middle - plane.point, axis) / grid) * grid - std::ceil(half / grid) * grid;
    };
    const double side = 2 * std::ceil(half / grid) * grid;
    drawing_.panels.push_back({local(plane.point + u * snapped(u) + v * snapped(v)), narrow(u * side), narrow(v * side),
                               panel_colour, static_cast<float>(grid), true});
}

void Stage::draw_shell(const Shell& shell) {
    drawing_.hollow = Hollow{local(shell.centre), static_cast<float>(shell.radius), faded(panel_colour, 0.6)};
}

void Stage::draw_obstacles(double time) {
    drawing_.shapes = obstacles_.shapes(drawing_.origin);
    for (const auto& [from, to] : obstacles_.edges()) add_outline(from, to, obstacle_edge_colour);
    for (const auto& [from, to] : obstacles_.meridians(time)) add_outline(from, to, obstacle_edge_colour);
}

/// Those that no body carries, as crosses.
void Stage::draw_attractors(const Moment& moment) {
    for (const Attractor& attractor : moment.attractors) {
        if (attractor.body.is_set()) continue;
        const double arm = std::max(attractor.softening, 0.03 * bodies_->radius);
        for (const Vec3& axis : {Vec3{arm, 0, 0}, Vec3{0, arm, 0}, Vec3{0, 0, arm}}) {
            drawing_.lines_on_top.push_back({local(attractor.position - axis), local(attractor.position + axis), 1.5F,
                                             attractor_colour, attractor_colour});
        }
    }
}

/// Lines from centre to centre, or to the face, the thicker the larger the force.
void Stage::draw_forces(const Moment& moment, double time) {
    if (moment.contacts.empty()) return;
    std::vector<double> forces;
    forces.reserve(moment.contacts.size());
    for (const Contact& contact : moment.contacts) forces.push_back(contact.force);
    const auto high = forces.begin() + static_cast<std::ptrdiff_t>(0.98 * static_cast<double>(forces.size() - 1));
    std::nth_element(forces.begin(), high, forces.end());
    const double most = *high;
    for (const Contact& contact : moment.contacts) {
        const auto a = place_of(*moment.ids, contact.a);
        if (!a) continue;
        const auto b = contact.b.is_set() ? place_of(*moment.ids, contact.b) : std::nullopt;
        const Vec3 from = moment.position_at(*a, time);
        // Not to the centre of b, which may be that of a planet.
        const double reach = b ? std::min((*moment.radii)[*a], (*moment.radii)[*b]) : 0.0F;
        const Vec3 to = contact.position + contact.normal * reach;
        const double strength = std::min(contact.force / most, 1.0);
        const Colour colour = faded(force_colour, 0.25 + 0.75 * strength);
        drawing_.lines_on_top.push_back(
            {local(from), local(to), static_cast<float>(0.6 + 3.0 * strength), colour, colour});
    }
}

void Stage::set_highlight(std::optional<BodyId> body) {
    if (body == highlight_) return;
    highlight_ = body;
    forget_trails();
}

void Stage::forget_trails() {
    trails_.clear();
    trail_bodies_.clear();
}

double Stage::trail_seconds() const {
    constexpr double of_highlight = 2;
    return highlight_ ? std::max(trail_seconds_, of_highlight) : trail_seconds_;
}

void Stage::choose_trail_bodies(const Moment& moment) {
    if (highlight_ && !(trail_seconds_ > 0)) {
        trail_bodies_ = {*highlight_};
        return;
    }
    const std::size_t stride = (moment.ids->size() + most_trails - 1) / most_trails;
    for (std::size_t i = 0; i < moment.ids->size(); i += std::max<std::size_t>(stride, 1)) {
        trail_bodies_.push_back((*moment.ids)[i]);
    }
}

void Stage::remember_trails(const Moment& moment, double time) {
    if (!(trail_seconds() > 0)) return forget_trails();
    if (!trails_.empty() && time < trails_.back().time) forget_trails();
    if (trail_bodies_.empty()) choose_trail_bodies(moment);
    TrailPoint point{time, {}};
    for (const BodyId id : trail_bodies_) {
        const auto place = place_of(*moment.ids, id);
        if (!place) return forget_trails(); // a body is gone
        point.position.push_back(moment.position_at(*place, time));
    }
    if (trails_.empty() || time > trails_.back().time) trails_.push_back(std::move(point));
    while (trails_.front().time < time - trail_seconds()) trails_.pop_front();
}

void Stage::draw_trails(double time, const Vec3& periods) {
    const auto age = [&](const TrailPoint& point) {
        return std::clamp(1 - (time - point.time) / trail_seconds(), 0.0, 1.0);
    };
    for (std::size_t i = 1; i < trails_.size(); ++i) {
        const TrailPoint& before = trails_[i - 1];
        const TrailPoint& after = trails_[i];
        for (std::size_t k = 0; k < trail_bodies_.size(); ++k) {
            const Vec3 way = after.position[k] - before.position[k];
            if (shortest(way, periods) != way) continue; // it went across a periodic face
            drawing_.lines.push_back({local(before.position[k]), local(after.position[k]), 1.3F,
                                      faded(trail_colour, age(before)), faded(trail_colour, age(after))});
        }
    }
}

} // namespace carom::viewer
