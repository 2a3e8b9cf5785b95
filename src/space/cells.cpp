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

/// Room for what lies around a ball, which varies a lot.
std::size_t roomy(std::size_t needed) { return std::max<std::size_t>(512, 2 * needed); }

/// More than the roundings of ticks and of the test whether balls meet.
constexpr double tick_margin = 3;
constexpr double relative_margin = 1e-5;

} // namespace

void Cells::start_levels(const Axes& axes) {
    for (std::size_t k = 0; k < 3; ++k) {
        scale_[k] = static_cast<float>(axes.metres_per_tick[k]);
        ticks_per_metre_[k] = 1 / static_cast<double>(scale_[k]);
    }
    histogram_.assign(bin_count, 0);
    levels_.clear();
    clear_for_bursts(late_);
}

void Cells::count_diameter(const Ball& ball) { ++histogram_[length_bin(std::abs(2 * ball.radius))]; }

double Cells::first_edge(std::size_t bodies) const {
    const auto quantile = [&](double part) {
        auto left = static_cast<double>(bodies) * part;
        std::uint32_t bin = 0;
        while (bin + 1 < histogram_.size() && left > histogram_[bin]) left -= histogram_[bin++];
        return bin_end(bin);
    };
    // One size: the first level takes nearly all, in cells with some to spare: fewer of them, each with more balls that
    // look around together. Many sizes: start low, the others find their own level.
    constexpr double one_size = 4;
    constexpr double spare = 1.4;
    const double most = quantile(0.98);
    return most <= one_size * quantile(0.05) ? spare * most : quantile(0.25);
}

void Cells::choose_levels(std::size_t bodies) {
    std::size_t sampled = 0;
    for (const std::uint32_t count : histogram_) sampled += count;
    // The edge: of the smallest diameters it takes for granted that they are more than nothing.
    double edge =
        std::max(first_edge(sampled), 8 * static_cast<double>(*std::max_element(scale_.begin(), scale_.end())));
    for (; bodies > 0; edge *= 4) {
        Level level;
        const auto ticks = [&](std::size_t k) {
            return edge * ticks_per_metre_[k] * (1 + relative_margin) + 2 * tick_margin;
        };
        if (!(std::max({ticks(0), ticks(1), ticks(2)}) < whole_turn / 4)) break;
        for (std::size_t k = 0; k < 3; ++k) level.edge[k] = static_cast<Tick>(ticks(k));
        level.largest_radius = largest_radius(level);
        levels_.push_back(level);
    }
    levels_.push_back({.edge = {0xffffffffU, 0xffffffffU, 0xffffffffU}});
}

void Cells::lay_out_levels(const Axes& axes, std::size_t bodies) {
    // Also for balls that come later.
    const double least = std::max(64.0, static_cast<double>(bodies) / 32);
    std::uint32_t first_cell = 0;
    for (Level& level : levels_) {
        lay_out_level(level, axes, std::max(least, cells_per_body * level.population));
        level.population = 0;
        level.first_cell = first_cell;
        first_cell += level.cell_count();
    }
}

void Cells::lay_out_level(Level& level, const Axes& axes, double most_cells) {
    level.turns = {1, 1, 1};
    level.cells = {1, 1, 1};
    if (level.is_last()) return;
    std::array<double, 3> wanted{};
    for (std::size_t k = 0; k < 3; ++k) {
        wanted[k] = std::clamp(axes.extent[k] / level.edge[k] + 2, 1.0, whole_turn / level.edge[k]);
    }
    // Too many cells: fold the grid along its longest side.
    while (wanted[0] * wanted[1] * wanted[2] > most_cells) *std::max_element(wanted.begin(), wanted.end()) /= 2;
    for (std::size_t k = 0; k < 3; ++k) {
        const double turns = std::max(1.0, std::floor(whole_turn / (level.edge[k] * std::ceil(wanted[k]))));
        const double cells = std::floor(whole_turn / (turns * level.edge[k]));
        if (cells < 3) continue;
        level.turns[k] = static_cast<std::uint32_t>(turns);
        level.cells[k] = static_cast<std::uint32_t>(cells);
    }
}

float Cells::largest_radius(const Level& level) const {
    const auto longest = [&](std::size_t k) {
        return (level.edge[k] - tick_margin) * static_cast<double>(scale_[k]) / (1 + 2 * relative_margin);
    };
    return static_cast<float>(std::min({longest(0), longest(1), longest(2)}) / 2);
}

std::uint32_t Cells::home_cell(const Level& level, const Ball& ball) {
    return level.cell_at(level.coordinate(0, ball.centre[0]), level.coordinate(1, ball.centre[1]),
                         level.coordinate(2, ball.centre[2]));
}

void Cells::start_sorting(std::size_t bodies) {
    const std::size_t cell_count = levels_.back().first_cell + 1;
    starts_.assign(cell_count + 1, 0);
    late_heads_.assign(late_group(static_cast<std::uint32_t>(cell_count)) + 1, nothing);
    place_.resize(bodies);
    body_.resize(bodies + simd_padding);
    x_.resize(bodies + simd_padding);
    y_.resize(bodies + simd_padding);
    z_.resize(bodies + simd_padding);
    radius_.resize(bodies + simd_padding);
}

