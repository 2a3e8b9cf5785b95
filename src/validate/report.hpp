/// \file
/// What `carom validate` reports.
#pragma once

#include "validate/cases.hpp"

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace carom::validate {

struct Report {
    std::vector<Row> rows;
    std::vector<Curve> curves;

    [[nodiscard]] bool passed() const;
};

/// Called when a task is done, from any thread but never twice at once: how many are, of how many.
using Progress = std::function<void(std::size_t done, std::size_t tasks)>;

/// Runs the chosen groups with the default executor. The report is the same for any number of threads.
Report make_report(std::span<const Group> chosen, Extent extent, const Progress& progress);

/// The root mean square of all deviations in standard errors, which honest error bars make about 1.
Row error_bar_row(std::span<const Row> rows);

/// As a table to read.
std::string to_text(const Report& report);
/// As JSON for programs: docs/command_line.md lists the keys.
std::string to_json(const Report& report);

/// Seven significant digits; two of what is smaller than 0.001: "1.0e-13".
std::string number_text(double value);
/// "+0.12", "-3e-10", "0"
std::string signed_text(double value);

} // namespace carom::validate
