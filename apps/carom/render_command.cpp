#include "commands.hpp"
#include "interrupt.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "scene/scene.hpp"
#include "simulation.hpp"
#include "viewer/sound/render_sound.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <utility>

namespace carom::cli {

namespace {

struct RenderOptions {
    std::string scene;
    std::string file;
    std::optional<double> time;
    std::optional<std::uint64_t> threads;
};

int render(const RenderOptions& options) {
    const std::filesystem::path file = options.file;
    if (!sound::is_sound(file)) throw UsageError(fmt::format("-o must end in .wav, not '{}'", options.file));
    scene::Overrides overrides;
    overrides.time = options.time;
    if (options.threads) overrides.threads = static_cast<unsigned>(*options.threads);
    const scene::Scene scene = scene::load_scene(options.scene, overrides);

    note_interrupts();
    std::optional<Progress> progress(std::in_place, 0, schedule_of(scene.run).steps);
    const bool finished = sound::render_sound(scene, file, [&](const World& world) {
        progress->update(world.step_count(), world.time(), world.ledger().impacts + world.ledger().face_impacts);
        return interrupted_by() == 0;
    });
    progress.reset();
    if (finished) return success;
    fmt::print(stderr, "carom: interrupted; nothing was written\n");
    return 128 + interrupted_by();
}

} // namespace

void add_render_command(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<RenderOptions>();
    CLI::App* command = app.add_subcommand("render", "Run a scene and write what it sounds like");
    command->add_option("SCENE", options->scene, "the scene file, in TOML")->required()->type_name("FILE");
    command->add_option("-o,--output", options->file, "FILE.wav")->required()->type_name("FILE");
    add_seconds(*command, "--time", "how long to run, in seconds of the world", options->time);
    add_threads(*command, options->threads);
    command->footer("A second of the world is a second of sound. The file appears whole or not at all.");
    command->callback([options, &exit_code] { exit_code = render(*options); });
}

} // namespace carom::cli
