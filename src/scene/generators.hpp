/// \file
/// Initial states: where many bodies start, how fast, how large and how heavy. Everything here is a function of its
/// arguments and the random numbers, with the same bits on every machine.
#pragma once

#include "scene/occupancy.hpp"
#include "scene/random.hpp"

#include <carom/base.hpp>
#include <carom/region.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <stdexcept>
#include <vector>

namespace carom::scene {

/// What was asked for is impossible; the text says why and what would be possible.
class GeneratorError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// \name Space to fill
/// @{

/// An axis-aligned box; its sides are positive and finite.
struct Cuboid {
    Vec3 min{}; ///< m
    Vec3 max{}; ///< m

    [[nodiscard]] Vec3 size() const { return max - min; }
    [[nodiscard]] Vec3 centre() const { return min + 0.5 * size(); }
    [[nodiscard]] double volume() const { return size().x * size().y * size().z; }
};

/// What lies between two spheres about one centre; a ball if `inner` is 0.
struct Ball {
    Vec3 centre{};    ///< m
    double inner = 0; ///< m, in [0, outer]
    double outer = 1; ///< m
};

/// A flat ring; a disc if `inner` is 0.
struct Disc {
    Vec3 centre{};        ///< m
    Vec3 normal{0, 0, 1}; ///< of length 1
    double inner = 0;     ///< m, in [0, outer]
    double outer = 1;     ///< m
    double thickness = 0; ///< m, along the normal
};

/// Any unit vector perpendicular to one of length 1; the same one every time.
Vec3 any_perpendicular(const Vec3& unit);

/// True if a body there is inside the region, its surface at most touching the faces.
bool is_inside(const Region& region, const Vec3& position, double radius);
/// @}

/// \name Regular positions
/// @{

/// How many lattice sites there are along each axis.
struct Sites {
    std::uint64_t x = 1;
    std::uint64_t y = 1;
    std::uint64_t z = 1;
};

/// The most nearly cubic cells that cut the box into at least `count` >= 1.
Sites lattice_sites(const Cuboid& box, std::size_t count);

/// The centres of `count` of the cells that the sites cut the box into, spread evenly over all of them, x fastest.
std::vector<Vec3> lattice(const Cuboid& box, const Sites& sites, std::size_t count);

/// m: how far along each axis bodies of this radius may move from their sites and neither leave their cells nor
/// overlap. Throws GeneratorError where not even the lattice itself has room for them.
Vec3 largest_jitter(const Cuboid& box, const Sites& sites, double radius);

/// Moves every position by up to so much (m) along each axis.
void jitter(std::span<Vec3> positions, const Vec3& most, Random& random);

/// `count` sites of the face-centred cubic lattice that fit into the box with their surfaces inside. The lattice
/// constant is the largest with which that many fit; they are filled in order, x fastest, z slowest. Throws
/// GeneratorError where they would overlap.
std::vector<Vec3> fcc(const Cuboid& box, std::size_t count, double radius);
/// @}

/// \name Random positions
/// @{

/// Uniform in the box, at least `radius` away from its sides along the axes whose `inset` is 1 (0: up to the side).
Vec3 in_cuboid(const Cuboid& box, double radius, const Vec3& inset, Random& random);
Vec3 in_ball(const Ball& ball, Random& random);
Vec3 in_disc(const Disc& disc, Random& random);

/// Somewhere a body of this radius may be, overlaps with other bodies aside; nothing if this try found no place.
using Sampler = std::function<std::optional<Vec3>(double radius, Random& random)>;

/// Where to place bodies at random.
struct Room {
    Sampler sample;
    double volume; ///< m^3 that all of each body is in; only to refuse at once what cannot be
};

/// A random place without overlap for each body, the largest first, and enters them into `occupancy`. Throws
/// GeneratorError where there is no room for all.
std::vector<Vec3> place_randomly(std::span<const double> radii, const Room& room, Occupancy& occupancy, Random& random);
/// @}

/// \name Velocities, m/s
/// @{

/// Each component uniform in [low, high).
std::vector<Vec3> uniform_velocities(std::size_t count, double low, double high, Random& random);

/// Maxwell's distribution: each component normal with variance kT / mass (kT in J).
std::vector<Vec3> maxwell_velocities(std::span<const double> masses, double kt, Random& random);

/// All of this speed away from the centre (towards it if negative), each turned by a random share of `spread`, in
/// [0, 1]: 0 turns none, 1 turns by up to 90 degrees. A body at the centre goes along x.
std::vector<Vec3> radial_velocities(std::span<const Vec3> positions, const Vec3& centre, double speed, double spread,
                                    Random& random);

/// What bodies circle around, and how much their orbits vary.
struct Orbit {
    Vec3 centre{};                ///< m
    Vec3 drift{};                 ///< m/s, the velocity of the centre
    double strength = 0;          ///< m^3/s^2, > 0
    double softening = 0;         ///< m
    double eccentricity = 0;      ///< root mean square, in [0, 0.7]; Rayleigh-distributed
    double inclination = 0;       ///< rad, root mean square against the plane; Rayleigh-distributed
    std::optional<Vec3> normal{}; ///< of length 1; without it every orbit has a random plane
};

/// A velocity at `position` on a Kepler orbit of random eccentricity, phase and plane. Softening weakens it so that an
/// orbit without eccentricity is a circle all the same.
Vec3 orbit_velocity(const Vec3& position, const Orbit& orbit, Random& random);
/// @}

/// m^3: volume of a ball.
double ball_volume(double radius);

} // namespace carom::scene
