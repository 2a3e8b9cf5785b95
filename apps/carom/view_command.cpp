#include "commands.hpp"
#include "interrupt.hpp"
#include "options.hpp"
#include "viewer/window/view.hpp"

#include <CLI/CLI.hpp>

#include <memory>

namespace carom::cli {

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
        viewer::view(*options, [] { return interrupted_by() != 0; });
        exit_code = interrupted_by() != 0 ? 128 + interrupted_by() : success;
    });
}

} // namespace carom::cli
