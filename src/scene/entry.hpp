/// \file
/// One entry [[bodies]] of a scene file while its bodies are being made.
#pragma once

#include "scene/generators.hpp"
#include "scene/random.hpp"
#include "scene/reader.hpp"
#include "scene/scene.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace carom::scene {

/// How an entry says where its bodies are.
enum class Generator : std::uint8_t { listed, lattice, jittered_lattice, fcc, random, cloud, shell, disc, csv };
/// Their names in the file, in the order of the enumeration.
inline constexpr std::array<std::string_view, 9> generator_names{
    "listed", "lattice", "jittered_lattice", "fcc", "random", "cloud", "shell", "disc", "csv"};

/// Random numbers of an entry come from one generator per purpose, so that a change of one thing leaves the rest.
enum class Purpose : std::uint8_t { radii, positions, velocities };

/// A named material of the file. Its key in the world is its place in the list + 1; 0 is a body without one.
struct Material {
    std::string name;
    double restitution = 1;
    double friction = 0;
    std::optional<RestitutionLaw> law{}; ///< instead of `restitution`
};

/// An attractor and what other entries call it.
struct NamedAttractor {
    std::string name;
    AttractorSpec spec;
    std::optional<std::size_t> entry; ///< number of the entry whose only body carries it
};

struct Entry {
    TableReader table;
    std::size_t number; ///< its place among the entries
    std::string name{};
    Generator generator = Generator::listed;
    std::uint64_t count = 0;
    BodyTable bodies{};
    std::vector<std::string> csv_columns{};
    std::optional<Vec3> centre{}; ///< m, of a round shape or of what the bodies are around
    std::optional<Vec3> normal{}; ///< of a disc
    bool has_velocities = false;

    [[nodiscard]] double largest_radius() const {
        return *std::max_element(bodies.radius.begin(), bodies.radius.end());
    }
    [[nodiscard]] bool is_in_csv(std::string_view column) const {
        return std::find(csv_columns.begin(), csv_columns.end(), column) != csv_columns.end();
    }
    [[nodiscard]] Random random_for(std::uint64_t seed, Purpose purpose) const {
        constexpr std::uint64_t purposes = 4;
        return Random::stream(seed, purposes * number + static_cast<std::uint64_t>(purpose));
    }
    /// Finds a key that must not be given here if the entry's CSV file has the column.
    std::optional<ValueReader> find_unless_in_csv(std::string_view key, std::string_view column);
};

/// Runs a generator for an entry; what it refuses is refused under that key.
template <class Make>
auto generated(const Entry& entry, std::string_view key, const Make& make) {
    try {
        return make();
    } catch (const GeneratorError& error) {
        entry.table.fail(key, error.what());
    }
}

/// The attractor that an entry is around: the named one, or the scene's only one; null where there is none.
const NamedAttractor* find_around(Entry& entry, const std::vector<NamedAttractor>& attractors);

/// Reads the centre of a round shape: `centre`, or else the place of what the entry is around.
void read_centre(Entry& entry, const std::vector<NamedAttractor>& attractors);

} // namespace carom::scene
