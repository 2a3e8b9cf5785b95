/// \file
/// The figures that end a run or a benchmark: as JSON for programs, whose keys are a contract, and as text.
#pragma once

#include "scene/metrics.hpp"
#include "scene/overlap_search.hpp"

#include <carom/world.hpp>

#include <nlohmann/json.hpp>

#include <cstdint>
#include <optional>
#include <string>

namespace carom::scene {

/// What `carom run` and `carom bench` measure alike; docs/command_line.md says what each figure means.
struct Summary {
    std::uint64_t bodies = 0;
    std::uint64_t steps = 0;
    double dt = 0; ///< s
    unsigned threads = 1;
    Precision precision = Precision::double_precision;
    double wall_seconds = 0;
    double ns_per_body_step = 0;     ///< median of the repeats
    double ns_per_body_step_min = 0; ///< least of the repeats
    std::uint64_t pair_impacts = 0;
    std::uint64_t face_impacts = 0;
    double impacts_per_second = 0;
    std::uint64_t contacts = 0;
    Books start;
    Books end;
    std::optional<OverlapReport> overlap; ///< at the end, its `largest` over all steps; not set if not searched for
    std::uint64_t peak_rss_bytes = 0;
    double bytes_per_body = 0;
    std::uint64_t hash = 0;
};

/// "single" or "double", as in options, scenes and JSON.
const char* name_of(Precision precision);

/// 16 hex digits.
std::string hash_text(std::uint64_t hash);

/// 0 where there is nothing to divide by.
double ratio(double value, double by);

/// All keys of the contract, in its order. Overlap figures that were not measured are null.
nlohmann::ordered_json to_json(const Summary& summary);

/// Lines for people, indented by two.
std::string to_text(const Summary& summary);

/// JSON as a file: indented, with a newline at the end.
std::string file_text(const nlohmann::ordered_json& json);

} // namespace carom::scene
