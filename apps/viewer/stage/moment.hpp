/// \file
/// What is seen of a world after a step, apart from the world itself, which may be at the next one already.
#pragma once

#include "viewer/render/matrix.hpp"
#include "viewer/stage/colouring.hpp"

#include <carom/world.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace carom::viewer {

/// Bodies in the order of their ids, from the beginning to the end of the last step.
struct Moment {
    double begin = 0; ///< s
    double end = 0;   ///< s
    std::shared_ptr<const std::vector<BodyId>> ids = std::make_shared<const std::vector<BodyId>>();
    std::shared_ptr<const std::vector<float>> radii = std::make_shared<const std::vector<float>>(); ///< m
    std::uint64_t version = 0;        ///< another one where ids or radii are others
    std::uint64_t era = 0;            ///< how often the simulation was restarted before
    std::vector<Vec3> position;       ///< m, at the end
    std::vector<Vec3f> way;           ///< m, during the step, by the short way across periodic faces
    std::vector<std::uint32_t> looks; ///< PackedBody::look
    std::vector<Contact> contacts;    ///< if asked for
    std::vector<Attractor> attractors;
    double lowest = 0; ///< what the ends of the scale of colours stand for
    double highest = 0;
    Region region_before; ///< as it was at the beginning
    Region region;        ///< at the end

    /// Where body number `i` is at `time`, on the straight line between the two ends.
    [[nodiscard]] Vec3 position_at(std::size_t i, double time) const;
    /// The region at `time`; its faces go straight, too.
    [[nodiscard]] Region region_at(double time) const;

private:
    /// The part of the step that is still to come at `time`.
    [[nodiscard]] double part_left(double time) const;
};

/// Looks at a world after its steps. Where it was made without WorldOptions::interpolation, bodies are taken to have
/// come straight with the velocity that they have at the end of the step.
class Spectator {
public:
    explicit Spectator(scene::ColourBy colour_by) : colouring_(colour_by) {}

    Colouring& colouring() { return colouring_; }
    /// To be called after each step.
    void watch_step(const World& world);
    /// What is seen now. `old`, if given, lends its memory.
    std::shared_ptr<Moment> look(const World& world, bool with_contacts, std::shared_ptr<Moment> old = nullptr);
    /// Bodies were added, removed, or given other masses, radii or materials, or the world is at another time.
    void bodies_changed();

private:
    void read_bodies(const World& world);
    void read_radii(const World& world);
    void find_ways(const World& world, Moment& moment);

    Colouring colouring_;
    std::shared_ptr<const std::vector<BodyId>> ids_;
    std::shared_ptr<const std::vector<float>> radii_;
    std::uint64_t version_ = 0;
    std::vector<Vec3> velocity_;
    std::vector<Vec3> before_; ///< m, at the beginning of the step
    std::vector<double> mass_;
    std::vector<std::uint32_t> material_;
    bool growing_ = false;                ///< a radius changes from step to step
    std::optional<Region> region_before_; ///< at the beginning of the last step, if that was watched
    std::optional<Region> region_;        ///< at its end
};

} // namespace carom::viewer
