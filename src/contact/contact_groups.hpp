/// \file
/// Contacts of a pile in groups that are solved at once, by vector instructions: the same bits from every instruction
/// set.
#pragma once

#include <carom/base.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace carom::core {

/// Contacts in a group, whatever the machine.
inline constexpr std::size_t group_size = 8;

/// One side of contacts: a body that they move, or an *anchor*, which takes any impulse without moving.
template <class Real>
struct alignas(4 * sizeof(Real)) Mover {
    Vector3<Real> v{};     ///< m/s
    Real inverse_mass = 0; ///< 1/kg; 0 for anchors
};

/// What else the passes know of a mover.
template <class Real>
struct alignas(4 * sizeof(Real)) Place {
    Vector3<Real> x{}; ///< m, how far it has come since it was listed
    Real pressing = 0; ///< m/s^2: what its strongest contact does to it, at least
};

/// Eight contacts that have no movers in common; where there are fewer, they are of idle anchors.
template <class Real>
struct alignas(64) ContactGroup {
    using Lanes = std::array<Real, group_size>;
    using Vectors = std::array<Lanes, 3>;

    std::array<std::uint32_t, group_size> a{}; ///< mover, whose contact it is
    std::array<std::uint32_t, group_size> b{}; ///< mover, the other one
    Vectors normal{};                          ///< unit vectors from a to b
    Lanes gap{};                               ///< m; infinite where the contact is closed to the solver
    Lanes impulse{};                           ///< N s in a piece, pushes them apart
    Lanes mass{};                              ///< kg, reduced
    Lanes friction{};                          ///< Coulomb's mu
    Vectors rub{};                             ///< N s in a piece, friction on b
    Vectors apart{};                           ///< m, from a to b when they were listed; or the normal, if it is given
    Lanes touching{};                          ///< m, at which two balls touch; < 0 where normal and gap are given
    Lanes plastic{};                           ///< m, of the overlap, what bears nothing
    Vectors sprung{};                          ///< N s in a piece, of the friction, what stays when nothing slides
};

/// The vector in a lane.
template <class Lanes>
Vector3<typename Lanes::value_type> vector_in(const std::array<Lanes, 3>& vectors, std::size_t lane) {
    return {vectors[0][lane], vectors[1][lane], vectors[2][lane]};
}
/// Puts a vector, rounded, into a lane.
template <class Lanes>
void put_into(std::array<Lanes, 3>& vectors, std::size_t lane, const Vec3& v) {
    vectors[0][lane] = static_cast<Lanes::value_type>(v.x);
    vectors[1][lane] = static_cast<Lanes::value_type>(v.y);
    vectors[2][lane] = static_cast<Lanes::value_type>(v.z);
}

/// How a soft pass turns overlap and approach into impulses.
template <class Real>
struct Softness {
    Real rate = 0;      ///< 1/s, at which overlap is undone
    Real mass = 0;      ///< part of the effective mass
    Real impulse = 0;   ///< part of the impulse so far that is taken back
    Real frequency = 0; ///< 1/s, pieces: gaps may be closed within one
    Real stick = 0;     ///< part of the sliding that friction takes, if it can
};

/// What the passes run over.
template <class Real>
struct ContactRun {
    std::span<ContactGroup<Real>> groups;
    Mover<Real>* movers = nullptr;
    Place<Real>* places = nullptr;   ///< per mover
    std::uint8_t* carried = nullptr; ///< per mover, set to 1 where a contact between two bodies carried it
    bool rubs = false;               ///< whether any contact has friction
};

/// All of them take the groups in their order.
template <class Real>
struct GroupSolver {
    /// Looks where the balls are: normals and gaps.
    void (*measure)(const ContactRun<Real>&) = nullptr;
    /// Gives the movers what the impulses so far come to.
    void (*warm_up)(const ContactRun<Real>&) = nullptr;
    /// Solves with softness; normals and gaps stay as they are. Returns the energy that friction took, J.
    double (*solve_softly)(const ContactRun<Real>&, const Softness<Real>&) = nullptr;
    /// Looks where the balls are, turns the impulses along, and takes all approach out, and no overlap. `frequency`: as
    /// in Softness.
    void (*solve_hard)(const ContactRun<Real>&, Real frequency) = nullptr;
};

/// The one for the instruction set in use: see carom/executor.hpp.
template <class Real>
const GroupSolver<Real>& group_solver();

} // namespace carom::core
