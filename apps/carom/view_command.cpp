#include "commands.hpp"
#include "interrupt.hpp"
#include "options.hpp"
#include "viewer/window/view.hpp"

#include <CLI/CLI.hpp>

#include <chrono>
#include <cstdlib>
#include <future>
#include <memory>
#include <vector>

namespace carom::cli {

namespace {

/// A step can last for minutes, and nobody sees what comes of it any more. Everything is written and the window is
/// gone, so the process ends without it.
void leave_behind(const std::vector<std::future<void>>& unfinished, int exit_code) {
    const auto patience = std::chrono::steady_clock::now() + std::chrono::milliseconds(300);
    for (const std::future<void>& work : unfinished) {
        if (work.wait_until(patience) == std::future_status::timeout) std::_Exit(exit_code);
    }
}

} // namespace

void add_view_command(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<viewer::ViewOptions>();
    CLI::App* command = app.add_subcommand("view", "Show a scene in a window while it runs");
    command->add_option("FILE", options->file, "a scene in TOML, a checkpoint or a snapshot")
        ->required()
        ->type_name("FILE");
    // For tests: apps/viewer/window/script.hpp says what is in it.
    command->add_option("--script", options->script)->group("");
    command->footer("F1 in the window tells the keys. Window and cameras are remembered in\n"
                    "$XDG_CONFIG_HOME/carom/view.json.");
    command->callback([options, &exit_code] {
        note_interrupts();
        const auto unfinished = viewer::view(*options, [] { return interrupted_by() != 0; });
        exit_code = interrupted_by() != 0 ? 128 + interrupted_by() : success;
        leave_behind(unfinished, exit_code);
    });
}

} // namespace carom::cli
