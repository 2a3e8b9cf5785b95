/// \file
/// The record of every impact of a run: impacts.csv.
#pragma once

#include <carom/events.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace carom::scene {

/// The first line of impacts.csv: the names of its columns.
std::string_view impact_log_header();

/// Appends a line for each impact of step number `step`. A body is named by its place in the scene, from 0; `b` is
/// empty where a wall was hit, `face` where none was. Numbers read back exactly.
void append_impacts(std::string& log, std::uint64_t step, std::span<const Impact> impacts);

} // namespace carom::scene
