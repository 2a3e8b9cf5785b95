/// \file
/// Tables of all bodies at regular times of a run: bodies/000000.csv and so on, of constant cost in memory.
#pragma once

#include "output_folder.hpp"
#include "simulation.hpp"

#include <cstdint>
#include <string>

namespace carom::cli {

/// Writes the frame of now, if one is due. Throws carom::Error{input_output} naming the file.
void write_due_frame(const Simulation& simulation, const OutputFolder& folder);

/// A run that goes on from the checkpoint `resumed` needs the first `count` frames, which it does not write again.
/// Throws UsageError naming one that is not in the folder.
void check_frames(std::uint64_t count, const OutputFolder& folder, const std::string& resumed);

/// Sees that no frames of an earlier run lie behind the first `count` as if they were of this one.
void remove_frames_from(std::uint64_t count, const OutputFolder& folder);

} // namespace carom::cli
