#include "scene/overlap_search.hpp"

#include "collision/component.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <utility>
#include <variant>

namespace carom::scene {

namespace {

/// A cell is this many largest radii wide: then the partners of most bodies lie in one or two cells along each axis.
constexpr double radii_per_cell = 4;

using detail::component;

/// Which level a radius belongs to; points have one of their own. Radii of a level differ by less than a factor of 4:
/// fewer levels to look through, against fewer bodies to a cell.
int level_of(double radius) { return radius > 0 ? std::ilogb(radius) >> 1 : std::numeric_limits<int>::min(); }

double largest_coordinate(std::span<const Vec3> positions) {
    double largest = 0;
    for (const Vec3& p : positions) largest = std::max({largest, std::abs(p.x), std::abs(p.y), std::abs(p.z)});
    return largest;
}

/// The largest integer not above x. (std::floor is a call on processors of the x86-64 baseline, and costs more.)
std::int64_t floor_of(double x) {
    const auto truncated = static_cast<std::int64_t>(x);
    return truncated - static_cast<std::int64_t>(static_cast<double>(truncated) > x);
}

std::array<std::int64_t, 3> cell_of(const Vec3& position, double cells_per_metre) {
    return {floor_of(position.x * cells_per_metre), floor_of(position.y * cells_per_metre),
            floor_of(position.z * cells_per_metre)};
}

/// Cells of a row along x have buckets side by side, and rows are scattered: any shape of world fills the table evenly.
std::uint64_t row_of(std::int64_t y, std::int64_t z) {
    std::uint64_t row = static_cast<std::uint64_t>(y) * 0x9e3779b97f4a7c15U;
    row ^= static_cast<std::uint64_t>(z) * 0xc2b2ae3d27d4eb4fU;
    row ^= row >> 29U;
    row *= 0xbf58476d1ce4e5b9U;
    return row >> 20U;
}

/// The overlap in diameters of two radii, of which one is not 0.
double in_diameters(double overlap, double radius_a, double radius_b) {
    const double smaller = std::min(radius_a, radius_b);
    return overlap / (2 * (smaller > 0 ? smaller : std::max(radius_a, radius_b)));
}

} // namespace

void OverlapSearch::Sum::add(double overlap) {
    largest = std::max(largest, overlap);
    total += overlap;
    ++touching;
}

OverlapSearch::OverlapSearch(const Region& region, std::span<const double> radii, std::span<const double> masses)
    : radii_(radii.begin(), radii.end()) {
    take_region(region);
    is_static_.reserve(masses.size());
    for (const double mass : masses) is_static_.push_back(static_cast<std::uint8_t>(mass == infinite_mass));
    make_levels();
}

OverlapSearch::OverlapSearch(const World& world) : ids_(world.ids()), positions_(world.size()) {
    take_region(world.region());
    radii_.resize(ids_.size());
    std::vector<double> masses(ids_.size());
    world.get(ids_, {.mass = masses, .radius = radii_});
    is_static_.reserve(masses.size());
    for (const double mass : masses) is_static_.push_back(static_cast<std::uint8_t>(mass == infinite_mass));
    make_levels();
}

void OverlapSearch::take_region(const Region& region) {
    walls_.clear();
    if (const auto* box = std::get_if<Box>(&region)) take_box(*box);
    if (const auto* shell = std::get_if<Shell>(&region)) shell_ = *shell;
    if (const auto* planes = std::get_if<std::vector<Plane>>(&region)) {
        for (const Plane& plane : *planes) walls_.push_back({plane.point, plane.normal / length(plane.normal)});
    }
}

void OverlapSearch::take_box(const Box& box) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double min = component(box.min, axis);
        const double max = component(box.max, axis);
        axes_.at(axis) = {box.faces.at(2 * axis).kind == FaceKind::periodic, min, max - min};
        Vec3 inward{};
        component(inward, axis) = 1;
        if (box.faces.at(2 * axis).kind == FaceKind::reflecting) walls_.push_back({box.min, inward});
        if (box.faces.at(2 * axis + 1).kind == FaceKind::reflecting) walls_.push_back({box.max, -inward});
    }
}

void OverlapSearch::make_levels() {
    std::map<int, Level> levels;
    for (std::uint32_t body = 0; body < radii_.size(); ++body) {
        Level& level = levels[level_of(radii_[body])];
        level.bodies.push_back(body);
        level.largest_radius = std::max(level.largest_radius, radii_[body]);
    }
    for (auto& [key, level] : levels) levels_.push_back(std::move(level));
}

OverlapReport OverlapSearch::find(const World& world) {
    take_region(world.region());
    std::vector<double> radii(ids_.size());
    world.get(ids_, {.position = positions_, .radius = radii});
    if (radii != radii_) {
        radii_ = std::move(radii);
        levels_.clear();
        make_levels();
    }
    return find(positions_);
}

OverlapReport OverlapSearch::find(std::span<const Vec3> positions) {
    const double extent = largest_coordinate(positions);
    for (Level& level : levels_) sort_into_cells(level, positions, extent);
    Sum sum;
    for (std::size_t level = 0; level < levels_.size(); ++level) find_pairs(level, extent, sum);

    OverlapReport report;
    for (std::size_t body = 0; body < radii_.size(); ++body) {
        if (is_static_[body] == 0 && find_walls(positions[body], radii_[body], sum)) ++report.bodies_outside;
    }
    report.largest = sum.largest;
    report.touching = sum.touching;
    report.mean = sum.touching > 0 ? sum.total / static_cast<double>(sum.touching) : 0;
    return report;
}

