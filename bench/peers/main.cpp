// Measures another engine on carom's workloads `gas` and `pile`, with the options and the figures of `carom bench`.
#include "engine.hpp"
#include "memory.hpp"
#include "options.hpp"
#include "scene/metrics.hpp"
#include "scene/overlap_search.hpp"
#include "scene/summary.hpp"
#include "scene/workloads.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <optional>
#include <string>
#include <vector>

namespace carom::peers {

namespace {

struct Options {
    std::string workload;
    std::optional<std::uint64_t> bodies;
    std::optional<double> dt;
    std::optional<std::uint64_t> steps;
    std::optional<std::uint64_t> warm_up;
    std::optional<std::uint64_t> repeat;
    bool skip_overlap = false;
};

/// What is measured, with every default filled in.
struct Plan {
    scene::Scene scene;
    std::uint64_t warm_up = 0;
    std::uint64_t steps = 0;
    std::uint64_t repeats = 3;

    [[nodiscard]] std::unique_ptr<Engine> start() const { return make_engine(scene); }
};

Plan plan_of(const Options& options) {
    scene::Workload workload = scene::workload(options.workload, *options.bodies, engine_precision);
    if (options.dt) workload.scene.run.dt = *options.dt;
    Plan plan{.scene = std::move(workload.scene), .warm_up = options.warm_up.value_or(workload.warm_up)};
    plan.steps = options.steps.value_or(*plan.scene.run.steps);
    plan.repeats = options.repeat.value_or(plan.repeats);
    return plan;
}

/// As in `carom bench`: the memory is read after so many steps, or after the last if there are fewer.
constexpr std::uint64_t steps_before_memory = 100;

/// The books of bodies that are here and move so.
scene::Books books_of(const scene::Scene& scene, const std::vector<Vec3>& positions,
                      const std::vector<Vec3>& velocities) {
    long double kinetic = 0;
    long double potential = 0;
    for (std::size_t i = 0; i < velocities.size(); ++i) {
        kinetic += scene.bodies.mass[i] * dot(velocities[i], velocities[i]) / 2;
        potential -= scene.bodies.mass[i] * dot(scene.options.gravity, positions[i]);
    }
    return {.kinetic = static_cast<double>(kinetic), .potential = static_cast<double>(potential)};
}

/// One passage from the start through warm-up and timed steps.
struct Repeat {
    double seconds = 0;
    double bytes_per_body = 0;
    scene::Books end;
};

Repeat measure(const Plan& plan) {
    Repeat result;
    const scene::BodyTable& bodies = plan.scene.bodies;
    const std::uint64_t memory_before = cli::resident_bytes();
    const std::unique_ptr<Engine> engine = plan.start();
    const std::uint64_t all_steps = plan.warm_up + plan.steps;
    for (std::uint64_t step = 1; step <= all_steps; ++step) {
        const auto begin = std::chrono::steady_clock::now();
        engine->step(plan.scene.run.dt);
        const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
        if (step > plan.warm_up) result.seconds += taken.count();
        if (step == std::min(steps_before_memory, all_steps)) {
            result.bytes_per_body = cli::bytes_per_body(memory_before, bodies.size());
        }
    }
    std::vector<Vec3> positions(bodies.size());
    std::vector<Vec3> velocities(bodies.size());
    engine->read(positions, velocities);
    result.end = books_of(plan.scene, positions, velocities);
    return result;
}

/// The same steps once more, untimed, with a search for overlaps after each.
scene::OverlapReport search_overlaps(const Plan& plan) {
    const scene::BodyTable& bodies = plan.scene.bodies;
    const std::unique_ptr<Engine> engine = plan.start();
    scene::OverlapSearch search(plan.scene.options.region, bodies.radius, bodies.mass);
    std::vector<Vec3> positions(bodies.size());
    std::vector<Vec3> velocities(bodies.size());
    scene::OverlapReport report;
    double largest = 0;
    for (std::uint64_t step = 0; step < plan.warm_up + plan.steps; ++step) {
        engine->step(plan.scene.run.dt);
        engine->read(positions, velocities);
        report = search.find(positions);
        largest = std::max(largest, report.largest);
    }
    report.largest = largest;
    return report;
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

/// The keys of `carom bench --json` that another engine can answer.
nlohmann::ordered_json bench(const Options& options) {
    const Plan plan = plan_of(options);
    const scene::BodyTable& bodies = plan.scene.bodies;
    std::vector<double> seconds;
    Repeat last;
    for (std::uint64_t i = 0; i < plan.repeats; ++i) {
        last = measure(plan);
        seconds.push_back(last.seconds);
    }
    std::optional<scene::OverlapReport> overlap;
    if (!options.skip_overlap) overlap = search_overlaps(plan);

    const scene::Books start = books_of(plan.scene, bodies.position, bodies.velocity);
    const double ns_per_second = 1e9 / static_cast<double>(bodies.size() * plan.steps);
    nlohmann::ordered_json json;
    json["engine"] = engine_name;
    json["workload"] = plan.scene.name;
    json["warmup"] = plan.warm_up;
    json["repeat"] = plan.repeats;
    json["bodies"] = bodies.size();
    json["steps"] = plan.steps;
    json["dt"] = plan.scene.run.dt;
    json["threads"] = 1;
    json["precision"] = scene::name_of(engine_precision);
    json["wall_seconds"] = median(seconds);
    json["ns_per_body_step"] = median(seconds) * ns_per_second;
    json["ns_per_body_step_min"] = *std::min_element(seconds.begin(), seconds.end()) * ns_per_second;
    json["energy_initial"] = start.total();
    json["energy_final"] = last.end.total();
    json["energy_drift"] = nullptr;
    // No other engine tells what its impacts and contacts took.
    if (restitution_between(plan.scene) == 1) json["energy_drift"] = scene::energy_drift(start, last.end);
    json["kinetic_final"] = last.end.kinetic;
    for (const char* key : {"max_overlap", "mean_overlap", "bodies_outside"}) json[key] = nullptr;
    if (overlap) {
        json["max_overlap"] = overlap->largest;
        json["mean_overlap"] = overlap->mean;
        json["bodies_outside"] = overlap->bodies_outside;
    }
    json["peak_rss_bytes"] = cli::peak_resident_bytes();
    json["bytes_per_body"] = last.bytes_per_body;
    return json;
}

int run(int argc, char** argv) {
    Options options;
    CLI::App app(fmt::format("Measures {} on a workload of carom's, with one thread, and prints JSON", engine_name));
    app.add_option("workload", options.workload, "gas or pile")->required()->check(CLI::IsMember({"gas", "pile"}));
    cli::add_count(app, "--bodies", "how many bodies", 1, scene::default_max_bodies, options.bodies)->required();
    cli::add_seconds(app, "--dt", "length of a step, in seconds", options.dt);
    cli::add_count(app, "--steps", "how many steps to time", 1, cli::most_steps, options.steps);
    cli::add_count(app, "--warmup", "how many steps to do before", 0, cli::most_steps, options.warm_up);
    cli::add_count(app, "--repeat", "how often to measure all of it (default: 3)", 1, 1000, options.repeat);
    app.add_flag("--skip-overlap", options.skip_overlap, "no search for overlaps, which does all steps once more");
    try {
        app.parse(argc, argv);
        fmt::print("{}", scene::file_text(bench(options)));
        return cli::success;
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? cli::success : cli::bad_usage;
    } catch (const cli::UsageError& error) {
        fmt::print(stderr, "{}: {}\n", engine_name, error.what());
        return cli::bad_usage;
    } catch (const std::exception& error) {
        fmt::print(stderr, "{}: {}\n", engine_name, error.what());
        return cli::failure;
    }
}

} // namespace

} // namespace carom::peers

int main(int argc, char** argv) { return carom::peers::run(argc, argv); }
