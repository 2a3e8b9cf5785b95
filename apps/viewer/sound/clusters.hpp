/// \file
/// Thousands of strikes as few sounds.
#pragma once

#include <carom/base.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace carom::sound {

/// One strike or several, as one voice plays them.
struct Sound {
    std::int64_t start = 0; ///< sample
    Vec3 position{};        ///< m
    Vec3 velocity{};        ///< m/s
    double pitch = 0;       ///< Hz, of the lowest mode, at rest
    double restitution = 1; ///< of the body
    double energy = 0;      ///< square of the amplitude at the reference distance
};

/// What matters of a listener and the medium for how loud and how high something is.
struct Ear {
    Vec3 position{};               ///< m
    Vec3 velocity{};               ///< m/s
    double reference_distance = 1; ///< m
    double speed_of_sound = 343.3; ///< m/s
};

/// By what the amplitude of something at `position` falls: OpenAL's AL_INVERSE_DISTANCE_CLAMPED.
double attenuation(const Ear& ear, const Vec3& position);

/// `velocity`, but not faster than half the speed of sound.
Vec3 subsonic(const Vec3& velocity, double speed_of_sound);

/// Frequency that arrives by frequency that left, of something at `position`: OpenAL's Doppler shift.
double doppler(const Ear& ear, const Vec3& position, const Vec3& velocity);

/// Joins sounds to as many as there are `bars`, or fewer. The loudest at the ear come first, each in turn opens a
/// cluster of its own, unless it is not told apart from one there is; the one that opens cluster i, from 0, must be
/// louder (in energy at the ear) than bars[i], which ascend. All others join the nearest. A cluster has the time, pitch
/// and ring of its loudest sound, the mean place and velocity of all, weighted by loudness, and their loudness
/// together. Takes O(sounds * clusters); a pure function, ties go by the order of `sounds`. The result is in the order
/// of start.
std::vector<Sound> join(std::span<const Sound> sounds, const Ear& ear, std::span<const double> bars, double rate);

} // namespace carom::sound
