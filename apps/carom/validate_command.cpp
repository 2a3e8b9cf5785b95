#include "commands.hpp"
#include "options.hpp"
#include "scene/atomic_file.hpp"
#include "validate/page.hpp"
#include "validate/report.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <memory>

namespace carom::cli {

namespace {

struct ValidateOptions {
    bool full = false;
    bool json = false;
    std::string page; ///< a file; none if empty
    std::string only; ///< a group; all if empty
};

std::string group_names() {
    std::vector<std::string_view> names;
    for (const validate::Group& group : validate::groups()) names.push_back(group.name);
    return fmt::format("{}", fmt::join(names, ", "));
}

std::span<const validate::Group> chosen_groups(const std::string& only) {
    const std::span<const validate::Group> all = validate::groups();
    if (only.empty()) return all;
    const auto found = std::find_if(all.begin(), all.end(), [&](const validate::Group& g) { return g.name == only; });
    if (found == all.end()) throw UsageError(fmt::format("--only must be one of {}, not '{}'", group_names(), only));
    return all.subspan(static_cast<std::size_t>(found - all.begin()), 1);
}

void show_progress(std::size_t done, std::size_t tasks) {
    if (isatty(STDERR_FILENO) == 0) return;
    fmt::print(stderr, "\r{} of {} computations{}", done, tasks, done == tasks ? "\n" : "");
    std::fflush(stderr);
}

int run_validation(const ValidateOptions& options) {
    const validate::Extent extent = options.full ? validate::Extent::full : validate::Extent::quick;
    validate::Report report = validate::make_report(chosen_groups(options.only), extent, show_progress);
    if (options.full && options.only.empty()) report.rows.push_back(validate::error_bar_row(report.rows));
    if (!options.page.empty()) scene::write_file(options.page, validate::page(report, extent));
    fmt::print("{}", options.json ? to_json(report) : to_text(report));
    return report.passed() ? success : failure;
}

} // namespace

void add_validate_command(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<ValidateOptions>();
    CLI::App* command = app.add_subcommand("validate", "Measure carom against theory and literature");
    command->add_flag("--full", options->full, "the long set, half an hour on two cores, with smaller errors");
    command->add_option("--html", options->page, "also write a page with the table and plots")->type_name("FILE");
    command->add_option("--only", options->only, "one group of cases: " + group_names())->type_name("NAME");
    add_json(*command, options->json);
    command->footer("Exit code 0: every row passes; 1: a row fails; 2: bad usage.");
    command->callback([options, &exit_code] { exit_code = run_validation(*options); });
}

} // namespace carom::cli
