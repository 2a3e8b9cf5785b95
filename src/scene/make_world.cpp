#include "scene/scene.hpp"

#include <carom/base.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <variant>

namespace carom::scene {

namespace {

int line_of(const Scene& scene, const std::string& key) {
    const auto found = scene.lines.find(key);
    return found == scene.lines.end() ? 0 : found->second;
}

/// An option that the world refused, under its name in the file.
SceneError option_error(const Scene& scene, const Error& error) {
    const std::string& field = error.field();
    if (field.starts_with("region")) return {scene.file, line_of(scene, "region"), field, reason_of(error)};
    if (field.starts_with("obstacles")) {
        // "obstacles[2].triangles" is the table obstacle[2] of the file.
        const std::string table = field.substr(0, field.find('.'));
        const std::string rest = field.substr(std::string_view("obstacles").size());
        return {scene.file, line_of(scene, table == "obstacles" ? "obstacles[0]" : table), "obstacle" + rest,
                reason_of(error)};
    }
    const std::string key = "world." + field;
    return {scene.file, line_of(scene, key), key, reason_of(error)};
}

const BodySource* source_of(const Scene& scene, std::size_t body) {
    const auto found = std::find_if(scene.sources.begin(), scene.sources.end(), [body](const BodySource& source) {
        return body >= source.first && body - source.first < source.count;
    });
    return found == scene.sources.end() ? nullptr : &*found;
}

/// "body 7", and the entry that made it.
std::string body_name(const Scene& scene, std::size_t body) {
    const BodySource* source = source_of(scene, body);
    if (source == nullptr) return fmt::format("body {}", body);
    if (source->line == 0) return fmt::format("body {} ({})", body, source->key);
    return fmt::format("body {} ({}, line {})", body, source->key, source->line);
}

/// m: the sides along which the scene's space repeats, 0 along the others.
Vec3 periods_of(const Region& region) {
    const Box* box = std::get_if<Box>(&region);
    if (box == nullptr) return {};
    const Vec3 size = box->max - box->min;
    const auto period = [box](std::size_t axis, double side) {
        return box->faces[2 * axis].kind == FaceKind::periodic ? side : 0.0;
    };
    return {period(0, size.x), period(1, size.y), period(2, size.z)};
}

double nearest_image(double offset, double period) {
    return period > 0 ? offset - period * std::nearbyint(offset / period) : offset;
}

struct Overlapping {
    std::size_t body;
    double depth; ///< m, > 0
};

/// The body that reaches deepest into `body`, if any does.
std::optional<Overlapping> deepest_overlap(const Scene& scene, std::size_t body) {
    const BodyTable& bodies = scene.bodies;
    const Vec3 periods = periods_of(scene.options.region);
    std::optional<Overlapping> deepest;
    for (std::size_t other = 0; other < bodies.size(); ++other) {
        if (other == body) continue;
        const Vec3 offset = bodies.position[other] - bodies.position[body];
        const double distance = length(Vec3{nearest_image(offset.x, periods.x), nearest_image(offset.y, periods.y),
                                            nearest_image(offset.z, periods.z)});
        const double depth = bodies.radius[other] + bodies.radius[body] - distance;
        if (depth > 0 && (!deepest || depth > deepest->depth)) deepest = Overlapping{other, depth};
    }
    return deepest;
}

std::string body_reason(const Scene& scene, const Error& error) {
    const std::string self = fmt::format("body {}", error.index());
    if (error.code() == ErrorCode::overlap) {
        if (const auto other = deepest_overlap(scene, error.index())) {
            return fmt::format("{} overlaps {} by {:.6g} m; move one, or set overlap = \"accept\" in [world]", self,
                               body_name(scene, other->body), other->depth);
        }
    }
    return fmt::format("{}: {}", self, reason_of(error));
}

/// A body that the world refused, under the entry of the file that made it.
SceneError body_error(const Scene& scene, const Error& error) {
    const BodySource* source = error.index() == Error::no_index ? nullptr : source_of(scene, error.index());
    if (source == nullptr) return {scene.file, 0, "bodies." + error.field(), reason_of(error)};
    return {scene.file, source->line, source->key + "." + error.field(), body_reason(scene, error)};
}

/// An attractor that the world refused, under its entry of the file.
SceneError attractor_error(const Scene& scene, const Error& error) {
    if (error.index() >= scene.attractors.size()) return {scene.file, 0, error.field(), reason_of(error)};
    const std::string member = error.field().substr(error.field().find('.') + 1);
    return {scene.file, scene.attractors[error.index()].line, fmt::format("attractor[{}].{}", error.index(), member),
            reason_of(error)};
}

World made_world(const Scene& scene) {
    try {
        return World(scene.options);
    } catch (const Error& error) {
        throw option_error(scene, error);
    }
}

std::vector<BodyId> add_bodies(World& world, const Scene& scene) {
    try {
        return world.add(scene.bodies.columns(), scene.overlap);
    } catch (const Error& error) {
        throw body_error(scene, error);
    }
}

void set_attractors(World& world, const Scene& scene, const std::vector<BodyId>& ids) {
    std::vector<Attractor> attractors;
    attractors.reserve(scene.attractors.size());
    for (const AttractorSpec& spec : scene.attractors) {
        attractors.push_back({.position = spec.position,
                              .strength = spec.strength,
                              .softening = spec.softening,
                              .body = spec.body ? ids.at(*spec.body) : BodyId{}});
    }
    try {
        world.set_attractors(attractors);
    } catch (const Error& error) {
        throw attractor_error(scene, error);
    }
}

} // namespace

World make_world(const Scene& scene) {
    World world = made_world(scene);
    const std::vector<BodyId> ids = add_bodies(world, scene);
    set_attractors(world, scene, ids);
    return world;
}

} // namespace carom::scene
