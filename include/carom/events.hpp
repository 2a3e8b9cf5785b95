/// \file
/// What a step tells afterwards: its impacts, its report, and the world's books.
#pragma once

#include <carom/body.hpp>

#include <cstdint>

namespace carom {

/// Two bodies, or a body and a face of the region, met with a finite approach speed.
struct Impact {
    double time = 0;           ///< s, the world's time, rounded to a double
    double offset = 0;         ///< s since the start of the step: exact however late it is
    BodyId a{};                ///< of two bodies the one with the lower id
    BodyId b{};                ///< not set where a face was hit
    std::int32_t face = -1;    ///< index of the face that was hit, -1 between bodies
    Vec3 position{};           ///< m, the point of contact
    Vec3 normal{};             ///< unit vector from a to b, or from a into the face
    double impulse = 0;        ///< N s along the normal, >= 0: b gets it along the normal, a against it
    double approach_speed = 0; ///< m/s along the normal just before, > 0
    double energy_lost = 0;    ///< J, by restitution and friction, >= 0
};

/// Two bodies, or a body and a face of the region, that touch and press on each other.
struct Contact {
    BodyId a{};             ///< of two bodies of a pile the one with the lower id; else the one that is not static
    BodyId b{};             ///< not set where it is a face
    std::int32_t face = -1; ///< index of the face, -1 between bodies
    Vec3 position{};        ///< m, the point of contact
    Vec3 normal{};          ///< unit vector from a to b, or from a into the face
    double force = 0;       ///< N along the normal, > 0: b gets it along the normal, a against it
    Vec3 friction{};        ///< N across the normal on b, or on the face; a gets the opposite
};

/// A Contact began in the last step, or ended. One that began and ended in it is told of by neither.
struct ContactChange {
    BodyId a{};             ///< as in Contact
    BodyId b{};             ///< not set where it is a face
    std::int32_t face = -1; ///< index of the face, -1 between bodies
    bool has_begun = false; ///< else it has ended

    friend bool operator==(const ContactChange&, const ContactChange&) = default;
};

/// Wall-clock seconds that the phases of a step took.
struct PhaseTimes {
    double forces = 0;   ///< kicks of drag and attractors, contacts of held bodies
    double contacts = 0; ///< contacts of piles
    double cells = 0;    ///< swept boxes and sorting into cells
    double pairs = 0;    ///< pair search and first predictions
    double impacts = 0;  ///< event loop
    double bodies = 0;   ///< bringing every body to the end of the step
};

/// What one call of World::step did.
struct StepReport {
    double advanced = 0;              ///< s the world moved on
    double behind = 0;                ///< s it was asked for beyond that: > 0 only if the step ended early
    bool work_cap_reached = false;    ///< the step ended early because of WorldOptions::work_cap
    bool edge_reached = false;        ///< the step ended early: a body was about to leave the representable world
    bool crushed = false;             ///< the step ended early: what moves as prescribed leaves a body no room
    std::uint64_t impacts = 0;        ///< all of them, recorded or not; body with body
    std::uint64_t face_impacts = 0;   ///< body with a face of the region
    std::uint64_t predictions = 0;    ///< times of impact computed
    std::uint64_t tc_conversions = 0; ///< impacts made elastic by the TC rule against inelastic collapse
    std::uint64_t held = 0;           ///< bodies that something carries, at the end: see World::held()
    std::uint64_t asleep = 0;         ///< of these, bodies that have lain still for long
    std::uint64_t contacts = 0;       ///< what carries them: pairs that touch, or a body and a face, at the end
    std::uint32_t pieces = 0;     ///< that contacts between moving bodies had the step cut into; 0 if there were none
    std::uint32_t windows = 0;    ///< that the impacts had it cut into
    std::uint64_t candidates = 0; ///< pairs of bodies that a window's first look could not tell apart
    std::uint64_t islands = 0;    ///< groups of bodies that impacts coupled, over all windows
    std::uint64_t largest_island = 0; ///< bodies
    std::uint64_t rounds = 0;         ///< of islands being resolved and compared, over all windows
    std::uint64_t merges = 0;         ///< islands that were merged with another, and run again
    PhaseTimes seconds{};
};

/// The world's books since it was made, so that energy and momentum can be accounted for to rounding.
struct Ledger {
    std::uint64_t impacts = 0;      ///< body with body
    std::uint64_t face_impacts = 0; ///< body with a face of the region
    double lost_to_restitution = 0; ///< J, in impacts and by coming to rest
    double lost_to_friction = 0;    ///< J
    double lost_to_drag = 0;        ///< J
    double prescribed_work = 0; ///< J, given to the bodies by faces and bodies that move as prescribed, and by growth
    /// N s given to the bodies by gravity, attractors, drag, faces and static bodies, all together.
    Vec3 outer_impulse{};

    friend bool operator==(const Ledger&, const Ledger&) = default;
};

/// Energies of all bodies that are not static, J.
struct Energy {
    double kinetic = 0;
    double potential = 0; ///< in uniform gravity (zero at the world's origin) and of attractors (zero at infinity)
    [[nodiscard]] constexpr double total() const { return kinetic + potential; }
};

} // namespace carom
