/// \file
/// The world: bodies that move and collide, every impact at its exact time and in order.
#pragma once

#include <carom/base.hpp>
#include <carom/body.hpp>
#include <carom/events.hpp>
#include <carom/executor.hpp>
#include <carom/region.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace carom {

/// How velocities, masses and radii are kept. Positions are 64-bit integers in either.
enum class Precision : std::uint8_t { single_precision, double_precision };

/// Drag slows every body that is not static: dv/dt = -(linear + quadratic |v|) v.
struct Drag {
    double linear = 0;    ///< 1/s, >= 0
    double quadratic = 0; ///< 1/m, >= 0
};

/// A softened point that attracts every body: acceleration strength * d / (|d|^2 + softening^2)^(3/2), d towards it.
/// The attraction is one-way: a body that carries an attractor feels nothing of it, nor a reaction.
struct Attractor {
    Vec3 position{};      ///< m; not used if `body` is set
    double strength = 0;  ///< m^3/s^2 (G M), any sign
    double softening = 0; ///< m, >= 0
    BodyId body{};        ///< if set, the attractor moves with this body; it ends when the body is removed
};

/// How a world is made.
struct WorldOptions {
    Vec3 gravity{};  ///< m/s^2, uniform
    Region region{}; ///< what bounds the world; open space by default
    /// What stands in it. Impact::face counts obstacles on from the faces of the region: from 6 in a box, from the
    /// number of planes, from 1 in a shell, from 0 in open space. Not together with periodic faces.
    std::vector<Obstacle> obstacles{};
    Precision precision = Precision::double_precision;
    /// m, a power of two; 0 means 2^-40 m in double (a world of +-8e6 m) and 2^-20 m in single (+-8e12 m).
    double resolution = 0;
    /// m; positions of the API are relative to this point. A multiple of the resolution.
    std::array<std::int64_t, 3> origin{};
    Drag drag{};
    std::vector<Material> materials{};          ///< those whose restitution is a law; each key once
    std::vector<MaterialRule> material_rules{}; ///< each pair once
    /// s, > 0: a touching body comes to rest when its remaining bounces would last less than this.
    double rest_time = 1.0 / 120;
    /// Piles that have lain still for half a second fall asleep, each for itself: they cost next to nothing until
    /// something meets them. What is slower than 1/1000 of gravity times rest_time lies still.
    bool sleeping = true;
    /// s, > 0: TC rule. After 8 impacts with flights shorter than this, further ones are elastic until a longer flight.
    /// Under gravity also how long bodies touch that lean on each other; longer where the resolution asks for it.
    double collapse_time = 1e-5;
    /// Impacts that one step may spend before it ends early; 0 means no cap.
    std::uint64_t work_cap = 0;
    /// How many windows a step is cut into at least, >= 1. A tuning knob: no result depends on it.
    std::uint32_t min_windows = 1;
    /// Resolve all impacts in one queue: slower, the reference that everything else is tested against.
    bool serial_reference = false;
    /// Threads that a step may use, at most most_threads; 0: one for each core. No result depends on it.
    unsigned threads = 0;
    bool record_impacts = true;
    bool record_contacts = false;      ///< keep what World::contact_changes() tells
    double least_recorded_impulse = 0; ///< N s, >= 0: weaker impacts happen but are not recorded
    /// Keep each body's position at the start of the last step, for positions_at. Costs 24 bytes a body.
    bool interpolation = false;
};

/// Bodies that move, collide and come to rest. A world is not shared between threads without a lock; distinct
/// worlds are independent. Every function throws Error on bad input, before anything has changed.
class World {
public:
    /// Throws Error{not_finite|out_of_range} naming the option.
    explicit World(WorldOptions options = {});
    ~World();
    World(World&&) noexcept;
    World& operator=(World&&) noexcept;
    World(const World& other); ///< an independent copy with the same state, hash and ids
    World& operator=(const World& other);

    /// \name Bodies in and out
    /// @{

    /// Adds as many bodies as `columns.position` has elements; the columns are equally long or empty.
    /// Errors name column and index. Ids come in the order of the columns. Costs O(1) a body.
    std::vector<BodyId> add(const ConstBodyColumns& columns, Overlap overlap = Overlap::refuse);
    /// A body with all defaults is `Body{}`: bare braces could be columns as well.
    BodyId add(const Body& body, Overlap overlap = Overlap::refuse);

    /// Writes the wanted columns; each is as long as `ids` or empty.
    void get(std::span<const BodyId> ids, const BodyColumns& columns) const;
    [[nodiscard]] Body get(BodyId id) const;

    /// Overwrites the given columns. A set velocity, position, mass or radius ends the body's rest.
    void set(std::span<const BodyId> ids, const ConstBodyColumns& columns, Overlap overlap = Overlap::refuse);
    void set(BodyId id, const Body& body, Overlap overlap = Overlap::refuse);

    /// Removes bodies; their ids become stale, and what rested on them is let go.
    void remove(std::span<const BodyId> ids);
    void remove(BodyId id);

    /// Adds impulses / masses to velocities (N s). Static bodies are refused.
    void apply_impulses(std::span<const BodyId> ids, std::span<const Vec3> impulses);
    /// Adds to velocities (m/s). Static bodies are refused.
    void change_velocities(std::span<const BodyId> ids, std::span<const Vec3> changes);

