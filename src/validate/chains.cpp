// Cradles and chains in a line, and the billiard whose impacts count digits of pi: exact sequences.

#include "collision/portable_math.hpp"
#include "validate/cases.hpp"

#include <carom/world.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace carom::validate {

namespace {

/// A row of balls, the first of which come in together at 1 m/s.
struct Strike {
    std::size_t balls = 5;
    std::size_t moving = 1;
    double e = 1;
    double gap = 0x1p-10; ///< m
};

struct Outcome {
    std::vector<double> velocities; ///< m/s
    double impacts = 0;
};

Outcome outcome_of(const Strike& strike) {
    World world({.threads = 1});
    std::vector<BodyId> ids;
    for (std::size_t i = 0; i < strike.balls; ++i) {
        const bool comes_in = i < strike.moving;
        ids.push_back(world.add({.position = {static_cast<double>(i) * (1 + strike.gap) - (comes_in ? 0.25 : 0), 0, 0},
                                 .velocity = {comes_in ? 1.0 : 0.0, 0, 0},
                                 .restitution = strike.e}));
    }
    for (int i = 0; i < 300; ++i) world.step(0.25);
    Outcome outcome;
    for (const BodyId id : ids) outcome.velocities.push_back(world.get(id).velocity.x);
    outcome.impacts = static_cast<double>(world.ledger().impacts);
    return outcome;
}

void add_chain(const Strike& strike, const std::vector<double>& expected, double impacts, double admitted,
               const char* source, Findings& findings) {
    const Outcome outcome = outcome_of(strike);
    double worst = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) {
        worst = std::max(worst, std::abs(outcome.velocities[i] - expected[i]));
    }
    const std::string setup = fmt::format("{} of {} balls come in at 1 m/s, e = {}, gaps {:.2g} m", strike.moving,
                                          strike.balls, strike.e, strike.gap);
    findings.rows.push_back(
        exact_row({"chain: largest error of final velocities, m/s", setup, source}, 0, worst, admitted));
    findings.rows.push_back(exact_row({"chain: impacts", setup, source}, impacts, outcome.impacts, 0));
}

Findings run_chains() {
    constexpr const char* cradle = "Newton's cradle: as many out as in";
    constexpr const char* products = "products of 2x2 impact matrices";
    Findings findings;
    for (const double gap : {0.0, 0x1p-10}) {
        add_chain({5, 1, 1, gap}, {0, 0, 0, 0, 1}, 4, 1e-14, cradle, findings);
        add_chain({5, 2, 1, gap}, {0, 0, 0, 1, 1}, 6, 1e-14, cradle, findings);
        add_chain({5, 3, 1, gap}, {0, 0, 1, 1, 1}, 6, 1e-14, cradle, findings);
    }
    add_chain({3, 1, 0.9}, {0.047625, 0.049875, 0.9025}, 3, 1e-14, products, findings);
    // Nine decimals: half a unit of the last, and a little for rounding.
    add_chain({5, 1, 0.9}, {0.043525082, 0.045372965, 0.047296641, 0.049299062, 0.81450625}, 10, 5.1e-10, products,
              findings);
    const Strike long_chain{.balls = 20, .e = 0.9};
    findings.rows.push_back(
        exact_row({"chain: velocity of the last ball, m/s", "20 balls, e = 0.9", "((1 + e) / 2)^19"},
                  detail::pow(0.95, 19), outcome_of(long_chain).velocities.back(), 1e-13));
    return findings;
}

/// Impacts of a wall, a ball of 1 kg and one of 100^k kg that comes in.
Findings run_pi(int k, double digits) {
    const double mass = detail::pow(100, k);
    WorldOptions options;
    options.region = std::vector<Plane>{{.normal = {1, 0, 0}}};
    options.record_impacts = false;
    options.threads = 1;
    World world(options);
    world.add({.position = {2, 0, 0}});
    world.add({.position = {4, 0, 0}, .velocity = {-1, 0, 0}, .mass = mass});
    for (int i = 0; i < 200; ++i) world.step(0.125);
    const auto impacts = static_cast<double>(world.ledger().impacts + world.ledger().face_impacts);
    const double energy = world.energy().kinetic / (0.5 * mass);
    constexpr const char* source = "Galperin, Regular and Chaotic Dynamics 8, 375 (2003)";
    const std::string setup = fmt::format("a wall, 1 kg, and 100^{} kg coming in, e = 1", k);
    Findings findings;
    findings.rows = {
        exact_row({"pi: impacts", setup, source}, digits, impacts, 0),
        exact_row({"pi: energy after by before", setup, "energy is kept, but for a rounding at each impact"}, 1, energy,
                  std::numeric_limits<double>::epsilon() * digits)};
    return findings;
}

} // namespace

std::vector<Task> chain_tasks(Extent /*extent*/) { return {{0, run_chains}}; }

std::vector<Task> pi_tasks(Extent extent) {
    constexpr std::array<double, 8> digits{3, 31, 314, 3141, 31415, 314159, 3141592, 31415926};
    const int most = extent == Extent::full ? 7 : 5;
    std::vector<Task> tasks;
    for (int k = 0; k <= most; ++k) {
        const double expected = digits.at(static_cast<std::size_t>(k));
        tasks.push_back({expected * 1e-6, [k, expected] { return run_pi(k, expected); }});
    }
    return tasks;
}

} // namespace carom::validate
