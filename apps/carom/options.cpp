#include "options.hpp"

#include "scene/reader.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <thread>

namespace carom::cli {

namespace {

/// Parses all of `text`, or nothing.
std::optional<std::uint64_t> whole_number_of(const std::string& text) {
    std::uint64_t value = 0;
    const char* end = text.data() + text.size();
    const auto [rest, error] = std::from_chars(text.data(), end, value);
    if (error != std::errc{} || rest != end) return std::nullopt;
    return value;
}

} // namespace

std::uint64_t parse_count(std::string_view option, const std::string& text, std::uint64_t least, std::uint64_t most) {
    const auto value = whole_number_of(text);
    if (value && *value >= least && *value <= most) return *value;
    throw UsageError(fmt::format("{} must be a whole number from {} to {}, not '{}'", option, least, most, text));
}

double parse_positive(std::string_view option, const std::string& text, std::string_view unit) {
    const auto value = scene::quotient_of_text(text);
    if (value && std::isfinite(*value) && *value > 0) return *value;
    throw UsageError(
        fmt::format("{} must be a number of {} greater than 0, such as 0.5 or 1/60, not '{}'", option, unit, text));
}

Precision parse_precision(std::string_view option, const std::string& text) {
    if (text == "single") return Precision::single_precision;
    if (text == "double") return Precision::double_precision;
    throw UsageError(fmt::format("{} must be single or double, not '{}'", option, text));
}

CLI::Option* add_count(CLI::App& app, const std::string& name, const std::string& text, std::uint64_t least,
                       std::uint64_t most, std::optional<std::uint64_t>& target) {
    const auto read = [name, least, most, &target](const std::string& value) {
        target = parse_count(name, value, least, most);
    };
    return app.add_option_function<std::string>(name, read, text)->type_name("N");
}

CLI::Option* add_seconds(CLI::App& app, const std::string& name, const std::string& text,
                         std::optional<double>& target) {
    const auto read = [name, &target](const std::string& value) { target = parse_positive(name, value, "seconds"); };
    return app.add_option_function<std::string>(name, read, text)->type_name("S");
}

CLI::Option* add_precision(CLI::App& app, std::optional<Precision>& target) {
    const auto read = [&target](const std::string& value) { target = parse_precision("--precision", value); };
    return app.add_option_function<std::string>("--precision", read, "single or double")->type_name("P");
}

CLI::Option* add_threads(CLI::App& app, std::optional<std::uint64_t>& target) {
    return add_count(app, "--threads", "threads to use; 0: all of the machine", 0, most_threads, target);
}

CLI::Option* add_json(CLI::App& app, bool& target) {
    return app.add_flag("--json", target, "print the results as JSON instead of text");
}

unsigned threads_used(std::uint64_t asked_for) {
    return asked_for != 0 ? static_cast<unsigned>(asked_for) : std::max(1U, std::thread::hardware_concurrency());
}

} // namespace carom::cli
