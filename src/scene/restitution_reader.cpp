#include "scene/restitution_reader.hpp"

#include <array>

namespace carom::scene {

namespace {

constexpr NumberRange share{0, 1, true, false, "must be in (0, 1]"};

PowerLaw read_power(TableReader& table) {
    return {.restitution = table.need("restitution").number(share),
            .speed = table.need("speed").number(positive),
            .exponent = table.need("exponent").number(not_negative)};
}

Viscoelastic read_viscoelastic(TableReader& table) {
    return {.dissipation = table.need("dissipation").number(not_negative),
            .modulus = table.need("modulus").number(not_negative)};
}

} // namespace

std::optional<RestitutionLaw> read_law(const ValueReader& value) {
    if (!value.is_table()) return std::nullopt;
    constexpr std::array<std::string_view, 2> names{"power", "viscoelastic"};
    TableReader table = value.table();
    const bool is_power = table.need("law").choice(names) == 0;
    const RestitutionLaw law = is_power ? RestitutionLaw(read_power(table)) : read_viscoelastic(table);
    table.finish();
    return law;
}

} // namespace carom::scene
