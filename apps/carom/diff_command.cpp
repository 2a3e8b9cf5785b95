#include "commands.hpp"
#include "options.hpp"
#include "recording.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <memory>

namespace carom::cli {

namespace {

struct DiffOptions {
    std::string a;
    std::string b;
};

/// What is found, comparison by comparison.
class Report {
public:
    /// `extent` says how much was compared.
    void add(const char* what, const std::string& extent, const std::optional<std::string>& difference) {
        compared_ = true;
        same_ = same_ && !difference;
        remark(what, difference ? *difference : "the same, " + extent);
    }
    void remark(const char* what, const std::string& text) { text_ += fmt::format("{}: {}\n", what, text); }

    [[nodiscard]] bool compared() const { return compared_; }
    [[nodiscard]] bool same() const { return same_; }
    [[nodiscard]] const std::string& text() const { return text_; }

private:
    bool compared_ = false;
    bool same_ = true;
    std::string text_;
};

int diff(const DiffOptions& options) {
    const Recording a = read_recording(options.a);
    const Recording b = read_recording(options.b);
    Report report;
    if (a.state && b.state) {
        report.add("state", fmt::format("{} bodies at {} s", a.state->size(), a.state->time()),
                   difference(*a.state, *b.state));
    }
    const auto compare_tables = [&](const char* what, const char* row, const auto& in_a, const auto& in_b) {
        if (in_a && in_b) {
            report.add(what, fmt::format("{} rows", in_a->lines.size() - 1), difference(*in_a, *in_b, row));
        } else if (in_a || in_b) {
            report.remark(what, fmt::format("only {} has any", in_a ? options.a : options.b));
        }
    };
    compare_tables("timeline", "row", a.timeline, b.timeline);
    compare_tables("impacts", "impact", a.impacts, b.impacts);
    if (!report.compared()) {
        throw UsageError(fmt::format("{} and {} hold nothing of the same kind", options.a, options.b));
    }
    fmt::print("{}", report.text());
    return report.same() ? success : failure;
}

} // namespace

void add_diff_command(CLI::App& app, int& exit_code) {
    const auto options = std::make_shared<DiffOptions>();
    CLI::App* command = app.add_subcommand("diff", "Name the first difference of two results");
    constexpr const char* allowed = "folder of a run, checkpoint, snapshot, timeline.csv or impacts.csv";
    command->add_option("A", options->a, allowed)->required()->type_name("PATH");
    command->add_option("B", options->b, "the same for the other side")->required()->type_name("PATH");
    command->footer("Exit code 0: no difference; 1: there is one; 2: they cannot be compared.");
    command->callback([options, &exit_code] { exit_code = diff(*options); });
}

} // namespace carom::cli
