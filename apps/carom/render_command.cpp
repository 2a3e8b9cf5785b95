#include "commands.hpp"
#include "interrupt.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "scene/scene.hpp"
#include "simulation.hpp"
#include "sound/sound_track.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>

namespace carom::cli {

namespace {

struct RenderOptions {
    std::string scene;
    std::string out;
    std::optional<double> time;
    std::optional<double> dt;
    std::optional<std::uint64_t> threads;
};

scene::Scene load(const RenderOptions& options) {
    scene::Overrides overrides;
    overrides.time = options.time;
    overrides.dt = options.dt;
    if (options.threads) overrides.threads = static_cast<unsigned>(*options.threads);
    scene::Scene scene = scene::load_scene(options.scene, overrides);
    scene.options.record_impacts = true;
    return scene;
}

/// Runs the scene and writes what it sounds like.
int render_sound(const scene::Scene& scene, const std::filesystem::path& file) {
    World world = scene::make_world(scene);
    world.set_threads(scene.run.threads);
    sound::SoundTrack track(world, sound::settings_for(world));
    track.listen(sound::overview(world));

    note_interrupts();
    const Schedule schedule = schedule_of(scene.run);
    {
        Progress progress(0, schedule.steps);
        for (std::uint64_t step = 1; step <= schedule.steps && interrupted_by() == 0; ++step) {
            world.step(step < schedule.steps ? schedule.dt : schedule.last);
            track.record(world);
            progress.update(step, world.time(), world.ledger().impacts + world.ledger().face_impacts);
        }
    }
    if (interrupted_by() != 0) {
        fmt::print(stderr, "carom: interrupted; {} is not written\n", file.string());
        return 128 + interrupted_by();
    }
    track.write_wav(file);
    fmt::print("{}: {:.6g} s of sound in {}\n", scene.title, world.time(), file.string());
    return success;
}

int render(const RenderOptions& options) {
    const std::filesystem::path file = options.out;
    if (file.extension() != ".wav") {
        throw UsageError(fmt::format("--out must be a file that ends in .wav, not '{}'", options.out));
    }
    return render_sound(load(options), file);
}

} // namespace

void add_render_command(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<RenderOptions>();
    CLI::App* command = app.add_subcommand("render", "Run a scene and write what it sounds like");
    command->add_option("SCENE", options->scene, "the scene file, in TOML")->required()->type_name("FILE");
    command->add_option("-o,--out", options->out, "the file to write: FILE.wav")->required()->type_name("FILE");
    add_seconds(*command, "--time", "how long to run, in seconds of the world", options->time);
    add_seconds(*command, "--dt", "length of a step, in seconds", options->dt);
    add_threads(*command, options->threads);
    command->footer("A second of the world is a second of sound. The file appears whole or not at all.");
    command->callback([options, &exit_code] { exit_code = render(*options); });
}

} // namespace carom::cli
