#include "viewer/stage/colouring.hpp"

#include "viewer/render/drawing.hpp"
#include "viewer/stage/palette.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace carom::viewer {

namespace {

constexpr double memory_of_rates = 1.0;  ///< s of the world
constexpr double memory_of_scales = 3.0; ///< s of the world
constexpr std::size_t most_samples = 4096;

/// Bodies of a cell of the grid for temperatures.
struct Cell {
    double mass = 0;
    Vec3 momentum{};
    double twice_energy = 0;
    double bodies = 0;
};

/// A grid over all bodies with about so many in a cell.
class Grid {
public:
    explicit Grid(std::span<const Vec3> positions) {
        constexpr double bodies_in_cell = 16;
        if (positions.empty()) return;
        low_ = positions.front();
        Vec3 high = low_;
        for (const Vec3& p : positions) {
            low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), std::min(low_.z, p.z)};
            high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
        }
        const double side = std::cbrt(static_cast<double>(positions.size()) / bodies_in_cell);
        for (std::size_t axis = 0; axis < 3; ++axis)
            count_[axis] = std::max<std::size_t>(static_cast<std::size_t>(side), 1);
        const auto per_metre = [](double from, double to, std::size_t count) {
            return to > from ? static_cast<double>(count) / (to - from) : 0;
        };
        scale_ = {per_metre(low_.x, high.x, count_[0]), per_metre(low_.y, high.y, count_[1]),
                  per_metre(low_.z, high.z, count_[2])};
    }

    [[nodiscard]] std::size_t size() const { return count_[0] * count_[1] * count_[2]; }
    [[nodiscard]] std::size_t cell_of(const Vec3& p) const {
        const auto index = [](double place, std::size_t count) {
            return std::min(static_cast<std::size_t>(place), count - 1);
        };
        return (index((p.z - low_.z) * scale_.z, count_[2]) * count_[1] + index((p.y - low_.y) * scale_.y, count_[1])) *
                   count_[0] +
               index((p.x - low_.x) * scale_.x, count_[0]);
    }

private:
    Vec3 low_{};
    Vec3 scale_{}; ///< cells per metre
    std::array<std::size_t, 3> count_{1, 1, 1};
};

/// The value that `part` of all bodies do not exceed, from a sample of them.
double quantile(std::span<const float> values, std::span<const double> mass, double part) {
    std::vector<float> sample;
    const std::size_t stride = (values.size() + most_samples - 1) / most_samples;
    for (std::size_t i = 0; i < values.size(); i += std::max<std::size_t>(stride, 1)) {
        if (mass[i] != infinite_mass) sample.push_back(values[i]);
    }
    if (sample.empty()) return 0;
    const auto place = sample.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(sample.size() - 1));
    std::nth_element(sample.begin(), place, sample.end());
    return static_cast<double>(*place);
}

} // namespace

void find_temperatures(const ColouredBodies& bodies, std::span<float> temperatures) {
    const Grid grid(bodies.position);
    std::vector<Cell> cells(grid.size());
    for (std::size_t i = 0; i < bodies.ids.size(); ++i) {
        if (bodies.mass[i] == infinite_mass) continue;
        Cell& cell = cells[grid.cell_of(bodies.position[i])];
        cell.mass += bodies.mass[i];
        cell.momentum += bodies.velocity[i] * bodies.mass[i];
        cell.twice_energy += bodies.mass[i] * length_squared(bodies.velocity[i]);
        cell.bodies += 1;
    }
    for (std::size_t i = 0; i < bodies.ids.size(); ++i) {
        const Cell& cell = cells[grid.cell_of(bodies.position[i])];
        const double of_mean = cell.mass > 0 ? length_squared(cell.momentum) / cell.mass : 0;
        temperatures[i] =
            cell.bodies > 0 ? static_cast<float>(std::max(cell.twice_energy - of_mean, 0.0) / (3 * cell.bodies)) : 0;
    }
}

