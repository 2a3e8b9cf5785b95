// Self-diffusion of the elastic gas, by mean squared displacement.

#include "validate/cases.hpp"
#include "validate/gas.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace carom::validate {

namespace {

using std::numbers::pi;

constexpr std::size_t samples_per_free_time = 4;
constexpr std::size_t settled = 10 * samples_per_free_time; ///< lag after which displacements diffuse
constexpr std::size_t most_lag = 20 * samples_per_free_time;

struct Measurement {
    GasSetup gas;
    std::size_t segments = 16;
    std::size_t segment_samples = 200; ///< of each
};

/// m^2/s: Enskog's self-diffusion with the second Sonine approximation.
double enskog(double packing) { return 0.375 / (6 * packing / pi * contact_value(packing)) / std::sqrt(pi) * 1.018954; }

struct Diffusion {
    Estimate coefficient; ///< m^2/s
    Estimate early;       ///< mean squared displacement by 3 t^2 after a short time
    Estimate free_time;   ///< s, by the collisions of each stretch
};

constexpr double short_time = 0.005; // mean free times

/// Mean squared displacement after a short time by that of free flight, 3 t^2.
double early_ratio(World& world, double free_time) {
    Correlations early(1, 1);
    Sample sample;
    sample.read(world);
    early.observe(sample);
    world.step(short_time * free_time);
    sample.read(world);
    early.observe(sample);
    const double t = early.time(1);
    return early.squared_displacement(1).value / (3 * t * t);
}

Diffusion measure(const Measurement& m) {
    World world = make_gas(m.gas);
    const double free_time = 1 / collision_rate(m.gas.packing);
    const double dt = free_time / samples_per_free_time;
    while (collisions_per_body(world) < 50) world.step(dt);
    std::vector<double> coefficients;
    std::vector<double> ratios;
    std::vector<double> free_times;
    Sample sample;
    for (std::size_t segment = 0; segment < m.segments; ++segment) {
        ratios.push_back(early_ratio(world, free_time));
        Correlations correlations(most_lag, 5);
        const double collisions = collisions_per_body(world);
        for (std::size_t i = 0; i < m.segment_samples; ++i) {
            sample.read(world);
            correlations.observe(sample);
            world.step(dt);
        }
        const double moved =
            correlations.squared_displacement(most_lag).value - correlations.squared_displacement(settled).value;
        free_times.push_back(static_cast<double>(m.segment_samples) * dt / (collisions_per_body(world) - collisions));
        coefficients.push_back(moved / (6 * (correlations.time(most_lag) - correlations.time(settled))));
    }
    return {mean_of(coefficients), mean_of(ratios), mean_of(free_times)};
}

std::string described(const Measurement& m) {
    return fmt::format("{} spheres in a periodic cube, packing {:.4g}, {} stretches of {} mean free times",
                       m.gas.bodies(), m.gas.packing, m.segments, m.segment_samples / samples_per_free_time);
}

/// Against Enskog's theory and the ratio that molecular dynamics has to it.
Findings run_against_enskog(const Measurement& m, double ratio) {
    const Diffusion measured = measure(m);
    const double reference = ratio * enskog(m.gas.packing);
    // Impacts take a third of their rate times 2/3 of the velocity away; kT is 2 K / (3 N - 3).
    const double early = (1 - 1 / m.gas.bodies()) * (1 - 2.0 / 9 * short_time);
    const std::string setup = described(m);
    Findings findings;
    findings.rows = {
        statistical_row(
            {"self-diffusion, m^2/s", setup,
             fmt::format("Enskog times {} (independent MD, 1 to 2 %; sizes and lags of a few per cent)", ratio)},
            {reference, 0.015 * reference}, measured.coefficient, 0.02 * reference),
        statistical_row({"mean squared displacement by 3 t^2", setup + "; t = 0.005 mean free times", "free flight"},
                        {early, 0}, measured.early, 0.005)};
    return findings;
}

/// DynamO's unit test: n = 1/2.
Findings run_against_dynamo(const Measurement& m) {
    const Diffusion measured = measure(m);
    constexpr const char* source = "DynamO's unit tests, N = 1372";
    Findings findings;
    findings.rows = {statistical_row({"mean free time, s", described(m), std::string(source) + ", 1 %"},
                                     {0.13031, 0.13031 * 0.005}, measured.free_time, 0.13031 * 0.01),
                     statistical_row({"self-diffusion, m^2/s", described(m), std::string(source) + ", 8 %"},
                                     {0.247, 0.247 * 0.04}, measured.coefficient, 0.247 * 0.08)};
    return findings;
}

} // namespace

std::vector<Task> diffusion_tasks(Extent extent) {
    const bool full = extent == Extent::full;
    const std::size_t segments = full ? 32 : 12;
    const double cost = full ? 20 : 8;
    const Measurement dilute{.gas = {.packing = 0.01, .seed = 31}, .segments = segments};
    const Measurement gas{.gas = {.packing = 0.1, .seed = 32}, .segments = segments};
    const Measurement dense{.gas = {.packing = pi / 12, .per_axis = 11, .seed = 33}, .segments = segments};
    return {{cost, [dilute] { return run_against_enskog(dilute, 1.002); }},
            {cost, [gas] { return run_against_enskog(gas, 1.078); }},
            {cost, [dense] { return run_against_dynamo(dense); }}};
}

} // namespace carom::validate
