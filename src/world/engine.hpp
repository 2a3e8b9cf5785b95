/// \file
/// The world behind carom::World, for one precision.
#pragma once

#include "contact/pile.hpp"
#include "impact/islands.hpp"
#include "space/placement.hpp"
#include "space/state.hpp"
#include "world/clock.hpp"

#include <carom/world.hpp>

#include <optional>

namespace carom::core {

/// Windows that a step can be cut into.
inline constexpr std::uint32_t most_windows = 1'000'000;

/// What does not depend on the precision and is checked before a world is made.
struct Setting {
    WorldOptions options;
    Resolution resolution;
    Int3 origin{};       ///< units; the API's positions are relative to it
    Int3 first_origin{}; ///< units; the origin at creation: the region's, and where potential energy is zero
};

/// Throws Error naming the option that is refused.
Setting checked_setting(WorldOptions options);
/// The origin of the API in units. Throws Error{out_of_range|out_of_world}.
Int3 origin_units(const std::array<std::int64_t, 3>& origin, const Resolution& resolution);
void check_drag(const Drag& drag);

/// The functions of World, which documents them.
template <class Real>
class Engine {
public:
    /// `world_tag` marks the ids that this world gives out.
    Engine(Setting setting, std::uint16_t world_tag);
    Engine(const Engine& other);
    Engine& operator=(const Engine&) = delete;

    // engine_bodies.cpp
    std::vector<BodyId> add(const ConstBodyColumns& columns, Overlap overlap);
    void get(std::span<const BodyId> ids, const BodyColumns& columns) const;
    void set(std::span<const BodyId> ids, const ConstBodyColumns& columns, Overlap overlap);
    void remove(std::span<const BodyId> ids);
    void change_velocities(std::span<const BodyId> ids, std::span<const Vec3> changes, bool are_impulses);
    [[nodiscard]] bool contains(BodyId id) const noexcept;
    [[nodiscard]] bool held(BodyId id) const;
    [[nodiscard]] std::size_t size() const noexcept { return state_.bodies.size(); }
    [[nodiscard]] std::vector<BodyId> ids() const;

    // engine_step.cpp
    const StepReport& step(double dt);
    void positions_at(double time, std::span<const BodyId> ids, std::span<Vec3> positions) const;
    [[nodiscard]] const Clock& clock() const noexcept { return clock_; }
    [[nodiscard]] const StepReport& report() const noexcept { return report_; }
    [[nodiscard]] std::span<const Impact> impacts() const noexcept { return impacts_; }

    // engine.cpp
    [[nodiscard]] const Setting& setting() const noexcept { return setting_; }
    void set_gravity(const Vec3& gravity);
    void set_drag(const Drag& drag);
    void set_attractors(std::span<const Attractor> attractors);
    [[nodiscard]] std::span<const Attractor> attractors() const noexcept { return attractors_; }
    void set_face_motion(std::int32_t face, const FaceMotion& motion);
    [[nodiscard]] Region region() const;
    void set_origin(const std::array<std::int64_t, 3>& origin);
    void set_recording(bool record_impacts, double least_recorded_impulse);
    void set_work_cap(std::uint64_t work_cap) { setting_.options.work_cap = work_cap; }
    void set_min_windows(std::uint32_t min_windows);
    void set_serial_reference(bool serial_reference);
    void set_threads(unsigned threads);
    void set_executor(std::shared_ptr<Executor> executor);

    // engine_contacts.cpp
    [[nodiscard]] std::vector<Contact> contacts() const;
    [[nodiscard]] std::vector<double> face_forces() const;
    [[nodiscard]] std::span<const ContactChange> contact_changes() const;

    // engine_sums.cpp
    [[nodiscard]] Energy energy() const;
    [[nodiscard]] Vec3 momentum() const;
    [[nodiscard]] Vec3 angular_momentum(const Vec3& about) const;
    [[nodiscard]] Vec3 centre_of_mass() const;
    [[nodiscard]] const Ledger& ledger() const noexcept { return ledger_; }