/// From the cell of each body to its place among the sorted ones: cell by cell, and in one by their indices.
void Cells::sort_places(std::size_t bodies) {
    for (std::size_t i = 0; i < bodies; ++i) ++starts_[place_[i] + 1];
    for (std::size_t c = 1; c < starts_.size(); ++c) starts_[c] += starts_[c - 1];
    for (Level& level : levels_) {
        level.population = starts_[level.first_cell + level.cell_count()] - starts_[level.first_cell];
    }
    for (std::size_t i = 0; i < bodies; ++i) place_[i] = starts_[place_[i]]++;
    for (std::size_t c = starts_.size() - 1; c > 0; --c) starts_[c] = starts_[c - 1];
    starts_[0] = 0;
}

Cells::Reach Cells::reach_of(const Ball& ball) const {
    constexpr double most = 4.0e9;
    const double radius = static_cast<double>(ball.radius) * (1 + relative_margin);
    Reach reach{};
    for (std::size_t k = 0; k < 3; ++k) {
        const double ticks = radius * ticks_per_metre_[k] + tick_margin;
        // Also where it is not a number.
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

std::span<Index> Cells::take_tiled_order() {
    constexpr std::uint32_t tile = 8;
    auto end = place_.begin();
    const auto take_tile = [&](const Level& level, std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        for (std::uint32_t k = z; k < std::min(z + tile, level.cells[2]); ++k) {
            for (std::uint32_t j = y; j < std::min(y + tile, level.cells[1]); ++j) {
                const std::uint32_t row = level.cell_at(0, j, k);
                const auto from = body_.begin() + starts_[row + x];
                const auto to = body_.begin() + starts_[row + std::min(x + tile, level.cells[0])];
                end = std::copy(from, to, end);
            }
        }
    };
    for (const Level& level : levels_) {
        for (std::uint32_t z = 0; z < level.cells[2]; z += tile) {
            for (std::uint32_t y = 0; y < level.cells[1]; y += tile) {
                for (std::uint32_t x = 0; x < level.cells[0]; x += tile) take_tile(level, x, y, z);
            }
        }
    }
    return place_;
}

void Cells::find_neighbours(std::uint32_t k, BallSearcher& searcher, std::vector<Index>& found,
                            std::size_t& used) const {
    if (k < searcher.cell_.from || k >= searcher.cell_.to) look_around(k, searcher);
    const Ball ball = sorted_ball(k);
    BallSearcher::View& apart = searcher.apart_;
    apart.size = 0;
    if (!searcher.other_levels_.empty()) {
        searcher.runs_.clear();
        const Region region{ball.centre, reach_of(ball)};
        for (const std::uint32_t level : searcher.other_levels_) take_rows(levels_[level], region, searcher.runs_);
        view(searcher, apart, ball.centre);
    }
    // Grown by an eighth, where resize() alone would double: the lists are among the largest that there is.
    BallSearcher::View& around = searcher.around_;
    const std::size_t needed = used + around.size + apart.size + simd_padding;
    if (found.size() < needed) {
        found.reserve(needed + used / 8);
        found.resize(needed + used / 8);
    }
    const SeenBall seen{tick_distance(around.origin[0], ball.centre[0], scale_[0]),
                        tick_distance(around.origin[1], ball.centre[1], scale_[1]),
                        tick_distance(around.origin[2], ball.centre[2], scale_[2]), ball.radius + searcher.margin_,
                        body_[k]};
    Index* end = searcher.search_(around.arrays(), around.size, seen, found.data() + used);
    if (apart.size > 0) end = searcher.search_(apart.arrays(), apart.size, {0, 0, 0, ball.radius, body_[k]}, end);
    used = static_cast<std::size_t>(end - found.data());
}

/// Collects what the balls of the cell of the k-th ball may meet.
void Cells::look_around(std::uint32_t k, BallSearcher& searcher) const {
    const Ball ball = sorted_ball(k);
    const std::size_t own = level_of(ball);
    const Level& level = levels_[own];
    const std::uint32_t cell = home_cell(level, ball);
    searcher.cell_ = {starts_[cell], starts_[cell + 1]};
    Region region = region_of(searcher.cell_, ball.centre);
    // In a grid that repeats, balls of one cell may be far apart, and each is a cell of its own then. No two that are
    // seen from the origin, at most a quarter of the torus away, may meet round its other side: the balls of all levels
    // but the last are no wider than a quarter either.
    constexpr std::uint64_t eighth = 1U << 29U;
    const auto is_wide = [&](std::size_t axis) {
        return region.reach[axis] > std::min(eighth, 2 * std::uint64_t{level.edge[axis]});
    };
    const bool is_alone = is_wide(0) || is_wide(1) || is_wide(2);
    if (is_alone) {
        searcher.cell_ = {k, k + 1};
        region = {ball.centre, reach_of(ball)};
    }
    searcher.runs_.clear();
    searcher.other_levels_.clear();
    for (std::uint32_t other = 0; other < levels_.size(); ++other) {
        if (levels_[other].population == 0) continue;
        if (other < own || (levels_[other].is_last() && !is_alone)) {
            // Finer cells around all balls of the cell are too many to be looked at for each; the balls of the last
            // level reach round the torus.
            searcher.other_levels_.push_back(other);
        } else {
            take_rows(levels_[other], region, searcher.runs_);
        }
    }
    view(searcher, searcher.around_, ball.centre);
    // Of places up to five edges from the origin, each rounded twice along each axis.
    constexpr float roundings = 5 * 2 * 2 * 1.8F * 0x1p-24F;
    const auto edge = [&](std::size_t axis) { return static_cast<float>(level.edge[axis]) * scale_[axis]; };
    searcher.margin_ = roundings * std::max({edge(0), edge(1), edge(2)});
}

void Cells::take_rows(const Level& level, const Region& region, std::vector<Run>& runs) const {
    for_each_row(level, region.centre, region.reach, [&](const Run& row) {
        const Run run{starts_[row.from], starts_[row.to]};
        if (run.from < run.to) runs.push_back(run);
    });
}

/// What the balls of a run take up, of which one is at `centre`. They may lie in any turn of the grid.
Cells::Region Cells::region_of(const Run& balls, const std::array<Tick, 3>& centre) const {
    std::array<std::int64_t, 3> low{};
    std::array<std::int64_t, 3> high{};
    for (std::uint32_t k = balls.from; k < balls.to; ++k) {
        const Ball ball = sorted_ball(k);
        const Reach reach = reach_of(ball);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const auto place = std::int64_t{static_cast<std::int32_t>(ball.centre[axis] - centre[axis])};
            low[axis] = std::min(low[axis], place - static_cast<std::int64_t>(reach[axis]));
            high[axis] = std::max(high[axis], place + static_cast<std::int64_t>(reach[axis]));
        }
    }
    Region region;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        region.centre[axis] = centre[axis] + static_cast<Tick>((low[axis] + high[axis]) / 2);
        region.reach[axis] = static_cast<std::uint64_t>((high[axis] - low[axis]) / 2 + 1);
    }
    return region;
}

