/// \file
/// A scene: everything that a run starts from, as data. It is read from a TOML file (docs/scenes.md) or made by a
/// workload, and a world is made from it.
#pragma once

#include "scene/observation.hpp"
#include "scene/scene_error.hpp"
#include "scene/view.hpp"

#include <carom/body.hpp>
#include <carom/world.hpp>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace carom::scene {

/// More bodies than this are refused, so that a slip of the pen does not fill the memory.
inline constexpr std::uint64_t default_max_bodies = 100'000'000;

/// Bodies as columns that are all equally long. Units as in carom::Body.
struct BodyTable {
    std::vector<Vec3> position;
    std::vector<Vec3> velocity;
    std::vector<double> mass;
    std::vector<double> radius;
    std::vector<double> growth;
    std::vector<double> restitution;
    std::vector<double> friction;
    std::vector<std::uint32_t> material;

    [[nodiscard]] std::size_t size() const { return position.size(); }
    /// `count` bodies with the defaults of carom::Body.
    [[nodiscard]] static BodyTable of(std::size_t count);
    /// Adds the bodies of another table behind these.
    void append(const BodyTable& other);
    /// What World::add takes; valid until the table changes.
    [[nodiscard]] ConstBodyColumns columns() const;
};

/// One entry of the scene that made the bodies `first` to `first + count - 1`.
struct BodySource {
    std::string key;       ///< "bodies[2]"
    int line = 0;          ///< where the entry begins; 0 if it is from no file
    std::size_t first = 0; ///< index of its first body
    std::size_t count = 0;
};

/// An attractor of the scene; tied to a body if it has one.
struct AttractorSpec {
    Vec3 position{};                 ///< m; not used if `body` is set
    double strength = 0;             ///< m^3/s^2
    double softening = 0;            ///< m
    std::optional<std::size_t> body; ///< index of the body that carries it
    int line = 0;                    ///< where its entry begins; 0 if it is from no file
};

/// How long and in which steps to run.
struct RunSettings {
    double time = 10;                   ///< s to run; where steps are given: steps * dt
    std::optional<std::uint64_t> steps; ///< steps to run; not set where the scene gives a time
    double dt = 1.0 / 60;               ///< s per step
    unsigned threads = 0;               ///< 0: all that the machine has
};

/// What a run writes.
struct OutputSettings {
    double timeline_every = 0;   ///< s of the world's time between rows of timeline.csv; 0: a row per step
    double checkpoint_every = 0; ///< s of the world's time between checkpoints; 0: none but the one of Ctrl-C
    double bodies_every = 0;     ///< s of the world's time between tables of all bodies; 0: none
    bool energy_plot = true;     ///< write energy.svg
    bool record_impacts = false; ///< write impacts.csv
    bool check_overlap = true;   ///< search for overlaps at the end of each step (outside the timed part)
};

/// Everything that a run starts from.
struct Scene {
    std::string name;  ///< the file's name without ending, or the workload's name
    std::string title; ///< one line for people; the name where the scene gives none
    WorldOptions options;
    BodyTable bodies;
    std::vector<AttractorSpec> attractors;
    Overlap overlap = Overlap::refuse;
    RunSettings run;
    OutputSettings outputs;
    std::vector<Observation> observations; ///< none has seen anything
    ViewSettings view;
    std::uint64_t seed = 1;

    std::string file;                 ///< where it came from; empty for a workload
    std::vector<BodySource> sources;  ///< in the order of the bodies, together all of them
    std::map<std::string, int> lines; ///< line of each key of the file that is no body's, "world.gravity" -> 4
};

/// What the command line sets over what the file says.
struct Overrides {
    std::optional<double> time;         ///< s; replaces the file's `steps`
    std::optional<std::uint64_t> steps; ///< replaces the file's `time`
    std::optional<double> dt;           ///< s
    std::optional<unsigned> threads;
    std::optional<Precision> precision;
    std::optional<double> checkpoint_every; ///< s
    std::uint64_t max_bodies = default_max_bodies;
};

/// Reads a scene file. Throws SceneError naming file, line, key and what is allowed; also for a file that cannot
/// be read. Values of `overrides` are checked like the file's, under the names of the options ("--dt").
Scene load_scene(const std::filesystem::path& file, const Overrides& overrides = {});

/// The same from text; `file` is what errors call it and where relative paths in it start from.
Scene parse_scene(std::string_view text, const std::filesystem::path& file, const Overrides& overrides = {});

/// Makes the world of a scene: its bodies have ids in the order of Scene::bodies. Throws SceneError naming the
/// entry, and for an overlap both bodies.
World make_world(const Scene& scene);

} // namespace carom::scene