    // snapshot.cpp
    [[nodiscard]] std::vector<std::byte> save() const;
    /// `payload` starts after the setting. Throws Error{bad_data}.
    void load(std::span<const std::byte> payload);
    [[nodiscard]] std::uint64_t hash() const;

private:
    // engine_bodies.cpp
    [[nodiscard]] Index index_of(BodyId id, std::size_t place) const;
    [[nodiscard]] std::vector<Index> indices_of(std::span<const BodyId> ids) const;
    [[nodiscard]] BodyId id_of(std::uint32_t slot) const;
    void check_values(const ConstBodyColumns& columns, std::size_t count) const;
    void check_radius(double radius, std::size_t place) const;
    void check_inside(const Motion<Real>& motion, std::size_t place) const;
    [[nodiscard]] std::vector<Int3> positions_of(const ConstBodyColumns& columns) const;
    void append(const ConstBodyColumns& columns, const std::vector<Int3>& positions);
    void drop_last(std::size_t remaining);
    void check_overlaps_of_new(std::size_t first_new);
    BodyId give_id(Index index);
    /// What a body was before it was set.
    struct Former {
        Motion<Real> motion;
        Kind kind;
        Real mass;     ///< kg
        double radius; ///< m
        double growth; ///< m/s
    };
    [[nodiscard]] std::vector<Former> formers_of(std::span<const Index> indices) const;
    [[nodiscard]] bool is_as(const Former& former, Index i) const;
    void change_kind(Index i, Kind former);
    void move_bodies(const ConstBodyColumns& columns, const std::vector<Index>& indices,
                     std::span<const Former> formers, Overlap overlap);
    void note_places(const std::vector<Index>& indices);
    void check_moved(const std::vector<Index>& indices, std::span<const Former> formers);
    void write_columns(const ConstBodyColumns& columns, const std::vector<Index>& indices);
    void set_growth(std::span<const double> rates, std::span<const Index> indices);
    [[nodiscard]] std::vector<Kind> kinds_of(std::span<const Index> indices) const;
    void wake_all_for(std::span<const Kind> kinds);
    void drop_attractors_of(BodyId id);
    [[nodiscard]] Vec3 metres_from(const Int3& zero, const Int3& x) const {
        return {metres_between(zero.x, x.x, setting_.resolution), metres_between(zero.y, x.y, setting_.resolution),
                metres_between(zero.z, x.z, setting_.resolution)};
    }
    [[nodiscard]] Vec3 api_position(const Int3& x) const { return metres_from(setting_.origin, x); }

    // engine_contacts.cpp
    [[nodiscard]] Contact contact_of(Index body, std::uint32_t code) const;
    void find_touching(std::vector<ContactChange>& touching) const;
    void note_contact_changes();
    void add_held(std::uint32_t slot, const Hold& hold, std::span<const PointField> fields,
                  std::vector<Contact>& contacts) const;

    // engine_step.cpp
    /// m/s^2, at least what the attractors do to any body.
    [[nodiscard]] double strongest_attraction() const;
    void check_step(const Census& census, double dt) const;
    void check_growth(double dt) const;
    void begin_step(double dt);
    double resolve_impacts(const Census& census, double dt);
    void tell_of_pile();
    /// Resolves the windows [from, to] of the same piece.
    Progress resolve_piece(const Census& census, const Window& all, std::uint32_t windows);
    Progress resolve_window(const Census& census, const Window& window);
    /// Drag or attractors change velocities at the ends of steps.
    [[nodiscard]] bool is_asleep() const;
    const StepReport& sleep_on(double dt);
    [[nodiscard]] bool has_kicks() const;
    void start_holds(double dt);
    /// Bodies were changed from outside.
    void forget_sums() {
        census_.reset();
        moving_mass_.reset();
    }
    [[nodiscard]] Census take_census_in_parts() const;
    [[nodiscard]] double sum_moving_mass() const;
    void report_solvers();
    void finish_bodies(double reached);
    void keep_spatial_order();
    void finish_step(double dt, double reached);
    /// As the API shows it, of a step that began at `start` (s).
    [[nodiscard]] Impact impact_of(const ImpactRecord& record, double start) const;

    // forces.cpp
    [[nodiscard]] std::vector<PointField> placed_fields() const;
    void first_kick(double duration);
    void last_kick(double duration);
    void attract(double duration);
    void drag(double duration);

    // snapshot.cpp
    template <class Archive>
    void transfer(Archive& archive, Bodies<Real>& bodies);
    void check_loaded() const;
    [[nodiscard]] bool arrays_are_sound() const;
    [[nodiscard]] bool slots_are_sound() const;
    [[nodiscard]] bool bodies_are_sound() const;
    [[nodiscard]] bool flights_are_sound() const;
    [[nodiscard]] bool holds_are_sound() const;
    [[nodiscard]] bool contacts_are_sound() const;
    [[nodiscard]] bool attractors_are_sound() const;
    [[nodiscard]] bool walls_are_sound() const;

    Setting setting_;
    std::uint16_t world_tag_;
    State<Real> state_;
    std::vector<Attractor> attractors_;
    std::vector<Int3> attractor_places_; ///< units, of those that no body carries
    Clock clock_;
    Ledger ledger_;
    StepReport report_;
    Outcome outcome_;
    std::vector<ContactChange> contact_changes_;
    std::vector<ContactChange> touched_;  ///< when the step began
    std::vector<ContactChange> touching_; ///< when it ended
    std::vector<Impact> impacts_;
    std::shared_ptr<Executor> executor_;
    Pile<Real> pile_;
    SerialSolver<Real> serial_;
    IslandSolver<Real> islands_;
    Placement<Real> placement_;
    double last_start_ = 0; ///< s, when the last step began
    double last_step_ = 0;  ///< s, how far it came
    /// Since the bodies were last put in spatial order.
    std::uint32_t steps_since_order_ = std::numeric_limits<std::uint32_t>::max();
    std::optional<Census> census_;      ///< of the bodies as they are, if they have not changed since
    std::optional<double> moving_mass_; ///< kg, of the bodies that are not static
    std::vector<Index> released_;       ///< bodies that were let go at the start of the step
};

} // namespace carom::core
