/// \file
/// What a scene wants to have measured while it runs.
#pragma once

#include <carom/observers.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace carom::scene {

/// All that impacts tell. The mean free path takes the mean speed of the samples.
struct ImpactObserver {
    std::optional<ImpactStatistics> impacts{}; ///< not set before the first step that is observed
    Speeds speeds{1, 1};

    template <class Archive, class Self>
    static void transfer(Archive& archive, Self& self) {
        archive(self.speeds);
        if (self.impacts) archive(*self.impacts);
    }
};

using Observer = std::variant<Energies, ImpactObserver, Speeds, Profile, RadialDistribution, Coordination, SlabPacking,
                              Correlations>;
/// Their names in the file, in the order of the alternatives.
inline constexpr std::array<std::string_view, std::variant_size_v<Observer>> observer_names{
    "energies", "impacts", "speeds", "profile", "radial_distribution", "coordination", "slab_packing", "correlations"};

/// An observer, and when it looks.
struct Observation {
    std::string name;
    double from = 0;         ///< s of the world's time; earlier steps are not observed
    std::uint64_t every = 1; ///< steps from sample to sample; impacts are observed in each step
    Observer observer;
    std::uint64_t samples = 0; ///< seen so far
};

/// Lets all observers see a world that has done `step` steps.
void observe(std::span<Observation> observations, const World& world, std::uint64_t step);

/// All that they are and have seen, as bytes.
std::vector<std::byte> save_observations(std::span<const Observation> observations);

/// Lets observers, made by the same scene, go on from what was saved; `world` is where they saw it. Error{bad_data} if
/// the bytes are no such ones.
void restore_observations(std::span<Observation> observations, std::span<const std::byte> bytes, const World& world);

/// What they have seen as CSV: a line for each quantity, or for each of its values along an axis, with the standard
/// error; empty where nothing says how large that is. Of observers without a sample only that. Numbers read back
/// exactly.
std::string to_csv(std::span<const Observation> observations);

} // namespace carom::scene
