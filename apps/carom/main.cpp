#include "commands.hpp"
#include "options.hpp"
#include "scene/reader.hpp"
#include "scene/scene_error.hpp"

#include <carom/base.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>
#include <string_view>
#include <vector>

namespace {

constexpr const char* exit_codes = R"(Exit codes:
  0    fine; diff: no difference; validate: every row passes
  1    failed at run time, for example because the disk is full; diff: there is a difference; validate: a row fails
  2    bad usage, scene or input file: the message says what is allowed
  130  interrupted by Ctrl-C, 143 by SIGTERM; what run had computed is saved, render writes nothing
)";

int report(const std::string& message, int exit_code) {
    fmt::print(stderr, "carom: {}\n", message);
    return exit_code;
}

/// Of a command that is missing or that there is not.
std::string needed_command(const CLI::App& app) {
    std::vector<std::string_view> names;
    for (const CLI::App* command : app.get_subcommands({})) names.push_back(command->get_name());
    std::string text =
        fmt::format("a command is required: {} or {}", fmt::join(names.begin(), names.end() - 1, ", "), names.back());
    const std::vector<std::string> rest = app.remaining();
    if (!rest.empty()) text += fmt::format(", not '{}'{}", rest.front(), carom::scene::hint(rest.front(), names));
    return text;
}

/// What CLI11 has to say: help that was asked for, or a mistake together with the command's usage.
int report(const CLI::App& app, const CLI::ParseError& error) {
    if (error.get_exit_code() == static_cast<int>(CLI::ExitCodes::Success)) return app.exit(error);
    const auto commands = app.get_subcommands();
    if (commands.empty()) {
        return report(needed_command(app) + "\ncarom: try 'carom --help'", carom::cli::bad_usage);
    }
    return report(fmt::format("{}\ncarom: try 'carom {} --help'", error.what(), commands.front()->get_name()),
                  carom::cli::bad_usage);
}

int run(int argc, char** argv) {
    CLI::App app("carom: exact collisions of point masses in three dimensions", "carom");
    app.set_version_flag("--version", "carom " CAROM_VERSION);
    app.require_subcommand(1);
    app.footer(exit_codes);
    int exit_code = carom::cli::success;
    carom::cli::add_run_command(app, exit_code);
    carom::cli::add_bench_command(app, exit_code);
    carom::cli::add_validate_command(app, exit_code);
    carom::cli::add_view_command(app, exit_code);
    carom::cli::add_render_command(app, exit_code);
    carom::cli::add_info_command(app, exit_code);
    carom::cli::add_diff_command(app, exit_code);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        exit_code = report(app, error);
    }
    return exit_code;
}

/// The results may be waiting in the buffer of stdout for a disk that is full.
int close_stdout(int exit_code) {
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return exit_code;
    return report("the results could not be written to standard output", carom::cli::failure);
}

} // namespace

int main(int argc, char** argv) {
    // A file beyond the user's limit is an error like any other, and no reason to be killed.
    std::signal(SIGXFSZ, SIG_IGN);
    try {
        return close_stdout(run(argc, argv));
    } catch (const carom::cli::UsageError& error) {
        return report(error.what(), carom::cli::bad_usage);
    } catch (const carom::scene::SceneError& error) {
        return report(error.what(), carom::cli::bad_usage);
    } catch (const std::bad_alloc&) {
        return report("there is not enough memory for this", carom::cli::failure);
    } catch (const std::exception& error) {
        return report(error.what(), carom::cli::failure);
    }
}
