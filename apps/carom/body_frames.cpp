#include "body_frames.hpp"

#include "options.hpp"
#include "scene/atomic_file.hpp"
#include "scene/csv.hpp"

#include <carom/base.hpp>

#include <fmt/format.h>

#include <charconv>
#include <filesystem>
#include <optional>
#include <system_error>
#include <vector>

namespace carom::cli {

namespace {

constexpr const char* subfolder = "bodies";

/// Names of six digits sort like their numbers; those of longer runs have more.
std::string name_of(std::uint64_t number) { return fmt::format("{:06}.csv", number); }

std::filesystem::path path_of(std::uint64_t number, const OutputFolder& folder) {
    return folder.file(subfolder) / name_of(number);
}

/// Nothing for a file that is no frame.
std::optional<std::uint64_t> number_of(const std::filesystem::path& file) {
    const std::string name = file.filename().string();
    std::uint64_t number = 0;
    const auto [rest, error] = std::from_chars(name.data(), name.data() + name.size(), number);
    if (error != std::errc{} || name != name_of(number)) return std::nullopt;
    return number;
}

[[noreturn]] void fail(const std::filesystem::path& path, const char* what, const std::error_code& error) {
    throw Error(ErrorCode::input_output, path.string(), what + error.message());
}

std::vector<std::filesystem::path> frames_from(std::uint64_t count, const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> frames;
    std::error_code error;
    for (std::filesystem::directory_iterator file(folder, error), end; !error && file != end; file.increment(error)) {
        const auto number = number_of(file->path());
        if (number && *number >= count) frames.push_back(file->path());
    }
    if (error) fail(folder, "cannot be read: ", error);
    return frames;
}

} // namespace

void write_due_frame(const Simulation& simulation, const OutputFolder& folder) {
    if (!simulation.frame_is_due()) return;
    const std::filesystem::path file = path_of(simulation.frames() - 1, folder);
    std::error_code error;
    std::filesystem::create_directory(file.parent_path(), error);
    if (error) fail(file.parent_path(), "cannot be made: ", error);
    scene::write_file(file, scene::to_csv(simulation.world()));
}

void check_frames(std::uint64_t count, const OutputFolder& folder, const std::string& resumed) {
    for (std::uint64_t number = 0; number < count; ++number) {
        const std::filesystem::path file = path_of(number, folder);
        std::error_code missing;
        if (std::filesystem::is_regular_file(file, missing)) continue;
        throw UsageError(
            fmt::format("--resume {}: the run up to there wrote {}, which is missing: say with --out where "
                        "its results are",
                        resumed, file.string()));
    }
}

void remove_frames_from(std::uint64_t count, const OutputFolder& folder) {
    const std::filesystem::path bodies = folder.file(subfolder);
    std::error_code missing;
    if (!std::filesystem::is_directory(bodies, missing)) return;
    for (const std::filesystem::path& frame : frames_from(count, bodies)) {
        std::error_code error;
        std::filesystem::remove(frame, error);
        if (error) fail(frame, "cannot be removed: ", error);
    }
    // Where there are no frames there is no folder of theirs, unless something else lies in it.
    std::error_code not_empty;
    std::filesystem::remove(bodies, not_empty);
}

} // namespace carom::cli
