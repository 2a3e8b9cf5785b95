#include "commands.hpp"
#include "interrupt.hpp"
#include "options.hpp"
#include "progress.hpp"
#include "scene/subject.hpp"
#include "simulation.hpp"
#include "viewer/film/render.hpp"
#include "viewer/sound/render_sound.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <utility>

namespace carom::cli {

namespace {

struct RenderCommandOptions {
    std::string scene;
    std::string file;
    std::string size = "1280x720";
    std::string colour_by;
    std::optional<double> time;
    std::optional<double> fps;
    std::optional<double> time_scale;
    std::optional<std::uint64_t> supersample;
    std::optional<std::uint64_t> threads;
    bool no_sound = false;
    bool legend = false;
};

/// Larger than any graphics card draws.
constexpr std::uint64_t largest_side = 32768;
constexpr std::uint64_t most_supersampling = 8;

void read_size(const std::string& text, viewer::PictureSize& size) {
    const std::size_t cross = text.find('x');
    if (cross == std::string::npos) throw UsageError(fmt::format("--size must be like 1280x720, not '{}'", text));
    size.width = static_cast<int>(parse_count("--size: width", text.substr(0, cross), 1, largest_side));
    size.height = static_cast<int>(parse_count("--size: height", text.substr(cross + 1), 1, largest_side));
}

viewer::RenderOptions read_options(const RenderCommandOptions& options) {
    viewer::RenderOptions result;
    result.file = options.file;
    const bool film = viewer::is_film(result.file);
    if (!film && result.file.extension() != ".png") {
        throw UsageError(fmt::format(
            "-o must end in .png for a picture, in .mp4 for a film or in .wav for sound, not '{}'", options.file));
    }
    read_size(options.size, result.size);
    if (film && (result.size.width % 2 != 0 || result.size.height % 2 != 0)) {
        throw UsageError(fmt::format("--size of a film must be even, not {}", options.size));
    }
    result.size.supersample = static_cast<int>(options.supersample.value_or(2));
    result.fps = options.fps.value_or(30);
    result.sound = !options.no_sound;
    result.legend = options.legend;
    if (result.fps > 1000) throw UsageError(fmt::format("--fps must be at most 1000, not {}", result.fps));
    return result;
}

scene::ColourBy read_colour(const std::string& name) {
    const auto* const found = std::find(scene::colour_names.begin(), scene::colour_names.end(), name);
    if (found == scene::colour_names.end()) {
        throw UsageError(
            fmt::format("--colour-by must be one of {}, not '{}'", fmt::join(scene::colour_names, ", "), name));
    }
    return static_cast<scene::ColourBy>(found - scene::colour_names.begin());
}

int ended(bool finished) {
    if (finished) return success;
    fmt::print(stderr, "carom: interrupted; nothing was written\n");
    return 128 + interrupted_by();
}

int render_sound(const RenderCommandOptions& options) {
    scene::Overrides overrides;
    overrides.time = options.time;
    if (options.threads) overrides.threads = static_cast<unsigned>(*options.threads);
    scene::Subject subject = scene::load_subject(options.scene, overrides);

    note_interrupts();
    std::optional<Progress> progress(std::in_place, 0, schedule_of(subject.run).steps);
    const std::uint64_t before = subject.world.step_count();
    const bool finished = sound::render_sound(std::move(subject), options.file, [&](const World& world) {
        progress->update(world.step_count() - before, world.time(),
                         world.ledger().impacts + world.ledger().face_impacts);
        return interrupted_by() == 0;
    });
    progress.reset();
    return ended(finished);
}

int render(const RenderCommandOptions& options) {
    if (sound::is_sound(options.file)) return render_sound(options);
    viewer::RenderOptions wanted = read_options(options);
    scene::Overrides overrides;
    const bool film = viewer::is_film(wanted.file);
    if (film) overrides.time = options.time;
    if (options.threads) overrides.threads = static_cast<unsigned>(*options.threads);
    scene::Subject subject = scene::load_subject(options.scene, overrides);
    scene::PictureSettings& picture = subject.view.picture;
    if (options.time && !film) picture.moment = options.time;
    if (options.time_scale) picture.time_scale = *options.time_scale;
    if (!options.colour_by.empty()) picture.colour_by = read_colour(options.colour_by);
    if (options.legend && picture.colour_by == scene::ColourBy::material) {
        throw UsageError(
            "--legend needs colours that are a scale: --colour-by speed, mass, impact_rate or temperature");
    }
    if (!film && picture.moment && *picture.moment < subject.world.time()) {
        throw UsageError(fmt::format("--time must be at least {:.6g}, where {} begins, not {:.6g}",
                                     subject.world.time(), options.scene, *picture.moment));
    }
    wanted.threads = threads_used(subject.run.threads);

    note_interrupts();
    std::optional<Progress> progress;
    const bool finished = viewer::render(std::move(subject), wanted, [&](const viewer::RenderProgress& now) {
        if (!progress) progress.emplace(0, now.total, film ? "frame" : "step");
        progress->update(now.done, now.time, now.impacts);
        return interrupted_by() == 0;
    });
    progress.reset();
    return ended(finished);
}

} // namespace

void add_render_command(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<RenderCommandOptions>();
    CLI::App* command =
        app.add_subcommand("render", "Write a scene, or how a run went on, as a picture, a film or sound");
    command->add_option("SCENE", options->scene, "a scene in TOML, a checkpoint or a snapshot")
        ->required()
        ->type_name("FILE");
    command->add_option("-o,--output", options->file, "FILE.png for a picture, FILE.mp4 for a film, FILE.wav for sound")
        ->required()
        ->type_name("FILE");
    command->add_option("--size", options->size, "width and height in pixels (default: 1280x720)")->type_name("WxH");
    add_seconds(*command, "--time", "when the picture is taken, or how long the film or the sound runs", options->time);
    command
        ->add_option_function<std::string>(
            "--fps",
            [options](const std::string& text) { options->fps = parse_positive("--fps", text, "frames a second"); },
            "frames a second of a film (default: 30)")
        ->type_name("F");
    command
        ->add_option_function<std::string>(
            "--time-scale",
            [options](const std::string& text) {
                options->time_scale = parse_positive("--time-scale", text, "seconds of the world a second");
            },
            "seconds of the world in a second of a film (default: the scene's)")
        ->type_name("X");
    add_count(*command, "--supersample", "samples of a pixel in each direction, 1 to 8 (default: 2)", 1,
              most_supersampling, options->supersample);
    command
        ->add_option("--colour-by", options->colour_by,
                     fmt::format("{} (default: the scene's)", fmt::join(scene::colour_names, ", ")))
        ->type_name("WHAT");
    command->add_flag("--legend", options->legend, "tell in the picture what its colours stand for");
    command->add_flag("--no-sound", options->no_sound, "a film without the sound of its impacts");
    add_threads(*command, options->threads);
    command->footer("Needs no window and no display. The same command draws the same picture again. A file appears\n"
                    "whole or not at all. Films need ffmpeg. Sound takes --time and --threads alone.");
    command->callback([options, &exit_code] { exit_code = render(*options); });
}

} // namespace carom::cli
