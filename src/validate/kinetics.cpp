// Gases on their way: relaxation to Maxwell's distribution, and cooling by inelastic impacts.

#include "validate/cases.hpp"
#include "validate/gas.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

namespace carom::validate {

namespace {

constexpr double packing = 0.01;
constexpr std::size_t per_axis = 20; // 8000 bodies

double a2_of(const World& world, Sample& sample) {
    sample.read(world);
    Speeds speeds(1, 1);
    speeds.observe(sample);
    return speeds.a2().value;
}

// -- From equal speeds ------------------------------------------------------------------------------------------------

/// Reference: a2 after so many collisions per body.
struct Relaxed {
    double collisions;
    double a2;
    double error;
};
constexpr std::array<Relaxed, 3> relaxed{{{1, -0.2784, 4e-4}, {2, -0.1879, 7e-4}, {4, -0.0787, 6e-4}}};

/// a2 over collisions per body, of one gas.
std::vector<Point> relax(std::uint64_t seed) {
    World world = make_gas({.packing = packing, .per_axis = per_axis, .seed = seed, .equal_speeds = true});
    const double dt = 0.05 / collision_rate(packing);
    Sample sample;
    std::vector<Point> course{{0, a2_of(world, sample)}};
    while (course.back().x < 6) {
        world.step(dt);
        course.push_back({collisions_per_body(world), a2_of(world, sample)});
    }
    return course;
}

double interpolated(const std::vector<Point>& course, double x) {
    std::size_t i = 1;
    while (course[i].x < x) ++i;
    const Point& a = course[i - 1];
    const Point& b = course[i];
    return a.y + (b.y - a.y) * (x - a.x) / (b.x - a.x);
}

Estimate mean_at(const std::vector<std::vector<Point>>& courses, double x) {
    std::vector<double> values;
    values.reserve(courses.size());
    for (const std::vector<Point>& course : courses) values.push_back(interpolated(course, x));
    return mean_of(values);
}

Findings run_relaxation(std::size_t runs) {
    std::vector<std::vector<Point>> courses;
    courses.reserve(runs);
    for (std::size_t i = 0; i < runs; ++i) courses.push_back(relax(1000 + i));
    Findings findings;
    Curve reference{"a2", "independent computation", Mark::points, {}};
    for (const Relaxed& r : relaxed) {
        findings.rows.push_back(
            statistical_row({fmt::format("a2 after {} collisions per body", r.collisions),
                             fmt::format("{} runs of 8000 spheres from equal speeds, packing 0.01", runs),
                             "independent event-driven computation"},
                            {r.a2, r.error}, mean_at(courses, r.collisions), 0.01));
        reference.points.push_back({r.collisions, r.a2, r.error});
    }
    Curve measured{"a2", "carom", Mark::line, {}};
    for (int i = 0; i <= 60; ++i) {
        const double x = 0.1 * i;
        const Estimate mean = mean_at(courses, x);
        measured.points.push_back({x, mean.value, mean.standard_error});
    }
    findings.curves = {std::move(measured), std::move(reference)};
    return findings;
}

// -- Haff's law -------------------------------------------------------------------------------------------------------

double a2_of_cooling(double e) { return 16 * (1 - e) * (1 - 2 * e * e) / (81 - 17 * e + 30 * e * e * (1 - e)); }

/// Collision rate at the start times Haff's time tau.
double haff_time(double e) { return 6 / ((1 - e * e) * (1 + 3 * a2_of_cooling(e) / 16)); }

struct Cooling {
    double slope = 0;          ///< of 1/sqrt(T) over time, 1/s, from 5 to 25 collisions per body
    std::vector<Point> course; ///< T over time
};

/// Slope of the line through the points, by least squares.
double slope_of(const std::vector<Point>& points) {
    double x = 0;
    double y = 0;
    for (const Point& p : points) {
        x += p.x / static_cast<double>(points.size());
        y += p.y / static_cast<double>(points.size());
    }
    double xy = 0;
    double xx = 0;
    for (const Point& p : points) {
        xy += (p.x - x) * (p.y - y);
        xx += (p.x - x) * (p.x - x);
    }
    return xy / xx;
}

Cooling cool(double e, std::uint64_t seed) {
    World world = make_gas({.packing = packing, .per_axis = per_axis, .restitution = e, .seed = seed});
    Cooling cooling;
    std::vector<Point> line;
    double t = temperature(world);
    while (collisions_per_body(world) < 25) {
        world.step(0.25 / (collision_rate(packing) * std::sqrt(t)));
        t = temperature(world);
        cooling.course.push_back({world.time(), t});
        if (collisions_per_body(world) >= 5) line.push_back({world.time(), 1 / std::sqrt(t)});
    }
    cooling.slope = slope_of(line);
    return cooling;
}

Findings run_cooling(double e, std::size_t runs) {
    std::vector<double> times;
    std::vector<Point> course;
    for (std::size_t i = 0; i < runs; ++i) {
        Cooling cooling = cool(e, 2000 + i);
        times.push_back(collision_rate(packing) / cooling.slope);
        if (i == 0) course = std::move(cooling.course);
    }
    const double reference = haff_time(e);
    Findings findings;
    findings.rows.push_back(statistical_row(
        {"Haff's law: omega_E tau",
         fmt::format("{} runs of 8000 spheres, e = {}, packing 0.01, 5 to 25 collisions per body", runs, e),
         "kinetic theory: 6 / ((1 - e^2) (1 + 3 a2 / 16)), van Noije & Ernst 1998; 0.1 % for what it leaves out"},
        {reference, 1e-3 * reference}, mean_of(times), 0.01 * reference));
    Curve law{"haff", fmt::format("e = {}", e), Mark::line, {}};
    Curve measured{"haff", fmt::format("e = {}", e), Mark::points, {}};
    const double tau = reference / collision_rate(packing);
    for (std::size_t i = 0; i < course.size(); ++i) {
        const double cooled = 1 + course[i].x / tau;
        law.points.push_back({course[i].x, 1 / (cooled * cooled)});
        if (i % 6 == 0) measured.points.push_back(course[i]);
    }
    findings.curves = {std::move(law), std::move(measured)};
    return findings;
}

} // namespace

std::vector<Task> relaxation_tasks(Extent extent) {
    const std::size_t runs = extent == Extent::full ? 64 : 24;
    return {{0.3 * static_cast<double>(runs), [runs] { return run_relaxation(runs); }}};
}

std::vector<Task> cooling_tasks(Extent extent) {
    const std::size_t runs = extent == Extent::full ? 32 : 10;
    std::vector<Task> tasks;
    for (const double e : {0.95, 0.9, 0.8}) {
        tasks.push_back({0.7 * static_cast<double>(runs), [e, runs] { return run_cooling(e, runs); }});
    }
    return tasks;
}

} // namespace carom::validate
