/// \file
/// How far a run has come, on stderr: a bar on a terminal, now and then a line elsewhere.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>

namespace carom::cli {

class Progress {
public:
    /// `first` steps of `total` were done by earlier parts of the run. `unit` is what a step is called.
    Progress(std::uint64_t first, std::uint64_t total, const char* unit = "step");
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    /// After step number `step`, at `time` (s) of the world. Shows it if the last showing is long enough ago.
    void update(std::uint64_t step, double time, std::uint64_t impacts);

private:
    using Clock = std::chrono::steady_clock;

    [[nodiscard]] std::string status(std::uint64_t step, double time, std::uint64_t impacts) const;
    void show_bar(double done, const std::string& status);

    std::uint64_t first_;
    std::uint64_t total_;
    const char* unit_;
    bool on_terminal_;
    bool bar_shown_ = false;
    Clock::time_point start_;
    Clock::time_point next_showing_;
};

/// "1:02:03", "2:03" or "0:03".
std::string clock_text(double seconds);

} // namespace carom::cli
