#include "viewer/sound/checks.hpp"

#include <cmath>
#include <cstddef>

namespace carom::sound {

namespace {

void check_finite(double value, const char* field, std::size_t index = Error::no_index) {
    if (!std::isfinite(value)) throw Error(ErrorCode::not_finite, field, "must be finite", index);
}

void check_finite(const Vec3& value, const char* field, std::size_t index = Error::no_index) {
    check_finite(value.x, field, index);
    check_finite(value.y, field, index);
    check_finite(value.z, field, index);
}

/// m: farther than any world reaches, and still a number in single precision.
constexpr double farthest = 1e15;

void check_place(const Vec3& value, const char* field, std::size_t index = Error::no_index) {
    check_finite(value, field, index);
    if (std::abs(value.x) > farthest || std::abs(value.y) > farthest || std::abs(value.z) > farthest) {
        throw Error(ErrorCode::out_of_range, field, "must be within 1e15 m", index);
    }
}

/// Long enough, and not too long, to be scaled to length 1.
bool is_direction(const Vec3& value) { return std::isnormal(length_squared(value)); }

void check_positive(double value, const char* field, std::size_t index = Error::no_index) {
    check_finite(value, field, index);
    if (!(value > 0)) throw Error(ErrorCode::out_of_range, field, "must be > 0", index);
}

void check_not_negative(double value, const char* field, std::size_t index) {
    check_finite(value, field, index);
    if (value < 0) throw Error(ErrorCode::out_of_range, field, "must be >= 0", index);
}

} // namespace

void check(const SoundSettings& settings) {
    if (settings.rate < 8000 || settings.rate > 192000) {
        throw Error(ErrorCode::out_of_range, "rate", "must be from 8000 to 192000 samples a second");
    }
    check_positive(settings.reference_mass, "reference_mass");
    check_finite(settings.reference_pitch, "reference_pitch");
    if (settings.reference_pitch < lowest_pitch || settings.reference_pitch > highest_pitch) {
        throw Error(ErrorCode::out_of_range, "reference_pitch", "must be from 110 to 7040 Hz");
    }
    check_positive(settings.reference_impulse, "reference_impulse");
    check_positive(settings.reference_distance, "reference_distance");
    check_positive(settings.speed_of_sound, "speed_of_sound");
}

void check(const Listener& listener) {
    check_place(listener.position, "position");
    check_finite(listener.forward, "forward");
    check_finite(listener.up, "up");
    check_finite(listener.velocity, "velocity");
    if (!is_direction(listener.forward)) throw Error(ErrorCode::out_of_range, "forward", "must not be zero");
    if (!is_direction(listener.up) || !is_direction(cross(listener.forward, listener.up))) {
        throw Error(ErrorCode::out_of_range, "up", "must not be zero or along forward");
    }
}

void check(std::span<const Strike> strikes) {
    for (std::size_t i = 0; i < strikes.size(); ++i) {
        const Strike& strike = strikes[i];
        check_not_negative(strike.delay, "delay", i);
        if (strike.delay > 1e6) throw Error(ErrorCode::out_of_range, "delay", "must be at most 1e6 s", i);
        check_place(strike.position, "position", i);
        check_finite(strike.velocity, "velocity", i);
        check_positive(strike.mass, "mass", i);
        check_not_negative(strike.restitution, "restitution", i);
        if (strike.restitution > 1) throw Error(ErrorCode::out_of_range, "restitution", "must be at most 1", i);
        check_not_negative(strike.impulse, "impulse", i);
    }
}

} // namespace carom::sound
