/// \file
/// Gases of equal hard spheres in a periodic cube, and what theory says about them. Units: diameter = mass = kT = 1.
#pragma once

#include <carom/world.hpp>

#include <cstddef>
#include <cstdint>

namespace carom::validate {

/// A gas to start from: jittered simple cubic lattice, total momentum zero.
struct GasSetup {
    double packing = 0.1;
    std::size_t per_axis = 16; ///< per_axis^3 bodies
    double restitution = 1;
    std::uint64_t seed = 1;
    bool equal_speeds = false; ///< else Maxwell's distribution; 2 K / (3 N - 3) = 1 in either case
    bool periodic = true;      ///< else elastic walls
    Precision precision = Precision::double_precision;

    [[nodiscard]] double bodies() const { return static_cast<double>(per_axis * per_axis * per_axis); }
    /// 1/m^3
    [[nodiscard]] double density() const;
    /// m
    [[nodiscard]] double side() const;
};

World make_gas(const GasSetup& setup);

/// J: 2 K / (3 N - 3), as total momentum is zero.
double temperature(const World& world);

/// Collisions per body since the world was made.
double collisions_per_body(const World& world);

/// Compressibility factor of the infinite system: modified Kolafa-Labik-Malijevsky equation.
double compressibility(double packing);
/// The same of N bodies in a periodic cube, to first order in 1/N.
double compressibility(double packing, double bodies);
/// g at contact, (Z - 1) / (4 packing).
double contact_value(double packing);
/// 1/s, collisions per body of the infinite system at kT = 1: 4 sqrt(pi) n chi.
double collision_rate(double packing);
/// The same of N bodies in a periodic cube with zero momentum and given energy, to first order in 1/N.
double collision_rate(double packing, double bodies);

inline constexpr const char* equation_source = "modified Kolafa-Labik-Malijevsky equation";

} // namespace carom::validate
