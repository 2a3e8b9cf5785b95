#include "space/cells.hpp"

#include <algorithm>
#include <bit>

namespace carom::core {

namespace {

/// Eighth-octave bins of a length: sorts like the logarithm, without computing one.
constexpr std::uint32_t bin_shift = 20;
constexpr std::size_t bin_count = 1U << (31 - bin_shift);
std::uint32_t length_bin(double metres) {
    return std::bit_cast<std::uint32_t>(static_cast<float>(metres)) >> bin_shift;
}

/// A length that no member of the bin exceeds.
double bin_end(std::uint32_t bin) { return static_cast<double>(std::bit_cast<float>((bin + 1) << bin_shift)); }

/// The longest side, m.
double longest(const SweptBox& box, const Cells::Axes& axes) {
    const auto side = [&](std::size_t k) { return static_cast<double>(box.length[k]) * axes.metres_per_tick[k]; };
    return std::max({side(0), side(1), side(2)});
}

/// Cells per body that a grid may have at most: empty cells cost little time but memory.
constexpr double cells_per_body = 4;

} // namespace

bool SweptBox::holds(const SweptBox& inner) const {
    for (std::size_t k = 0; k < 3; ++k) {
        const std::uint64_t offset = inner.lo[k] - lo[k];
        if (length[k] != 0xffffffffU && offset + inner.length[k] > length[k]) return false;
    }
    return true;
}

Cells::Span Cells::span_of(const Level& level, std::size_t axis, Tick lo, std::uint64_t length) {
    const std::uint32_t cells = level.cells[axis];
    const Tick start = lo * level.turns[axis];
    const std::uint64_t stretched = length * level.turns[axis];
    if (stretched >= (std::uint64_t{1} << 32U)) return {0, cells, cells};
    const auto first = static_cast<std::uint32_t>((std::uint64_t{start} * cells) >> 32U);
    // start + stretched < 2^33 and cells < 2^30, so the product stays below 2^63.
    const auto last = static_cast<std::uint32_t>(((start + stretched) * cells) >> 32U);
    return {first, std::min(last - first + 1, cells), cells};
}

std::array<Cells::Span, 3> Cells::reach_of(const Level& level, const SweptBox& box) {
    const auto span = [&](std::size_t k) {
        const Tick half = level.edge[k] / 2 + 1;
        return span_of(level, k, box.lo[k] - half, std::uint64_t{box.length[k]} + 2 * std::uint64_t{half});
    };
    return {span(0), span(1), span(2)};
}

void Cells::build(std::vector<SweptBox>& boxes, const Axes& axes) {
    choose_levels(boxes, axes);
    sort_into_cells(boxes);
    late_.clear();
}

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

void Cells::choose_levels(std::vector<SweptBox>& boxes, const Axes& axes) {
    // A sample is enough: levels decide about speed only.
    constexpr std::size_t sample = 8;
    histogram_.assign(bin_count, 0);
    for (std::size_t i = 0; i < boxes.size(); i += sample) ++histogram_[length_bin(longest(boxes[i], axes))];
    levels_.clear();
    for (double edge = first_edge((boxes.size() + sample - 1) / sample);; edge *= 2) {
        Level level;
        const auto ticks = [&](std::size_t k) { return edge / axes.metres_per_tick[k] + 2; };
        if (boxes.empty() || std::max({ticks(0), ticks(1), ticks(2)}) >= whole_turn / 4) break;
        for (std::size_t k = 0; k < 3; ++k) level.edge[k] = static_cast<Tick>(ticks(k));
        levels_.push_back(level);
    }
    levels_.push_back({.edge = {0xffffffffU, 0xffffffffU, 0xffffffffU}});
    for (SweptBox& box : boxes) {
        const std::size_t level = level_of(box);
        box.set_cell(static_cast<std::uint32_t>(level));
        ++levels_[level].population;
    }
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

bool Cells::fits(const Level& level, const SweptBox& box) {
    const auto fits_on = [&](std::size_t k) { return std::uint64_t{box.length[k]} + 2 <= level.edge[k]; };
    return level.is_last() || (fits_on(0) && fits_on(1) && fits_on(2));
}

std::size_t Cells::level_of(const SweptBox& box) const {
    std::size_t level = 0;
    while (!fits(levels_[level], box)) ++level;
    return level;
}

std::uint32_t Cells::home_cell(const Level& level, const SweptBox& box) {
    const auto coordinate = [&](std::size_t k) { return level.coordinate(k, box.lo[k] + box.length[k] / 2); };
    return level.cell_at(coordinate(0), coordinate(1), coordinate(2));
}

void Cells::sort_into_cells(std::vector<SweptBox>& boxes) {
    const std::size_t cell_count = levels_.back().first_cell + 1;
    cells_.assign(cell_count + 1, Cell{});
    for (SweptBox& box : boxes) {
        // Until now the tag named the level only.
        box.set_cell(home_cell(levels_[box.cell()], box));
        ++cells_[box.cell() + 1].start;
    }
    for (std::size_t c = 0; c < cell_count; ++c) cells_[c + 1].start += cells_[c].start;
    sorted_.resize(boxes.size());
    place_.resize(boxes.size());
    for (Index i = 0; i < boxes.size(); ++i) {
        const std::uint32_t place = cells_[boxes[i].cell()].start++;
        boxes[i].set_body(i);
        sorted_[place] = boxes[i];
        place_[i] = place;
    }
    for (std::size_t c = cell_count; c > 0; --c) cells_[c].start = cells_[c - 1].start;
    cells_[0].start = 0;
}

bool Cells::stays_findable(const Level& level, std::uint32_t cell, const SweptBox& box) {
    if (level.is_last()) return true;
    if (!fits(level, box)) return false;
    // Whoever meets the box at a point p visits all cells within half an edge of p: the cell must be among those for
    // every p of the box.
    const auto inside = [&](std::size_t k, std::uint32_t coordinate) {
        const Tick half = level.edge[k] / 2;
        const Tick start = box.lo[k] + box.length[k] - half;
        return span_of(level, k, start, 2 * half - box.length[k]).contains(coordinate);
    };
    const std::uint32_t local = cell - level.first_cell;
    const std::uint32_t row = local / level.cells[0];
    return inside(0, local % level.cells[0]) && inside(1, row % level.cells[1]) && inside(2, row / level.cells[1]);
}

void Cells::update(Index body, const SweptBox& box) {
    if (body == place_.size()) place_.push_back(nothing);
    if (place_[body] != nothing) {
        const std::uint32_t place = place_[body];
        SweptBox& former = (place & late_bit) != 0 ? late_[place & ~late_bit].box : sorted_[place];
        const auto level = std::find_if(levels_.begin(), levels_.end(),
                                        [&](const Level& l) { return former.cell() < l.first_cell + l.cell_count(); });
        if (stays_findable(*level, former.cell(), box)) {
            const std::uint32_t cell = former.cell();
            former = box;
            former.set_body(body);
            former.set_cell(cell);
            return;
        }
        former.set_outdated();
    }
    place_[body] = late_bit | add_late(body, box);
}

void Cells::add(Index body, const SweptBox& box) { add_late(body, box); }

std::uint32_t Cells::add_late(Index body, const SweptBox& box) {
    Level& level = levels_[level_of(box)];
    ++level.late;
    const std::uint32_t cell = home_cell(level, box);
    late_.push_back({box, cells_[cell].late});
    late_.back().box.set_body(body);
    late_.back().box.set_cell(cell);
    return cells_[cell].late = static_cast<std::uint32_t>(late_.size() - 1);
}

void Cells::find_pairs(PairList& pairs) const {
    for (std::size_t coarse = 0; coarse < levels_.size(); ++coarse) {
        if (levels_[coarse].population == 0) continue;
        pairs_inside(levels_[coarse], pairs);
        for (std::size_t fine = 0; fine < coarse; ++fine) {
            if (levels_[fine].population > 0) pairs_across(levels_[fine], levels_[coarse], pairs);
        }
    }
}

std::size_t Cells::rows_after(const Level& level, std::uint32_t y, std::uint32_t z,
                              std::array<std::uint32_t, 4>& rows) {
    constexpr std::array<std::array<std::int32_t, 2>, 4> steps{{{1, 0}, {-1, 1}, {0, 1}, {1, 1}}};
    const auto neighbour = [](std::uint32_t c, std::int32_t step, std::uint32_t n) {
        if (step > 0) return c + 1 == n ? 0 : c + 1;
        if (step < 0) return c == 0 ? n - 1 : c - 1;
        return c;
    };
    const auto [nx, ny, nz] = level.cells;
    std::size_t count = 0;
    for (const auto& [dy, dz] : steps) {
        if ((dy != 0 && ny == 1) || (dz != 0 && nz == 1)) continue;
        rows[count++] = level.cell_at(0, neighbour(y, dy, ny), neighbour(z, dz, nz));
    }
    return count;
}

Cells::Runs Cells::runs_after(std::uint32_t row, std::uint32_t x, std::uint32_t nx,
                              std::span<const std::uint32_t> rows) const {
    const std::uint32_t low = x == 0 ? 0 : x - 1;
    const std::uint32_t high = x + 1 == nx ? nx : x + 2;
    Runs runs;
    runs.add(cells_[row + x + 1].start, cells_[row + high].start);
    for (const std::uint32_t other : rows) runs.add(cells_[other + low].start, cells_[other + high].start);
    if (nx == 1 || (x != 0 && x + 1 != nx)) return runs;
    // The ends of a row are neighbours too.
    const std::uint32_t across = x == 0 ? nx - 1 : 0;
    if (x != 0) runs.add(cells_[row].start, cells_[row + 1].start);
    for (const std::uint32_t other : rows) runs.add(cells_[other + across].start, cells_[other + across + 1].start);
    return runs;
}

void Cells::pairs_of_cell(Run cell, const Runs& others, PairList& pairs) const {
    const std::size_t inside = cell.to - cell.from;
    Pair* out = pairs.room(inside * (inside + others.boxes));
    const SweptBox* const boxes = sorted_.data();
    for (std::uint32_t i = cell.from; i < cell.to; ++i) {
        const MeetingTest meets(boxes[i]);
        // Nothing is outdated yet: the tags are the bodies.
        const Index body = boxes[i].lo[SweptBox::tag];
        const auto scan = [&](std::uint32_t from, std::uint32_t to) {
            for (std::uint32_t j = from; j < to; ++j) {
                *out = {body, boxes[j].lo[SweptBox::tag]};
                out += meets(boxes[j]) ? 1 : 0;
            }
        };
        scan(i + 1, cell.to);
        for (std::size_t k = 0; k < others.count; ++k) scan(others.runs[k].from, others.runs[k].to);
    }
    pairs.take(out);
}

void Cells::pairs_inside(const Level& level, PairList& pairs) const {
    const auto [nx, ny, nz] = level.cells;
    std::array<std::uint32_t, 4> others{};
    for (std::uint32_t z = 0; z < nz; ++z) {
        for (std::uint32_t y = 0; y < ny; ++y) {
            const std::uint32_t row = level.cell_at(0, y, z);
            if (cells_[row].start == cells_[row + nx].start) continue;
            const std::size_t other_count = rows_after(level, y, z, others);
            for (std::uint32_t x = 0; x < nx; ++x) {
                const Run cell{cells_[row + x].start, cells_[row + x + 1].start};
                if (cell.from == cell.to) continue;
                pairs_of_cell(cell, runs_after(row, x, nx, {others.data(), other_count}), pairs);
            }
        }
    }
}

void Cells::pairs_across(const Level& fine, const Level& coarse, PairList& pairs) const {
    // Either side can look the other up; take the one that visits fewer rows of cells.
    const double ratio = static_cast<double>(coarse.edge[0]) / static_cast<double>(fine.edge[0]);
    const double fine_rows = std::min((ratio + 2) * (ratio + 2), 1.0 * fine.cells[1] * fine.cells[2]);
    const double coarse_rows = std::min(6.0, 1.0 * coarse.cells[1] * coarse.cells[2]);
    const bool from_coarse = coarse.population * fine_rows < fine.population * coarse_rows;
    const Level& asking = from_coarse ? coarse : fine;
    const Level& asked = from_coarse ? fine : coarse;
    const auto [begin, end] = sorted_range(asking);
    for (std::uint32_t k = begin; k < end; ++k) {
        const SweptBox& box = sorted_[k];
        for_each_in(asked, box, [&](Index other) {
            Pair* const out = pairs.room(1);
            *out = {box.body(), other};
            pairs.take(out + 1);
        });
    }
}

void Cells::spatial_order(std::vector<Index>& order) const {
    order.resize(sorted_.size());
    std::transform(sorted_.begin(), sorted_.end(), order.begin(), [](const SweptBox& box) { return box.body(); });
}

} // namespace carom::core
