/// \file
/// What the colour of each body is.
#pragma once

#include "scene/view.hpp"

#include <carom/world.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace carom::viewer {

/// The columns of the bodies that colours go by, in the order of their ids.
struct ColouredBodies {
    std::span<const BodyId> ids;
    std::span<const Vec3> position;
    std::span<const Vec3> velocity;
    std::span<const double> mass;
    std::span<const std::uint32_t> material;
};

/// Gives bodies their colours, after each step or now and then. The scale reaches up to what one body in twenty
/// exceeds; it grows at once and shrinks slowly, so that films do not flicker.
class Colouring {
public:
    explicit Colouring(scene::ColourBy by) : by_(by) {}

    [[nodiscard]] scene::ColourBy by() const { return by_; }
    /// Another meaning of colours from now on.
    void set(scene::ColourBy by);
    /// To be called after each step: counts impacts, if colours go by them. `ids` in ascending order.
    void count_impacts(const World& world, std::span<const BodyId> ids);
    /// The words PackedBody::look; `now` is in s of the world.
    void paint(const ColouredBodies& bodies, std::span<const Attractor> attractors, double now,
               std::vector<std::uint32_t>& looks);
    /// What the ends of the scale stand for, in the quantity's unit; both 0 where colours are no scale.
    [[nodiscard]] double lowest() const { return lowest_; }
    [[nodiscard]] double highest() const { return highest_; }

private:
    void find_values(const ColouredBodies& bodies);
    void find_scale(const ColouredBodies& bodies, double now);

    scene::ColourBy by_;
    std::vector<float> values_;
    std::vector<float> rates_; ///< impacts a second of each body, a mean that forgets
    double rates_time_ = 0;    ///< s
    double lowest_ = 0;
    double highest_ = 0;
    double painted_ = 0; ///< s
};

/// The temperature in J around each body: two thirds of the kinetic energy relative to the mean motion of its
/// neighbourhood, a cell with about 16 bodies.
void find_temperatures(const ColouredBodies& bodies, std::span<float> temperatures);

} // namespace carom::viewer
