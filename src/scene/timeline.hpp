/// \file
/// What a run records over time: one row per step, or every so many, of energies, momentum and impacts.
#pragma once

#include <carom/base.hpp>
#include <carom/world.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace carom::scene {

/// One row of timeline.csv.
struct TimelineRow {
    double time = 0;                ///< s of the world's time
    std::uint64_t step = 0;         ///< steps done
    double kinetic = 0;             ///< J
    double potential = 0;           ///< J
    double total = 0;               ///< J, kinetic + potential
    double lost = 0;                ///< J, booked as lost to restitution, friction and drag since time 0
    Vec3 momentum{};                ///< kg m/s
    std::uint64_t impacts = 0;      ///< body with body, since time 0
    std::uint64_t face_impacts = 0; ///< body with a wall, since time 0
    std::uint64_t contacts = 0;     ///< resting ones, of bodies with each other, faces and static bodies

    friend bool operator==(const TimelineRow&, const TimelineRow&) = default;
    template <class Archive, class Self>
    static void transfer(Archive& archive, Self& self) {
        archive(self.time, self.step, self.kinetic, self.potential, self.total, self.lost, self.momentum, self.impacts,
                self.face_impacts, self.contacts);
    }
};

/// The row of `world` as it is now, `step` steps after its start.
TimelineRow timeline_row(const World& world, std::uint64_t step);

/// The first line of timeline.csv: the names of its columns.
std::string_view timeline_header();

/// The rows as CSV below the header. Numbers read back exactly.
std::string to_csv(std::span<const TimelineRow> rows);

} // namespace carom::scene
