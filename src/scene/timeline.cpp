#include "scene/timeline.hpp"

#include "scene/metrics.hpp"

#include <fmt/format.h>

#include <iterator>

namespace carom::scene {

std::string_view timeline_header() {
    return "time,step,kinetic,potential,total,lost,momentum_x,momentum_y,momentum_z,impacts,face_impacts,contacts\n";
}

TimelineRow timeline_row(const World& world, std::uint64_t step) {
    const Energy energy = world.energy();
    const Ledger& ledger = world.ledger();
    return {.time = world.time(),
            .step = step,
            .kinetic = energy.kinetic,
            .potential = energy.potential,
            .total = energy.total(),
            .lost = energy_lost(ledger),
            .momentum = world.momentum(),
            .impacts = ledger.impacts,
            .face_impacts = ledger.face_impacts,
            .contacts = world.report().contacts};
}

std::string to_csv(std::span<const TimelineRow> rows) {
    fmt::memory_buffer text;
    const auto out = std::back_inserter(text);
    text.append(timeline_header());
    for (const TimelineRow& r : rows) {
        // fmt writes the shortest digits that read back to the same double, whatever the locale.
        fmt::format_to(out, "{},{},{},{},{},{},{},{},{},{},{},{}\n", r.time, r.step, r.kinetic, r.potential, r.total,
                       r.lost, r.momentum.x, r.momentum.y, r.momentum.z, r.impacts, r.face_impacts, r.contacts);
    }
    return fmt::to_string(text);
}

} // namespace carom::scene
