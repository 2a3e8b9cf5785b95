#include "viewer/sound/checks.hpp"
#include "viewer/sound/sound_stage.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <thread>
#include <utility>
#include <vector>

namespace carom::sound {

namespace {

constexpr double block_time = 0.01; ///< s, what the speaker is given at once
constexpr double latency = 0.025;   ///< s between a frame's arrival and its sound, before that of the device: it takes
                                    ///< up by how much frames come early or late
constexpr double most_ahead = 0.1;  ///< s: frames that come faster than they last are not queued beyond this
constexpr std::size_t most_frames = 256;             ///< that wait for a speaker that takes nothing
constexpr auto pause = std::chrono::milliseconds(2); ///< between two looks at a speaker without room

} // namespace

/// The thread alone opens, feeds and closes the speaker, and renders: neither a server of sound that hangs nor a crowd
/// of voices makes anybody else wait. The others only leave word.
class LiveSound::Impl {
public:
    Impl(const SoundSettings& settings, OpenSpeaker open)
        : rate_(settings.rate), open_(std::move(open)), settings_(settings), thread_([this] { work(); }) {}

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

    void begin_scene(const SoundSettings& settings) {
        const std::scoped_lock lock(mutex_);
        settings_ = settings;
        settings_.rate = rate_;
        settings_changed_ = true;
        frames_.clear();
    }

    void listen(const Listener& listener) {
        const std::scoped_lock lock(mutex_);
        listener_ = listener;
    }

    void set_volume(double volume) {
        const std::scoped_lock lock(mutex_);
        volume_ = static_cast<float>(volume);
    }

    void play(std::span<const Strike> strikes, double duration) {
        const std::scoped_lock lock(mutex_);
        if (!audible_) return;
        if (frames_.size() == most_frames) frames_.erase(frames_.begin());
        frames_.push_back({{strikes.begin(), strikes.end()}, duration});
    }

    bool audible() const {
        const std::scoped_lock lock(mutex_);
        return audible_;
    }

    std::optional<std::string> take_problem() {
        const std::scoped_lock lock(mutex_);
        return std::exchange(problem_, std::nullopt);
    }

    void reopen() {
        {
            const std::scoped_lock lock(mutex_);
            wanted_ = !audible_;
        }
        wake_.notify_one();
    }

private:
    struct Frame {
        std::vector<Strike> strikes;
        double duration; ///< s
    };
    class Player;

    void work();
    void feed(Speaker& speaker);
    void fall_silent(const std::string& problem);
    bool ends() const {
        const std::scoped_lock lock(mutex_);
        return ends_;
    }

    int rate_;
    OpenSpeaker open_;
    mutable std::mutex mutex_; ///< guards all that follows, for moments only
    std::condition_variable wake_;
    bool wanted_ = true; ///< the speaker is to be opened
    bool ends_ = false;
    bool audible_ = false;
    SoundSettings settings_;
    bool settings_changed_ = false;
    Listener listener_;
    float volume_ = 1;
    std::vector<Frame> frames_; ///< that the player has not taken yet
    std::optional<std::string> problem_;
    std::thread thread_; ///< last: all else is there when it starts
};

/// Renders what was left for it, block by block.
class LiveSound::Impl::Player {
public:
    explicit Player(Impl& impl) : impl_(impl), stage_(begin()), block_(2 * block_frames()) {}

    std::span<const float> next_block() {
        take_word();
        stage_->render(block_);
        rendered_ += static_cast<double>(block_frames()) / impl_.rate_;
        set_gain();
        return block_;
    }

private:
    [[nodiscard]] std::size_t block_frames() const { return static_cast<std::size_t>(block_time * impl_.rate_); }

    SoundStage begin() {
        SoundSettings settings;
        {
            const std::scoped_lock lock(impl_.mutex_);
            impl_.settings_changed_ = false;
            settings = impl_.settings_;
            gain_ = impl_.volume_;
        }
        return SoundStage(settings);
    }

    void take_word() {
        std::vector<Frame> frames;
        Listener listener;
        std::optional<SoundSettings> settings;
        {
            const std::scoped_lock lock(impl_.mutex_);
            frames = std::exchange(impl_.frames_, {});
            listener = impl_.listener_;
            volume_ = impl_.volume_;
            if (std::exchange(impl_.settings_changed_, false)) settings = impl_.settings_;
        }
        if (settings) stage_.emplace(*settings);
        stage_->listen(listener);
        for (Frame& frame : frames) play(frame);
    }

    void play(Frame& frame) {
        const double earliest = rendered_ + latency;
        if (next_frame_ < rendered_ || next_frame_ > earliest + most_ahead) next_frame_ = earliest;
        for (Strike& strike : frame.strikes) strike.delay += next_frame_ - rendered_;
        stage_->play(frame.strikes);
        next_frame_ += frame.duration;
    }

    /// From one volume to the next within the block, so that nothing jumps.
    void set_gain() {
        const float step = (volume_ - gain_) / static_cast<float>(block_frames());
        for (std::size_t i = 0; i < block_.size(); i += 2) {
            gain_ += step;
            block_[i] *= gain_;
            block_[i + 1] *= gain_;
        }
        gain_ = volume_;
    }

    Impl& impl_;
    float volume_ = 1; ///< asked for
    float gain_ = 1;   ///< of the last sample
    std::optional<SoundStage> stage_;
    std::vector<float> block_;
    double rendered_ = 0;    ///< s that the stage has rendered
    double next_frame_ = -1; ///< s: when the next frame begins, if it comes in time; the first one is late
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
            const std::unique_ptr<Speaker> speaker = open_(rate_);
            feed(*speaker);
        } catch (const std::exception& error) {
            fall_silent(error.what());
        }
    }
}

/// Renders as fast as the speaker plays, until the end or until the device has vanished.
void LiveSound::Impl::feed(Speaker& speaker) {
    Player player(*this);
    {
        const std::scoped_lock lock(mutex_);
        audible_ = true;
    }
    while (!ends()) {
        if (!speaker.connected()) throw Error(ErrorCode::not_available, "sound", "the sound device has vanished");
        if (speaker.has_room()) {
            speaker.take(player.next_block());
        } else {
            std::this_thread::sleep_for(pause);
        }
    }
}

void LiveSound::Impl::fall_silent(const std::string& problem) {
    const std::scoped_lock lock(mutex_);
    audible_ = false;
    problem_ = problem;
}

LiveSound::LiveSound(const SoundSettings& settings, OpenSpeaker open) {
    check(settings);
    impl_ = std::make_unique<Impl>(settings, std::move(open));
}
LiveSound::~LiveSound() = default;

void LiveSound::begin_scene(const SoundSettings& settings) {
    check(settings);
    impl_->begin_scene(settings);
}

void LiveSound::set_volume(double volume) {
    if (!(volume >= 0 && volume <= 1)) throw Error(ErrorCode::out_of_range, "volume", "must be from 0 to 1");
    impl_->set_volume(volume);
}

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