    [[nodiscard]] bool contains(BodyId id) const noexcept;
    /// True while the body rests on a face of the region or a static body, or leans on others in a pile.
    [[nodiscard]] bool held(BodyId id) const;
    /// Bodies, static ones included.
    [[nodiscard]] std::size_t size() const noexcept;
    /// All ids, in ascending order.
    [[nodiscard]] std::vector<BodyId> ids() const;
    /// @}

    /// \name Time
    /// @{

    /// Moves the world on by `dt` seconds (> 0, finite). Throws Error{out_of_world}, unchanged, if a body would
    /// leave the representable world; the error names the body's slot and the resolution to set.
    const StepReport& step(double dt);
    /// One step, or several of at most `max_dt`, to `time` (s, > time()). Returns the last step's report; stops
    /// after a step that ended early.
    const StepReport& step_until(double time, double max_dt = std::numeric_limits<double>::infinity());
    /// s since the world was made, kept without accumulating rounding.
    [[nodiscard]] double time() const noexcept;
    /// Steps done since the world was made.
    [[nodiscard]] std::uint64_t step_count() const noexcept;
    /// The last step's report.
    [[nodiscard]] const StepReport& report() const noexcept;
    /// Impacts of the last step in the order (time, ids); valid until the next step. None where they are not recorded:
    /// see set_recording().
    [[nodiscard]] std::span<const Impact> impacts() const noexcept;
    /// What rests on what at the end of the last step, and with what force: of a pile, the mean over the last piece of
    /// the step; of a held body, what its supports give now. In the order of (a, then b, then faces). The force on a
    /// face or a static body is the sum of `force * normal + friction` over its contacts. Takes O(contacts log
    /// contacts).
    [[nodiscard]] std::vector<Contact> contacts() const;
    /// N along the normal, with which contacts() press on each face of the region and obstacle, numbered as in
    /// Impact::face. Takes O(contacts).
    [[nodiscard]] std::vector<double> face_forces() const;
    /// Contacts that began or ended in the last step, in the order of (a, then b, then faces); valid until the next
    /// step. What the caller has changed or removed before it ends without a word. Error{not_available} naming
    /// `record_contacts` where WorldOptions has it false.
    [[nodiscard]] std::span<const ContactChange> contact_changes() const;
    /// Positions (m) at `time` inside the last step, on the straight line between its two ends (across a periodic
    /// face the short way): for drawing between steps. Needs WorldOptions::interpolation.
    void positions_at(double time, std::span<const BodyId> ids, std::span<Vec3> positions) const;
    /// @}

    /// \name Surroundings; changes hold from the next step on
    /// @{
    [[nodiscard]] const WorldOptions& options() const noexcept;
    /// m, the resolution in use.
    [[nodiscard]] double resolution() const noexcept;
    void set_gravity(const Vec3& gravity);
    void set_drag(const Drag& drag);
    void set_attractors(std::span<const Attractor> attractors);
    [[nodiscard]] std::span<const Attractor> attractors() const noexcept;
    /// Moves a reflecting face of a box, or a plane, in another way from now on, and from where it is; the phase is
    /// that of now. `face` as in Impact::face. A step in which a face of a box may run over the opposite one throws
    /// Error{out_of_range}, before anything has changed.
    void set_face_motion(std::int32_t face, const FaceMotion& motion);
    /// The region as it is now: with the faces where they have moved to.
    [[nodiscard]] Region region() const;
    /// Makes positions of the API relative to another point (m); nothing moves.
    void set_origin(const std::array<std::int64_t, 3>& origin);
    void set_recording(bool record_impacts, double least_recorded_impulse = 0);
    void set_work_cap(std::uint64_t work_cap);
    void set_min_windows(std::uint32_t min_windows);
    void set_serial_reference(bool serial_reference);
    /// 0: one for each core.
    void set_threads(unsigned threads);
    /// Runs steps elsewhere, say in a game's own job system; copies of the world share it. Throws Error{out_of_range}
    /// for a null pointer.
    void set_executor(std::shared_ptr<Executor> executor);
    /// @}

    /// \name Sums over all bodies that are not static, compensated
    /// @{
    [[nodiscard]] Energy energy() const;
    [[nodiscard]] Vec3 momentum() const;                               ///< kg m/s
    [[nodiscard]] Vec3 angular_momentum(const Vec3& about = {}) const; ///< kg m^2/s about a point (m)
    [[nodiscard]] Vec3 centre_of_mass() const;                         ///< m; zero without bodies that move
    [[nodiscard]] const Ledger& ledger() const noexcept;
    /// @}

    /// \name Snapshots
    /// @{

    /// The whole world as bytes: versioned, checksummed, the same on every machine.
    [[nodiscard]] std::vector<std::byte> save() const;
    /// A world that goes on bit-identically. How it is computed is no part of a snapshot: it has one thread for each
    /// core until set_threads() or set_executor() say otherwise. Throws Error{bad_data} saying what is wrong with the
    /// bytes.
    static World load(std::span<const std::byte> snapshot);
    /// 64 bits over the state by id: positions, velocities, time, collapse counters, rest. XXH64.
    [[nodiscard]] std::uint64_t hash() const;
    /// @}

private:
    struct Impl;
    explicit World(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

} // namespace carom
