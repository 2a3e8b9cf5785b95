/// \file
/// What an impact does to its bodies.
#pragma once

#include "impact/events.hpp"
#include "impact/prediction.hpp"

#include <functional>

namespace carom::core {

/// An impact with bodies by slot, lengths in m and positions in units: what a solver knows of it.
struct ImpactRecord {
    double offset = 0; ///< s since the start of the step
    std::uint32_t a = 0;
    std::uint32_t b = 0; ///< not used at a face
    std::int32_t face = -1;
    Int3 x{};   ///< units, of body a
    Vec3 arm{}; ///< m, from there to the point of contact
    Vec3 normal{};
    double impulse = 0;
    double approach_speed = 0;
    double energy_lost = 0;
};

/// What one event did.
struct Occurrence {
    ImpactRecord impact{};
    Entry entry{};
    bool is_impact = false;    ///< false: a body only found a support that it rests against, or something to lean on
    bool piles_up = false;     ///< the two bodies lean on each other from now on, or one on an obstacle
    bool is_converted = false; ///< the TC rule made it elastic
    bool is_crushed = false;   ///< what moves as prescribed leaves a body no room: time cannot go on
};

/// What the impacts of a step add up to, and who writes them down.
struct Outcome {
    std::uint64_t impacts = 0;
    std::uint64_t face_impacts = 0;
    std::uint64_t tc_conversions = 0;
    double least_impulse = 0; ///< N s, of what is recorded
    std::function<void(const ImpactRecord&)> record;

    [[nodiscard]] std::uint64_t all_impacts() const { return impacts + face_impacts; }
    void add(const Occurrence& occurrence);
};

/// Carries out an event that is not outdated: brings its bodies to its time and changes their velocities.
template <class Real>
void execute(State<Real>& state, const Event& event, Occurrence& occurrence);

} // namespace carom::core
