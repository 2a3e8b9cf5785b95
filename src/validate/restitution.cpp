// Restitution that depends on the approach speed: what comes out of impacts, and how a gas of such spheres cools.

#include "collision/portable_math.hpp"
#include "validate/cases.hpp"
#include "validate/gas.hpp"

#include <carom/world.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace carom::validate {

namespace {

constexpr std::uint32_t material = 1;

WorldOptions with_law(const RestitutionLaw& law) {
    return {.materials = {{.key = material, .restitution = law}}, .threads = 1};
}

/// e of two spheres of 1 cm and 10 g that meet head-on at an approach speed (m/s).
double measured(const RestitutionLaw& law, double speed) {
    World world(with_law(law));
    const Body sphere{.mass = 0.01, .radius = 0.01, .material = material};
    Body left = sphere;
    Body right = sphere;
    left.position = {-0.02, 0, 0};
    right.position = {0.02, 0, 0};
    left.velocity = {speed / 2, 0, 0};
    right.velocity = {-speed / 2, 0, 0};
    const BodyId a = world.add(left);
    const BodyId b = world.add(right);
    world.step(0.04 / speed);
    return (world.get(b).velocity.x - world.get(a).velocity.x) / speed;
}

// ---------------------------------------------------------------------------------------------------------------------
// Viscoelastic spheres, and ice
// ---------------------------------------------------------------------------------------------------------------------

constexpr Viscoelastic elastomer{.dissipation = 1e-4, .modulus = 1e7};

/// m/s, at which those two spheres have x: x = (3/2) A (rho / m)^(2/5) v^(1/5).
double speed_of(double x) {
    const double rho = 2.0 / 3 * elastomer.modulus * std::sqrt(0.005);
    const double stiffness = detail::pow(rho / 0.005, 0.4);
    return detail::pow(x / (1.5 * elastomer.dissipation * stiffness), 5);
}

/// x and e, from the equation of motion.
struct Solved {
    double x;
    double e;
};
constexpr std::array<Solved, 5> solved{
    {{0.01, 0.988544819}, {0.1, 0.892147587}, {0.2, 0.797550062}, {0.3, 0.714044880}, {0.5, 0.573824629}}};

Findings run_viscoelastic() {
    Findings findings;
    Curve reference{"restitution", "viscoelastic", Mark::points, {{0, 1}}};
    for (const Solved& s : solved) {
        findings.rows.push_back(
            exact_row({"restitution of viscoelastic spheres",
                       fmt::format("two spheres meet at {:.3g} m/s: x = {}", speed_of(s.x), s.x),
                       "equation of motion until the overlap is zero, solved independently to nine digits"},
                      s.e, measured(elastomer, speed_of(s.x)), 1e-9));
        reference.points.push_back({s.x, s.e});
    }
    Curve carom{"restitution", "viscoelastic", Mark::line, {{0, 1}}};
    for (int i = 1; i <= 60; ++i) {
        const double x = 0.01 * i;
        carom.points.push_back({x, measured(elastomer, speed_of(x))});
    }
    findings.curves = {std::move(carom), std::move(reference)};
    return findings;
}

Findings run_ice() {
    constexpr PowerLaw ice{.restitution = 0.32, .speed = 0.01, .exponent = 0.234};
    Findings findings;
    for (const double speed : {1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0}) {
        findings.rows.push_back(exact_row({"restitution of ice", fmt::format("two spheres meet at {} m/s", speed),
                                           "min(1, 0.32 (100 v)^-0.234), REBOUND, shearing_sheet; Bridges, Hatzes & "
                                           "Lin, Nature 309, 333 (1984)"},
                                          std::min(1.0, 0.32 * detail::pow(100 * speed, -0.234)), measured(ice, speed),
                                          1e-12));
    }
    return findings;
}

// ---------------------------------------------------------------------------------------------------------------------
// A gas of viscoelastic spheres
// ---------------------------------------------------------------------------------------------------------------------

constexpr double packing = 0.01;
constexpr double start_x = 0.05;  // at an approach of 1 m/s
constexpr double collisions = 30; // per body
constexpr double constant_c1 = 1.15344;
constexpr double constant_c2 = 0.79826;

/// Spheres of 1 m and 1 kg with x = start_x v^(1/5): reduced mass 1/2, reduced radius 1/4.
constexpr Viscoelastic soft{.dissipation = start_x / 1.5, .modulus = 1.5};

/// Mean of 1 - e^2 over impacts at kT, weighted by the square of the approach g, that is by g^3 exp(-g^2 / 4 kT): with
/// e = 1 - C1 x + C2 x^2 (Schwager & Poeschel, Phys. Rev. E 57, 650 (1998)).
double mean_loss(double kt) {
    double loss = 0;
    double weight = 0;
    constexpr int steps = 400;
    for (int i = 0; i < steps; ++i) {
        const double u = 6 * (i + 0.5) / steps; // g by sqrt(2 kT)
        const double x = start_x * detail::pow(u * std::sqrt(2 * kt), 0.2);
        const double e = 1 - x * (constant_c1 - constant_c2 * x);
        const double w = u * u * u * detail::exp(-u * u / 2);
        loss += (1 - e * e) * w;
        weight += w;
    }
    return loss / weight;
}

/// kT over time, in kinetic theory of a Maxwellian gas: dT/dt = -(1 - e^2) omega sqrt(T) T / 3.
class Cooling {
public:
    explicit Cooling(double duration) : dt_(duration / steps) {
        const double rate = collision_rate(packing) / 3;
        const auto slope = [rate](double t) { return -rate * mean_loss(t) * t * std::sqrt(t); };
        for (int i = 0; i < steps; ++i) {
            const double t = kt_.back();
            kt_.push_back(t + dt_ * slope(t + dt_ / 2 * slope(t)));
        }
    }
    [[nodiscard]] double at(double time) const {
        const auto i = std::min(static_cast<std::size_t>(time / dt_), kt_.size() - 2);
        const double part = time / dt_ - static_cast<double>(i);
        return kt_[i] + part * (kt_[i + 1] - kt_[i]);
    }

private:
    static constexpr int steps = 500;
    double dt_;
    std::vector<double> kt_{1};
};

World make_soft_gas(std::uint64_t seed) {
    const World plain = make_gas({.packing = packing, .per_axis = 20, .seed = seed});
    WorldOptions options = plain.options();
    options.materials = {{.key = material, .restitution = soft}};
    Sample sample;
    sample.read(plain);
    World world(options);
    const std::vector<std::uint32_t> materials(sample.position.size(), material);
    world.add(
        {.position = sample.position, .velocity = sample.velocity, .radius = sample.radius, .material = materials});
    return world;
}

Findings run_soft_gas(std::size_t runs, double admitted) {
    // The gas cools to about a third meanwhile, and its impacts get rarer.
    const double duration = 1.5 * collisions / collision_rate(packing);
    constexpr int parts = 60;
    std::vector<double> ends;
    std::vector<Point> course{{0, 1}};
    double impacts = 0;
    for (std::size_t i = 0; i < runs; ++i) {
        World world = make_soft_gas(7000 + i);
        for (int part = 1; part <= parts; ++part) {
            world.step(duration / parts);
            if (i == 0) course.push_back({world.time(), temperature(world)});
        }
        ends.push_back(temperature(world));
        impacts += collisions_per_body(world) / static_cast<double>(runs);
    }
    const Cooling theory(duration);
    const double reference = theory.at(duration);
    Findings findings;
    findings.rows.push_back(statistical_row(
        {"cooling of viscoelastic spheres: T by that at the start",
         fmt::format("{} runs of 8000 spheres, packing 0.01, x = {} v^(1/5), {:.3g} collisions per body", runs, start_x,
                     impacts),
         "kinetic theory of a Maxwellian gas with e = 1 - C1 x + C2 x^2, T falls with t^(-5/3) at the end; 0.3 % for "
         "what it leaves out"},
        {reference, 3e-3 * reference}, mean_of(ends), admitted * reference));
    Curve law{"viscoelastic_gas", "viscoelastic", Mark::line, {}};
    Curve carom{"viscoelastic_gas", "viscoelastic", Mark::points, {}};
    for (std::size_t i = 0; i < course.size(); ++i) {
        law.points.push_back({course[i].x, theory.at(course[i].x)});
        if (i % 4 == 0) carom.points.push_back(course[i]);
    }
    findings.curves = {std::move(law), std::move(carom)};
    return findings;
}

} // namespace

std::vector<Task> restitution_tasks(Extent extent) {
    const bool full = extent == Extent::full;
    const std::size_t runs = full ? 32 : 6;
    const double admitted = full ? 1e-2 : 2e-2;
    return {{0.1, run_viscoelastic}, {0, run_ice}, {0.8 * static_cast<double>(runs), [=] {
                                                        return run_soft_gas(runs, admitted);
                                                    }}};
}

} // namespace carom::validate
