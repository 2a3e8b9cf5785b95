#include "commands.hpp"
#include "memory.hpp"
#include "options.hpp"
#include "scene/overlap_search.hpp"
#include "scene/scene.hpp"
#include "scene/summary.hpp"
#include "scene/workloads.hpp"
#include "stepping.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

namespace carom::cli {

namespace {

struct BenchOptions {
    std::string workload;
    std::optional<std::uint64_t> bodies;
    std::optional<double> dt;
    std::optional<std::uint64_t> steps;
    std::optional<std::uint64_t> warm_up;
    std::optional<std::uint64_t> threads;
    std::optional<Precision> precision;
    std::optional<std::uint64_t> repeat;
    bool skip_overlap = false;
    bool json = false;
};

/// What is measured, with every default filled in.
struct Plan {
    scene::Scene scene;
    std::uint64_t warm_up = 0;
    std::uint64_t steps = 0;
    std::uint64_t repeats = 3;
};

/// The memory of a world is read after so many steps, or after the last if there are fewer.
constexpr std::uint64_t steps_before_memory = 100;

Plan plan_of(const BenchOptions& options) {
    scene::Workload workload =
        scene::workload(options.workload, *options.bodies, options.precision.value_or(Precision::double_precision));
    if (options.dt) workload.scene.run.dt = *options.dt;
    Plan plan{.scene = std::move(workload.scene), .warm_up = options.warm_up.value_or(workload.warm_up)};
    plan.steps = options.steps.value_or(plan.scene.run.steps.value_or(120));
    plan.repeats = options.repeat.value_or(plan.repeats);
    return plan;
}

/// One passage from the start through warm-up and timed steps.
struct Repeat {
    StepTotals timed;
    std::uint64_t contacts = 0;
    scene::Books start;
    scene::Books end;
    double bytes_per_body = 0;
    std::uint64_t hash = 0;
};

Repeat measure(const Plan& plan, unsigned threads) {
    Repeat result;
    const std::uint64_t memory_before = resident_bytes();
    World world = scene::make_world(plan.scene);
    world.set_threads(threads);
    result.start = scene::read_books(world);
    StepTotals warm_up;
    const std::uint64_t all_steps = plan.warm_up + plan.steps;
    for (std::uint64_t step = 1; step <= all_steps; ++step) {
        timed_step(world, plan.scene.run.dt, step <= plan.warm_up ? warm_up : result.timed);
        if (step == std::min(steps_before_memory, all_steps)) {
            result.bytes_per_body = bytes_per_body(memory_before, world.size());
        }
    }
    result.contacts = world.report().contacts;
    result.end = scene::read_books(world);
    result.hash = world.hash();
    return result;
}

/// The same steps once more, untimed, with a search for overlaps after each.
scene::OverlapReport search_overlaps(const Plan& plan, std::uint64_t expected_hash) {
    World world = scene::make_world(plan.scene);
    scene::OverlapSearch search(world);
    scene::OverlapReport report;
    double largest = 0;
    StepTotals untimed;
    for (std::uint64_t step = 0; step < plan.warm_up + plan.steps; ++step) {
        timed_step(world, plan.scene.run.dt, untimed);
        report = search.find(world);
        largest = std::max(largest, report.largest);
    }
    if (world.hash() != expected_hash) throw std::runtime_error("two passages of one workload ended differently");
    report.largest = largest;
    return report;
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    const std::size_t middle = values.size() / 2;
    return values.size() % 2 == 1 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

scene::Summary summary_of(const Plan& plan, const std::vector<Repeat>& repeats, unsigned threads) {
    std::vector<double> seconds;
    std::vector<double> bytes_per_body;
    for (const Repeat& repeat : repeats) {
        seconds.push_back(repeat.timed.seconds);
        // The first one also meets the program's code and threads for the first time.
        bytes_per_body.push_back(repeat.bytes_per_body);
    }
    const Repeat& first = repeats.front();
    scene::Summary summary;
    summary.bodies = plan.scene.bodies.size();
    summary.steps = plan.steps;
    summary.dt = plan.scene.run.dt;
    summary.threads = threads;
    summary.precision = plan.scene.options.precision;
    summary.wall_seconds = median(seconds);
    const auto body_steps = static_cast<double>(summary.bodies * summary.steps);
    summary.ns_per_body_step = summary.wall_seconds * 1e9 / body_steps;
    summary.ns_per_body_step_min = *std::min_element(seconds.begin(), seconds.end()) * 1e9 / body_steps;
    summary.pair_impacts = first.timed.impacts;
    summary.face_impacts = first.timed.face_impacts;
    summary.impacts_per_second =
        scene::ratio(static_cast<double>(summary.pair_impacts + summary.face_impacts), summary.wall_seconds);
    summary.contacts = first.contacts;
    summary.start = first.start;
    summary.end = first.end;
    summary.bytes_per_body = median(bytes_per_body);
    summary.hash = first.hash;
    return summary;
}

nlohmann::ordered_json to_json(const Plan& plan, const scene::Summary& summary) {
    nlohmann::ordered_json json;
    json["workload"] = plan.scene.name;
    json["warmup"] = plan.warm_up;
    json["repeat"] = plan.repeats;
    json.update(scene::to_json(summary));
    return json;
}

int bench(const BenchOptions& options) {
    const Plan plan = plan_of(options);
    const unsigned threads = threads_used(options.threads.value_or(0));
    std::vector<Repeat> repeats;
    for (std::uint64_t i = 0; i < plan.repeats; ++i) {
        repeats.push_back(measure(plan, threads));
        if (repeats.back().hash != repeats.front().hash) {
            throw std::runtime_error("two repeats of one workload ended differently");
        }
    }
    scene::Summary summary = summary_of(plan, repeats, threads);
    summary.peak_rss_bytes = peak_resident_bytes();
    if (!options.skip_overlap) summary.overlap = search_overlaps(plan, summary.hash);
    if (options.json) {
        fmt::print("{}", scene::file_text(to_json(plan, summary)));
    } else {
        fmt::print("{}: {} steps to warm up, {} timed, {} {} (median; least {:.4g} ns per body and step)\n{}",
                   plan.scene.name, plan.warm_up, plan.steps, plan.repeats, plan.repeats == 1 ? "repeat" : "repeats",
                   summary.ns_per_body_step_min, scene::to_text(summary));
    }
    return success;
}

std::string workload_help() {
    std::string text = "Workloads (their steps and dt unless options say otherwise):\n";
    for (const scene::WorkloadInfo& info : scene::workload_list()) {
        text += fmt::format("  {:<13} {}\n", info.name, info.text);
    }
    return text;
}

} // namespace

void add_bench_command(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<BenchOptions>();
    CLI::App* command = app.add_subcommand("bench", "Measure a workload");
    command->add_option("WORKLOAD", options->workload, "what to measure; see below")->required()->type_name("NAME");
    add_count(*command, "--bodies", "how many bodies", 1, scene::default_max_bodies, options->bodies)->required();
    add_seconds(*command, "--dt", "length of a step, in seconds", options->dt);
    add_count(*command, "--steps", "how many steps to time", 1, most_steps, options->steps);
    add_count(*command, "--warmup", "how many steps to do before", 0, most_steps, options->warm_up);
    add_threads(*command, options->threads);
    add_precision(*command, options->precision);
    add_count(*command, "--repeat", "how often to measure all of it (default: 3)", 1, 1000, options->repeat);
    command->add_flag("--skip-overlap", options->skip_overlap,
                      "no search for overlaps, which does all steps once more");
    add_json(*command, options->json);
    command->footer(workload_help());
    command->callback([options, &exit_code] { exit_code = bench(*options); });
}

} // namespace carom::cli
