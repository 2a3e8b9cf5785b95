/// \file
/// What the commands share in reading their options: every mistake says what is allowed.
#pragma once

#include <carom/world.hpp>

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace carom::cli {

/// \name The program's exit codes; docs/command_line.md and `carom --help` explain them
/// @{
inline constexpr int success = 0;
inline constexpr int failure = 1;   ///< at run time; `diff`: there is a difference
inline constexpr int bad_usage = 2; ///< bad usage, scene or input file
/// @}

/// A mistake of the caller; ends the program with bad_usage.
class UsageError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// 2^53: larger counts are not told apart as doubles, in JSON and elsewhere.
inline constexpr std::uint64_t most_steps = std::uint64_t{1} << 53U;

/// A whole number from `least` to `most`, or UsageError naming the option.
std::uint64_t parse_count(std::string_view option, const std::string& text, std::uint64_t least, std::uint64_t most);
/// A finite number or quotient > 0, or UsageError naming the option. `what` is its unit, for the message.
double parse_positive(std::string_view option, const std::string& text, std::string_view unit);
Precision parse_precision(std::string_view option, const std::string& text);

/// \name Options that store what they parse; `name` begins with two dashes
/// @{
CLI::Option* add_count(CLI::App& app, const std::string& name, const std::string& text, std::uint64_t least,
                       std::uint64_t most, std::optional<std::uint64_t>& target);
CLI::Option* add_seconds(CLI::App& app, const std::string& name, const std::string& text,
                         std::optional<double>& target);
CLI::Option* add_precision(CLI::App& app, std::optional<Precision>& target);
CLI::Option* add_threads(CLI::App& app, std::optional<std::uint64_t>& target);
CLI::Option* add_json(CLI::App& app, bool& target);
/// @}

/// How many threads the engine uses of those asked for; 0: one for each core.
unsigned threads_used(std::uint64_t asked_for);

} // namespace carom::cli
