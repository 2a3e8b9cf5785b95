#include "contact/rest.hpp"
#include "space/checks.hpp"
#include "space/stopwatch.hpp"
#include "world/engine.hpp"

namespace carom::core {

namespace {

/// Loops over bodies have parts of at least so many.
constexpr std::size_t body_grain = 4096;

/// Impacts of a body per m of its way, 1/m, if bodies of one size were spread evenly: the inverse of Enskog's mean free
/// path, with the contact value of Carnahan & Starling, J. Chem. Phys. 51, 635 (1969).
double impacts_per_metre(const Census& census, double volume) {
    constexpr double pi = 3.141592653589793;
    constexpr double densest = 0.6;
    const double diameter = 2 * census.mean_radius;
    const double cross_section = pi * diameter * diameter;
    const double density = static_cast<double>(census.moving) / volume;
    const double packing = std::min(density * cross_section * diameter / 6, densest);
    const double loose = 1 - packing;
    return std::sqrt(2.0) * density * cross_section * (1 - packing / 2) / (loose * loose * loose);
}

/// How many windows a step is cut into. In longer windows islands grow together, shorter ones cost more. Results do not
/// depend on it.
std::uint32_t window_count(const Census& census, const Bounds& bounds, const Resolution& resolution, double dt) {
    double windows = 1;
    if (census.moving > 1) {
        const auto side = [&](std::int64_t low, std::int64_t high) {
            return metres_between(low, high, resolution) + 2 * census.mean_radius;
        };
        const double volume =
            side(census.low.x, census.high.x) * side(census.low.y, census.high.y) * side(census.low.z, census.high.z);
        const double spacing = std::cbrt(volume / static_cast<double>(census.moving));
        const double way = census.typical_speed * dt;
        const double longest_way = std::max(census.mean_radius, spacing / 4);
        constexpr double impacts_per_window = 0.12;
        if (longest_way > 0) windows = way / longest_way;
        if (volume > 0) windows = std::max(windows, way * impacts_per_metre(census, volume) / impacts_per_window);
        // Testing all pairs once costs no more than as many windows as there are bodies.
        windows = std::clamp(windows, 1.0, static_cast<double>(census.moving));
    }
    for (int axis = 0; axis < 3; ++axis) {
        // Few periodic images to try for the fastest body.
        const double period = static_cast<double>(bounds.period(axis)) * resolution.metres;
        if (period > 0) windows = std::max(windows, census.top_speed * dt / period);
    }
    return static_cast<std::uint32_t>(std::ceil(std::min<double>(windows, most_windows)));
}

} // namespace

template <class Real>
double Engine<Real>::strongest_attraction() const {
    double sum = 0;
    for (const PointField& field : state_.laws.fields) {
        double nearest = std::numeric_limits<double>::infinity();
        for (Index i = 0; i < size(); ++i) {
            if (is_prescribed(state_.bodies.kind[i]) || state_.bodies.slot[i] == field.carrier) continue;
            const Vec3 d = to_metres(field.x - state_.bodies.motion[i].x, setting_.resolution);
            nearest = std::min(nearest, length_squared(d));
        }
        sum += std::abs(field.strength) / (nearest + field.softening * field.softening);
    }
    return sum;
}

template <class Real>
void Engine<Real>::check_step(const Census& census, double dt) const {
    const double gravity = length(state_.laws.gravity);
    const auto farthest = [](const Int3& x) {
        const auto away = [](std::int64_t c) { return std::abs(static_cast<double>(c)); };
        return std::max({away(x.x), away(x.y), away(x.z)});
    };
    const auto edge = static_cast<double>(world_edge);
    const auto end_of = [&](double distance, double speed) {
        return distance + (speed + gravity * dt) * dt * setting_.resolution.per_metre;
    };
    const double top_kick = strongest_attraction() * (0.5 * dt);
    const double all = end_of(std::max(farthest(census.low), farthest(census.high)), census.top_speed + top_kick);
    if (all < edge) return;
    for (Index i = 0; i < size(); ++i) {
        if (state_.bodies.kind[i] == Kind::fixed) continue;
        const double speed = length(velocity_of(state_.bodies.motion[i])) + length(attraction(state_, i)) * (0.5 * dt);
        const double end = end_of(farthest(state_.bodies.motion[i].x), speed);
        if (end < edge) continue;
        throw Error(ErrorCode::out_of_world, "position",
                    "would leave the world of +-" + shown(edge * setting_.resolution.metres) +
                        " m in one step (shorter ones may do); " + remedy_for(end * setting_.resolution.metres),
                    state_.bodies.slot[i]);
    }
}

template <class Real>
void Engine<Real>::check_growth(double dt) const {
    for (Index i = 0; i < state_.bodies.growth.size(); ++i) {
        if (state_.bodies.growth[i].rate == 0) continue;
        const std::size_t slot = state_.bodies.slot[i];
        const double radius = radius_at(state_.bodies, i, dt);
        if (radius < 0)
            throw Error(ErrorCode::out_of_range, "growth", "would make the radius negative in this step", slot);
        try {
            check_radius(radius, slot);
        } catch (const Error& error) {
            throw Error(ErrorCode::out_of_range, "growth",
                        std::string("would make the radius too large in this step: ") + error.what(), slot);
        }
    }
}

template <class Real>
const StepReport& Engine<Real>::step(double dt) {
    Stopwatch watch;
    check_positive(dt, "dt");
    if (dt > Clock::longest_interval) {
        throw Error(ErrorCode::out_of_range, "dt",
                    "must be at most " + shown(Clock::longest_interval) + " s, got " + shown(dt));
    }
    state_.laws.fields = placed_fields();
    if (is_asleep()) return sleep_on(dt);
    const Census census = census_ ? *census_ : take_census_in_parts();
    check_step(census, dt);
    state_.bounds.check_motion(dt, setting_.resolution);
    check_growth(dt);
    begin_step(dt);
    report_.seconds.cells += watch.lap();
    first_kick(0.5 * dt);
    start_holds(dt);
    report_.seconds.forces += watch.lap();
    keep_spatial_order();
    report_.seconds.bodies += watch.lap();
    const double reached = resolve_impacts(census, dt);
    watch.lap();
    finish_bodies(reached);
    report_.seconds.bodies += watch.lap();
    settle_holds(state_);
    last_kick(reached - 0.5 * dt);
    finish_step(dt, reached);
    report_.seconds.forces += watch.lap();
    return report_;
}

/// Whether nothing can happen.
template <class Real>
bool Engine<Real>::is_asleep() const {
    const std::vector<Kind>& kinds = state_.bodies.kind;
    return !state_.bodies.sleeping.empty() && std::all_of(kinds.begin(), kinds.end(), is_still);
}

/// A step in which nothing happens.
template <class Real>
const StepReport& Engine<Real>::sleep_on(double dt) {
    begin_step(dt);
    pile_.begin_step();
    pile_.end_step(dt);
    for (RecentFlight& recent : state_.bodies.recent_flights) recent.flight.last_impact -= dt;
    finish_step(dt, dt);
    return report_;
}

template <class Real>
bool Engine<Real>::has_kicks() const {
    const Drag& drag = setting_.options.drag;
    return drag.linear != 0 || drag.quadratic != 0 || !state_.laws.fields.empty();
}

template <class Real>
void Engine<Real>::start_holds(double dt) {
    released_.clear();
    refresh_holds(state_, dt, released_);
    for (const Index body : released_) islands_.vicinity().disturb(body);
}

template <class Real>
void Engine<Real>::begin_step(double dt) {
    report_ = {};
    placement_.forget();
    state_.bounds.begin_step(dt, setting_.resolution);
    contact_changes_.clear();
    if (setting_.options.record_contacts) find_touching(touched_);
    clear_for_reuse(impacts_);
    outcome_ = {};
    outcome_.least_impulse = setting_.options.least_recorded_impulse;
    if (setting_.options.record_impacts) {
        outcome_.record = [this, start = clock_.seconds()](const ImpactRecord& record) {
            impacts_.push_back(impact_of(record, start));
        };
    }
    state_.laws.kick_interval = dt;
    state_.laws.wears = state_.laws.gravity != Vec3{} && wears(state_);
    state_.books.held_mass_time = {};
    if (!state_.bodies.interpolating) return;
    for (Index i = 0; i < size(); ++i) state_.bodies.previous[i] = state_.bodies.motion[i].x;
}

template <class Real>
double Engine<Real>::resolve_impacts(const Census& census, double dt) {
    const std::uint32_t windows =
        std::max(setting_.options.min_windows, window_count(census, state_.bounds, setting_.resolution, dt));
    Stopwatch watch;
    const Pieces pieces = pile_.cut(dt);
    pile_.begin_step();
    Progress progress;
    bool goes_on = true;
    while (goes_on && progress.reached < dt) {
        Window piece{.from = progress.reached, .to = dt, .pieces = pieces, .piece_end = dt};
        if (pile_.is_active()) {
            piece.piece_end = piece.to = pieces.end_after(piece.from);
            piece.begins_piece = true;
            ++report_.pieces;
            pile_.begin_piece(piece.from, piece.to);
        }
        tell_of_pile();
        report_.seconds.contacts += watch.lap();
        progress = resolve_piece(census, piece, windows);
        watch.lap();
        pile_.end_piece(progress.reached);
        for (const Index body : pile_.released()) islands_.vicinity().disturb(body);
        goes_on = !progress.ends_step();
    }
    pile_.end_step(progress.reached);
    report_.seconds.contacts += watch.lap();
    report_.work_cap_reached = progress.work_cap_reached;
    report_.edge_reached = progress.edge_reached;
    report_.crushed = progress.crushed;
    report_solvers();
    return progress.reached;
}

/// Lets the islands know who of a pile may have impacts in the piece.
template <class Real>
void Engine<Real>::tell_of_pile() {
    Vicinity<Real>& vicinity = islands_.vicinity();
    vicinity.begin_piece(pile_.told_speed(), pile_.is_active());
    pile_.for_each_strike([&vicinity](Index a, Index b) {
        if (b == no_index) {
            vicinity.suspect_at_wall(a);
        } else {
            vicinity.suspect(a, b);
        }
    });
    for (const Index body : pile_.untold()) vicinity.disturb(body);
}

template <class Real>
Progress Engine<Real>::resolve_piece(const Census& census, const Window& all, std::uint32_t windows) {
    const double dt = all.step_end();
    const double share = windows * ((all.to - all.from) / dt);
    const auto count = static_cast<std::uint32_t>(std::max(1.0, std::ceil(share * (1 - 1e-9))));
    Progress progress{.reached = all.from, .until = all.to};
    double end = all.to;
    for (std::uint32_t k = 0; k < count && progress.reached < end; ++k) {
        Window window = all;
        const double share_so_far = static_cast<double>(k + 1) / count;
        window.to = std::min(end, k + 1 == count ? all.to : all.from + (all.to - all.from) * share_so_far);
        // A window ends before its time when it is worth building the lists of neighbours anew, or in a pile's piece.
        do {
            window.from = progress.reached;
            progress = resolve_window(census, window);
            window.begins_piece = false;
            end = std::min(end, progress.until);
            window.to = std::min(window.to, end);
            ++report_.windows;
        } while (progress.reached < window.to && !progress.ends_step());
        if (progress.ends_step()) break;
    }
    return progress;
}

template <class Real>
Progress Engine<Real>::resolve_window(const Census& census, const Window& window) {
    const std::uint64_t work_cap = setting_.options.work_cap;
    if (setting_.options.serial_reference) return serial_.resolve(census, window, work_cap, outcome_);
    return islands_.resolve(census, window, has_kicks(), work_cap, outcome_);
}

template <class Real>
void Engine<Real>::report_solvers() {
    const IslandCounts counts = islands_.take_counts();
    report_.candidates = counts.candidates;
    report_.islands = counts.islands;
    report_.largest_island = counts.largest;
    report_.rounds = counts.rounds;
    report_.merges = counts.merges;
    for (const SolverCosts& costs : {serial_.take_costs(), islands_.take_costs()}) {
        report_.predictions += costs.predictions;
        report_.seconds.cells += costs.seconds.cells;
        report_.seconds.pairs += costs.seconds.pairs;
        report_.seconds.impacts += costs.seconds.impacts;
    }
}

/// Brings all bodies to the end of the step, and takes their census on the way.
template <class Real>
void Engine<Real>::finish_bodies(double reached) {
    Bodies<Real>& bodies = state_.bodies;
    // What is held goes into the books, in the order of ids.
    for (const auto& [slot, hold] : bodies.holds) {
        Entry entry;
        advance(state_, bodies.slots[slot], reached, entry);
        state_.books.add(entry);
    }
    for (const std::uint32_t slot : bodies.kinematics) {
        move_on(bodies.motion[bodies.slots[slot]], {}, reached, state_.resolution);
    }
    std::array<CensusTaker, most_parts> takers{};
    const bool is_periodic = state_.bounds.any_periodic();
    for_each_in_parts(*executor_, bodies.size(), body_grain, [&](std::size_t part, std::size_t k) {
        const auto i = static_cast<Index>(k);
        prefetch_ahead(bodies.motion.data() + i);
        Motion<Real>& m = bodies.motion[i];
        if (bodies.kind[i] == Kind::free) move_on(m, state_.laws.gravity, reached, state_.resolution);
        if (is_periodic && bodies.kind[i] != Kind::fixed) m.x = state_.bounds.wrapped(m.x);
        m.t = 0;
        takers[part].count(m, bodies.kind[i]);
    });
    for (std::size_t part = 1; part < most_parts; ++part) takers[0].add(takers[part]);
    for (Index i = 0; i < bodies.growth.size(); ++i) {
        bodies.growth[i].radius += bodies.growth[i].rate * reached;
        bodies.motion[i].radius = static_cast<Real>(bodies.growth[i].radius);
    }
    census_.reset();
    if (!has_kicks()) census_ = takers[0].census();
    for (RecentFlight& recent : bodies.recent_flights) recent.flight.last_impact -= reached;
}

template <class Real>
Census Engine<Real>::take_census_in_parts() const {
    std::array<CensusTaker, most_parts> takers{};
    for_each_in_parts(*executor_, size(), body_grain, [&](std::size_t part, std::size_t i) {
        prefetch_ahead(state_.bodies.motion.data() + i);
        takers[part].count(state_.bodies.motion[i], state_.bodies.kind[i]);
    });
    for (std::size_t part = 1; part < most_parts; ++part) takers[0].add(takers[part]);
    return takers[0].census();
}

template <class Real>
double Engine<Real>::sum_moving_mass() const {
    ExactSum sum;
    for (Index i = 0; i < size(); ++i) {
        if (!is_prescribed(state_.bodies.kind[i])) sum.add(static_cast<double>(state_.bodies.mass[i]));
    }
    return sum.value();
}

template <class Real>
void Engine<Real>::keep_spatial_order() {
    // Rarely enough to cost little, often enough that neighbours stay near in memory.
    constexpr std::uint32_t least_steps = 16;
    constexpr std::uint32_t most_steps = 64;
    if (steps_since_order_ < std::numeric_limits<std::uint32_t>::max()) ++steps_since_order_;
    const bool is_cheap = setting_.options.serial_reference || islands_.vicinity().is_about_to_build();
    if (steps_since_order_ < (is_cheap ? least_steps : most_steps)) return;
    steps_since_order_ = 0;
    const Census census = take_census_in_parts();
    const double scale = std::max(4 * census.mean_radius, setting_.resolution.metres);
    const Ticks ticks(state_.bounds, setting_.resolution, scale);
    Cells& cells = setting_.options.serial_reference ? serial_.lend_cells() : islands_.vicinity().lend_cells();
    cells.build(*executor_, size(), ticks.axes(census), [&](Index i) {
        const Motion<Real>& m = state_.bodies.motion[i];
        return ticks.ball(m.x, {}, static_cast<double>(m.radius));
    });
    reorder(state_.bodies, cells.take_tiled_order());
    islands_.vicinity().forget();
}

template <class Real>
void Engine<Real>::finish_step(double dt, double reached) {
    const double start = clock_.seconds();
    if (reached > 0) clock_.advance(reached);
    islands_.vicinity().end_step(reached);
    state_.bounds.end_step(reached);
    last_start_ = start;
    last_step_ = reached;
    if (state_.laws.gravity != Vec3{}) {
        if (!moving_mass_) moving_mass_ = sum_moving_mass();
        const double free_mass_time = *moving_mass_ * reached - state_.books.held_mass_time.value();
        state_.books.outer_impulse.add(state_.laws.gravity * free_mass_time);
    }
    report_.advanced = reached;
    report_.behind = dt - reached;
    report_.impacts = outcome_.impacts;
    report_.face_impacts = outcome_.face_impacts;
    report_.tc_conversions = outcome_.tc_conversions;
    report_.held = state_.bodies.holds.size() + pile_.size();
    report_.asleep = pile_.asleep();
    if (setting_.options.record_contacts) note_contact_changes();
    report_.contacts = pile_.contacts();
    for (const auto& [slot, hold] : state_.bodies.holds) report_.contacts += hold.supports.size();
    ledger_.impacts += outcome_.impacts;
    ledger_.face_impacts += outcome_.face_impacts;
    ledger_.lost_to_restitution = state_.books.lost_to_restitution.value();
    ledger_.lost_to_friction = state_.books.lost_to_friction.value();
    ledger_.lost_to_drag = state_.books.lost_to_drag.value();
    ledger_.prescribed_work = state_.books.prescribed_work.value();
    ledger_.outer_impulse = state_.books.outer_impulse.value();
}

template <class Real>
Impact Engine<Real>::impact_of(const ImpactRecord& record, double start) const {
    const bool at_face = record.face >= 0;
    const Int3 x = state_.bounds.any_periodic() ? state_.bounds.wrapped(record.x) : record.x;
    return {.time = start + record.offset,
            .offset = record.offset,
            .a = id_of(record.a),
            .b = at_face ? BodyId{} : id_of(record.b),
            .face = record.face,
            .position = api_position(x) + record.arm,
            .normal = record.normal,
            .impulse = record.impulse,
            .approach_speed = record.approach_speed,
            .energy_lost = record.energy_lost};
}

template <class Real>
void Engine<Real>::positions_at(double time, std::span<const BodyId> ids, std::span<Vec3> positions) const {
    if (!state_.bodies.interpolating) {
        throw Error(ErrorCode::not_available, "interpolation", "the world was made without it");
    }
    check_finite(time, "time");
    const double end = clock_.seconds();
    // The time of an impact, a rounded sum, may be a little late, and time() - report().advanced a little early.
    const double slack = 2 * std::numeric_limits<double>::epsilon() * end;
    if (time > end + slack || time < last_start_ - slack) {
        throw Error(ErrorCode::out_of_range, "time",
                    "must lie in the last step, [" + shown(last_start_) + ", " + shown(end) + "] s, got " +
                        shown(time));
    }
    if (positions.size() != ids.size()) {
        throw Error(ErrorCode::size_mismatch, "positions", "must be as long as ids");
    }
    const std::vector<Index> indices = indices_of(ids);
    const double back = last_step_ > 0 ? std::clamp((end - time) / last_step_, 0.0, 1.0) : 0;
    for (std::size_t k = 0; k < indices.size(); ++k) {
        const Int3 now = state_.bodies.motion[indices[k]].x;
        const Int3 way =
            nearest_image(state_.bounds, setting_.resolution, state_.bodies.previous[indices[k]] - now, {});
        const Int3 then = now + round_to_units(to_metres(way, setting_.resolution) * back, setting_.resolution);
        positions[k] = api_position(state_.bounds.wrapped(then));
    }
}

#define CAROM_INSTANTIATE(Real)                                                                                        \
    template const StepReport& Engine<Real>::step(double);                                                             \
    template void Engine<Real>::positions_at(double, std::span<const BodyId>, std::span<Vec3>) const;
CAROM_INSTANTIATE(float)
CAROM_INSTANTIATE(double)
#undef CAROM_INSTANTIATE

} // namespace carom::core
