/// \file
/// The figures that say how well a world kept its books: energy_balance, energy_drift and momentum_drift.
#pragma once

#include <carom/base.hpp>
#include <carom/events.hpp>
#include <carom/world.hpp>

namespace carom::scene {

/// The books of a world at one time. Its sums are taken in double with compensation.
struct Books {
    double kinetic = 0;        ///< J
    double potential = 0;      ///< J
    double dissipated = 0;     ///< J, booked as lost to restitution, friction and drag since the world was made
    double work = 0;           ///< J, done since then by what moves as prescribed, and by growth
    Vec3 momentum{};           ///< kg m/s
    Vec3 outer_impulse{};      ///< N s from gravity, attractors, drag, walls and static bodies since the world was made
    double momentum_scale = 0; ///< kg m/s, sum of m |v|

    [[nodiscard]] double total() const { return kinetic + potential; }
    [[nodiscard]] double lost() const { return dissipated - work; }
    template <class Archive, class Self>
    static void transfer(Archive& archive, Self& self) {
        archive(self.kinetic, self.potential, self.dissipated, self.work, self.momentum, self.outer_impulse,
                self.momentum_scale);
    }
};

/// J booked as lost, of all kinds, less the work of what moves as prescribed.
double energy_lost(const Ledger& ledger);

/// Reads the books of `world`.
Books read_books(const World& world);

/// E_end + losses booked in between - E_start, by the largest energy at hand: the kinetic or potential one at either
/// time, what was dissipated or what work was done in between; 0 where there is none.
double energy_balance(const Books& start, const Books& end);

/// (E_end + losses booked in between - E_start) / max(K_start, K_end); 0 where nothing moves at either time.
double energy_drift(const Books& start, const Books& end);

/// |P_end - P_start - impulses from outside in between| / sum of m |v|, of the two sums the larger; 0 where nothing
/// moves at either time.
double momentum_drift(const Books& start, const Books& end);

} // namespace carom::scene
