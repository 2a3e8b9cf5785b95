#include "room.hpp"
#include "viewer/sound/sound_stage.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdlib>
#include <mutex>
#include <thread>

namespace carom::sound {

namespace {

using namespace std::chrono_literals;
using test::eventually;
using test::onsets;
using test::pass;
using test::plug;
using test::Room;
using test::speaker_in;

/// A thud that is over after a few milliseconds.
const Strike thud{.position = {0, 1, 0}, .restitution = 0};

TEST(LiveSound, FramesFollowOnEachOtherExactly) {
    Room room;
    LiveSound sound({}, speaker_in(room));
    ASSERT_TRUE(eventually([&] { return sound.audible(); }));
    pass(room, 0.1);
    // Frames of 60 ms, fed a little early or late, each with a thud 20 ms after its start.
    for (int frame = 0; frame < 10; ++frame) {
        Strike strike = thud;
        strike.delay = 0.02;
        sound.play({&strike, 1}, 0.06);
        pass(room, frame % 2 == 0 ? 0.05 : 0.07);
    }
    pass(room, 0.2);
    const std::vector<double> times = onsets(room);
    ASSERT_EQ(times.size(), 10);
    for (std::size_t i = 1; i < times.size(); ++i) EXPECT_NEAR(times[i] - times[i - 1], 0.06, 0.0005) << i;
    EXPECT_EQ(sound.take_problem(), std::nullopt);
}

TEST(LiveSound, NeitherFallsBehindNorRunsAhead) {
    Room room;
    LiveSound sound({}, speaker_in(room));
    ASSERT_TRUE(eventually([&] { return sound.audible(); }));
    // The simulation stood still for a second: the next frame is heard at once.
    sound.play({}, 0.01);
    pass(room, 1);
    sound.play({&thud, 1}, 0.01);
    pass(room, 0.2);
    // It runs away: a second of frames at a time when none has passed; what comes after is still heard soon.
    for (int i = 0; i < 100; ++i) sound.play({}, 0.01);
    sound.play({&thud, 1}, 0.01);
    pass(room, 0.3);
    const std::vector<double> times = onsets(room);
    ASSERT_EQ(times.size(), 2);
    EXPECT_NEAR(times[0], 1.025, 0.005);
    EXPECT_LE(times[1], 1.2 + 0.025 + 0.1 + 0.015);
}

TEST(LiveSound, WithoutADeviceIsSilentAndSaysSoOnce) {
    Room room;
    room.plugged = false;
    LiveSound sound({}, speaker_in(room));
    std::optional<std::string> problem;
    ASSERT_TRUE(eventually([&] { return (problem = sound.take_problem()).has_value(); }));
    EXPECT_EQ(*problem, "sound: there is no sound device");
    EXPECT_EQ(sound.take_problem(), std::nullopt);
    EXPECT_FALSE(sound.audible());
    sound.listen({});
    sound.play({&thud, 1}, 0.01);
}

TEST(LiveSound, SurvivesADeviceThatVanishesAndComesBack) {
    Room room;
    LiveSound sound({}, speaker_in(room));
    ASSERT_TRUE(eventually([&] { return sound.audible(); }));
    pass(room, 0.05);
    plug(room, false);
    std::optional<std::string> problem;
    ASSERT_TRUE(eventually([&] { return (problem = sound.take_problem()).has_value(); }));
    EXPECT_EQ(*problem, "sound: the sound device has vanished");
    EXPECT_FALSE(sound.audible());
    for (int i = 0; i < 100; ++i) sound.play({&thud, 1}, 0.01);
    EXPECT_EQ(sound.take_problem(), std::nullopt);

    sound.reopen(); // too early
    ASSERT_TRUE(eventually([&] { return (problem = sound.take_problem()).has_value(); }));
    EXPECT_EQ(*problem, "sound: there is no sound device");

    plug(room, true);
    sound.reopen();
    ASSERT_TRUE(eventually([&] { return sound.audible(); }));
    EXPECT_EQ(room.opened, 2);
    sound.play({&thud, 1}, 0.01);
    pass(room, 0.2);
    EXPECT_EQ(onsets(room).size(), 1);
}

TEST(LiveSound, ListensFromWhereItWasPutBeforeTheDeviceCame) {
    Room room;
    room.plugged = false;
    LiveSound sound({}, speaker_in(room));
    ASSERT_TRUE(eventually([&] { return sound.take_problem().has_value(); }));
    sound.listen({.position = {-1, 1, 0}}); // so that what is at {0, 1, 0} is on the right
    plug(room, true);
    sound.reopen();
    ASSERT_TRUE(eventually([&] { return sound.audible(); }));
    sound.play({&thud, 1}, 0.01);
    pass(room, 0.1);
    double left = 0;
    double right = 0;
    for (std::size_t i = 0; i < room.heard.size(); i += 2) {
        left += std::abs(static_cast<double>(room.heard[i]));
        right += std::abs(static_cast<double>(room.heard[i + 1]));
    }
    EXPECT_GT(right, 100 * left);
}

/// The largest sample of the last `seconds`.
float loudness(const Room& room, double seconds) {
    float largest = 0;
    const auto count = std::min(room.heard.size(), 2 * static_cast<std::size_t>(seconds * 48000));
    for (std::size_t i = room.heard.size() - count; i < room.heard.size(); ++i) {
        largest = std::max(largest, std::abs(room.heard[i]));
    }
    return largest;
}

TEST(LiveSound, IsAsLoudAsTheVolumeSays) {
    Room room;
    LiveSound sound({}, speaker_in(room));
    ASSERT_TRUE(eventually([&] { return sound.audible(); }));
    std::vector<float> loud;
    for (const double volume : {1.0, 0.5, 0.0, 1.0}) {
        sound.set_volume(volume);
        pass(room, 0.1);
        sound.play({&thud, 1}, 0.01);
        pass(room, 0.2);
        loud.push_back(loudness(room, 0.2));
    }
    EXPECT_GT(loud[0], 0.1F);
    EXPECT_NEAR(loud[1], loud[0] / 2, 1e-3F);
    EXPECT_EQ(loud[2], 0);
    EXPECT_NEAR(loud[3], loud[0], 1e-3F);
    EXPECT_THROW(sound.set_volume(1.1), Error);
    EXPECT_THROW(sound.set_volume(std::nan("")), Error);
}

TEST(LiveSound, ChangesItsVolumeWithoutAClick) {
    Room room;
    LiveSound sound({}, speaker_in(room));
    ASSERT_TRUE(eventually([&] { return sound.audible(); }));
    Strike ring{.position = {0, 1, 0}, .mass = 512}; // at 110 Hz, for a quarter of a second
    sound.play({&ring, 1}, 0.01);
    pass(room, 0.1);
    sound.set_volume(0);
    pass(room, 0.1);
    float jump = 0;
    for (std::size_t i = 2; i < room.heard.size(); ++i) {
        if (i > 9600) jump = std::max(jump, std::abs(room.heard[i] - room.heard[i - 2]));
    }
    EXPECT_LT(jump, 0.02F); // 110 Hz and its modes at a quarter of full scale move by 0.008 from sample to sample
    EXPECT_EQ(room.heard.back(), 0);
}

TEST(LiveSound, BeginsAnotherSceneInSilence) {
    Room room;
    LiveSound sound({}, speaker_in(room));
    ASSERT_TRUE(eventually([&] { return sound.audible(); }));
    Strike ring{.position = {0, 1, 0}, .mass = 512};
    sound.play({&ring, 1}, 0.01);
    pass(room, 0.1);
    EXPECT_GT(loudness(room, 0.02), 0.01F);
    sound.begin_scene({.reference_impulse = 100});
    pass(room, 0.1);
    EXPECT_EQ(loudness(room, 0.05), 0);
    sound.play({&ring, 1}, 0.01);
    pass(room, 0.1);
    EXPECT_LT(loudness(room, 0.1), 0.1F); // as weak as it is beside this scene's
    EXPECT_GT(loudness(room, 0.1), 0.001F);
    EXPECT_THROW(sound.begin_scene({.reference_mass = -1}), Error);
}

/// Hangs where it is given something, until it may go on.
class HangingSpeaker : public Speaker {
public:
    explicit HangingSpeaker(std::atomic<bool>& hangs) : hangs_(hangs) {}
    bool has_room() override { return true; }
    void take(std::span<const float>) override {
        while (hangs_) std::this_thread::sleep_for(1ms);
        std::this_thread::sleep_for(1ms);
    }
    bool connected() override { return true; }

private:
    std::atomic<bool>& hangs_;
};

TEST(LiveSound, MakesNobodyWait) {
    std::atomic<bool> hangs = true;
    {
        LiveSound sound({}, [&hangs](int) { return std::make_unique<HangingSpeaker>(hangs); });
        ASSERT_TRUE(eventually([&] { return sound.audible(); }));
        const auto start = std::chrono::steady_clock::now();
        for (int i = 0; i < 1000; ++i) {
            sound.listen({.position = {0.0, 0.0, static_cast<double>(i)}});
            sound.play({&thud, 1}, 0.01);
            sound.set_volume(0.5);
            sound.begin_scene({});
        }
        EXPECT_LT(std::chrono::steady_clock::now() - start, 500ms);
        hangs = false;
    }
}

TEST(LiveSound, RefusesWhatASoundStageRefuses) {
    Room room;
    EXPECT_THROW(LiveSound({.rate = 1}, speaker_in(room)), Error);
    LiveSound sound({}, speaker_in(room));
    EXPECT_THROW(sound.play({}, 0), Error);
    EXPECT_THROW(sound.listen({.forward = {}}), Error);
    const Strike bad{.mass = -1};
    EXPECT_THROW(sound.play({&bad, 1}, 1), Error);
}

/// Which drivers OpenAL has is settled when it is first used, so each of these is a process of its own.
class DefaultSpeaker : public testing::Test {
protected:
    void SetUp() override { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

/// Ends the process with 0 if it goes as it should.
[[noreturn]] void play_for_a_moment() {
    ::setenv("ALSOFT_DRIVERS", "null", 1);
    const std::unique_ptr<Speaker> speaker = open_default_speaker(48000);
    const std::vector<float> block(960);
    // A second takes a second, give or take what waits in the queue.
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < 100; ++i) {
        while (!speaker->has_room()) std::this_thread::sleep_for(1ms);
        speaker->take(block);
    }
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    std::exit(speaker->connected() && seconds > 0.8 ? 0 : 1);
}

[[noreturn]] void play_to_nobody() {
    ::setenv("ALSOFT_DRIVERS", "wave", 1); // writes to a file that nobody has named
    LiveSound sound({});
    std::optional<std::string> problem;
    const bool told = eventually([&] { return (problem = sound.take_problem()).has_value(); });
    sound.play({&thud, 1}, 0.01);
    std::exit(told && *problem == "sound: there is no sound device" && !sound.audible() ? 0 : 1);
}

TEST_F(DefaultSpeaker, TakesSamplesInRealTime) { EXPECT_EXIT(play_for_a_moment(), testing::ExitedWithCode(0), ""); }

TEST_F(DefaultSpeaker, ThatIsMissingLeavesSilence) { EXPECT_EXIT(play_to_nobody(), testing::ExitedWithCode(0), ""); }

} // namespace

} // namespace carom::sound
