/// \file
/// What carom is measured beside: another engine, set up as somebody who knows it would for the workloads `gas` and
/// `pile`.
#pragma once

#include "scene/scene.hpp"

#include <carom/base.hpp>

#include <memory>
#include <span>
#include <variant>

namespace carom::peers {

class Engine {
public:
    Engine() = default;
    Engine(const Engine&) = delete;
    Engine& operator=(const Engine&) = delete;
    virtual ~Engine() = default;

    virtual void step(double dt) = 0;
    /// In the order of the scene's bodies.
    virtual void read(std::span<Vec3> positions, std::span<Vec3> velocities) const = 0;
};

/// Of the one engine that is linked in; each is a program of its own.
extern const char* const engine_name;
extern const Precision engine_precision;

/// A world of equal spheres in a box, some of whose faces may be open; without friction, damping and sleep.
std::unique_ptr<Engine> make_engine(const scene::Scene& scene);

inline const Box& box_of(const scene::Scene& scene) { return std::get<Box>(scene.options.region); }
/// e of spheres that meet each other.
inline double restitution_between(const scene::Scene& scene) { return scene.bodies.restitution.front(); }
/// e of a sphere that meets a face.
inline double restitution_at(const Face& face, const scene::Scene& scene) {
    return face.surface.restitution.value_or(restitution_between(scene));
}
/// m/s, what approaches more slowly does not bounce: contacts under gravity need such a limit, which is Bullet's own.
inline double slowest_bounce(const scene::Scene& scene) { return scene.options.gravity == Vec3{} ? 0 : 0.5; }

} // namespace carom::peers
