/// \file
/// Bodies as the public API sees them: ids, one body, and columns of many.
#pragma once

#include <carom/base.hpp>

#include <compare>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <variant>

namespace carom {

/// Names a body for as long as it exists, wherever it is kept in memory. A default id names nothing.
/// An id is refused once its body was removed, and by every world but its own (and that world's copies and snapshots).
/// Worlds are told apart by 16 bits: of worlds that were made 65 536 after each other one takes the other's ids.
struct BodyId {
    std::uint32_t slot = 0xffffffffU; ///< place in the world's table of ids; the order of ids
    std::uint16_t generation = 0;     ///< how often the slot was given out before
    std::uint16_t world = 0;          ///< which world of this process gave it out; takes no part in the order

    friend constexpr bool operator==(const BodyId&, const BodyId&) = default;
    friend constexpr std::strong_ordering operator<=>(const BodyId& a, const BodyId& b) {
        if (const auto by_slot = a.slot <=> b.slot; by_slot != 0) return by_slot;
        return a.generation <=> b.generation;
    }
    /// False for a default id; says nothing about whether the body still exists (see World::contains).
    [[nodiscard]] constexpr bool is_set() const { return slot != 0xffffffffU; }
};

/// Mass of a body that takes any momentum, and that nothing which happens makes move otherwise: a static body, or with
/// a velocity a kinematic one. That goes straight on at this velocity until it is set anew; it passes through faces and
/// static and kinematic bodies.
inline constexpr double infinite_mass = std::numeric_limits<double>::infinity();

/// A point mass with a collision radius.
struct Body {
    Vec3 position{};             ///< m, relative to the world's origin; rounded to the world's resolution
    Vec3 velocity{};             ///< m/s
    double mass = 1;             ///< kg, > 0; infinite_mass makes the body static, or kinematic if it has a velocity
    double radius = 0.5;         ///< m, >= 0; 0 is a point: two points never meet unless exactly head-on
    double restitution = 1;      ///< e in [0, 1]; two bodies use the larger; not used where the material has a law
    double friction = 0;         ///< Coulomb's mu >= 0; two bodies use sqrt(mu_a mu_b)
    std::uint32_t material = 0;  ///< key into the world's materials and material rules; has no other effect
    std::uint64_t user_data = 0; ///< yours; kept in snapshots, no part of the hash
    double growth = 0;           ///< m/s, of the radius; a step to a negative radius is refused
};

/// Columns of many bodies to read from: the primary way in. Either all bodies' values or, if empty, none: then
/// `add` takes the default of Body, and `set` leaves what is there. Units as in Body.
struct ConstBodyColumns {
    std::span<const Vec3> position{};
    std::span<const Vec3> velocity{};
    std::span<const double> mass{};
    std::span<const double> radius{};
    std::span<const double> restitution{};
    std::span<const double> friction{};
    std::span<const std::uint32_t> material{};
    std::span<const std::uint64_t> user_data{};
    std::span<const double> growth{};
};

/// Columns of many bodies to write to: the primary way out. Empty columns are not wanted. Units as in Body.
struct BodyColumns {
    std::span<Vec3> position{};
    std::span<Vec3> velocity{};
    std::span<double> mass{};
    std::span<double> radius{};
    std::span<double> restitution{};
    std::span<double> friction{};
    std::span<std::uint32_t> material{};
    std::span<std::uint64_t> user_data{};
    std::span<double> growth{};
};

/// Restitution that falls with a power of the approach speed v: e = min(1, restitution (v / speed)^-exponent). Ice at
/// 100 K: 0.32, 0.01 m/s, 0.234 (Bridges, Hatzes & Lin, Nature 309, 333 (1984)).
struct PowerLaw {
    double restitution = 1; ///< e at `speed`, in (0, 1]
    double speed = 1;       ///< m/s, > 0
    double exponent = 0;    ///< >= 0

    friend bool operator==(const PowerLaw&, const PowerLaw&) = default;
};

/// Restitution of viscoelastic spheres: e falls from 1 with x = (3/2) A (rho / m)^(2/5) v^(1/5), where m is the reduced
/// mass, R the reduced radius (the body's own at a face) and rho = (2/3) `modulus` sqrt(R). The force at an overlap h
/// is rho h^(3/2) + (3/2) A rho h^(1/2) dh/dt until h is zero again (Brilliantov, Spahn, Hertzsch & Poeschel, Phys.
/// Rev. E 53, 5382 (1996)); e(x) is the exact solution to 1e-12 up to x = 2, where e is 0.095, and to 2e-8 of itself
/// beyond.
struct Viscoelastic {
    double dissipation = 0; ///< s, >= 0: the material's constant A
    double modulus = 0;     ///< Pa, >= 0: Young's modulus / (1 - Poisson's ratio^2)

    friend bool operator==(const Viscoelastic&, const Viscoelastic&) = default;
};

/// Restitution as a function of the approach speed, which is that along the normal. The rest rule (see
/// WorldOptions::rest_time) takes e at the speed that gravity gives in the rest time, and without uniform gravity e at
/// the approach speed.
using RestitutionLaw = std::variant<PowerLaw, Viscoelastic>;

/// A material whose bodies have a law instead of Body::restitution, for each other, for bodies without a law (the
/// larger e at the approach speed) and for surfaces without an e of their own.
struct Material {
    std::uint32_t key = 0; ///< Body::material of its bodies
    RestitutionLaw restitution{};
};

/// What e and mu two bodies of the materials `a` and `b` (in either order) use instead of the combined ones.
struct MaterialRule {
    std::uint32_t a = 0;
    std::uint32_t b = 0;
    double restitution = 1;              ///< in [0, 1]
    double friction = 0;                 ///< >= 0
    std::optional<RestitutionLaw> law{}; ///< instead of `restitution`
};

/// What to do when an added or moved body would overlap another one, or reach through a face of the region.
enum class Overlap : std::uint8_t {
    refuse, ///< throw Error{overlap}; gaps down to a rounding (-1e-9 diameters in double, -1e-6 in single, or two
            ///< units of the world's resolution) are no overlap
    accept, ///< take it: the pair does not approach further (it has its impact at once) and parts freely
};

} // namespace carom
