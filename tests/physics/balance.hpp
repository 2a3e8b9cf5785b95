/// \file
/// The energy that no world gains or loses.
#pragma once

#include <carom/world.hpp>

namespace carom::test {

/// J: what the bodies have, and what the books say that they lost, less what was done on them. Does not change.
inline double balance(const World& world) {
    const Ledger& ledger = world.ledger();
    return world.energy().total() + ledger.lost_to_restitution + ledger.lost_to_friction + ledger.lost_to_drag -
           ledger.prescribed_work;
}

} // namespace carom::test
