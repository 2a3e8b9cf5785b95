#include "contact/rest.hpp"
#include "space/checks.hpp"
#include "world/engine.hpp"

#include <carom/collision.hpp>

namespace carom::core {

namespace {

void check_size(std::size_t size, std::size_t count, const char* field) {
    if (size == 0 || size == count) return;
    throw Error(ErrorCode::size_mismatch, field,
                "has " + std::to_string(size) + " elements, needs " + std::to_string(count) + " or none");
}

void check_sizes(const auto& columns, std::size_t count) {
    check_size(columns.position.size(), count, "position");
    check_size(columns.velocity.size(), count, "velocity");
    check_size(columns.mass.size(), count, "mass");
    check_size(columns.radius.size(), count, "radius");
    check_size(columns.growth.size(), count, "growth");
    check_size(columns.restitution.size(), count, "restitution");
    check_size(columns.friction.size(), count, "friction");
    check_size(columns.material.size(), count, "material");
    check_size(columns.user_data.size(), count, "user_data");
}

template <class T>
T element(std::span<const T> column, std::size_t k, const T& fallback) {
    return column.empty() ? fallback : column[k];
}

/// A number that the precision of the world can keep: not rounded to zero or infinity.
template <class Real>
void check_kept(double value, const char* field, std::size_t place) {
    const auto kept = static_cast<Real>(value);
    if (std::isfinite(kept) == std::isfinite(value) && (kept == 0) == (value == 0)) return;
    throw Error(ErrorCode::out_of_range, field, "does not fit the world's precision, got " + shown(value), place);
}

template <class Real>
void check_mass(double mass, std::size_t place) {
    if (std::isnan(mass)) throw Error(ErrorCode::not_finite, "mass", "must be a number, got " + shown(mass), place);
    if (!(mass > 0)) throw Error(ErrorCode::out_of_range, "mass", "must be > 0, got " + shown(mass), place);
    check_kept<Real>(mass, "mass", place);
    if (std::isfinite(static_cast<Real>(1 / mass))) return;
    throw Error(ErrorCode::out_of_range, "mass", "is too small for the world's precision, got " + shown(mass), place);
}

/// What a body of infinite mass is.
template <class Real>
Kind prescribed_kind(const Motion<Real>& motion) {
    return velocity_of(motion) == Vec3{} ? Kind::fixed : Kind::kinematic;
}

template <class Real>
bool is_finite(const Vector3<Real>& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

template <class Real>
void check_velocity(const Vec3& velocity, std::size_t place) {
    check_finite(velocity, "velocity", place);
    if (is_finite(rounded<Real>(velocity))) return;
    throw Error(ErrorCode::out_of_range, "velocity", "does not fit the world's precision", place);
}

} // namespace

template <class Real>
Index Engine<Real>::index_of(BodyId id, std::size_t place) const {
    if (!contains(id)) {
        throw Error(ErrorCode::unknown_body, "id", "there is no such body in this world", place);
    }
    return state_.bodies.slots[id.slot];
}

template <class Real>
std::vector<Index> Engine<Real>::indices_of(std::span<const BodyId> ids) const {
    std::vector<Index> indices(ids.size());
    for (std::size_t k = 0; k < ids.size(); ++k) indices[k] = index_of(ids[k], k);
    return indices;
}

template <class Real>
BodyId Engine<Real>::id_of(std::uint32_t slot) const {
    return {slot, state_.bodies.generations[slot], world_tag_};
}

template <class Real>
bool Engine<Real>::contains(BodyId id) const noexcept {
    if (id.world != world_tag_ || id.slot >= state_.bodies.slots.size()) return false;
    return state_.bodies.slots[id.slot] != no_index && state_.bodies.generations[id.slot] == id.generation;
}

template <class Real>
bool Engine<Real>::held(BodyId id) const {
    return rests(state_.bodies.kind[index_of(id, Error::no_index)]);
}

template <class Real>
std::vector<BodyId> Engine<Real>::ids() const {
    std::vector<BodyId> ids;
    ids.reserve(size());
    for (std::uint32_t slot = 0; slot < state_.bodies.slots.size(); ++slot) {
        if (state_.bodies.slots[slot] != no_index) ids.push_back(id_of(slot));
    }
    return ids;
}

template <class Real>
void Engine<Real>::check_radius(double radius, std::size_t place) const {
    check_not_negative(radius, "radius", place);
    check_kept<Real>(radius, "radius", place);
    const double half_size = static_cast<double>(world_edge) * setting_.resolution.metres;
    if (!(radius < half_size)) {
        throw Error(ErrorCode::out_of_range, "radius",
                    "must be less than the " + shown(half_size) + " m of the world, got " + shown(radius), place);
    }
    for (int axis = 0; axis < 3; ++axis) {
        const double period = static_cast<double>(state_.bounds.period(axis)) * setting_.resolution.metres;
        if (period == 0 || 4 * radius < period) continue;
        throw Error(ErrorCode::out_of_range, "radius",
                    "must be less than a quarter of the periodic side of " + shown(period) + " m, got " + shown(radius),
                    place);
    }
}

template <class Real>
void Engine<Real>::check_values(const ConstBodyColumns& columns, std::size_t count) const {
    check_sizes(columns, count);
    for (std::size_t k = 0; k < columns.velocity.size(); ++k) check_velocity<Real>(columns.velocity[k], k);
    for (std::size_t k = 0; k < columns.mass.size(); ++k) check_mass<Real>(columns.mass[k], k);
    for (std::size_t k = 0; k < columns.radius.size(); ++k) check_radius(columns.radius[k], k);
    for (std::size_t k = 0; k < columns.growth.size(); ++k) check_finite(columns.growth[k], "growth", k);
    for (std::size_t k = 0; k < columns.restitution.size(); ++k) {
        check_fraction(columns.restitution[k], "restitution", k);
    }
    for (std::size_t k = 0; k < columns.friction.size(); ++k) {
        check_not_negative(columns.friction[k], "friction", k);
        check_kept<Real>(columns.friction[k], "friction", k);
    }
}

template <class Real>
std::vector<Int3> Engine<Real>::positions_of(const ConstBodyColumns& columns) const {
    std::vector<Int3> positions(columns.position.size());
    for (std::size_t k = 0; k < positions.size(); ++k) {
        positions[k] = state_.bounds.wrapped(
            position_units(columns.position[k], setting_.resolution, setting_.origin, "position", k));
    }
    return positions;
}

template <class Real>
void Engine<Real>::check_inside(const Motion<Real>& motion, std::size_t place) const {
    const auto radius = static_cast<double>(motion.radius);
    for (const Bounds::Wall& wall : state_.bounds.walls()) {
        const double gap = state_.bounds.gap(wall, motion.x, {}, radius, 0, setting_.resolution);
        if (gap >= -touching_tolerance(state_, 2 * radius)) continue;
        throw Error(ErrorCode::overlap, "position",
                    "reaches " + shown(-gap) + " m through face " + std::to_string(wall.face) + " of the region",
                    place);
    }
    const Obstacles* obstacles = state_.bounds.obstacles();
    if (obstacles == nullptr) return;
    obstacles->for_each_near(motion.x, radius, [&](std::uint32_t facet) {
        const double gap = obstacles->impact(facet, motion.x, {}, radius).gap;
        if (gap >= -touching_tolerance(state_, 2 * radius)) return;
        throw Error(ErrorCode::overlap, "position",
                    "reaches " + shown(-gap) + " m into obstacle " + std::to_string(obstacles->obstacle_of(facet)),
                    place);
    });
}

template <class Real>
void Engine<Real>::append(const ConstBodyColumns& columns, const std::vector<Int3>& positions) {
    Bodies<Real>& bodies = state_.bodies;
    const Body standard;
    const auto real = [](std::span<const double> column, std::size_t k, double value) {
        return static_cast<Real>(element(column, k, value));
    };
    // No more than is needed, but bodies that come one by one must not move all others each time.
    bodies.for_each_array([needed = bodies.size() + positions.size()](auto& array) {
        if (array.capacity() < needed) array.reserve(std::max(needed, array.size() + array.size() / 2));
    });
    for (std::size_t k = 0; k < positions.size(); ++k) {
        const std::size_t place = bodies.size();
        const double mass = element(columns.mass, k, standard.mass);
        bodies.motion.push_back({positions[k], 0, rounded<Real>(element(columns.velocity, k, standard.velocity)),
                                 real(columns.radius, k, standard.radius)});
        bodies.slot.push_back(0);
        bodies.mass.append(static_cast<Real>(mass), place);
        bodies.kind.push_back(std::isinf(mass) ? prescribed_kind(bodies.motion.back()) : Kind::free);
        bodies.restitution.append(real(columns.restitution, k, standard.restitution), place);
        bodies.friction.append(real(columns.friction, k, standard.friction), place);
        bodies.material.append(element(columns.material, k, standard.material), place);
        bodies.user_data.append(element(columns.user_data, k, standard.user_data), place);
        if (bodies.interpolating) bodies.previous.push_back(positions[k]);
        if (!bodies.growth.empty()) bodies.growth.push_back({element(columns.radius, k, standard.radius), 0});
    }
}

/// Drops the bodies that append() added behind the first `remaining`.
template <class Real>
void Engine<Real>::drop_last(std::size_t remaining) {
    state_.bodies.for_each_array([remaining](auto& array) { array.resize(std::min(array.size(), remaining)); });
}

template <class Real>
void Engine<Real>::check_overlaps_of_new(std::size_t first_new) {
    const std::size_t end = size();
    for (std::size_t i = first_new; i < end; ++i) {
        if (!is_prescribed(state_.bodies.kind[i])) check_inside(state_.bodies.motion[i], i - first_new);
    }
    for (std::size_t i = first_new; i < end; ++i) {
        const auto other = placement_.overlapping(static_cast<Index>(i), static_cast<Index>(i));
        if (!other) continue;
        const std::string name = *other >= first_new ? "body " + std::to_string(*other - first_new) + " of this call"
                                                     : "the body in slot " + std::to_string(state_.bodies.slot[*other]);
        throw Error(ErrorCode::overlap, "position", "overlaps " + name, i - first_new);
    }
}

template <class Real>
BodyId Engine<Real>::give_id(Index index) {
    Bodies<Real>& bodies = state_.bodies;
    std::uint32_t slot = 0;
    if (bodies.free_slots.empty()) {
        slot = static_cast<std::uint32_t>(bodies.slots.size());
        bodies.generations.resize(slot + 1);
        bodies.slots.push_back(no_index);
    } else {
        slot = bodies.free_slots.back();
        bodies.free_slots.pop_back();
    }
    bodies.slots[slot] = index;
    bodies.slot[index] = slot;
    if (bodies.kind[index] == Kind::kinematic) bodies.kinematics.insert(slot);
    return id_of(slot);
}

template <class Real>
std::vector<BodyId> Engine<Real>::add(const ConstBodyColumns& columns, Overlap overlap) {
    const std::size_t count = columns.position.size();
    check_values(columns, count);
    if (count == 0) return {};
    if (columns.radius.empty()) check_radius(Body{}.radius, 0);
    islands_.vicinity().forget();
    const std::size_t first_new = size();
    forget_sums();
    constexpr std::size_t most_bodies = 0x7fffffffU;
    if (count > most_bodies - first_new) {
        throw Error(ErrorCode::out_of_range, "position", "a world has at most 2^31 - 1 bodies");
    }
    const std::vector<Int3> positions = positions_of(columns);
    std::vector<BodyId> ids(count);
    try {
        append(columns, positions);
        placement_.note(static_cast<Index>(first_new), static_cast<Index>(size() - 1));
        if (overlap == Overlap::refuse) check_overlaps_of_new(first_new);
    } catch (...) {
        drop_last(first_new);
        throw;
    }
    std::vector<Index> indices(count);
    for (std::size_t k = 0; k < count; ++k) {
        indices[k] = static_cast<Index>(first_new + k);
        ids[k] = give_id(indices[k]);
    }
    set_growth(columns.growth, indices);
    const bool has_prescribed =
        std::any_of(columns.mass.begin(), columns.mass.end(), [](double m) { return std::isinf(m); });
    if (has_prescribed) {
        wake_all(state_.bodies);
        drop_contact_list(state_.bodies);
    }
    return ids;
}

template <class Real>
void Engine<Real>::get(std::span<const BodyId> ids, const BodyColumns& columns) const {
    check_sizes(columns, ids.size());
    const std::vector<Index> indices = indices_of(ids);
    const Bodies<Real>& bodies = state_.bodies;
    const auto fill = [&indices](auto column, auto&& value_of) {
        for (std::size_t k = 0; k < column.size(); ++k) column[k] = value_of(indices[k]);
    };
    fill(columns.position, [&](Index i) { return api_position(bodies.motion[i].x); });
    fill(columns.velocity, [&](Index i) { return velocity_of(bodies.motion[i]); });
    fill(columns.mass, [&](Index i) { return static_cast<double>(bodies.mass[i]); });
    fill(columns.radius, [&](Index i) { return radius_at(bodies, i, 0); });
    fill(columns.growth, [&](Index i) { return growth_of(bodies, i); });
    fill(columns.restitution, [&](Index i) { return static_cast<double>(bodies.restitution[i]); });
    fill(columns.friction, [&](Index i) { return static_cast<double>(bodies.friction[i]); });
    fill(columns.material, [&](Index i) { return bodies.material[i]; });
    fill(columns.user_data, [&](Index i) { return bodies.user_data[i]; });
}

template <class Real>
void Engine<Real>::note_places(const std::vector<Index>& indices) {
    for (const Index i : indices) placement_.note(i, i);
}

/// What lies somewhere has sunk in a little: only what has come there or has grown is asked.
template <class Real>
void Engine<Real>::check_moved(const std::vector<Index>& indices, std::span<const Former> formers) {
    for (std::size_t k = 0; k < indices.size(); ++k) {
        const Motion<Real>& m = state_.bodies.motion[indices[k]];
        const bool is_let_loose = is_prescribed(formers[k].kind) && !is_prescribed(state_.bodies.kind[indices[k]]);
        if (m.x == formers[k].motion.x && !(m.radius > formers[k].motion.radius) && !is_let_loose) continue;
        if (!is_prescribed(state_.bodies.kind[indices[k]])) check_inside(m, k);
        const auto other = placement_.overlapping(indices[k], static_cast<Index>(size()));
        if (!other) continue;
        throw Error(ErrorCode::overlap, "position",
                    "overlaps the body in slot " + std::to_string(state_.bodies.slot[*other]), k);
    }
}

template <class Real>
auto Engine<Real>::formers_of(std::span<const Index> indices) const -> std::vector<Former> {
    std::vector<Former> formers;
    formers.reserve(indices.size());
    const Bodies<Real>& bodies = state_.bodies;
    for (const Index i : indices) {
        formers.push_back(
            {bodies.motion[i], bodies.kind[i], bodies.mass[i], radius_at(bodies, i, 0), growth_of(bodies, i)});
    }
    return formers;
}

/// Whether a body moves as before, as far as that was written. Its kind tells of nothing else.
template <class Real>
bool Engine<Real>::is_as(const Former& former, Index i) const {
    const Bodies<Real>& bodies = state_.bodies;
    return former.motion.x == bodies.motion[i].x && former.motion.v == bodies.motion[i].v &&
           former.mass == bodies.mass[i] && former.radius == radius_at(bodies, i, 0) &&
           former.growth == growth_of(bodies, i);
}

template <class Real>
void Engine<Real>::move_bodies(const ConstBodyColumns& columns, const std::vector<Index>& indices,
                               std::span<const Former> formers, Overlap overlap) {
    if (columns.position.empty() && columns.radius.empty() && columns.mass.empty()) return;
    islands_.vicinity().forget();
    Bodies<Real>& bodies = state_.bodies;
    const std::vector<Int3> positions = positions_of(columns);
    for (std::size_t k = 0; k < indices.size(); ++k) {
        const Index i = indices[k];
        if (!positions.empty()) bodies.motion[i].x = positions[k];
        if (!columns.radius.empty()) bodies.motion[i].radius = static_cast<Real>(columns.radius[k]);
        if (columns.mass.empty() || std::isinf(columns.mass[k]) == is_prescribed(bodies.kind[i])) continue;
        bodies.kind[i] = std::isinf(columns.mass[k]) ? Kind::fixed : Kind::free;
    }
    note_places(indices);
    try {
        if (overlap == Overlap::refuse) check_moved(indices, formers);
    } catch (...) {
        for (std::size_t k = indices.size(); k-- > 0;) {
            bodies.motion[indices[k]] = formers[k].motion;
            bodies.kind[indices[k]] = formers[k].kind;
        }
        note_places(indices);
        throw;
    }
    if (!bodies.interpolating) return;
    for (std::size_t k = 0; k < positions.size(); ++k) bodies.previous[indices[k]] = positions[k];
}

template <class Real>
void Engine<Real>::write_columns(const ConstBodyColumns& columns, const std::vector<Index>& indices) {
    Bodies<Real>& bodies = state_.bodies;
    const auto write = [&indices](auto column, auto&& writer) {
        for (std::size_t k = 0; k < column.size(); ++k) writer(indices[k], column[k]);
    };
    write(columns.velocity, [&](Index i, const Vec3& v) { bodies.motion[i].v = rounded<Real>(v); });
    write(columns.mass, [&](Index i, double mass) { bodies.mass.set(i, static_cast<Real>(mass), bodies.size()); });
    if (!bodies.growth.empty()) {
        write(columns.radius, [&](Index i, double radius) { bodies.growth[i].radius = radius; });
    }
    set_growth(columns.growth, indices);
    write(columns.restitution, [&](Index i, double e) { bodies.restitution.set(i, static_cast<Real>(e), size()); });
    write(columns.friction, [&](Index i, double mu) { bodies.friction.set(i, static_cast<Real>(mu), size()); });
    write(columns.material, [&](Index i, std::uint32_t key) { bodies.material.set(i, key, size()); });
    write(columns.user_data, [&](Index i, std::uint64_t data) { bodies.user_data.set(i, data, size()); });
}

/// All radii are kept as those that grow if one of them grows.
template <class Real>
void Engine<Real>::set_growth(std::span<const double> rates, std::span<const Index> indices) {
    Bodies<Real>& bodies = state_.bodies;
    const bool one_grows = std::any_of(rates.begin(), rates.end(), [](double rate) { return rate != 0; });
    if (rates.empty() || (bodies.growth.empty() && !one_grows)) return;
    islands_.vicinity().forget();
    for (std::size_t i = bodies.growth.size(); i < size(); ++i) {
        bodies.growth.push_back({static_cast<double>(bodies.motion[i].radius), 0});
    }
    for (std::size_t k = 0; k < rates.size(); ++k) bodies.growth[indices[k]].rate = rates[k];
    update_top_growth(bodies);
}

template <class Real>
void Engine<Real>::set(std::span<const BodyId> ids, const ConstBodyColumns& columns, Overlap overlap) {
    check_values(columns, ids.size());
    const std::vector<Index> indices = indices_of(ids);
    forget_sums();
    const std::vector<Former> formers = formers_of(indices);
    move_bodies(columns, indices, formers, overlap);
    write_columns(columns, indices);
    const bool meets_otherwise = !columns.restitution.empty() || !columns.friction.empty() || !columns.material.empty();
    std::vector<std::size_t> changed;
    for (std::size_t k = 0; k < indices.size(); ++k) {
        if (!is_as(formers[k], indices[k])) changed.push_back(k);
    }
    if (changed.empty() && !meets_otherwise) return;
    if (std::any_of(formers.begin(), formers.end(), [](const Former& f) { return is_still(f.kind); })) {
        wake_all(state_.bodies);
    }
    const bool moved =
        !columns.position.empty() || !columns.radius.empty() || !columns.mass.empty() || !columns.growth.empty();
    if (moved || meets_otherwise) drop_contact_list(state_.bodies);
    for (const std::size_t k : changed) change_kind(indices[k], formers[k].kind);
}

/// A body that moves in another way than before, when it was of a former kind: its rest ends, and that of others on it.
template <class Real>
void Engine<Real>::change_kind(Index i, Kind former) {
    Bodies<Real>& bodies = state_.bodies;
    const std::uint32_t slot = bodies.slot[i];
    islands_.vicinity().disturb(i);
    Kind& kind = bodies.kind[i];
    if (rests(kind)) kind = Kind::free;
    if (is_prescribed(kind)) kind = prescribed_kind(bodies.motion[i]);
    if (former == Kind::fixed) release_from(bodies, slot);
    if (former == Kind::held) bodies.holds.erase(slot);
    if (former == Kind::kinematic) bodies.kinematics.erase(slot);
    if (kind == Kind::kinematic) bodies.kinematics.insert(slot);
    if (kind == former || !is_prescribed(kind)) return;
    drop_contacts_of(bodies, slot);
    islands_.vicinity().forget();
}

template <class Real>
void Engine<Real>::remove(std::span<const BodyId> ids) {
    static_cast<void>(indices_of(ids));
    std::vector<BodyId> sorted(ids.begin(), ids.end());
    std::sort(sorted.begin(), sorted.end());
    if (const auto twice = std::adjacent_find(sorted.begin(), sorted.end()); twice != sorted.end()) {
        const auto last = std::find(ids.rbegin(), ids.rend(), *twice);
        throw Error(ErrorCode::unknown_body, "id", "the body is named twice",
                    static_cast<std::size_t>(ids.rend() - last) - 1);
    }
    islands_.vicinity().forget();
    wake_all_for(kinds_of(indices_of(ids)));
    for (const BodyId id : ids) {
        forget_sums();
        const Index index = state_.bodies.slots[id.slot];
        if (state_.bodies.kind[index] == Kind::fixed) release_from(state_.bodies, id.slot);
        drop_attractors_of(id);
        remove_body(state_.bodies, index);
        if (index < size()) placement_.note(index, index);
    }
    drop_stale_contacts(state_.bodies);
    update_top_growth(state_.bodies);
}

template <class Real>
std::vector<Kind> Engine<Real>::kinds_of(std::span<const Index> indices) const {
    std::vector<Kind> kinds(indices.size());
    for (std::size_t k = 0; k < kinds.size(); ++k) kinds[k] = state_.bodies.kind[indices[k]];
    return kinds;
}

/// Wakes everybody if one of some bodies was asleep, or others may lie on it.
template <class Real>
void Engine<Real>::wake_all_for(std::span<const Kind> kinds) {
    if (std::any_of(kinds.begin(), kinds.end(), is_still)) wake_all(state_.bodies);
}

template <class Real>
void Engine<Real>::drop_attractors_of(BodyId id) {
    for (std::size_t k = attractors_.size(); k-- > 0;) {
        if (attractors_[k].body != id) continue;
        attractors_.erase(attractors_.begin() + static_cast<std::ptrdiff_t>(k));
        attractor_places_.erase(attractor_places_.begin() + static_cast<std::ptrdiff_t>(k));
    }
}

template <class Real>
void Engine<Real>::change_velocities(std::span<const BodyId> ids, std::span<const Vec3> changes, bool are_impulses) {
    const char* field = are_impulses ? "impulses" : "changes";
    if (changes.size() != ids.size()) {
        throw Error(ErrorCode::size_mismatch, field,
                    "has " + std::to_string(changes.size()) + " elements, needs " + std::to_string(ids.size()));
    }
    const std::vector<Index> indices = indices_of(ids);
    Bodies<Real>& bodies = state_.bodies;
    for (std::size_t k = 0; k < indices.size(); ++k) {
        check_finite(changes[k], field, k);
        if (!is_prescribed(bodies.kind[indices[k]])) continue;
        const bool is_static = bodies.kind[indices[k]] == Kind::fixed;
        throw Error(ErrorCode::out_of_range, "id", is_static ? "the body is static" : "the body is kinematic", k);
    }
    std::vector<Vector3<Real>> formers(indices.size());
    forget_sums();
    for (std::size_t k = 0; k < indices.size(); ++k) {
        Motion<Real>& m = bodies.motion[indices[k]];
        formers[k] = m.v;
        const double divisor = are_impulses ? static_cast<double>(bodies.mass[indices[k]]) : 1;
        m.v = rounded<Real>(velocity_of(m) + changes[k] / divisor);
        if (is_finite(m.v)) continue;
        // A body may be named more than once: the last change is undone first.
        for (std::size_t j = k + 1; j-- > 0;) bodies.motion[indices[j]].v = formers[j];
        throw Error(ErrorCode::out_of_range, field, "the velocity does not fit the world's precision", k);
    }
    wake_all_for(kinds_of(indices));
    for (const Index i : indices) {
        let_go(bodies, i);
        islands_.vicinity().disturb(i);
    }
}

#define CAROM_INSTANTIATE(Real)                                                                                        \
    template std::vector<BodyId> Engine<Real>::add(const ConstBodyColumns&, Overlap);                                  \
    template void Engine<Real>::get(std::span<const BodyId>, const BodyColumns&) const;                                \
    template void Engine<Real>::set(std::span<const BodyId>, const ConstBodyColumns&, Overlap);                        \
    template void Engine<Real>::remove(std::span<const BodyId>);                                                       \
    template void Engine<Real>::change_velocities(std::span<const BodyId>, std::span<const Vec3>, bool);               \
    template bool Engine<Real>::contains(BodyId) const noexcept;                                                       \
    template bool Engine<Real>::held(BodyId) const;                                                                    \
    template std::vector<BodyId> Engine<Real>::ids() const;                                                            \
    template BodyId Engine<Real>::id_of(std::uint32_t) const;                                                          \
    template std::vector<Index> Engine<Real>::indices_of(std::span<const BodyId>) const;
CAROM_INSTANTIATE(float)
CAROM_INSTANTIATE(double)
#undef CAROM_INSTANTIATE

} // namespace carom::core
