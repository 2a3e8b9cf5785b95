/// \file
/// How a scene wants to be seen: camera, its path through a film, and what a picture shows.
#pragma once

#include <carom/base.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace carom::scene {

/// Where the camera of a film is at one moment; in between it moves smoothly from key to key.
struct CameraKey {
    double time = 0;           ///< s of the world
    Vec3 position{};           ///< m
    Vec3 target{};             ///< m, in the middle of the picture
    double field_of_view = 40; ///< degrees from the lower to the upper edge
};

/// What is not set is chosen so that the whole scene is in the picture.
struct CameraSpec {
    std::optional<Vec3> position{}; ///< m
    std::optional<Vec3> target{};   ///< m
    std::optional<Vec3> up{};       ///< against gravity, or z, if not set
    double field_of_view = 40;      ///< degrees from the lower to the upper edge
    std::vector<CameraKey> path{};  ///< in ascending order of time; stands over position and target
};

/// What the colour of a body tells.
enum class ColourBy : std::uint8_t { material, speed, mass, impact_rate, temperature };
/// Their names in the file, in the order of the enumeration.
inline constexpr std::array<std::string_view, 5> colour_names{"material", "speed", "mass", "impact_rate",
                                                              "temperature"};

/// What a picture or film shows.
struct PictureSettings {
    ColourBy colour_by = ColourBy::material;
    double time_scale = 1;        ///< seconds of the world in one second of a film
    std::optional<double> moment; ///< s, when a picture is taken; at the end of the run if not set
    double trails = 0;            ///< s of the world's time that the trail of a body reaches back
    bool forces = false;          ///< draw contact forces as lines
};

struct ViewSettings {
    CameraSpec camera{};
    PictureSettings picture{};
};

} // namespace carom::scene
