/// \file
/// What carom is measured beside: another engine, set up as somebody who knows it would for the workload `gas`.
#pragma once

#include "scene/scene.hpp"

#include <carom/base.hpp>

#include <memory>
#include <span>

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

/// A world of equal spheres in a box with reflecting walls, elastic, without gravity, friction, damping and sleep.
std::unique_ptr<Engine> make_engine(const scene::BodyTable& bodies, const Box& walls);

} // namespace carom::peers
