#include "space/cells.hpp"

namespace carom::core {

namespace {

/// Eighth-octave bins of a length: sorts like the logarithm, without computing one.
constexpr std::uint32_t bin_shift = 20;
constexpr std::size_t bin_count = 1U << (31 - bin_shift);
std::uint32_t length_bin(float metres) { return std::bit_cast<std::uint32_t>(metres) >> bin_shift; }

/// A length that no member of the bin exceeds.
double bin_end(std::uint32_t bin) { return static_cast<double>(std::bit_cast<float>((bin + 1) << bin_shift)); }

/// Cells per body that a grid may have at most: empty cells cost little time but memory.
constexpr double cells_per_body = 4;

/// More than the roundings of ticks and of the test whether balls meet.
constexpr double tick_margin = 3;
constexpr double relative_margin = 1e-5;

} // namespace

void Cells::start_levels(const Axes& axes) {
    for (std::size_t k = 0; k < 3; ++k) scale_[k] = static_cast<float>(axes.metres_per_tick[k]);
    histogram_.assign(bin_count, 0);
    levels_.clear();
    late_.clear();
}

void Cells::count_diameter(const Ball& ball) { ++histogram_[length_bin(std::abs(2 * ball.radius))]; }

double Cells::first_edge(std::size_t bodies) const {
    const auto quantile = [&](double part) {
        auto left = static_cast<double>(bodies) * part;
        std::uint32_t bin = 0;
        while (bin + 1 < histogram_.size() && left > histogram_[bin]) left -= histogram_[bin++];
        return bin_end(bin);
    };
    // One size: the first level takes nearly all. Many sizes: start low, the others find their own level.
    constexpr double one_size = 4;
    const double most = quantile(0.98);
    return most <= one_size * quantile(0.05) ? most : quantile(0.25);
}

void Cells::choose_levels(std::size_t bodies) {
    std::size_t sampled = 0;
    for (const std::uint32_t count : histogram_) sampled += count;
    // The edge: of the smallest diameters it takes for granted that they are more than nothing.
    double edge =
        std::max(first_edge(sampled), 8 * static_cast<double>(*std::max_element(scale_.begin(), scale_.end())));
    for (; bodies > 0; edge *= 4) {
        Level level;
        const auto ticks = [&](std::size_t k) { return ticks_of(edge, k) * (1 + relative_margin) + 2 * tick_margin; };
        if (!(std::max({ticks(0), ticks(1), ticks(2)}) < whole_turn / 4)) break;
        for (std::size_t k = 0; k < 3; ++k) level.edge[k] = static_cast<Tick>(ticks(k));
        levels_.push_back(level);
    }
    levels_.push_back({.edge = {0xffffffffU, 0xffffffffU, 0xffffffffU}});
}

void Cells::lay_out_levels(const Axes& axes) {
    std::uint32_t first_cell = 0;
    for (Level& level : levels_) {
        lay_out_level(level, axes);
        level.first_cell = first_cell;
        first_cell += level.cell_count();
    }
}

void Cells::lay_out_level(Level& level, const Axes& axes) {
    level.turns = {1, 1, 1};
    level.cells = {1, 1, 1};
    if (level.is_last()) return;
    const double most = std::max(64.0, cells_per_body * level.population);
    std::array<double, 3> wanted{};
    for (std::size_t k = 0; k < 3; ++k) {
        wanted[k] = std::clamp(axes.extent[k] / level.edge[k] + 2, 1.0, whole_turn / level.edge[k]);
    }
    // Too many cells: fold the grid along its longest side.
    while (wanted[0] * wanted[1] * wanted[2] > most) *std::max_element(wanted.begin(), wanted.end()) /= 2;
    for (std::size_t k = 0; k < 3; ++k) {
        const double turns = std::max(1.0, std::floor(whole_turn / (level.edge[k] * std::ceil(wanted[k]))));
        const double cells = std::floor(whole_turn / (turns * level.edge[k]));
        if (cells < 3) continue;
        level.turns[k] = static_cast<std::uint32_t>(turns);
        level.cells[k] = static_cast<std::uint32_t>(cells);
    }
}

bool Cells::fits(const Level& level, const Ball& ball) const {
    if (level.is_last()) return true;
    const double diameter = 2 * static_cast<double>(ball.radius) * (1 + relative_margin);
    const auto fits_on = [&](std::size_t k) { return ticks_of(diameter, k) + tick_margin <= level.edge[k]; };
    return fits_on(0) && fits_on(1) && fits_on(2);
}

std::size_t Cells::level_of(const Ball& ball) const {
    std::size_t level = 0;
    while (!fits(levels_[level], ball)) ++level;
    return level;
}

std::uint32_t Cells::home_cell(const Level& level, const Ball& ball) {
    return level.cell_at(level.coordinate(0, ball.centre[0]), level.coordinate(1, ball.centre[1]),
                         level.coordinate(2, ball.centre[2]));
}

void Cells::start_sorting(std::size_t bodies) {
    const std::size_t cell_count = levels_.back().first_cell + 1;
    starts_.assign(cell_count + 1, 0);
    late_heads_.assign(cell_count, nothing);
    place_.resize(bodies);
    body_.resize(bodies + simd_padding);
    x_.resize(bodies + simd_padding);
    y_.resize(bodies + simd_padding);
    z_.resize(bodies + simd_padding);
    radius_.resize(bodies + simd_padding);
}

void Cells::place_sorted(Index body, const Ball& ball, std::uint32_t place) {
    replace(place, ball);
    body_[place] = body;
    place_[body] = place;
}

Cells::Reach Cells::reach_of(const Ball& ball) const {
    constexpr double most = 4.0e9;
    Reach reach{};
    for (std::size_t k = 0; k < 3; ++k) {
        const double ticks = ticks_of(static_cast<double>(ball.radius) * (1 + relative_margin), k) + tick_margin;
        reach[k] = static_cast<std::uint64_t>(ticks < most ? ticks : most);
    }
    return reach;
}

Cells::Span Cells::span_of(const Level& level, std::size_t axis, Tick centre, std::uint64_t reach) {
    const std::uint32_t cells = level.cells[axis];
    const std::uint64_t half = reach + level.edge[axis] / 2;
    const std::uint64_t stretched = 2 * half * level.turns[axis];
    if (stretched >= std::uint64_t{1} << 32U) return {0, cells, cells};
    const Tick start = (centre - static_cast<Tick>(half)) * level.turns[axis];
    const auto first = static_cast<std::uint32_t>((std::uint64_t{start} * cells) >> 32U);
    // start + stretched < 2^33 and cells < 2^30, so the product stays below 2^63.
    const auto last = static_cast<std::uint32_t>(((start + stretched) * cells) >> 32U);
    return {first, std::min(last - first + 1, cells), cells};
}

void Cells::find_neighbours(std::uint32_t k, BallSearch search, std::vector<Run>& runs, std::vector<Index>& found,
                            std::size_t& used) const {
    const Ball ball = sorted_ball(k);
    runs.clear();
    std::size_t balls = 0;
    const Reach reach = reach_of(ball);
    for (const Level& level : levels_) {
        if (level.population == 0) continue;
        for_each_row(level, ball, reach, [&](const Run& row) {
            const Run run{starts_[row.from], starts_[row.to]};
            if (run.from == run.to) return;
            balls += run.to - run.from;
            runs.push_back(run);
        });
    }
    // Grown by an eighth: the lists are among the largest that there is.
    if (found.size() < used + balls + simd_padding) found.resize(used + used / 8 + balls + simd_padding);
    const BallArrays arrays{x_.data(), y_.data(), z_.data(), radius_.data(), body_.data(), scale_};
    Index* const end = search(arrays, ball, body_[k], runs.data(), runs.size(), found.data() + used);
    used = static_cast<std::size_t>(end - found.data());
}

void Cells::update(Index body, const Ball& ball) {
    if (body == place_.size()) {
        place_.push_back(late_bit | add_late(body, ball));
        return;
    }
    const Ball former = ball_of(body);
    const std::size_t level = level_of(ball);
    const bool is_there = !std::isnan(former.radius);
    if (is_there && level == level_of(former) && home_cell(levels_[level], ball) == home_cell(levels_[level], former)) {
        replace(place_[body], ball);
        return;
    }
    remove(body);
    place_[body] = late_bit | add_late(body, ball);
}

/// Puts another ball where one of the same cell was.
void Cells::replace(std::uint32_t place, const Ball& ball) {
    if ((place & late_bit) != 0) {
        late_[place & ~late_bit].ball = ball;
        return;
    }
    x_[place] = ball.centre[0];
    y_[place] = ball.centre[1];
    z_[place] = ball.centre[2];
    radius_[place] = ball.radius;
}

void Cells::remove(Index body) {
    const std::uint32_t place = place_[body];
    float& radius = (place & late_bit) != 0 ? late_[place & ~late_bit].ball.radius : radius_[place];
    radius = std::numeric_limits<float>::quiet_NaN();
}

void Cells::undo(std::size_t late) {
    for (; late_.size() > late; late_.pop_back()) {
        const Late& last = late_.back();
        Level& level = levels_[level_of(last.ball)];
        --level.late;
        late_heads_[home_cell(level, last.ball)] = last.next;
    }
}

std::uint32_t Cells::add_late(Index body, const Ball& ball) {
    Level& level = levels_[level_of(ball)];
    ++level.late;
    const std::uint32_t cell = home_cell(level, ball);
    late_.push_back({ball, body, late_heads_[cell]});
    return late_heads_[cell] = static_cast<std::uint32_t>(late_.size() - 1);
}

} // namespace carom::core
