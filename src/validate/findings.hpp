/// \file
/// What a validation case finds: rows of the table, and curves for the plots.
#pragma once

#include <carom/observers.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace carom::validate {

/// What is claimed, in words.
struct Claim {
    std::string name;   ///< the quantity, with its unit
    std::string setup;  ///< what was simulated
    std::string source; ///< where the reference comes from
};

/// One line of the table.
struct Row {
    Claim claim;
    double reference = 0;
    double measured = 0;
    double standard_error = 0;         ///< of the deviation; 0 in exact rows
    double admitted = 0;               ///< the largest deviation that passes, in the unit of the quantity
    std::optional<double> sigmas = {}; ///< deviation in standard errors; statistical rows only
    bool passed = false;

    /// Deviation in per cent of the reference; nothing where that is 0.
    [[nodiscard]] std::optional<double> percent() const;
};

/// A row whose deviation must be at most `admitted`, in the unit of the quantity.
Row exact_row(Claim claim, double reference, double measured, double admitted);

/// A row whose deviation must be at most four standard errors (of measurement and reference together), and in the unit
/// of the quantity at most `admitted`, as must be the measurement's own standard error.
Row statistical_row(Claim claim, const Estimate& reference, const Estimate& measured, double admitted);

/// Mean and standard error of independent values.
Estimate mean_of(std::span<const double> values);

/// A point of a plot; `error` is its standard error, 0 for none.
struct Point {
    double x = 0;
    double y = 0;
    double error = 0;
};

enum class Mark : std::uint8_t { line, points };

/// Something to draw in the plot of that name. What belongs together there, a law and its measurement, has one name.
struct Curve {
    std::string plot;
    std::string name;
    Mark mark = Mark::line;
    std::vector<Point> points;
};

struct Findings {
    std::vector<Row> rows;
    std::vector<Curve> curves;
};

} // namespace carom::validate
