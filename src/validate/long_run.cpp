// Energy and momentum after very many impacts.

#include "scene/overlap_search.hpp"
#include "validate/cases.hpp"
#include "validate/gas.hpp"

#include <fmt/format.h>

#include <cmath>

namespace carom::validate {

namespace {

Findings run(Precision precision, double impacts, double admitted_energy, double admitted_gap) {
    GasSetup gas{.packing = 0.3, .per_axis = 22, .seed = 71, .precision = precision};
    World world = make_gas(gas);
    world.set_recording(false);
    const double start = world.energy().kinetic;
    double momentum_scale = std::sqrt(3.0) * gas.bodies();
    const Vec3 momentum = world.momentum();
    const double dt = 2 / collision_rate(gas.packing);
    while (static_cast<double>(world.ledger().impacts) < impacts) world.step(dt);
    scene::OverlapSearch search(world);
    const char* in = precision == Precision::single_precision ? "single" : "double";
    const std::string setup = fmt::format("{} elastic spheres, packing 0.3, {:.2g} impacts, {} precision", gas.bodies(),
                                          static_cast<double>(world.ledger().impacts), in);
    Findings findings;
    findings.rows = {exact_row({"energy after by before, less 1", setup, "energy is kept"}, 0,
                               world.energy().kinetic / start - 1, admitted_energy),
                     exact_row({"momentum gained, by sum of m |v|", setup, "momentum is kept"}, 0,
                               length(world.momentum() - momentum) / momentum_scale, admitted_energy),
                     exact_row({"largest overlap, diameters", setup, "no body is inside another"}, 0,
                               search.find(world).largest, admitted_gap)};
    return findings;
}

} // namespace

std::vector<Task> long_run_tasks(Extent extent) {
    const double impacts = extent == Extent::full ? 1e8 : 1e6;
    return {{impacts / 4e5, [impacts] { return run(Precision::double_precision, impacts, 1e-12, 1e-10); }},
            {2, [] { return run(Precision::single_precision, 5e5, 1e-5, 1e-5); }}};
}

} // namespace carom::validate