/// The balls of the runs of the searcher.
void Cells::view(BallSearcher& searcher, BallSearcher::View& view, const std::array<Tick, 3>& origin) const {
    view.origin = origin;
    view.size = 0;
    for (const Run& run : searcher.runs_) view.size += run.to - run.from;
    view.reserve(view.size);
    searcher.packing_(sorted_balls(), origin, searcher.runs_.data(), searcher.runs_.size(), view.arrays());
}

void BallSearcher::View::reserve(std::size_t balls) {
    const std::size_t needed = balls + simd_padding;
    if (x.size() >= needed) return;
    const std::size_t room = roomy(needed);
    x.resize(room);
    y.resize(room);
    z.resize(room);
    radius.resize(room);
    body.resize(room);
}

void BallSearcher::get_ready() { apart_.reserve(1); }

void Cells::find_meeting(const Ball& ball, Index self, BallSearcher& searcher, std::vector<Index>& found) const {
    std::vector<Run>& runs = searcher.runs_;
    runs.clear();
    const Reach reach = reach_of(ball);
    for (const Level& level : levels_) {
        if (level.population + level.late == 0) continue;
        for_each_row(level, ball.centre, reach, [&](const Run& row) {
            prefetch(starts_.data() + row.from);
            prefetch(late_heads_.data() + late_group(row.from));
            runs.push_back(row);
        });
    }
    const auto add_late = [&](Index body) {
        if (body != self) found.push_back(body);
    };
    found.clear();
    for (Run& run : runs) {
        scan_late(run, ball, add_late);
        run = {starts_[run.from], starts_[run.to]};
        prefetch_sorted(run.from);
    }
    BallSearcher::View& apart = searcher.apart_;
    view(searcher, apart, ball.centre);
    const std::size_t late = found.size();
    const std::size_t needed = late + apart.size + simd_padding;
    if (found.capacity() < needed) found.reserve(roomy(needed));
    found.resize(needed);
    Index* const end = searcher.search_(apart.arrays(), apart.size, {0, 0, 0, ball.radius, self}, found.data() + late);
    found.resize(static_cast<std::size_t>(end - found.data()));
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
        late_heads_[late_group(home_cell(level, last.ball))] = last.next;
    }
}

std::uint32_t Cells::add_late(Index body, const Ball& ball) {
    Level& level = levels_[level_of(ball)];
    ++level.late;
    std::uint32_t& head = late_heads_[late_group(home_cell(level, ball))];
    late_.push_back({ball, body, head});
    return head = static_cast<std::uint32_t>(late_.size() - 1);
}

} // namespace carom::core
