/// \file
/// How often the window is drawn.
#pragma once

#include <chrono>
#include <thread>

namespace carom::viewer {

/// A little less than a sixtieth of a second, so that a monitor of 60 Hz sets the pace where there is one.
inline constexpr std::chrono::microseconds frame_time{16'000};

/// Sleeps through what is left of a frame: also where no monitor sets the pace, the window leaves the processor to
/// others.
inline void pace(std::chrono::steady_clock::time_point frame_began) {
    std::this_thread::sleep_until(frame_began + frame_time);
}

} // namespace carom::viewer
