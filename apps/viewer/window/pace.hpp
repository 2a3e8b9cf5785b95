/// \file
/// How often the window is drawn, and what that takes.
#pragma once

#include <chrono>
#include <cstdint>
#include <thread>

namespace carom::viewer {

/// A little less than a sixtieth of a second, so that a monitor of 60 Hz sets the pace where there is one.
inline constexpr std::chrono::microseconds frame_time{16'000};

/// What frames took, in s of the wall clock.
struct FrameTimes {
    std::uint64_t frames = 0;
    double seconds = 0; ///< in all, with the sleep between frames
    double late = 0;    ///< by which frames were longer than frame_time
    double asleep = 0;  ///< s of the processor that the sleep took
};

/// Sleeps through what is left of a frame: also where no monitor sets the pace, the window leaves the processor to
/// others.
inline void pace(std::chrono::steady_clock::time_point frame_began) {
    std::this_thread::sleep_until(frame_began + frame_time);
}

} // namespace carom::viewer
