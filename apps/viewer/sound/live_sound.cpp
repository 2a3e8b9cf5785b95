#include "viewer/sound/checks.hpp"
#include "viewer/sound/sound_stage.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <thread>
#include <utility>

namespace carom::sound {

namespace {

constexpr double block_time = 0.01; ///< s, what the speaker is given at once
constexpr double latency = 0.025;   ///< s between a frame's arrival and its sound, before that of the device: it takes
                                    ///< up by how much frames come early or late
constexpr double most_ahead = 0.1;  ///< s: frames that come faster than they last are not queued beyond this
constexpr auto pause = std::chrono::milliseconds(2); ///< between two looks at a speaker without room

} // namespace

/// The thread alone opens, feeds and closes the speaker: a server of sound that hangs makes nobody else wait.
class LiveSound::Impl {
public:
    Impl(const SoundSettings& settings, OpenSpeaker open)
        : settings_(settings), open_(std::move(open)), thread_([this] { work(); }) {}

    ~Impl() {
        {
            const std::scoped_lock lock(mutex_);
            ends_ = true;
        }
        wake_.notify_one();
        thread_.join();
    }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    void listen(const Listener& listener) {
        const std::scoped_lock lock(mutex_);
        listener_ = listener;
        if (stage_) stage_->listen(listener);
    }

    void play(std::span<const Strike> strikes, double duration) {
        const std::scoped_lock lock(mutex_);
        if (!stage_) return;
        const double earliest = rendered_ + latency;
        if (next_frame_ < rendered_ || next_frame_ > earliest + most_ahead) next_frame_ = earliest;
        std::vector<Strike> moved(strikes.begin(), strikes.end());
        for (Strike& strike : moved) strike.delay += next_frame_ - rendered_;
        stage_->play(moved);
        next_frame_ += duration;
    }

    bool audible() const {
        const std::scoped_lock lock(mutex_);
        return stage_.has_value();
    }

    std::optional<std::string> take_problem() {
        const std::scoped_lock lock(mutex_);
        return std::exchange(problem_, std::nullopt);
    }

    void reopen() {
        {
            const std::scoped_lock lock(mutex_);
            wanted_ = !stage_;
        }
        wake_.notify_one();
    }

private:
    void work();
    std::unique_ptr<Speaker> open();
    void feed(Speaker& speaker);
    void fall_silent(const std::string& problem);
    bool ends() const {
        const std::scoped_lock lock(mutex_);
        return ends_;
    }

    SoundSettings settings_;
    OpenSpeaker open_;
    mutable std::mutex mutex_; ///< guards all that follows
    std::condition_variable wake_;
    bool wanted_ = true; ///< the speaker is to be opened
    bool ends_ = false;
    std::optional<SoundStage> stage_; ///< while there is a speaker
    Listener listener_;
    double rendered_ = 0;   ///< s that the stage has rendered
    double next_frame_ = 0; ///< s: when the next frame begins, if it comes in time
    std::optional<std::string> problem_;
    std::thread thread_; ///< last: all else is there when it starts
};

void LiveSound::Impl::work() {
    for (;;) {
        {
            std::unique_lock lock(mutex_);
            wake_.wait(lock, [this] { return wanted_ || ends_; });
            if (ends_) return;
            wanted_ = false;
        }
        try {
            const std::unique_ptr<Speaker> speaker = open();
            feed(*speaker);
        } catch (const std::exception& error) {
            fall_silent(error.what());
        }
    }
}

std::unique_ptr<Speaker> LiveSound::Impl::open() {
    std::unique_ptr<Speaker> speaker = open_(settings_.rate);
    SoundStage stage(settings_);
    const std::scoped_lock lock(mutex_);
    stage.listen(listener_);
    stage_.emplace(std::move(stage));
    rendered_ = 0;
    next_frame_ = 0;
    return speaker;
}

/// Renders as fast as the speaker plays, until the end or until the device has vanished.
void LiveSound::Impl::feed(Speaker& speaker) {
    const auto frames = static_cast<std::size_t>(block_time * settings_.rate);
    std::vector<float> block(2 * frames);
    while (!ends()) {
        if (!speaker.connected()) throw Error(ErrorCode::not_available, "sound", "the sound device has vanished");
        if (!speaker.has_room()) {
            std::this_thread::sleep_for(pause);
            continue;
        }
        {
            const std::scoped_lock lock(mutex_);
            stage_->render(block);
            rendered_ += static_cast<double>(frames) / settings_.rate;
        }
        speaker.take(block);
    }
}

void LiveSound::Impl::fall_silent(const std::string& problem) {
    const std::scoped_lock lock(mutex_);
    stage_.reset();
    problem_ = problem;
}

LiveSound::LiveSound(const SoundSettings& settings, OpenSpeaker open) {
    check(settings);
    impl_ = std::make_unique<Impl>(settings, std::move(open));
}
LiveSound::~LiveSound() = default;

void LiveSound::listen(const Listener& listener) {
    check(listener);
    impl_->listen(listener);
}

void LiveSound::play(std::span<const Strike> strikes, double duration) {
    check(strikes);
    if (!(duration > 0 && duration <= 1e6)) {
        throw Error(ErrorCode::out_of_range, "duration", "must be > 0 and at most 1e6 s");
    }
    impl_->play(strikes, duration);
}

bool LiveSound::audible() const { return impl_->audible(); }

std::optional<std::string> LiveSound::take_problem() { return impl_->take_problem(); }

void LiveSound::reopen() { impl_->reopen(); }

} // namespace carom::sound