void Colouring::set(scene::ColourBy by) {
    if (by == by_) return;
    by_ = by;
    lowest_ = highest_ = 0;
    rates_.clear();
}

void Colouring::count_impacts(const World& world, std::span<const BodyId> ids) {
    if (by_ != scene::ColourBy::impact_rate) return;
    if (rates_.size() != ids.size()) {
        rates_.assign(ids.size(), 0);
        rates_time_ = world.time() - world.report().advanced;
    }
    const double passed = world.time() - rates_time_;
    const auto forget = static_cast<float>(std::exp(-std::max(passed, 0.0) / memory_of_rates));
    for (float& rate : rates_) rate *= forget;
    const auto count = [&](BodyId id) {
        const auto found = std::lower_bound(ids.begin(), ids.end(), id);
        if (found != ids.end() && *found == id) {
            rates_[static_cast<std::size_t>(found - ids.begin())] += static_cast<float>(1 / memory_of_rates);
        }
    };
    for (const Impact& impact : world.impacts()) {
        count(impact.a);
        if (impact.b.is_set()) count(impact.b);
    }
    rates_time_ = world.time();
}

void Colouring::find_values(const ColouredBodies& bodies) {
    const std::size_t count = bodies.ids.size();
    values_.assign(count, 0);
    switch (by_) {
    case scene::ColourBy::speed:
        for (std::size_t i = 0; i < count; ++i) values_[i] = static_cast<float>(length(bodies.velocity[i]));
        break;
    case scene::ColourBy::mass:
        for (std::size_t i = 0; i < count; ++i) values_[i] = static_cast<float>(std::log10(bodies.mass[i]));
        break;
    case scene::ColourBy::impact_rate:
        std::copy_n(rates_.begin(), std::min(rates_.size(), count), values_.begin());
        break;
    case scene::ColourBy::temperature:
        find_temperatures(bodies, values_);
        break;
    case scene::ColourBy::material:
        break;
    }
}

void Colouring::find_scale(const ColouredBodies& bodies, double now) {
    if (by_ == scene::ColourBy::material) return;
    if (by_ == scene::ColourBy::mass) {
        lowest_ = quantile(values_, bodies.mass, 0);
        highest_ = quantile(values_, bodies.mass, 1);
        return;
    }
    const double kept = highest_ * std::exp(-std::abs(now - painted_) / memory_of_scales);
    lowest_ = 0;
    highest_ = std::max(quantile(values_, bodies.mass, 0.95), kept);
    painted_ = now;
}

void Colouring::paint(const ColouredBodies& bodies, std::span<const Attractor> attractors, double now,
                      std::vector<std::uint32_t>& looks) {
    find_values(bodies);
    find_scale(bodies, now);
    const std::size_t count = bodies.ids.size();
    looks.resize(count);
    const auto low = static_cast<float>(lowest_);
    const float scale = highest_ > lowest_ ? 1 / static_cast<float>(highest_ - lowest_) : 0;
    for (std::size_t i = 0; i < count; ++i) {
        if (by_ == scene::ColourBy::material) {
            looks[i] = look_of(PaletteRow::materials, place_of_material(bodies.material[i], bodies.ids[i].slot));
        } else if (bodies.mass[i] == infinite_mass) {
            looks[i] = look_of(PaletteRow::still, bodies.velocity[i] == Vec3{} ? 0 : 1);
        } else {
            looks[i] = look_of(PaletteRow::scale, (values_[i] - low) * scale);
        }
    }
    for (const Attractor& attractor : attractors) {
        const auto found = std::lower_bound(bodies.ids.begin(), bodies.ids.end(), attractor.body);
        if (!attractor.body.is_set() || found == bodies.ids.end() || *found != attractor.body) continue;
        looks[static_cast<std::size_t>(found - bodies.ids.begin())] = look_of(PaletteRow::planet, 0);
    }
}

} // namespace carom::viewer
