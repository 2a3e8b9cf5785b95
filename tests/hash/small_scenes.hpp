/// \file
/// Scenes of few bodies that a world may get wrong for being so few, or so near each other.
#pragma once

#include "scene/generators.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <variant>

namespace carom::test {

/// A cube from 0 to `side` with six faces of one kind.
inline Box cube(double side, FaceKind kind) {
    Box box{.min = {}, .max = {side, side, side}};
    for (Face& face : box.faces) face.kind = kind;
    return box;
}

/// Three tenths of the period is a ball's diameter: cells of that edge and some to spare do not fit three times along
/// an axis, and then there is one cell alone.
inline scene::Scene one_cell() {
    constexpr double side = 3;
    constexpr std::size_t count = 27;
    constexpr double radius = 0.15 * side;
    scene::Scene scene;
    scene.options.region = cube(side, FaceKind::periodic);
    scene.bodies = scene::BodyTable::of(count);
    const scene::Cuboid space{{}, {side, side, side}};
    scene.bodies.position = scene::lattice(space, scene::lattice_sites(space, count), count);
    scene.bodies.radius.assign(count, radius);
    scene::Random random = scene::Random::stream(7, 0);
    scene.bodies.velocity = scene::uniform_velocities(count, -1, 1, random);
    return scene;
}

/// They bounce on the floor, and on each other, until they lie there.
inline scene::Scene three_bodies() {
    scene::Scene scene;
    scene.options.gravity = {0, 0, -9.8125};
    scene.options.region = cube(1.5, FaceKind::reflecting);
    scene.bodies = scene::BodyTable::of(3);
    scene.bodies.position = {{0.375, 0.75, 0.5}, {0.75, 0.75, 1.0625}, {1.125, 0.8125, 0.5}};
    scene.bodies.velocity = {{1, 0, 2}, {}, {-1.5, 0.125, 0}};
    scene.bodies.radius = {0.25, 0.375, 0.125};
    scene.bodies.mass = {1, 3, 0.5};
    scene.bodies.restitution.assign(3, 0.96875);
    scene.bodies.friction.assign(3, 0.25);
    return scene;
}

/// The eight corners are one place: all bodies meet there at the same time, across the faces.
inline scene::Scene corners() {
    constexpr double side = 4;
    constexpr double inset = 0.5;
    scene::Scene scene;
    scene.options.region = cube(side, FaceKind::periodic);
    scene.bodies = scene::BodyTable::of(8);
    scene.bodies.radius.assign(8, 0.375);
    for (std::size_t k = 0; k < 8; ++k) {
        const auto towards = [k](unsigned axis) { return (k >> axis & 1U) != 0 ? 1.0 : -1.0; };
        const Vec3 outward{towards(0), towards(1), towards(2)};
        const Vec3 centre{side / 2, side / 2, side / 2};
        const Vec3 drift{0.5, 0.25, 0.125};
        scene.bodies.position[k] = centre + (side / 2 - inset) * outward;
        scene.bodies.velocity[k] = 2.0 * outward + drift;
    }
    return scene;
}

/// They fall on each other and lie there as a heap, a body of other size and mass on top.
inline scene::Scene heap() {
    constexpr double side = 4.25;
    constexpr std::size_t count = 65;
    scene::Scene scene;
    scene.options.gravity = {0, 0, -9.8125};
    scene.options.region = Box{.min = {}, .max = {side, side, 8}};
    scene.bodies = scene::BodyTable::of(count);
    scene.bodies.radius.assign(count, 0.5);
    scene.bodies.restitution.assign(count, 0.25);
    scene.bodies.friction.assign(count, 0.25);
    for (std::size_t k = 0; k < count; ++k) {
        const auto cell = [k](unsigned axis) { return static_cast<double>(k >> 2 * axis & 3U); };
        const double off = 0.015625 * static_cast<double>(k % 5);
        scene.bodies.position[k] = {0.53125 + 1.0625 * cell(0) - off / 2, 0.53125 + 1.0625 * cell(1) + off / 4,
                                    0.5 + 1.03125 * cell(2)};
    }
    scene.bodies.position.back() = {2, 2.125, 5};
    scene.bodies.radius.back() = 0.25;
    scene.bodies.mass.back() = 8;
    return scene;
}

/// Bodies in a box that a piston makes smaller, and others that a ram drives through them.
inline scene::Scene piston() {
    constexpr std::size_t count = 66;
    scene::Scene scene;
    Box box = cube(6, FaceKind::reflecting);
    box.faces[1].motion.velocity = 0.25;
    scene.options.region = box;
    scene.bodies = scene::BodyTable::of(count);
    scene.bodies.radius.assign(count, 0.375);
    scene::Random random = scene::Random::stream(9, 0);
    scene.bodies.velocity = scene::uniform_velocities(count, -2, 2, random);
    for (std::size_t k = 0; k < count; ++k) {
        const auto cell = [k](unsigned axis) { return static_cast<double>(k >> 2 * axis & 3U); };
        scene.bodies.position[k] = {0.5 + 1.25 * cell(0), 0.5 + 1.25 * cell(1), 0.5 + 1.25 * cell(2)};
    }
    for (const std::size_t k : {std::size_t{64}, std::size_t{65}}) {
        scene.bodies.mass[k] = infinite_mass;
        scene.bodies.position[k] = {k == 64 ? -2.0 : 8.0, 2, 2};
        scene.bodies.velocity[k] = {k == 64 ? 1.0 : -3.0, 0.25, 0};
    }
    return scene;
}

/// They fall onto a floor that vibrates, and onto one that takes them along.
inline scene::Scene shaker() {
    scene::Scene scene = heap();
    Box box = std::get<Box>(scene.options.region);
    box.faces[4].motion = {.amplitude = 0.0625, .angular_frequency = 20, .phase = 0.5};
    box.faces[0].motion.surface_velocity = {0, 1, 0.5};
    scene.options.region = box;
    return scene;
}

/// A dense periodic fluid whose bodies grow until they hardly have room.
inline scene::Scene growing() {
    scene::Scene scene = one_cell();
    scene.bodies.radius.assign(scene.bodies.size(), 0.25);
    for (std::size_t k = 0; k < scene.bodies.size(); ++k) {
        scene.bodies.growth[k] = k % 3 == 0 ? 0.015625 : 0.0078125;
    }
    return scene;
}

/// A ground of triangles that goes up and down, and a funnel over it: bodies bounce off them, and lie on them.
inline scene::Scene obstacles() {
    constexpr std::uint32_t cells = 6;
    constexpr std::size_t count = 48;
    scene::Scene scene;
    scene.options.gravity = {0, 0, -9.8125};
    scene.options.region = Box{.min = {-3, -3, -1}, .max = {3, 3, 8}};
    Mesh ground;
    for (std::uint32_t k = 0; k < (cells + 1) * (cells + 1); ++k) {
        const std::uint32_t i = k % (cells + 1);
        const std::uint32_t j = k / (cells + 1);
        ground.vertices.push_back({i - 3.0, j - 3.0, 0.25 * (i * 3 % 4) + 0.125 * (j * 5 % 3) - 0.5});
        if (i == cells || j == cells) continue;
        ground.triangles.push_back({k, k + 1, k + cells + 2});
        ground.triangles.push_back({k, k + cells + 2, k + cells + 1});
    }
    scene.options.obstacles = {ground, Frustum{.base = {0.125, 0, 1.5},
                                               .axis = {0.125, 0, 1},
                                               .height = 1.5,
                                               .base_radius = 0.5,
                                               .top_radius = 2,
                                               .angular_velocity = 1.5}};
    scene.bodies = scene::BodyTable::of(count);
    scene.bodies.restitution.assign(count, 0.5);
    scene.bodies.friction.assign(count, 0.25);
    for (std::size_t k = 0; k < count; ++k) {
        const auto along = [k](std::size_t stride) { return static_cast<double>(k / stride % 4); };
        scene.bodies.position[k] = {along(1) - 1.5, along(4) - 1.5, 3.5 + along(16)};
        scene.bodies.velocity[k] = {along(4) - 1.25, 1.5 - along(1), -along(2)};
        scene.bodies.radius[k] = 0.125 + 0.0625 * static_cast<double>(k % 3);
    }
    scene.bodies.velocity[20] = {0, 0, -400};
    scene.bodies.restitution[5] = 1;
    return scene;
}

struct SmallScene {
    std::string_view name;
    scene::Scene (*make)();
};
inline constexpr std::array<SmallScene, 8> small_scenes{{{"one_cell", one_cell},
                                                         {"three_bodies", three_bodies},
                                                         {"corners", corners},
                                                         {"heap", heap},
                                                         {"piston", piston},
                                                         {"shaker", shaker},
                                                         {"growing", growing},
                                                         {"obstacles", obstacles}}};

inline scene::Scene small_scene(std::string_view name, Precision precision) {
    const auto* const small = std::find_if(small_scenes.begin(), small_scenes.end(),
                                           [name](const SmallScene& candidate) { return candidate.name == name; });
    scene::Scene scene = small->make();
    scene.name = name;
    scene.options.precision = precision;
    return scene;
}

} // namespace carom::test
