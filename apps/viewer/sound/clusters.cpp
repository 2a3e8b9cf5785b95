#include "viewer/sound/clusters.hpp"

#include "collision/portable_math.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace carom::sound {

namespace {

/// \name What the ear tells apart
/// @{
constexpr double least_angle = std::numbers::pi / 180; ///< Mills (1958), On the minimum audible angle
constexpr double least_time = 0.002;                   ///< s: two clicks that are closer fuse (Wallach et al. 1949)
constexpr double least_octaves = 1.0 / 12;             ///< a semitone
/// @}

/// A sound as it arrives.
struct Heard {
    const Sound* sound = nullptr;
    double loudness = 0; ///< energy at the ear
    double octave = 0;   ///< logarithm of the shifted pitch to base 2
    double distance = 0; ///< m
};

struct Cluster {
    Heard loudest;
    double loudness = 0;
    Vec3 position_sum{}; ///< weighted by loudness, relative to the loudest's
    Vec3 velocity_sum{};
};

Heard hear(const Sound& sound, const Ear& ear) {
    const double gain = attenuation(ear, sound.position);
    const double pitch = sound.pitch * doppler(ear, sound.position, sound.velocity);
    return {&sound, sound.energy * gain * gain, detail::log(pitch) / std::numbers::ln2,
            std::max(length(sound.position - ear.position), ear.reference_distance)};
}

/// Square of how different two sounds are; below 1 they are not told apart.
double difference(const Heard& a, const Heard& b, double rate) {
    const double angle = length(a.sound->position - b.sound->position) / (a.distance * least_angle);
    const double time = static_cast<double>(a.sound->start - b.sound->start) / (rate * least_time);
    const double octaves = (a.octave - b.octave) / least_octaves;
    return angle * angle + time * time + octaves * octaves;
}

void add(Cluster& cluster, const Heard& heard) {
    cluster.loudness += heard.loudness;
    cluster.position_sum += heard.loudness * (heard.sound->position - cluster.loudest.sound->position);
    cluster.velocity_sum += heard.loudness * heard.sound->velocity;
}

/// As loud at the ear as all together, though their mean may lie much nearer to it than any of them.
Sound sum(const Cluster& cluster, const Ear& ear) {
    Sound sound = *cluster.loudest.sound;
    sound.position += cluster.position_sum / cluster.loudness;
    sound.velocity = cluster.velocity_sum / cluster.loudness;
    const double gain = attenuation(ear, sound.position);
    sound.energy = cluster.loudness / (gain * gain);
    return sound;
}

} // namespace

double attenuation(const Ear& ear, const Vec3& position) {
    return ear.reference_distance / std::max(length(position - ear.position), ear.reference_distance);
}

Vec3 subsonic(const Vec3& velocity, double speed_of_sound) {
    const double speed = length(velocity);
    return speed > 0.5 * speed_of_sound ? velocity * (0.5 * speed_of_sound / speed) : velocity;
}

double doppler(const Ear& ear, const Vec3& position, const Vec3& velocity) {
    const Vec3 way = ear.position - position;
    const double distance = length(way);
    if (distance == 0) return 1;
    const double of_ear = dot(subsonic(ear.velocity, ear.speed_of_sound), way) / distance;
    const double of_source = dot(subsonic(velocity, ear.speed_of_sound), way) / distance;
    return (ear.speed_of_sound - of_ear) / (ear.speed_of_sound - of_source);
}

std::vector<Sound> join(std::span<const Sound> sounds, const Ear& ear, std::span<const double> bars, double rate) {
    std::vector<Heard> heard;
    heard.reserve(sounds.size());
    for (const Sound& sound : sounds) {
        if (sound.energy > 0) heard.push_back(hear(sound, ear));
    }
    std::stable_sort(heard.begin(), heard.end(),
                     [](const Heard& a, const Heard& b) { return a.loudness > b.loudness; });

    std::vector<Cluster> clusters;
    for (const Heard& sound : heard) {
        double least = std::numeric_limits<double>::infinity();
        std::size_t nearest = 0;
        for (std::size_t i = 0; i < clusters.size(); ++i) {
            const double now = difference(sound, clusters[i].loudest, rate);
            if (now >= least) continue;
            least = now;
            nearest = i;
        }
        if (least >= 1 && clusters.size() < bars.size() && sound.loudness > bars[clusters.size()]) {
            nearest = clusters.size();
            clusters.push_back({.loudest = sound});
        }
        if (nearest < clusters.size()) add(clusters[nearest], sound);
    }

    std::vector<Sound> result;
    result.reserve(clusters.size());
    for (const Cluster& cluster : clusters) result.push_back(sum(cluster, ear));
    std::stable_sort(result.begin(), result.end(), [](const Sound& a, const Sound& b) { return a.start < b.start; });
    return result;
}

} // namespace carom::sound
