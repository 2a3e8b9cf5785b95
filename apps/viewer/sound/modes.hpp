/// \file
/// What a struck body rings like: the damped modes of a small elastic sphere.
#pragma once

#include <array>
#include <vector>

namespace carom::sound {

/// A way in which an elastic sphere vibrates.
struct Mode {
    unsigned degree = 0;    ///< of its spherical harmonic
    double wave_number = 0; ///< angular frequency * radius / speed of shear waves
};

/// The lowest spheroidal mode of each degree from 0 to 5, by pitch: a blow along the normal excites no torsional ones.
/// They solve Lamb's equation (On the vibrations of an elastic sphere, 1882) for a Poisson's ratio of 1/4.
inline constexpr std::array<Mode, 6> modes{
    {{2, 2.6398692779}, {1, 3.4245297320}, {3, 3.9163370211}, {0, 4.4399982124}, {4, 5.0093128642}, {5, 6.0326988865}}};

/// Quality factor of a body's modes by its restitution e in [0, 1]: 10 * 30^e, from a thud to a chime. Chosen by ear.
double quality(double restitution);

/// s in which the lowest mode of `pitch` (Hz) falls to 1/e. Air and what a body lies on damp low ones: at most 0.25 s.
double ring_time(double pitch, double quality);

/// A blow at time 0 on a body whose lowest mode has `pitch` (Hz), at `rate` samples a second, until it has fallen by
/// 80 dB; the largest sample is 1 or -1. It gives all modes the same velocity, so that amplitudes fall with frequency.
/// Modes above 0.4 times the rate are left out. Same bits on every machine.
std::vector<float> ring(double pitch, double quality, double rate);

} // namespace carom::sound