void OverlapSearch::sort_into_cells(Level& level, std::span<const Vec3> positions, double extent) {
    // Tiny bodies in a huge world: cells no smaller than what numbers them within 2^40.
    const double cell_size = std::max(radii_per_cell * level.largest_radius, std::max(extent, 1e-300) * 0x1p-40);
    level.cells_per_metre = 1 / cell_size;
    level.mask = std::bit_ceil(level.bodies.size()) - 1;
    level.bucket_starts.assign(level.mask + 2, 0);
    level.members.resize(level.bodies.size());
    unsorted_.resize(level.bodies.size());

    std::vector<std::uint32_t>& starts = level.bucket_starts;
    for (std::size_t i = 0; i < level.bodies.size(); ++i) {
        const std::uint32_t body = level.bodies[i];
        const Vec3 position = wrapped(positions[body]);
        const auto [x, y, z] = cell_of(position, level.cells_per_metre);
        const auto bucket = static_cast<std::uint32_t>((row_of(y, z) + static_cast<std::uint64_t>(x)) & level.mask);
        unsorted_[i] = {{position, radii_[body], is_static_[body] != 0}, bucket};
        ++starts[bucket];
    }
    std::uint32_t end = 0;
    for (std::uint32_t& start : starts) start = end += start;
    // Each start is now the end of its bucket; filling from behind brings it to where it belongs.
    for (const auto& [member, bucket] : unsorted_) level.members[--starts[bucket]] = member;
}

Vec3 OverlapSearch::wrapped(Vec3 position) const {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const Axis& a = axes_.at(axis);
        if (!a.periodic) continue;
        double& x = component(position, axis);
        x -= a.length * std::floor((x - a.min) / a.length);
    }
    return position;
}

void OverlapSearch::find_pairs(std::size_t level_index, double extent, Sum& sum) const {
    const std::vector<Member>& members = levels_[level_index].members;
    for (std::size_t i = 0; i < members.size(); ++i) {
        for (std::size_t other = level_index; other < levels_.size(); ++other) {
            const Level& level = levels_[other];
            // A little wider than exact, so that no rounding of a cell's edge hides a pair.
            const double reach = (members[i].radius + level.largest_radius) * (1 + 1e-9) + extent * 1e-15;
            // Within a level both bodies of a pair look for each other: the one behind in memory is the one found.
            const auto first = static_cast<std::uint32_t>(other == level_index ? i + 1 : 0);
            find_around_images({members[i], level, first, reach}, members[i].position, 0, sum);
        }
    }
}

void OverlapSearch::find_around_images(const Seeker& seeker, Vec3 image, std::size_t axis, Sum& sum) const {
    if (axis == axes_.size()) return find_around(seeker, image, sum);
    find_around_images(seeker, image, axis + 1, sum);
    const Axis& a = axes_.at(axis);
    if (!a.periodic) return;
    const double x = component(image, axis);
    for (const double shift : {a.length, -a.length}) {
        const bool reaches = shift > 0 ? x - seeker.reach < a.min : x + seeker.reach > a.min + a.length;
        if (!reaches) continue;
        component(image, axis) = x + shift;
        find_around_images(seeker, image, axis + 1, sum);
    }
}

void OverlapSearch::find_around(const Seeker& seeker, const Vec3& image, Sum& sum) {
    const Level& level = seeker.level;
    const Vec3 reach{seeker.reach, seeker.reach, seeker.reach};
    const Cell low = cell_of(image - reach, level.cells_per_metre);
    const Cell high = cell_of(image + reach, level.cells_per_metre);
    for (std::int64_t z = low[2]; z <= high[2]; ++z) {
        for (std::int64_t y = low[1]; y <= high[1]; ++y) {
            const std::uint64_t row = row_of(y, z);
            for (std::int64_t x = low[0]; x <= high[0]; ++x) {
                const std::uint64_t bucket = (row + static_cast<std::uint64_t>(x)) & level.mask;
                const std::uint32_t begin = std::max(level.bucket_starts[bucket], seeker.first);
                const std::uint32_t end = level.bucket_starts[bucket + 1];
                for (std::uint32_t i = begin; i < end; ++i) look_at(seeker, image, level.members[i], {x, y, z}, sum);
            }
        }
    }
}

void OverlapSearch::look_at(const Seeker& seeker, const Vec3& image, const Member& b, const Cell& cell, Sum& sum) {
    const Member& a = seeker.member;
    const double contact = a.radius + b.radius;
    const double square = length_squared(b.position - image);
    if (square > contact * contact || contact == 0 || (a.is_static && b.is_static)) return;
    // Cells that share a bucket: what is from another one is found there.
    if (cell_of(b.position, seeker.level.cells_per_metre) != cell) return;
    sum.add(in_diameters(contact - std::sqrt(square), a.radius, b.radius));
}

bool OverlapSearch::find_walls(const Vec3& position, double radius, Sum& sum) const {
    bool outside = false;
    const auto look_at = [&](double distance) {
        outside = outside || distance < 0;
        if (distance <= radius && radius > 0) sum.add(in_diameters(radius - distance, radius, radius));
    };
    for (const Wall& wall : walls_) look_at(dot(position - wall.point, wall.normal));
    if (shell_) look_at(shell_->radius - length(position - shell_->centre));
    return outside;
}

} // namespace carom::scene
