/// \file
/// The folder that a run writes into.
#pragma once

#include <filesystem>
#include <string_view>

namespace carom::cli {

/// Makes the folder if need be, sees that files can be written into it, and keeps other runs out of it while it lives.
class OutputFolder {
public:
    /// Throws carom::Error{input_output} naming the folder.
    explicit OutputFolder(std::filesystem::path path);
    ~OutputFolder();
    OutputFolder(const OutputFolder&) = delete;
    OutputFolder& operator=(const OutputFolder&) = delete;

    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    [[nodiscard]] std::filesystem::path file(std::string_view name) const { return path_ / name; }

private:
    std::filesystem::path path_;
    int handle_ = -1;
};

} // namespace carom::cli
