/// \file
/// Files that appear whole or not at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string_view>
#include <vector>

namespace carom::scene {

/// Writes `bytes` to `file`, replacing what was there. The bytes go to `file` + ".part" beside it, are brought to the
/// disk, and only then take the name: whoever opens `file`, also after a crash, finds the old or the new content.
/// Throws carom::Error{input_output} that names the file; the old content is then untouched and no part is left
/// (but for the one failure after the rename, of which the message says so).
/// Two writers of the same file at the same time are the caller's to prevent (OutputFolder does).
void write_file(const std::filesystem::path& file, std::span<const std::byte> bytes);
void write_file(const std::filesystem::path& file, std::string_view text);

/// Brings a file that somebody else has written to the disk, and only then gives it the name `file`. Throws
/// carom::Error{input_output} that names the file; then no part is left.
void publish(const std::filesystem::path& part, const std::filesystem::path& file);

/// The whole content of a file. Throws carom::Error{input_output} that names the file.
std::vector<std::byte> read_file(const std::filesystem::path& file);

} // namespace carom::scene
