#include "scene/occupancy.hpp"

#include <algorithm>
#include <cmath>

namespace carom::scene {

namespace {

constexpr std::uint32_t no_entry = 0xffffffffU;

bool apart(const Vec3& a, const Vec3& b, double distance) { return length_squared(a - b) >= distance * distance; }

/// Levels are numbered by the binary exponent of the radius, three to a level. Below 2^-42 m there is one level.
int level_number(double radius) {
    constexpr int lowest = -42;
    const int exponent = radius == 0 ? lowest : std::max(std::ilogb(radius), lowest);
    return (exponent - lowest) / 3 + lowest / 3;
}

/// m: at least twice the largest diameter of the level, so that a body of its size looks into few cells.
double level_cell_size(int number) { return std::ldexp(1.0, 3 * number + 5); }

/// Cells beyond 2^60 count as one: slow there, but never wrong, because every candidate's distance is looked at.
std::int64_t cell_index(double coordinate, double cell_size) {
    constexpr double limit = 0x1p60;
    return static_cast<std::int64_t>(std::clamp(std::floor(coordinate / cell_size), -limit, limit));
}

/// Along one axis: where else a body at `x` has to be looked for.
std::array<double, 3> images(double x, double min, double length, double reach) {
    if (length == 0) return {0, 0, 0};
    return {0, x - min < reach ? length : 0, min + length - x < reach ? -length : 0};
}

} // namespace

void Occupancy::add(const Vec3& position, double radius) {
    const int number = level_number(radius);
    levels_.try_emplace(number, level_cell_size(number)).first->second.add(position, radius);
    largest_radius_ = std::max(largest_radius_, radius);
}

bool Occupancy::is_free(const Vec3& position, double radius) const {
    const double reach = radius + largest_radius_;
    const auto dx = images(position.x, periods_.min.x, periods_.length.x, reach);
    const auto dy = images(position.y, periods_.min.y, periods_.length.y, reach);
    const auto dz = images(position.z, periods_.min.z, periods_.length.z, reach);
    for (std::size_t i = 0; i < dx.size(); ++i) {
        for (std::size_t j = 0; j < dy.size(); ++j) {
            for (std::size_t k = 0; k < dz.size(); ++k) {
                const bool repeated = (i > 0 && dx[i] == 0) || (j > 0 && dy[j] == 0) || (k > 0 && dz[k] == 0);
                if (!repeated && !is_free_at(position + Vec3{dx[i], dy[j], dz[k]}, radius)) return false;
            }
        }
    }
    return true;
}

bool Occupancy::is_free_at(const Vec3& position, double radius) const {
    return std::all_of(levels_.begin(), levels_.end(),
                       [&](const auto& level) { return level.second.is_free(position, radius); });
}

void Occupancy::Level::add(const Vec3& position, double radius) {
    entries_.push_back({position, radius, no_entry});
    largest_radius_ = std::max(largest_radius_, radius);
    if (entries_.size() > heads_.size()) {
        grow();
    } else {
        link(static_cast<std::uint32_t>(entries_.size() - 1));
    }
}

void Occupancy::Level::link(std::uint32_t index) {
    std::uint32_t& head = heads_[bucket_of(cell_of(entries_[index].position))];
    entries_[index].next = head;
    head = index;
}

void Occupancy::Level::grow() {
    constexpr std::size_t least = 64;
    heads_.assign(std::max(least, 2 * heads_.size()), no_entry);
    for (std::size_t i = 0; i < entries_.size(); ++i) link(static_cast<std::uint32_t>(i));
}

Occupancy::Cell Occupancy::Level::cell_of(const Vec3& position) const {
    return {cell_index(position.x, cell_size_), cell_index(position.y, cell_size_), cell_index(position.z, cell_size_)};
}

std::size_t Occupancy::Level::bucket_of(const Cell& cell) const {
    std::uint64_t hash = 0;
    for (const std::int64_t index : cell) {
        hash = (hash ^ static_cast<std::uint64_t>(index)) * 0x9e3779b97f4a7c15U;
        hash ^= hash >> 29U;
    }
    return hash & (heads_.size() - 1);
}

bool Occupancy::Level::is_free(const Vec3& position, double radius) const {
    const double reach = radius + largest_radius_;
    const Cell low = cell_of(position - Vec3{reach, reach, reach});
    const Cell high = cell_of(position + Vec3{reach, reach, reach});
    double cells = 1;
    for (std::size_t axis = 0; axis < 3; ++axis) cells *= static_cast<double>(high[axis] - low[axis]) + 1;
    if (cells > static_cast<double>(entries_.size())) return is_free_among_all(position, radius);

    for (std::int64_t x = low[0]; x <= high[0]; ++x) {
        for (std::int64_t y = low[1]; y <= high[1]; ++y) {
            for (std::int64_t z = low[2]; z <= high[2]; ++z) {
                if (!is_free_in(bucket_of({x, y, z}), position, radius)) return false;
            }
        }
    }
    return true;
}

bool Occupancy::Level::is_free_among_all(const Vec3& position, double radius) const {
    return std::all_of(entries_.begin(), entries_.end(),
                       [&](const Entry& entry) { return apart(entry.position, position, entry.radius + radius); });
}

bool Occupancy::Level::is_free_in(std::size_t bucket, const Vec3& position, double radius) const {
    for (std::uint32_t i = heads_[bucket]; i != no_entry; i = entries_[i].next) {
        if (!apart(entries_[i].position, position, entries_[i].radius + radius)) return false;
    }
    return true;
}

} // namespace carom::scene
