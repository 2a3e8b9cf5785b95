#include "body_frames.hpp"
#include "commands.hpp"
#include "interrupt.hpp"
#include "options.hpp"
#include "output_folder.hpp"
#include "progress.hpp"
#include "scene/atomic_file.hpp"
#include "scene/digit_groups.hpp"
#include "scene/energy_plot.hpp"
#include "scene/impact_log.hpp"
#include "scene/scene.hpp"
#include "scene/summary.hpp"
#include "scene/timeline.hpp"
#include "simulation.hpp"

#include <carom/base.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <system_error>

namespace carom::cli {

namespace {

struct RunOptions {
    std::string scene;
    std::string out;
    std::string resume;
    std::optional<double> time;
    std::optional<double> dt;
    std::optional<double> checkpoint_every;
    std::optional<std::uint64_t> steps;
    std::optional<std::uint64_t> threads;
    std::optional<Precision> precision;
    bool json = false;
};

/// How the stepping ended.
struct Ending {
    int exit_code = success;
    std::string message; ///< empty if the run came to its end
};

scene::Scene load(const RunOptions& options) {
    scene::Overrides overrides;
    overrides.time = options.time;
    overrides.steps = options.steps;
    overrides.dt = options.dt;
    overrides.precision = options.precision;
    overrides.checkpoint_every = options.checkpoint_every;
    if (options.threads) overrides.threads = static_cast<unsigned>(*options.threads);
    return scene::load_scene(options.scene, overrides);
}

void write_checkpoint(const Simulation& simulation, const OutputFolder& folder) {
    scene::write_file(folder.file("checkpoint.carom"), simulation.checkpoint());
}

void step_to_the_end(Simulation& simulation, const OutputFolder& folder, double checkpoint_every) {
    Progress progress(simulation.steps(), simulation.schedule().steps);
    while (!simulation.finished() && interrupted_by() == 0) {
        simulation.advance();
        write_due_frame(simulation, folder);
        const Ledger& ledger = simulation.world().ledger();
        progress.update(simulation.steps(), simulation.world().time(), ledger.impacts + ledger.face_impacts);
        if (checkpoint_every > 0 && interval_ends(simulation.steps(), simulation.schedule().dt, checkpoint_every)) {
            write_checkpoint(simulation, folder);
        }
    }
}

/// A step that fails leaves the world as it was before: what was computed until then is not lost.
Ending run_to_its_end(Simulation& simulation, const OutputFolder& folder, double checkpoint_every) {
    try {
        step_to_the_end(simulation, folder, checkpoint_every);
    } catch (const Error& error) {
        if (error.code() == ErrorCode::input_output) throw;
        return {failure, fmt::format("step {} failed: {}", simulation.steps() + 1, error.what())};
    }
    if (simulation.finished()) return {};
    return {128 + interrupted_by(),
            fmt::format("interrupted after {} of {} steps; go on with --resume {}", simulation.steps(),
                        simulation.schedule().steps, folder.file("checkpoint.carom").string())};
}

nlohmann::ordered_json to_json(const scene::Scene& scene, const Simulation& simulation, const scene::Summary& summary) {
    nlohmann::ordered_json json;
    json["scene"] = scene.name;
    json["time"] = simulation.world().time();
    json["complete"] = simulation.finished();
    json["resumed_from_step"] = simulation.resumed_from();
    json.update(scene::to_json(summary));
    return json;
}

std::string subtitle(const scene::Summary& summary) {
    const auto count = [](std::uint64_t number) { return scene::group_digits(std::to_string(number), "\u202f"); };
    return fmt::format("{} {}, {} steps of {:.4g} s, {} precision", count(summary.bodies),
                       summary.bodies == 1 ? "body" : "bodies", count(summary.steps), summary.dt,
                       scene::name_of(summary.precision));
}

/// Writes a file, or sees that none of an earlier run lies there as if it were of this one.
void write_if(bool wanted, const std::filesystem::path& file, const std::function<std::string()>& text) {
    if (wanted) return scene::write_file(file, text());
    std::error_code error;
    std::filesystem::remove(file, error);
    if (error) throw Error(ErrorCode::input_output, file.string(), "cannot be removed: " + error.message());
}

/// summary.json comes last: where it is new, so is everything else.
void write_results(const scene::Scene& scene, const Simulation& simulation, const scene::Summary& summary,
                   const OutputFolder& folder) {
    write_checkpoint(simulation, folder);
    const std::vector<scene::TimelineRow> rows = simulation.timeline();
    scene::write_file(folder.file("timeline.csv"), scene::to_csv(rows));
    write_if(scene.outputs.energy_plot, folder.file("energy.svg"),
             [&] { return scene::energy_plot(rows, scene.title, subtitle(summary)); });
    write_if(scene.outputs.record_impacts, folder.file("impacts.csv"),
             [&] { return std::string(scene::impact_log_header()) + simulation.impact_log(); });
    write_if(!simulation.observations().empty(), folder.file("observations.csv"),
             [&] { return scene::to_csv(simulation.observations()); });
    scene::write_file(folder.file("summary.json"), scene::file_text(to_json(scene, simulation, summary)));
}

int run(const RunOptions& options) {
    const scene::Scene scene = load(options);
    const OutputFolder folder(options.out.empty() ? "out/" + scene.name : options.out);
    const unsigned threads = threads_used(scene.run.threads);
    Simulation simulation(scene);
    if (!options.resume.empty()) {
        simulation.resume(options.resume);
        check_frames(simulation.frames(), folder, options.resume);
    }
    remove_frames_from(simulation.frames(), folder);
    if (options.resume.empty()) write_due_frame(simulation, folder);
    simulation.use_threads(threads);

    note_interrupts();
    const Ending ending = run_to_its_end(simulation, folder, scene.outputs.checkpoint_every);
    const scene::Summary summary = simulation.summary(threads);
    write_results(scene, simulation, summary, folder);
    if (options.json) {
        fmt::print("{}", scene::file_text(to_json(scene, simulation, summary)));
    } else {
        fmt::print("{}: {:.6g} s simulated{}\n{}  results   {}\n", scene.title, simulation.world().time(),
                   simulation.finished() ? "" : ", not finished", scene::to_text(summary), folder.path().string());
    }
    if (simulation.capped_steps() > 0) {
        fmt::print(stderr,
                   "carom: {} steps ended early at the work cap of {}: the world is at {:.6g} s, {:.6g} s behind\n",
                   simulation.capped_steps(), scene.options.work_cap, simulation.world().time(), simulation.behind());
    }
    if (!ending.message.empty()) fmt::print(stderr, "carom: {}\n", ending.message);
    return ending.exit_code;
}

} // namespace

void add_run_command(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<RunOptions>();
    CLI::App* command = app.add_subcommand("run", "Run a scene and write what came of it");
    command->add_option("SCENE", options->scene, "the scene file, in TOML")->required()->type_name("FILE");
    command->add_option("--out", options->out, "folder for the results (default: out/NAME-OF-SCENE)")->type_name("DIR");
    CLI::Option* time = add_seconds(*command, "--time", "how long to run, in seconds of the world", options->time);
    add_count(*command, "--steps", "how many steps to run", 1, most_steps, options->steps)->excludes(time);
    add_seconds(*command, "--dt", "length of a step, in seconds", options->dt);
    add_threads(*command, options->threads);
    add_precision(*command, options->precision);
    add_seconds(*command, "--checkpoint-every", "write a checkpoint each so many seconds of the world",
                options->checkpoint_every);
    command->add_option("--resume", options->resume, "go on from this checkpoint of the same run")->type_name("FILE");
    add_json(*command, options->json);
    command->footer("Options stand over what the scene says. Into DIR go summary.json, timeline.csv, energy.svg and\n"
                    "checkpoint.carom, each whole or not at all. Ctrl-C ends the run after the current step, with all\n"
                    "files written; --resume goes on from there to the same bits as without the interruption.");
    command->callback([options, &exit_code] { exit_code = run(*options); });
}

} // namespace carom::cli
