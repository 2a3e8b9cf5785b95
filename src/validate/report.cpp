#include "validate/report.hpp"

#include <carom/executor.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <exception>
#include <mutex>
#include <numeric>

namespace carom::validate {

namespace {

/// The tasks of all groups, what they found, and in which order they start: the longest first.
struct Work {
    std::vector<Task> tasks{};
    std::vector<Findings> found{};
    std::vector<std::size_t> order{};
    std::size_t started = 0;
    std::size_t done = 0;
    std::mutex mutex{};
    const Progress& progress;

    std::size_t start_next() {
        const std::scoped_lock lock(mutex);
        return order[started++];
    }
    void finish() {
        const std::scoped_lock lock(mutex);
        progress(++done, tasks.size());
    }
};

/// A computation that fails is a row that fails.
Findings run_or_report(const Task& task) {
    try {
        return task.run();
    } catch (const std::exception& error) {
        Findings findings;
        findings.rows.push_back(exact_row({"computation", error.what(), "it ends without an error"}, 0, 1, 0));
        return findings;
    }
}

void run_one(void* context, std::size_t /*part*/) {
    Work& work = *static_cast<Work*>(context);
    const std::size_t task = work.start_next();
    work.found[task] = run_or_report(work.tasks[task]);
    work.finish();
}

nlohmann::ordered_json finite_or_null(double value) {
    return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json();
}

nlohmann::ordered_json json_of(const Row& row) {
    nlohmann::ordered_json json;
    json["name"] = row.claim.name;
    json["setup"] = row.claim.setup;
    json["reference"] = row.reference;
    json["source"] = row.claim.source;
    json["measured"] = finite_or_null(row.measured);
    json["standard_error"] = finite_or_null(row.standard_error);
    json["sigmas"] = row.sigmas ? finite_or_null(*row.sigmas) : nlohmann::ordered_json();
    json["percent"] = row.percent() ? finite_or_null(*row.percent()) : nlohmann::ordered_json();
    json["admitted"] = row.admitted;
    json["verdict"] = row.passed ? "pass" : "fail";
    return json;
}

std::string deviation_text(const Row& row) {
    std::string text;
    if (row.sigmas) text += fmt::format("{:+.1f} standard errors, ", *row.sigmas);
    if (const auto percent = row.percent()) text += signed_text(*percent) + " %, ";
    return text + fmt::format("admitted {}", row.admitted == 0 ? "none" : number_text(row.admitted));
}

std::string text_of(const Row& row) {
    std::string measured = number_text(row.measured);
    if (row.sigmas) measured += fmt::format(" +- {:.2g}", row.standard_error);
    return fmt::format("{}  {}\n      {}\n      measured {}, reference {}: {}\n      reference: {}\n",
                       row.passed ? "pass" : "FAIL", row.claim.name, row.claim.setup, measured,
                       number_text(row.reference), deviation_text(row), row.claim.source);
}

} // namespace

bool Report::passed() const {
    return std::all_of(rows.begin(), rows.end(), [](const Row& row) { return row.passed; });
}

Report make_report(std::span<const Group> chosen, Extent extent, const Progress& progress) {
    Work work{.progress = progress};
    for (const Group& group : chosen) {
        for (Task& task : group.tasks(extent)) work.tasks.push_back(std::move(task));
    }
    work.found.resize(work.tasks.size());
    work.order.resize(work.tasks.size());
    std::iota(work.order.begin(), work.order.end(), std::size_t{0});
    std::stable_sort(work.order.begin(), work.order.end(),
                     [&](std::size_t a, std::size_t b) { return work.tasks[a].cost > work.tasks[b].cost; });
    make_default_executor()->run(work.tasks.size(), run_one, &work);
    Report report;
    for (Findings& findings : work.found) {
        std::move(findings.rows.begin(), findings.rows.end(), std::back_inserter(report.rows));
        std::move(findings.curves.begin(), findings.curves.end(), std::back_inserter(report.curves));
    }
    return report;
}

Row error_bar_row(std::span<const Row> rows) {
    double squares = 0;
    double count = 0;
    for (const Row& row : rows) {
        if (!row.sigmas) continue;
        squares += *row.sigmas * *row.sigmas;
        ++count;
    }
    return exact_row({"all deviations in standard errors, root mean square",
                      fmt::format("the {} rows above that have a standard error", count), "honest error bars: 1"},
                     1, std::sqrt(squares / count), 0.3);
}

std::string number_text(double value) {
    if (value != 0 && std::abs(value) < 1e-3) return fmt::format("{:.1e}", value);
    return fmt::format("{:.7g}", value);
}

std::string signed_text(double value) { return value == 0 ? "0" : fmt::format("{:+.2g}", value); }

std::string to_text(const Report& report) {
    std::string text;
    for (const Row& row : report.rows) text += text_of(row);
    text += "\nNot tested:\n";
    for (const std::string_view what : not_tested()) text += fmt::format("- {}\n", what);
    const auto failed =
        std::count_if(report.rows.begin(), report.rows.end(), [](const Row& row) { return !row.passed; });
    return text + fmt::format("\n{} rows, {} failed\n", report.rows.size(), failed);
}

std::string to_json(const Report& report) {
    nlohmann::ordered_json json;
    json["rows"] = nlohmann::ordered_json::array();
    for (const Row& row : report.rows) json["rows"].push_back(json_of(row));
    json["not_tested"] = not_tested();
    return json.dump(2) + '\n';
}

} // namespace carom::validate
