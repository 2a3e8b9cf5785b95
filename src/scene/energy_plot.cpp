#include "scene/energy_plot.hpp"

#include "scene/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <vector>

namespace carom::scene {

namespace {

constexpr double width = 960;
constexpr double height = 600;
constexpr double left = 88;
constexpr double right = 932;
constexpr std::size_t line_columns = 422; ///< a line has at most two points in each
constexpr std::size_t most_bars = 106;

// Colours that colour-blind readers tell apart, on white and on near-black; `ink` is text, `rule` the grid.
constexpr std::string_view style = R"(<style>
text{font-family:"DejaVu Sans","Helvetica Neue",Arial,sans-serif;font-size:13px;fill:#3c4350}
.title{font-size:19px;font-weight:bold;fill:#171a20}.head{font-weight:bold;fill:#171a20}
.right{text-anchor:end}.middle{text-anchor:middle}
.paper{fill:#ffffff}.rule{stroke:#dfe3e8;stroke-width:1}.axis{stroke:#8a93a0;stroke-width:1}
.line{fill:none;stroke-width:2;stroke-linejoin:round;stroke-linecap:round}
.kinetic{stroke:#d1570b}.potential{stroke:#1c6fbf}.total{stroke:#a9b0ba;stroke-width:5}
.lost{stroke:#171a20;stroke-width:1.5;stroke-dasharray:6 5}
.pairs{fill:#23806a}.walls{fill:#a5d6c4}
@media (prefers-color-scheme:dark){
text{fill:#b4bcc8}.title,.head{fill:#f0f3f7}
.paper{fill:#14171c}.rule{stroke:#2b3038}.axis{stroke:#6b7482}
.kinetic{stroke:#ff9145}.potential{stroke:#62b0f5}.total{stroke:#566070}.lost{stroke:#f0f3f7}
.pairs{fill:#3fb491}.walls{fill:#245a4b}
}
</style>
)";

/// A unit to show values in: `text` stands for `size` of what they are given in.
struct Unit {
    double size = 1;
    std::string text;
};

/// The power of 1000 that makes `largest` a number of one to three digits before the point.
Unit unit_for(double largest, std::string_view name) {
    static constexpr std::array<std::string_view, 11> prefixes{"f", "p", "n", "µ", "m", "", "k", "M", "G", "T", "P"};
    if (!(largest > 0)) return {1, std::string(name)};
    const int power = static_cast<int>(std::floor(std::log10(largest) / 3 + 1e-9));
    const double size = std::pow(1000.0, power);
    if (power >= -5 && power <= 5) {
        return {size, fmt::format("{}{}", prefixes.at(static_cast<std::size_t>(power + 5)), name)};
    }
    return {size, fmt::format(R"(10<tspan dy="-5" style="font-size:10px">{}</tspan><tspan dx="5" dy="5">{}</tspan>)",
                              3 * power, name)};
}

Unit time_unit_for(double duration) {
    if (duration > 2 * 365.25 * 86400) return {365.25 * 86400, "years"};
    if (duration > 3 * 86400) return {86400, "days"};
    if (duration > 3 * 3600) return {3600, "hours"};
    if (duration > 20 * 60) return {60, "minutes"};
    return duration >= 1 ? Unit{1, "s"} : unit_for(duration, "s");
}

/// A curve of one value of the rows: of the rows that share a column of the picture the least and the greatest.
template <class Value>
std::vector<std::array<double, 2>> curve_of(std::span<const TimelineRow> rows, const Scale& x, double time_unit,
                                            const Scale& y, double unit, Value value) {
    std::vector<std::array<double, 2>> points;
    const std::size_t per_column = rows.size() / line_columns + 1;
    const auto add = [&](const TimelineRow& row) {
        points.push_back({x.at(row.time / time_unit), y.at(value(row) / unit)});
    };
    for (std::size_t begin = 0; begin < rows.size(); begin += per_column) {
        const auto column = rows.subspan(begin, std::min(per_column, rows.size() - begin));
        const auto less = [&](const TimelineRow& a, const TimelineRow& b) { return value(a) < value(b); };
        const auto [least, greatest] = std::minmax_element(column.begin(), column.end(), less);
        add(*std::min(least, greatest));
        if (least != greatest) add(*std::max(least, greatest));
    }
    return points;
}

struct Time {
    Scale scale; ///< in units of `unit`
    Unit unit;
};

void draw_energies(Picture& picture, std::span<const TimelineRow> rows, const Time& time, double top, double bottom) {
    const auto kinetic = [](const TimelineRow& r) { return r.kinetic; };
    const auto potential = [](const TimelineRow& r) { return r.potential; };
    const auto total = [](const TimelineRow& r) { return r.total; };
    const auto with_losses = [](const TimelineRow& r) { return r.total + r.lost; };
    double low = 0;
    double high = 0;
    bool has_potential = false;
    bool has_losses = false;
    for (const TimelineRow& r : rows) {
        low = std::min({low, r.kinetic, r.potential, r.total, r.total + r.lost});
        high = std::max({high, r.kinetic, r.potential, r.total, r.total + r.lost});
        has_potential = has_potential || r.potential != 0;
        has_losses = has_losses || r.lost != 0;
    }
    const Unit unit = unit_for(std::max(high, -low), "J");
    // A little room above, so that a curve does not hide in the upper edge.
    const Scale y = round_scale(low / unit.size, high / unit.size * 1.01, 7, bottom, top);
    draw_x_axis(picture, time.scale, top, bottom, false);
    draw_y_axis(picture, y, left, right);
    const auto draw = [&](std::string_view classes, const auto& value) {
        picture.curve(classes, curve_of(rows, time.scale, time.unit.size, y, unit.size, value));
    };
    draw("total", total);
    if (has_potential) draw("potential", potential);
    draw("kinetic", kinetic);
    if (has_losses) draw("lost", with_losses);

    picture.text(left, top - 14, "head", "energy, " + unit.text);
    double end = right;
    if (has_losses) end = picture.legend(end, top - 14, "lost", "total + booked losses", false);
    end = picture.legend(end, top - 14, "total", "total", false);
    if (has_potential) end = picture.legend(end, top - 14, "potential", "potential", false);
    picture.legend(end, top - 14, "kinetic", "kinetic", false);
}

/// Impacts of some neighbouring rows.
struct Bin {
    double begin; ///< s
    double end;   ///< s
    std::uint64_t pairs;
    std::uint64_t walls;
};

/// How many intervals between rows make a bar: as few as the picture has room for, and a round time if there is one.
std::size_t intervals_per_bar(std::size_t intervals, double interval) {
    const std::size_t least = (intervals + most_bars - 1) / most_bars;
    const auto most = static_cast<double>(std::min(3 * least, intervals));
    double bar_time = round_up(interval * static_cast<double>(least));
    while (bar_time <= most * interval) {
        const double exact = bar_time / interval;
        if (std::abs(exact - std::round(exact)) < 1e-3) return static_cast<std::size_t>(std::lround(exact));
        bar_time = round_up(bar_time * 1.01);
    }
    return least;
}

std::vector<Bin> bins_of(std::span<const TimelineRow> rows, std::size_t intervals) {
    std::vector<Bin> bins;
    for (std::size_t i = 0; i + 1 < rows.size(); i += intervals) {
        const TimelineRow& a = rows[i];
        const TimelineRow& b = rows[std::min(i + intervals, rows.size() - 1)];
        bins.push_back({a.time, b.time, b.impacts - a.impacts, b.face_impacts - a.face_impacts});
    }
    return bins;
}

void draw_impacts(Picture& picture, std::span<const TimelineRow> rows, const Time& time, double top, double bottom) {
    const double interval =
        (time.scale.high - time.scale.low) / static_cast<double>(rows.size() - 1); // in the unit of the axis
    const std::size_t intervals = intervals_per_bar(rows.size() - 1, interval);
    const std::vector<Bin> bins = bins_of(rows, intervals);
    std::uint64_t most = 1;
    for (const Bin& bin : bins) most = std::max(most, bin.pairs + bin.walls);
    const Scale y = round_scale(0, static_cast<double>(most), most < 3 ? static_cast<int>(most) : 3, bottom, top);
    draw_x_axis(picture, time.scale, top, bottom, true);
    draw_y_axis(picture, y, left, right);
    for (const Bin& bin : bins) {
        const double x = time.scale.at(bin.begin / time.unit.size);
        const double bar_width = std::max(0.5, time.scale.at(bin.end / time.unit.size) - x - 0.6);
        const double split = y.at(static_cast<double>(bin.pairs));
        const double end = y.at(static_cast<double>(bin.pairs + bin.walls));
        if (bin.pairs > 0) picture.bar("pairs", x, split, bar_width, bottom - split);
        if (bin.walls > 0) picture.bar("walls", x, end, bar_width, split - end);
    }
    const double bin_time = static_cast<double>(intervals) * interval;
    picture.text(left, top - 14, "head", fmt::format("impacts per {:.3g} {}", bin_time, time.unit.text));
    const auto total = [](std::uint64_t count) { return number_text(static_cast<double>(count), 0); };
    double end = right;
    if (rows.back().face_impacts > rows.front().face_impacts) {
        end = picture.legend(end, top - 14, "walls", total(rows.back().face_impacts) + " with walls", true);
    }
    picture.legend(end, top - 14, "pairs", total(rows.back().impacts) + " between bodies", true);
}

std::vector<TimelineRow> finite_rows(std::span<const TimelineRow> rows) {
    std::vector<TimelineRow> finite;
    for (const TimelineRow& r : rows) {
        if (std::isfinite(r.time + r.kinetic + r.potential + r.total + r.lost)) finite.push_back(r);
    }
    return finite;
}

} // namespace

std::string energy_plot(std::span<const TimelineRow> all_rows, std::string_view title, std::string_view subtitle) {
    const std::vector<TimelineRow> rows = finite_rows(all_rows);
    Picture picture(width, height, style);
    picture.text(left - 60, 38, "title", escaped(title));
    picture.text(left - 60, 60, "", escaped(subtitle));
    if (rows.size() < 2) {
        picture.text(width / 2, height / 2, "middle", "nothing happened: the run has no steps");
        return picture.take();
    }
    const double begin = rows.front().time;
    const double end = rows.back().time;
    Time time{{}, time_unit_for(end - begin)};
    time.scale = round_scale(begin / time.unit.size, end / time.unit.size, 10, left, right);
    time.scale.low = begin / time.unit.size;
    time.scale.high = end / time.unit.size;
    draw_energies(picture, rows, time, 108, 366);
    draw_impacts(picture, rows, time, 430, 548);
    picture.text((left + right) / 2, height - 14, "middle", "time, " + time.unit.text);
    return picture.take();
}

} // namespace carom::scene
