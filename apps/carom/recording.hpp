/// \file
/// What `carom diff` compares: states of worlds and tables of results, from files or from the folder of a run.
#pragma once

#include <carom/world.hpp>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace carom::cli {

/// A file of comma-separated values, as text: numbers that read back exactly are equal where their texts are.
struct Table {
    std::vector<std::string> lines; ///< the first one names the columns
};

/// What one path holds; at least one of the three.
struct Recording {
    std::optional<World> state;    ///< of a snapshot or checkpoint
    std::optional<Table> timeline; ///< timeline.csv
    std::optional<Table> impacts;  ///< impacts.csv
};

/// Reads a snapshot, a checkpoint, a timeline.csv, an impacts.csv, or the folder of a run. Throws UsageError saying
/// why a path cannot be read, or what it should be.
Recording read_recording(const std::filesystem::path& path);

/// The first difference of two states, in words: the first body by id and its first field; nothing if the states are
/// equal to the last bit.
std::optional<std::string> difference(const World& a, const World& b);

/// The first difference of two tables, in words. `row_name` is what a row is called.
std::optional<std::string> difference(const Table& a, const Table& b, const std::string& row_name);

} // namespace carom::cli
