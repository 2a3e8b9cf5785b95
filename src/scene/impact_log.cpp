#include "scene/impact_log.hpp"

#include <fmt/format.h>

#include <iterator>

namespace carom::scene {

std::string_view impact_log_header() {
    return "step,time,offset,a,b,face,x,y,z,normal_x,normal_y,normal_z,impulse,approach_speed,energy_lost\n";
}

void append_impacts(std::string& log, std::uint64_t step, std::span<const Impact> impacts) {
    const auto out = std::back_inserter(log);
    for (const Impact& i : impacts) {
        fmt::format_to(out, "{},{},{},{},", step, i.time, i.offset, i.a.slot);
        if (i.b.is_set())
            fmt::format_to(out, "{},,", i.b.slot);
        else
            fmt::format_to(out, ",{},", i.face);
        fmt::format_to(out, "{},{},{},{},{},{},{},{},{}\n", i.position.x, i.position.y, i.position.z, i.normal.x,
                       i.normal.y, i.normal.z, i.impulse, i.approach_speed, i.energy_lost);
    }
}

} // namespace carom::scene
