// Linked with parts of the engine that have a defect: says in which of the named groups `carom validate` finds it.
// usage: PROGRAM found|none GROUP...   Exit code 0 if a row of each group fails (found) or no row of any does (none).

#include "validate/report.hpp"

#include <algorithm>
#include <cstdio>
#include <span>
#include <string>

namespace {

using carom::validate::Group;

std::ptrdiff_t failing_rows(const Group& group) {
    const auto silent = [](std::size_t /*done*/, std::size_t /*tasks*/) {};
    const auto report = carom::validate::make_report(std::span(&group, 1), carom::validate::Extent::quick, silent);
    return std::count_if(report.rows.begin(), report.rows.end(), [](const auto& row) { return !row.passed; });
}

} // namespace

int main(int argc, char** argv) {
    const std::span<char*> arguments(argv, static_cast<std::size_t>(argc));
    if (arguments.size() < 3) return 2;
    const bool defect_is_found = std::string(arguments[1]) == "found";
    bool as_expected = true;
    for (const std::string name : arguments.subspan(2)) {
        const auto groups = carom::validate::groups();
        const auto group = std::find_if(groups.begin(), groups.end(), [&](const Group& g) { return g.name == name; });
        if (group == groups.end()) return 2;
        const std::ptrdiff_t failing = failing_rows(*group);
        std::printf("figure: %s: %td rows of %s fail\n", arguments[0], failing, name.c_str());
        as_expected = as_expected && (failing > 0) == defect_is_found;
    }
    return as_expected ? 0 : 1;
}
