// A ball on the floor: heights, times and energy, with closed formulas; SimBenchmark's bouncing balls.

#include "collision/portable_math.hpp"
#include "validate/cases.hpp"

#include <carom/world.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace carom::validate {

namespace {

constexpr double gravity = 9.81; // m/s^2
constexpr double radius = 0.1;   // m

WorldOptions floor_under_gravity(Precision precision = Precision::double_precision) {
    WorldOptions options;
    options.gravity = {0, 0, -gravity};
    options.region = std::vector<Plane>{{.point = {0, 0, 0}, .normal = {0, 0, 1}}};
    options.precision = precision;
    // Finer than by default: the errors of positions grow by 1/e at each bounce.
    options.resolution = precision == Precision::double_precision ? 0x1p-50 : 0x1p-30;
    options.threads = 1;
    return options;
}

/// A ball whose lowest point is 1 m above the floor.
Body ball(double e) { return {.position = {0, 0, radius + 1}, .radius = radius, .restitution = e}; }

/// s, when bounces from 1 m have become infinitely many.
double zeno_time(double e) { return std::sqrt(2 / gravity) * (1 + e) / (1 - e); }

struct Bounces {
    std::vector<Impact> impacts;
    bool rests = false;
    double resolution = 0; ///< m
};

/// Until it rests, or for so many impacts.
Bounces bounce(double e, double dt, Precision precision, std::size_t most = 1'000'000) {
    World world(floor_under_gravity(precision));
    const BodyId id = world.add(ball(e));
    Bounces result{.impacts = {}, .resolution = world.resolution()};
    while (!world.held(id) && result.impacts.size() < most && world.time() < 10'000) {
        world.step(dt);
        result.impacts.insert(result.impacts.end(), world.impacts().begin(), world.impacts().end());
    }
    result.rests = world.held(id);
    return result;
}

double apex_after(const Impact& impact, double e) {
    const double speed = e * impact.approach_speed;
    return speed * speed / (2 * gravity);
}

Findings run_zeno(double e, Precision precision, double admitted) {
    const Bounces bounces = bounce(e, 1.0 / 60, precision);
    const Impact& last = bounces.impacts.back();
    // What is left of the infinite series after the last impact before it rests.
    const double limit = last.time + 2 * e * last.approach_speed / (gravity * (1 - e));
    const char* in = precision == Precision::single_precision ? ", single precision" : "";
    Findings findings;
    findings.rows.push_back(
        exact_row({"Zeno time, s",
                   fmt::format("ball dropped from 1 m, e = {}; it {} after {} impacts{}", e,
                               bounces.rests ? "rests" : "does not rest", bounces.impacts.size(), in),
                   "sqrt(2 H / g) (1 + e) / (1 - e)"},
                  zeno_time(e), bounces.rests ? limit : std::numeric_limits<double>::infinity(), admitted));
    if (precision == Precision::single_precision) return findings;
    Curve measured{"apexes", fmt::format("{}", e), Mark::points, {}};
    Curve law{"apexes", fmt::format("{}", e), Mark::line, {}};
    for (std::size_t n = 0; n < std::min<std::size_t>(bounces.impacts.size(), 20); ++n) {
        const auto number = static_cast<double>(n + 1);
        const double height = apex_after(bounces.impacts[n], e);
        const double expected = detail::pow(e, 2 * number);
        if (expected < 1e-4) break;
        measured.points.push_back({number, height});
        law.points.push_back({number, expected});
    }
    findings.curves = {std::move(law), std::move(measured)};
    return findings;
}

Findings run_apexes(Extent extent) {
    const double e = 0.8;
    const Bounces inelastic = bounce(e, 1.0 / 60, Precision::double_precision);
    double worst = 0;
    for (std::size_t n = 0; n < 10; ++n) {
        const double expected = detail::pow(e, 2 * static_cast<double>(n + 1));
        worst = std::max(worst, std::abs(apex_after(inelastic.impacts[n], e) / expected - 1));
    }
    const std::size_t bounces = extent == Extent::full ? 100'000 : 5000;
    const Bounces elastic = bounce(1, 1.0 / 60, Precision::double_precision, bounces);
    double largest = 0;
    for (const Impact& impact : elastic.impacts) largest = std::max(largest, std::abs(apex_after(impact, 1) - 1));
    Findings findings;
    findings.rows = {
        exact_row({"apexes: largest relative error", "ball dropped from 1 m, e = 0.8, 10 bounces", "H e^2n"}, 0, worst,
                  1e-9),
        exact_row({"apexes: largest error, m",
                   fmt::format("ball dropped from 1 m, e = 1, {} bounces", elastic.impacts.size()),
                   "the height stays, but for half a unit of the world's resolution at each bounce"},
                  0, largest, 0.5 * static_cast<double>(elastic.impacts.size()) * elastic.resolution)};
    return findings;
}

/// J^2, mean over all steps of the squared error of the energy.
double sim_benchmark(double dt) {
    World world(floor_under_gravity());
    for (int i = 0; i < 49; ++i) {
        const int row = i / 7;
        world.add({.position = {2.0 * (i % 7), 2.0 * row, 5}, .mass = 10, .radius = 0.1});
    }
    const double reference = 49 * 10 * gravity * 5;
    const auto steps = std::lround(20 / dt);
    double sum = 0;
    for (long i = 0; i < steps; ++i) {
        world.step(dt);
        const double error = world.energy().total() - reference;
        sum += error * error;
    }
    return sum / static_cast<double>(steps);
}

Findings run_sim_benchmark() {
    Findings findings;
    for (const double dt : {1e-3, 1e-2, 1e-1}) {
        findings.rows.push_back(exact_row(
            {"SimBenchmark bouncing: energy error, J^2", fmt::format("49 elastic balls, 20 s, dt = {} s", dt),
             "exact times of impact: 0; published at 1e-3 s: RaiSim 0.0186, ODE 185, DART 72 274, Bullet 75 245"},
            0, sim_benchmark(dt), 1e-12));
    }
    return findings;
}

} // namespace

std::vector<Task> bouncing_tasks(Extent extent) {
    std::vector<Task> tasks;
    for (const double e : {0.5, 0.7, 0.8, 0.9, 0.95}) {
        tasks.push_back({0, [e] { return run_zeno(e, Precision::double_precision, 1e-9); }});
    }
    tasks.push_back({0, [] { return run_zeno(0.9, Precision::single_precision, 1e-4); }});
    tasks.push_back({0.5, [extent] { return run_apexes(extent); }});
    tasks.push_back({1, run_sim_benchmark});
    return tasks;
}

} // namespace carom::validate
