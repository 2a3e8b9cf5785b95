// Spheres that grow until a fluid is as dense as no random insertion makes it.

#include "collision/portable_math.hpp"
#include "scene/overlap_search.hpp"
#include "validate/cases.hpp"
#include "validate/gas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace carom::validate {

namespace {

constexpr double start_packing = 0.1;
constexpr double end_packing = 0.6;

/// J: does not change, whatever the growth does.
double balance(const World& world) { return world.energy().kinetic - world.ledger().prescribed_work; }

/// Growth heats the fluid: brings it back to kT = 1.
void cool(World& world, const std::vector<BodyId>& ids, std::vector<Vec3>& velocities) {
    world.get(ids, {.velocity = velocities});
    const double scale = 1 / std::sqrt(temperature(world));
    for (Vec3& v : velocities) v *= scale;
    world.set(ids, {.velocity = velocities});
}

/// `rate` (m/s) of the radii, which are 0.5 m at the start, while kT / m is 1 m^2/s^2.
Findings run(std::size_t per_axis, double rate) {
    const GasSetup gas{.packing = start_packing, .per_axis = per_axis, .seed = 61};
    World world = make_gas(gas);
    world.set_recording(false);
    const std::vector<BodyId> ids = world.ids();
    std::vector<Vec3> velocities(ids.size());
    world.set(ids, {.growth = std::vector<double>(ids.size(), rate)});
    const double factor = detail::pow(end_packing / start_packing, 1.0 / 3);
    const double duration = 0.5 * (factor - 1) / rate;
    constexpr int steps = 400;
    scene::OverlapSearch search(world);
    double largest_overlap = 0;
    double largest_imbalance = 0;
    for (int k = 0; k < steps; ++k) {
        const double before = balance(world);
        world.step(duration / steps);
        largest_imbalance = std::max(largest_imbalance, std::abs(balance(world) - before) / world.energy().kinetic);
        largest_overlap = std::max(largest_overlap, search.find(world).largest);
        cool(world, ids, velocities);
    }
    const double radius = world.get(ids.front()).radius;
    const double packing = start_packing * 8 * radius * radius * radius;
    const std::string setup =
        fmt::format("{} elastic spheres in a periodic cube grow at {} of the thermal speed, {:.2g} impacts", ids.size(),
                    rate, static_cast<double>(world.ledger().impacts));
    Findings findings;
    findings.rows = {
        exact_row({"packing after compression", setup, "Lubachevsky & Stillinger, J. Stat. Phys. 60, 561 (1990)"},
                  end_packing, packing, 1e-12),
        exact_row({"largest overlap while compressed, diameters", setup, "no body is inside another"}, 0,
                  largest_overlap, 1e-9),
        exact_row({"energy gained in a step, less the work of growth", setup, "energy is kept"}, 0, largest_imbalance,
                  1e-12)};
    return findings;
}

} // namespace

std::vector<Task> compression_tasks(Extent extent) {
    if (extent == Extent::quick) return {{2, [] { return run(8, 0.02); }}};
    return {{60, [] { return run(16, 0.01); }}};
}

} // namespace carom::validate
