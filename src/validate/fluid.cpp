// The hard-sphere fluid in equilibrium: equation of state, collision rate, speeds, structure.

#include "collision/portable_math.hpp"
#include "validate/cases.hpp"
#include "validate/gas.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

namespace carom::validate {

namespace {

constexpr double warm_up = 50;              // collisions per body
constexpr double collisions_per_step = 0.5; // per body

/// What is measured of one state.
struct State {
    GasSetup gas;
    double pair_impacts = 1e6;
    double admitted = 0.01; ///< relative, on Z and on the collision rate
    bool plots_structure = false;
};

struct Measured {
    Estimate z;
    Estimate rate;
    Estimate a2;
    Estimate mean_speed;
    double impacts = 0;
    std::vector<Point> g;
    std::vector<Point> speeds;
};

std::vector<Point> curve_of(const RadialDistribution& radial) {
    std::vector<Point> points;
    const double half_width = radial.distance(0);
    for (std::size_t i = 0; i < radial.shells(); ++i) {
        const Estimate g = radial.g(i);
        // The shell in which spheres touch is empty in part.
        if (radial.distance(i) - half_width > 1) points.push_back({radial.distance(i), g.value, g.standard_error});
    }
    return points;
}

std::vector<Point> curve_of(const Speeds& speeds) {
    std::vector<Point> points;
    for (std::size_t i = 0; i < speeds.bins(); ++i) {
        const Estimate density = speeds.density(i);
        points.push_back({speeds.speed(i), density.value, density.standard_error});
    }
    return points;
}

Measured measure(const State& state) {
    World world = make_gas(state.gas);
    const double dt = collisions_per_step / collision_rate(state.gas.packing);
    while (collisions_per_body(world) < warm_up) world.step(dt);
    const double kt = temperature(world);
    ImpactStatistics impacts(world);
    Speeds speeds(5, 50);
    RadialDistribution radial(3, 100);
    Sample sample;
    for (std::uint64_t step = 0; static_cast<double>(impacts.count()) < state.pair_impacts; ++step) {
        world.step(dt);
        impacts.observe(world);
        if (step % 8 != 0) continue;
        sample.read(world);
        speeds.observe(sample);
        if (state.plots_structure && step % 64 == 0) radial.observe(sample);
    }
    // The virial of all three axes has one error: that of the pressure.
    const double volume = state.gas.side() * state.gas.side() * state.gas.side();
    const double bodies = state.gas.bodies();
    const Estimate pressure = impacts.pressure();
    const double kinetic_part = 2 * world.energy().kinetic / (3 * volume);
    const double scale = volume / (bodies * kt);
    return {.z = {1 + (pressure.value - kinetic_part) * scale, pressure.standard_error * scale},
            .rate = impacts.collision_rate(),
            .a2 = speeds.a2(),
            .mean_speed = speeds.moment(1),
            .impacts = static_cast<double>(impacts.count()),
            .g = curve_of(radial),
            .speeds = curve_of(speeds)};
}

std::string described(const State& state, const Measured& measured) {
    return fmt::format("{} spheres in a periodic cube, packing {}, {:.2g} impacts{}", state.gas.bodies(),
                       state.gas.packing, measured.impacts,
                       state.gas.precision == Precision::single_precision ? ", single precision" : "");
}

void add_state_rows(const State& state, const Measured& measured, Findings& findings) {
    const double packing = state.gas.packing;
    const double bodies = state.gas.bodies();
    const std::string setup = described(state, measured);
    const double z = compressibility(packing, bodies);
    const double rate = collision_rate(packing, bodies);
    findings.rows.push_back(
        statistical_row({"Z = P V / N kT", setup, fmt::format("{}, with its 1/N term", equation_source)}, {z, 0},
                        measured.z, state.admitted * z));
    findings.rows.push_back(statistical_row(
        {"collision rate per body, 1/s", setup, fmt::format("4 sqrt(pi) n chi, chi from the {}", equation_source)},
        {rate, 0}, measured.rate, state.admitted * rate));
    if (state.gas.precision == Precision::single_precision) return;
    findings.curves.push_back({"state", "Z", Mark::points, {{packing, measured.z.value, measured.z.standard_error}}});
    const double percent = 100 / z;
    findings.curves.push_back({"residual",
                               "Z",
                               Mark::points,
                               {{packing, (measured.z.value - z) * percent, measured.z.standard_error * percent}}});
}

void add_speed_rows(const State& state, const Measured& measured, Findings& findings) {
    const std::string setup = described(state, measured);
    const double bodies = state.gas.bodies();
    const double freedom = 3 * bodies - 3;
    const double mean_speed = std::sqrt(8 / std::numbers::pi * (1 - 1 / bodies)) * (1 + 1 / (4 * freedom));
    findings.rows.push_back(statistical_row({"mean speed, m/s", setup, "Maxwell: sqrt(8 kT / pi m), with its 1/N term"},
                                            {mean_speed, 0}, measured.mean_speed, state.admitted * mean_speed));
    // <v^4> / <v^2>^2 = 5/3 (1 + a2), and a2 = -2 / (f + 2) in f dimensions of given energy.
    const Estimate kurtosis{5.0 / 3 * (1 + measured.a2.value), 5.0 / 3 * measured.a2.standard_error};
    const double expected = 5.0 / 3 * freedom / (freedom + 2);
    findings.rows.push_back(statistical_row({"<v^4> / <v^2>^2", setup, "Maxwell: 5/3, with its 1/N term"},
                                            {expected, 0}, kurtosis, state.admitted * expected));
}

std::vector<Point> maxwell_curve() {
    std::vector<Point> points;
    for (int i = 0; i <= 100; ++i) {
        const double v = 0.05 * i;
        points.push_back({v, std::sqrt(2 / std::numbers::pi) * v * v * detail::exp(-v * v / 2)});
    }
    return points;
}

std::vector<Point> equation_curve() {
    std::vector<Point> points;
    for (int i = 0; i <= 96; ++i) points.push_back({0.005 * i, compressibility(0.005 * i)});
    return points;
}

Findings run_state(const State& state) {
    const Measured measured = measure(state);
    Findings findings;
    add_state_rows(state, measured, findings);
    if (!state.plots_structure) return findings;
    add_speed_rows(state, measured, findings);
    findings.curves.push_back({"speeds", fmt::format("packing {}", state.gas.packing), Mark::points, measured.speeds});
    findings.curves.push_back({"g", fmt::format("packing {}", state.gas.packing), Mark::line, measured.g});
    const double chi = contact_value(state.gas.packing);
    findings.curves.push_back({"g", fmt::format("packing {}", state.gas.packing), Mark::points, {{1, chi}}});
    return findings;
}

/// Momentum given to the walls, by that given to other bodies: d/dt of sum(m x v) has mean zero.
Findings run_walls(double collisions) {
    const GasSetup gas{.packing = 0.2, .per_axis = 10, .seed = 77, .periodic = false};
    World world = make_gas(gas);
    const double dt = collisions_per_step / collision_rate(gas.packing);
    while (collisions_per_body(world) < warm_up) world.step(dt);
    ImpactStatistics impacts(world);
    while (static_cast<double>(impacts.count()) < collisions) {
        world.step(dt);
        impacts.observe(world);
    }
    const double volume = gas.side() * gas.side() * gas.side();
    double walls = 0;
    for (std::size_t face = 0; face < 6; ++face) walls += 0.5 * impacts.face_force(face).value * (gas.side() - 1);
    walls /= 3 * volume;
    Findings findings;
    findings.rows.push_back(exact_row({"pressure on walls, Pa",
                                       fmt::format("{} spheres in a cube with walls, packing 0.2, {:.2g} impacts",
                                                   gas.bodies(), static_cast<double>(impacts.count())),
                                       "virial theorem: pressure by the impacts between bodies in the same run"},
                                      impacts.pressure().value, walls, 1e-3 * walls));
    return findings;
}

Findings run_reference_curves() {
    return {
        .rows = {},
        .curves = {{"state", "Z", Mark::line, equation_curve()}, {"speeds", "Maxwell", Mark::line, maxwell_curve()}}};
}

} // namespace

std::vector<Task> fluid_tasks(Extent extent) {
    const bool full = extent == Extent::full;
    const double impacts = full ? 1.2e7 : 1e6;
    const double admitted = full ? 1e-3 : 1e-2;
    const double seconds = impacts / 4e5;
    constexpr std::array packings{0.05, 0.1, 0.2, 0.3, 0.4, 0.45};
    std::vector<Task> tasks{{0, run_reference_curves}};
    for (std::size_t i = 0; i < packings.size(); ++i) {
        const State state{.gas = {.packing = packings[i], .seed = 100 + i},
                          .pair_impacts = impacts,
                          .admitted = admitted,
                          .plots_structure = packings[i] == 0.1 || packings[i] == 0.4};
        tasks.push_back({seconds, [state] { return run_state(state); }});
    }
    const State single{.gas = {.packing = 0.3, .seed = 200, .precision = Precision::single_precision},
                       .pair_impacts = impacts / 2,
                       .admitted = admitted};
    tasks.push_back({seconds / 2, [single] { return run_state(single); }});
    tasks.push_back({seconds / 4, [impacts] { return run_walls(impacts / 4); }});
    return tasks;
}

} // namespace carom::validate
