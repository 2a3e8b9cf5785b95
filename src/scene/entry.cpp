#include "scene/entry.hpp"

#include <fmt/format.h>

namespace carom::scene {

std::optional<ValueReader> Entry::find_unless_in_csv(std::string_view key, std::string_view column) {
    const auto value = table.find(key);
    if (value && is_in_csv(column)) value->fail(fmt::format("is given twice: here and as column '{}'", column));
    return value;
}

const NamedAttractor* find_around(Entry& entry, const std::vector<NamedAttractor>& attractors) {
    const auto value = entry.table.find("around");
    if (!value) return attractors.size() == 1 ? attractors.data() : nullptr;
    std::vector<std::string_view> names;
    names.reserve(attractors.size());
    for (const NamedAttractor& attractor : attractors) names.push_back(attractor.name);
    if (names.empty()) value->fail("must be the name of an [[attractor]], but the scene has none");
    return &attractors[value->choice(names)];
}

void read_centre(Entry& entry, const std::vector<NamedAttractor>& attractors) {
    const NamedAttractor* attractor = find_around(entry, attractors);
    if (const auto value = entry.table.find("centre")) {
        entry.centre = value->vec3(coordinate_range);
    } else if (attractor != nullptr) {
        entry.centre = attractor->spec.position;
    } else {
        entry.table.fail("centre", "is missing: give a centre, or around = the name of an attractor");
    }
}

} // namespace carom::scene
