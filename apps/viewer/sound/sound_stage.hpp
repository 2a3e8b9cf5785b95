/// \file
/// The sound of impacts: each body that is struck rings at the pitch of its mass, where it was struck, as loud as the
/// impulse. OpenAL Soft places and mixes it. docs/sound.md has the laws.
///
/// SoundStage renders samples, for films and tests; LiveSound plays the same on the machine's loudspeakers. Without
/// OpenAL in the build the one refuses to be made and the other is silent and says why.
#pragma once

#include <carom/base.hpp>
#include <carom/events.hpp>
#include <carom/world.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace carom::sound {

/// No more voices than this ever sound at once.
inline constexpr std::size_t most_voices = 64;

/// Hz: no body sounds lower or higher.
inline constexpr double lowest_pitch = 110;
inline constexpr double highest_pitch = 7040;

/// An impact as one of its bodies sounds.
struct Strike {
    double delay = 0;       ///< s until it is heard, 0 to 1e6
    Vec3 position{};        ///< m, where it was struck
    Vec3 velocity{};        ///< m/s of the body: moves the sound, and shifts its pitch
    double mass = 1;        ///< kg, finite, > 0: its pitch
    double restitution = 1; ///< in [0, 1]: how long it rings
    double impulse = 1;     ///< N s, >= 0: how loud it is
};

/// How a scene sounds.
struct SoundSettings {
    int rate = 48000;              ///< samples a second, 8000 to 192000
    double reference_mass = 1;     ///< kg, > 0: sounds at the reference pitch; others by mass^(-1/3), 110 to 7040 Hz
    double reference_pitch = 880;  ///< Hz, 110 to 7040
    double reference_impulse = 1;  ///< N s, > 0: a quarter of full scale; amplitudes go by its square root
    double reference_distance = 1; ///< m, > 0: farther away amplitudes fall with distance, nearer they are the same
    double speed_of_sound = 343.3; ///< m/s, > 0; nothing shifts a pitch as if faster than half of it
};

/// Where one listens from. Positions are those of the world.
struct Listener {
    Vec3 position{};       ///< m
    Vec3 forward{0, 1, 0}; ///< any length but zero
    Vec3 up{0, 0, 1};      ///< not along `forward`
    Vec3 velocity{};       ///< m/s
};

/// Settings that suit the bodies of a world as it stands: the mean of their masses' logarithms at the reference pitch,
/// the momentum of such a body at a usual speed as the reference impulse, half their extent as the reference distance.
SoundSettings settings_for(const World& world);

/// Sees all bodies of the world as it stands: on its side -y, a little above, looking at the middle.
Listener overview(const World& world);

/// What the last step's impacts sound like: a strike for each body that moves, delayed by the impact's time in the
/// step. Velocities and masses are those at the end of the step. The world must record impacts.
std::vector<Strike> strikes_of(const World& world);

/// Renders the sound of strikes to samples. The same calls give the same samples on one machine. Functions throw Error
/// on bad input, before anything has changed.
class SoundStage {
public:
    /// Throws Error{not_finite|out_of_range} naming the setting, Error{not_available} without OpenAL Soft.
    explicit SoundStage(const SoundSettings& settings);
    ~SoundStage();
    SoundStage(SoundStage&&) noexcept;
    SoundStage& operator=(SoundStage&&) noexcept;

    /// Moves the listener; what sounds already follows in 10 ms, so that a cut between cameras does not click.
    void listen(const Listener& listener);
    /// Lets strikes be heard, their delays counted from the next sample that is rendered. Any number: those that the
    /// ear does not tell apart, or that find no voice, join the nearest louder one with their energy.
    void play(std::span<const Strike> strikes);
    /// The next samples, left and right in turn, in [-1, 1]. The loudest are limited, which delays all by 1 ms.
    void render(std::span<float> samples);
    /// Voices that sound now, at most most_voices.
    [[nodiscard]] std::size_t voices() const;

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

/// Where LiveSound sends its samples. Used by one thread only, and made there.
class Speaker {
public:
    Speaker() = default;
    virtual ~Speaker() = default;
    Speaker(const Speaker&) = delete;
    Speaker& operator=(const Speaker&) = delete;

    /// True if it has room for another block.
    [[nodiscard]] virtual bool has_room() = 0;
    /// Appends a block, left and right in turn.
    virtual void take(std::span<const float> samples) = 0;
    /// False once the device has vanished.
    [[nodiscard]] virtual bool connected() = 0;
};

/// Opens the loudspeakers at `rate` samples a second. Throws Error{not_available} saying why there are none.
using OpenSpeaker = std::function<std::unique_ptr<Speaker>(int rate)>;

/// The machine's default device, through OpenAL Soft.
std::unique_ptr<Speaker> open_default_speaker(int rate);

/// Plays the sound of strikes as they come, from a thread of its own: a window that is slow for a moment does not make
/// it stutter, and no call waits for it. Without a device, or once it has vanished, it is silent and everything else
/// goes on.
class LiveSound {
public:
    /// Throws Error{not_finite|out_of_range} naming the setting.
    explicit LiveSound(const SoundSettings& settings, OpenSpeaker open = open_default_speaker);
    ~LiveSound();
    LiveSound(const LiveSound&) = delete;
    LiveSound& operator=(const LiveSound&) = delete;

    /// Another scene from now on, at the same rate: what still sounds of the one before ends.
    void begin_scene(const SoundSettings& settings);
    void listen(const Listener& listener);
    /// 0 to 1, of full scale.
    void set_volume(double volume);
    /// Plays the strikes of a frame that lasts `duration` (s, > 0). Frames follow on each other without a gap and with
    /// a constant latency, as long as they come in time; one that comes late begins at once.
    void play(std::span<const Strike> strikes, double duration);
    /// True while there is a device.
    [[nodiscard]] bool audible() const;
    /// Why there is no sound. Each problem is told once.
    std::optional<std::string> take_problem();
    /// Tries to open the device again, in the background.
    void reopen();

private:
    class Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace carom::sound
