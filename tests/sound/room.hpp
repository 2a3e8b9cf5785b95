/// \file
/// A room in which tests listen to live sound, without a device.
#pragma once

#include "viewer/sound/sound_stage.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstddef>
#include <memory>
#include <mutex>
#include <span>
#include <thread>
#include <vector>

namespace carom::test {

/// What is said to a speaker of the test, and what it tells.
struct Room {
    std::mutex mutex;
    std::vector<float> heard; ///< all that any speaker took
    std::size_t wanted = 0;   ///< samples that are asked for
    bool plugged = true;      ///< there is a device
    int opened = 0;           ///< how often it was opened
};

/// Takes samples as fast as the test asks for them.
class FakeSpeaker : public sound::Speaker {
public:
    explicit FakeSpeaker(Room& room) : room_(room) {}
    bool has_room() override {
        const std::scoped_lock lock(room_.mutex);
        return room_.heard.size() < room_.wanted;
    }
    void take(std::span<const float> samples) override {
        const std::scoped_lock lock(room_.mutex);
        room_.heard.insert(room_.heard.end(), samples.begin(), samples.end());
    }
    bool connected() override {
        const std::scoped_lock lock(room_.mutex);
        return room_.plugged;
    }

private:
    Room& room_;
};

inline sound::OpenSpeaker speaker_in(Room& room) {
    return [&room](int) -> std::unique_ptr<sound::Speaker> {
        const std::scoped_lock lock(room.mutex);
        if (!room.plugged) throw Error(ErrorCode::not_available, "sound", "there is no sound device");
        ++room.opened;
        return std::make_unique<FakeSpeaker>(room);
    };
}

/// Waits until `condition` holds, for at most ten seconds.
template <class Condition>
bool eventually(const Condition& condition) {
    for (int i = 0; i < 5000; ++i) {
        if (condition()) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return false;
}

/// Lets `seconds` of sound pass.
inline void pass(Room& room, double seconds) {
    std::size_t wanted = 0;
    {
        const std::scoped_lock lock(room.mutex);
        room.wanted += 2 * static_cast<std::size_t>(std::lround(seconds * 48000));
        wanted = room.wanted;
    }
    ASSERT_TRUE(eventually([&] {
        const std::scoped_lock lock(room.mutex);
        return room.heard.size() >= wanted;
    }));
}

inline void plug(Room& room, bool plugged) {
    const std::scoped_lock lock(room.mutex);
    room.plugged = plugged;
}

/// s: when left rises after silence.
inline std::vector<double> onsets(const Room& room) {
    std::vector<double> times;
    std::size_t quiet = 4800;
    for (std::size_t i = 0; i < room.heard.size(); i += 2) {
        const bool sounds = std::abs(room.heard[i]) > 0.01F;
        if (sounds && quiet >= 2400) times.push_back(static_cast<double>(i) / 96000);
        quiet = sounds ? 0 : quiet + 1;
    }
    return times;
}

} // namespace carom::test
