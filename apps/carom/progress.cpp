#include "progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

namespace carom::cli {

namespace {

using namespace std::chrono_literals;

constexpr auto between_bars = 100ms;
constexpr auto between_lines = 10s;

/// A terminal that can go back to the start of its line.
bool stderr_is_terminal() {
    const char* kind = std::getenv("TERM");
    return ::isatty(STDERR_FILENO) == 1 && (kind == nullptr || std::string_view(kind) != "dumb");
}

std::size_t terminal_width() {
    winsize size{};
    const bool known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
    return known ? size.ws_col : 80;
}

/// About how much, in few letters: "12.3 k".
std::string short_number(double number) {
    if (number >= 1e10) return fmt::format("{:.1f} G", number / 1e9);
    if (number >= 1e7) return fmt::format("{:.1f} M", number / 1e6);
    if (number >= 1e4) return fmt::format("{:.1f} k", number / 1e3);
    return fmt::format("{:.{}f}", number, number < 100 && number != std::floor(number) ? 1 : 0);
}

} // namespace

std::string clock_text(double seconds) {
    const auto whole = static_cast<std::uint64_t>(std::clamp(seconds, 0.0, 1e15));
    const std::uint64_t hours = whole / 3600;
    const std::uint64_t minutes = whole / 60 % 60;
    if (hours > 0) return fmt::format("{}:{:02}:{:02}", hours, minutes, whole % 60);
    return fmt::format("{}:{:02}", minutes, whole % 60);
}

Progress::Progress(std::uint64_t first, std::uint64_t total, const char* unit)
    : first_(first), total_(total), unit_(unit), on_terminal_(stderr_is_terminal()), start_(Clock::now()),
      next_showing_(start_ + (on_terminal_ ? Clock::duration(between_bars) : Clock::duration(between_lines))) {}

Progress::~Progress() {
    if (bar_shown_) std::fputs("\r\x1b[K", stderr);
}

void Progress::update(std::uint64_t step, double time, std::uint64_t impacts) {
    const Clock::time_point now = Clock::now();
    if (now < next_showing_) return;
    const double done = static_cast<double>(step) / static_cast<double>(std::max<std::uint64_t>(total_, 1));
    const std::string text = status(step, time, impacts);
    if (on_terminal_) {
        show_bar(done, text);
        next_showing_ = now + between_bars;
    } else {
        fmt::print(stderr, "{:3.0f} %  {} {} of {}  {}\n", 100 * done, unit_, step, total_, text);
        next_showing_ = now + between_lines;
    }
}

std::string Progress::status(std::uint64_t step, double time, std::uint64_t impacts) const {
    const double seconds = std::chrono::duration<double>(Clock::now() - start_).count();
    const double rate = static_cast<double>(step - first_) / std::max(seconds, 1e-9);
    const double left = rate > 0 ? static_cast<double>(total_ - step) / rate : 0;
    return fmt::format("t = {:.4g} s  {} {}s/s  {} impacts  {} left", time, short_number(rate), unit_,
                       short_number(static_cast<double>(impacts)), clock_text(left));
}

void Progress::show_bar(double done, const std::string& status) {
    const std::size_t width = terminal_width();
    std::string line = fmt::format("{:3.0f} %  {}", 100 * done, status);
    // The bar takes what room the words leave; a narrow terminal gets the words alone, as many as fit.
    if (width > line.size() + 14) {
        const std::size_t room = std::min<std::size_t>(width - line.size() - 4, 40);
        const auto filled = static_cast<std::size_t>(done * static_cast<double>(room));
        line = fmt::format("[{:#<{}}{:.<{}}] {}", "", filled, "", room - filled, line);
    }
    line.resize(std::min(line.size(), width - 1));
    fmt::print(stderr, "\r{}\x1b[K", line);
    std::fflush(stderr);
    bar_shown_ = true;
}

} // namespace carom::cli
