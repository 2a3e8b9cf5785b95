#include "commands.hpp"
#include "options.hpp"
#include "scene/summary.hpp"

#include <carom/executor.hpp>
#include <carom/world.hpp>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <memory>
#include <thread>

namespace carom::cli {

namespace {

std::string compiler() {
#if defined(__clang__)
    return "Clang " __clang_version__;
#elif defined(__GNUC__)
    return "GCC " __VERSION__;
#else
    return "unknown";
#endif
}

/// What the compiler was asked for, as far as the program can see it.
std::string build_type() {
#ifdef __OPTIMIZE__
    std::string type = "optimised";
#else
    std::string type = "not optimised";
#endif
#ifdef NDEBUG
    type += ", no assertions";
#else
    type += ", assertions";
#endif
#ifdef __SANITIZE_ADDRESS__
    type += ", address sanitizer";
#endif
#ifdef __SANITIZE_THREAD__
    type += ", thread sanitizer";
#endif
    return type;
}

nlohmann::ordered_json facts() {
    const auto resolution = [](Precision precision) { return World({.precision = precision}).resolution(); };
    nlohmann::ordered_json json;
    json["version"] = CAROM_VERSION;
    json["compiler"] = compiler();
    json["build"] = build_type();
    json["precision"] = scene::name_of(WorldOptions{}.precision);
    json["resolution"] = {{"single", resolution(Precision::single_precision)},
                          {"double", resolution(Precision::double_precision)}};
    json["simd"] = simd_target();
    json["simd_targets"] = simd_targets();
    json["threads"] = threads_used(0);
    json["cores"] = std::thread::hardware_concurrency();
    return json;
}

int info(bool as_json) {
    const nlohmann::ordered_json json = facts();
    if (as_json) {
        fmt::print("{}", scene::file_text(json));
        return success;
    }
    const auto line = [](const char* name, const std::string& value) { fmt::print("{:<12} {}\n", name, value); };
    line("carom", json["version"]);
    line("compiler", json["compiler"]);
    line("build", json["build"]);
    line("precision", json["precision"].get<std::string>() + " unless said otherwise");
    line("resolution",
         fmt::format("{} m in double, {} m in single precision", json["resolution"]["double"].get<double>(),
                     json["resolution"]["single"].get<double>()));
    line("simd", fmt::format("{} of {}", simd_target(), fmt::join(simd_targets(), ", ")));
    line("threads", fmt::format("{} used of {} cores", json["threads"].get<unsigned>(), json["cores"].get<unsigned>()));
    return success;
}

} // namespace

void add_info_command(CLI::App& app, int& exit_code) {
    const auto as_json = std::make_shared<bool>(false);
    CLI::App* command = app.add_subcommand("info", "Say what this program is and what it uses");
    add_json(*command, *as_json);
    command->callback([as_json, &exit_code] { exit_code = info(*as_json); });
}

} // namespace carom::cli
