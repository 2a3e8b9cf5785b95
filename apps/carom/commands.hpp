/// \file
/// The commands of the program. Each adds itself to the command line, and sets `exit_code` when it has run.
#pragma once

namespace CLI {
class App;
} // namespace CLI

namespace carom::cli {

void add_run_command(CLI::App& app, int& exit_code);
void add_bench_command(CLI::App& app, int& exit_code);
void add_info_command(CLI::App& app, int& exit_code);
void add_validate_command(CLI::App& app, int& exit_code);
void add_view_command(CLI::App& app, int& exit_code);
void add_render_command(CLI::App& app, int& exit_code);
void add_diff_command(CLI::App& app, int& exit_code);

} // namespace carom::cli
