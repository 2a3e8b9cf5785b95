#include "world/snapshot.hpp"

#include "space/checks.hpp"
#include "world/archive.hpp"
#include "world/checksum.hpp"

#include <algorithm>
#include <string>

namespace carom::core {

namespace {

constexpr std::array<char, 8> snapshot_magic{'c', 'a', 'r', 'o', 'm', 's', 'n', '\n'};
constexpr std::uint32_t snapshot_version = 11;

[[noreturn]] void refuse(const std::string& reason) { throw Error(ErrorCode::bad_data, "snapshot", reason); }

std::uint64_t checksum(std::span<const std::byte> bytes) {
    Checksum sum;
    sum.add(bytes);
    return sum.value();
}

} // namespace

template <class Archive>
void transfer(Archive& archive, Surface& surface) {
    archive(surface.restitution, surface.friction);
}

template <class Archive>
void transfer(Archive& archive, FaceMotion& m) {
    archive(m.velocity, m.amplitude, m.angular_frequency, m.phase, m.surface_velocity);
}

template <class Archive>
void transfer(Archive& archive, Face& face) {
    archive(face.kind, face.surface, face.motion);
}

template <class Archive>
void transfer(Archive& archive, Plane& plane) {
    archive(plane.point, plane.normal, plane.surface, plane.motion);
}

template <class Archive>
void transfer(Archive& archive, PowerLaw& law) {
    archive(law.restitution, law.speed, law.exponent);
}

template <class Archive>
void transfer(Archive& archive, Viscoelastic& law) {
    archive(law.dissipation, law.modulus);
}

template <class Archive>
void transfer(Archive& archive, RestitutionLaw& law) {
    auto kind = static_cast<std::uint32_t>(law.index());
    archive(kind);
    if constexpr (Archive::reading) {
        if (kind > 1) refuse("names an unknown law of restitution");
        if (kind == 1) law = Viscoelastic{};
    }
    std::visit([&archive](auto& parameters) { archive(parameters); }, law);
}

template <class Archive>
void transfer(Archive& archive, Material& material) {
    archive(material.key, material.restitution);
}

template <class Archive>
void transfer(Archive& archive, MaterialRule& rule) {
    archive(rule.a, rule.b, rule.restitution, rule.friction, rule.law);
}

template <class Archive>
void transfer(Archive& archive, OpenSpace&) {
    static_cast<void>(archive);
}

template <class Archive>
void transfer(Archive& archive, Box& box) {
    archive(box.min, box.max, box.faces);
}

template <class Archive>
void transfer(Archive& archive, Shell& shell) {
    archive(shell.centre, shell.radius, shell.surface);
}

template <class Archive>
void transfer(Archive& archive, Region& region) {
    auto kind = static_cast<std::uint32_t>(region.index());
    archive(kind);
    if constexpr (Archive::reading) {
        switch (kind) {
        case 0:
            region = OpenSpace{};
            break;
        case 1:
            region = Box{};
            break;
        case 2:
            region = std::vector<Plane>{};
            break;
        case 3:
            region = Shell{};
            break;
        default:
            refuse("names an unknown kind of region");
        }
    }
    std::visit([&archive](auto& shape) { archive(shape); }, region);
}

template <class Archive>
void transfer(Archive& archive, Frustum& frustum) {
    archive(frustum.base, frustum.axis, frustum.height, frustum.base_radius, frustum.top_radius, frustum.surface,
            frustum.angular_velocity);
}

template <class Archive>
void transfer(Archive& archive, Mesh& mesh) {
    archive(mesh.vertices, mesh.triangles, mesh.surface);
}

template <class Archive>
void transfer(Archive& archive, Obstacle& obstacle) {
    auto kind = static_cast<std::uint32_t>(obstacle.index());
    archive(kind);
    if constexpr (Archive::reading) {
        if (kind > 1) refuse("names an unknown kind of obstacle");
        if (kind == 1) obstacle = Mesh{};
    }
    std::visit([&archive](auto& shape) { archive(shape); }, obstacle);
}

template <class Archive>
void transfer(Archive& archive, BodyId& id) {
    archive(id.slot, id.generation, id.world);
}

template <class Archive>
void transfer(Archive& archive, Attractor& attractor) {
    archive(attractor.position, attractor.strength, attractor.softening, attractor.body);
}

template <class Archive>
void transfer(Archive& archive, WorldOptions& o) {
    archive(o.gravity, o.region, o.obstacles, o.precision, o.resolution, o.origin, o.drag.linear, o.drag.quadratic,
            o.materials, o.material_rules, o.rest_time, o.collapse_time, o.work_cap, o.min_windows, o.serial_reference,
            o.record_impacts, o.least_recorded_impulse, o.interpolation, o.sleeping, o.record_contacts);
}

template <class Archive, class Real>
void transfer(Archive& archive, Motion<Real>& motion) {
    archive(motion.x, motion.v, motion.radius);
}

template <class Archive>
void transfer(Archive& archive, Flight& flight) {
    archive(flight.last_impact, flight.quick_impacts, flight.still_impacts, flight.still_bounces);
}

template <class Archive, class T>
void transfer(Archive& archive, Column<T>& column) {
    column.transfer(archive);
}

template <class Archive>
void transfer(Archive& archive, RecentFlight& recent) {
    archive(recent.slot, recent.flight);
}

template <class Archive>
void transfer(Archive& archive, Support& support) {
    archive(support.code, support.normal, support.bend, support.friction);
}

template <class Archive>
void transfer(Archive& archive, Hold& hold) {
    archive(hold.supports, hold.acceleration, hold.friction, hold.sticks);
}

template <class Archive>
void transfer(Archive& archive, std::map<std::uint32_t, Hold>& holds) {
    std::uint64_t count = holds.size();
    archive(count);
    if constexpr (Archive::reading) {
        for (std::uint64_t k = 0; k < count; ++k) {
            std::uint32_t slot = 0;
            archive(slot);
            archive(holds[slot]);
        }
    } else {
        for (auto& [slot, hold] : holds) {
            std::uint32_t key = slot;
            archive(key, hold);
        }
    }
}

template <class Archive>
void transfer(Archive& archive, Growth& growth) {
    archive(growth.radius, growth.rate);
}

template <class Archive>
void transfer(Archive& archive, ListedBody& listed) {
    archive(listed.slot, listed.x, listed.still, listed.is_borne);
}

template <class Archive>
void transfer(Archive& archive, ContactForce& force) {
    archive(force.a, force.code, force.normal, force.friction, force.plastic);
}

template <class Archive>
void transfer(Archive& archive, Books& books) {
    archive(books.lost_to_restitution, books.lost_to_friction, books.lost_to_drag, books.prescribed_work,
            books.outer_impulse);
}

template <class Archive>
void transfer(Archive& archive, Ledger& ledger) {
    archive(ledger.impacts, ledger.face_impacts, ledger.lost_to_restitution, ledger.lost_to_friction,
            ledger.lost_to_drag, ledger.prescribed_work, ledger.outer_impulse);
}

template <class Archive>
void transfer(Archive& archive, Clock& clock) {
    clock.transfer(archive);
}

namespace {

/// Hashes the parts of a state one after the other, in blocks.
class Hasher {
public:
    template <class... T>
    void operator()(const T&... values) {
        (put(values), ...);
    }
    template <class T>
    void vector(const T& v) {
        (*this)(v.x, v.y, v.z);
    }
    [[nodiscard]] std::uint64_t value() {
        flush();
        return sum_.value();
    }

private:
    template <Plain T>
    void put(const T& value) {
        if (used_ + sizeof(T) > block_.size()) flush();
        std::memcpy(block_.data() + used_, &value, sizeof(T));
        used_ += sizeof(T);
    }
    void flush() {
        sum_.add({block_.data(), used_});
        used_ = 0;
    }

    Checksum sum_;
    std::array<std::byte, 4096> block_{};
    std::size_t used_ = 0;
};

} // namespace

OpenedSnapshot open_snapshot(std::span<const std::byte> snapshot) {
    Reader reader(snapshot);
    std::array<char, 8> magic{};
    if (reader.left() < magic.size()) refuse("ends too early");
    reader(magic);
    if (magic != snapshot_magic) refuse("is no snapshot of carom");
    std::uint32_t version = 0;
    std::uint64_t size = 0;
    std::uint64_t sum = 0;
    reader(version, size, sum);
    if (version != snapshot_version) {
        refuse("has format version " + std::to_string(version) + ", this carom reads version " +
               std::to_string(snapshot_version));
    }
    if (reader.left() < size) refuse("ends too early");
    if (reader.left() > size) refuse("has bytes after its end");
    if (checksum(reader.rest()) != sum) refuse("was altered: its checksum does not match");
    WorldOptions options;
    OpenedSnapshot opened;
    Int3 first_origin;
    reader(options, opened.world_tag, first_origin);
    opened.setting = checked_setting(std::move(options));
    opened.setting.first_origin = first_origin;
    opened.payload = reader.rest();
    return opened;
}

template <class Real>
template <class Archive>
void Engine<Real>::transfer(Archive& archive, Bodies<Real>& b) {
    archive(b.motion, b.kind, b.slot, b.previous, b.growth, b.slots, b.generations, b.free_slots, b.holds, b.listed,
            b.contacts, b.sleeping, b.list_age, b.list_margin, b.list_edge, b.piece_rate, b.calm, b.recent_flights,
            state_.books, attractors_, attractor_places_, clock_, ledger_, last_start_, last_step_);
    b.for_each_column([&archive](auto& column) { archive(column); });
    state_.bounds.transfer_motion(archive);
}

template <class Real>
std::vector<std::byte> Engine<Real>::save() const {
    // The layout is described once, for both directions; writing changes nothing.
    auto& self = const_cast<Engine&>(*this); // NOLINT(cppcoreguidelines-pro-type-const-cast)
    Writer body;
    body(self.setting_.options, self.world_tag_, self.setting_.first_origin);
    // By ids, so that the bytes do not tell where in memory a body happens to be.
    Bodies<Real> ordered = state_.bodies;
    std::vector<Index> order;
    for (const Index i : ordered.slots) {
        if (i != no_index) order.push_back(i);
    }
    reorder(ordered, order);
    ordered.for_each_column([this](auto& column) { column.normalise(size()); });
    std::sort(ordered.listed.begin(), ordered.listed.end(),
              [](const ListedBody& a, const ListedBody& b) { return a.slot < b.slot; });
    self.transfer(body, ordered);
    const std::vector<std::byte> payload = body.take();
    Writer frame;
    std::array<char, 8> magic = snapshot_magic;
    std::uint32_t version = snapshot_version;
    std::uint64_t size = payload.size();
    std::uint64_t sum = checksum(payload);
    frame(magic, version, size, sum);
    std::vector<std::byte> bytes = frame.take();
    bytes.insert(bytes.end(), payload.begin(), payload.end());
    return bytes;
}

template <class Real>
void Engine<Real>::load(std::span<const std::byte> payload) {
    Reader reader(payload);
    transfer(reader, state_.bodies);
    if (reader.left() != 0) refuse("has bytes after its end");
    check_loaded();
    update_top_growth(state_.bodies);
    for (Index i = 0; i < size(); ++i) {
        if (state_.bodies.kind[i] == Kind::piled) state_.bodies.newly_piled = true;
        if (state_.bodies.kind[i] == Kind::kinematic) state_.bodies.kinematics.insert(state_.bodies.slot[i]);
    }
}

/// A checksum finds accidents; whoever writes a right one may still have written nonsense.
template <class Real>
void Engine<Real>::check_loaded() const {
    const bool sound = arrays_are_sound() && slots_are_sound() && bodies_are_sound() && flights_are_sound() &&
                       holds_are_sound() && contacts_are_sound() && attractors_are_sound() && walls_are_sound() &&
                       clock_.is_sound() && last_start_ >= 0 && last_step_ >= 0;
    if (!sound) refuse("contradicts itself");
}

template <class Real>
bool Engine<Real>::arrays_are_sound() const {
    const Bodies<Real>& b = state_.bodies;
    const std::size_t expected_previous = b.interpolating ? size() : 0;
    const std::size_t expected_growth = b.growth.empty() ? 0 : size();
    return b.kind.size() == size() && b.slot.size() == size() && b.previous.size() == expected_previous &&
           b.growth.size() == expected_growth && b.mass.is_sound(size()) && b.restitution.is_sound(size()) &&
           b.friction.is_sound(size()) && b.material.is_sound(size()) && b.user_data.is_sound(size());
}

template <class Real>
bool Engine<Real>::slots_are_sound() const {
    const Bodies<Real>& b = state_.bodies;
    if (b.generations.size() != b.slots.size()) return false;
    std::size_t used = 0;
    for (std::uint32_t k = 0; k < b.slots.size(); ++k) {
        const Index index = b.slots[k];
        if (index == no_index) continue;
        if (index >= size() || b.slot[index] != k) return false;
        ++used;
    }
    std::vector<bool> is_free(b.slots.size(), false);
    for (const std::uint32_t slot : b.free_slots) {
        if (slot >= b.slots.size() || b.slots[slot] != no_index || is_free[slot]) return false;
        is_free[slot] = true;
    }
    return used == size();
}

template <class Real>
bool Engine<Real>::bodies_are_sound() const {
    const Bodies<Real>& b = state_.bodies;
    for (Index i = 0; i < size(); ++i) {
        const Motion<Real>& m = b.motion[i];
        const Real mass = b.mass[i];
        for (int axis = 0; axis < 3; ++axis) {
            const std::int64_t x = component(m.x, axis);
            if (x < -flight_edge || x > flight_edge) return false;
        }
        check_finite(velocity_of(m), "velocity", i);
        check_radius(static_cast<double>(m.radius), i);
        check_finite(growth_of(b, i), "growth", i);
        if (static_cast<Real>(radius_at(b, i, 0)) != m.radius) return false;
        check_fraction(static_cast<double>(b.restitution[i]), "restitution", i);
        check_not_negative(static_cast<double>(b.friction[i]), "friction", i);
        const bool prescribed = is_prescribed(b.kind[i]);
        if (b.kind[i] > Kind::kinematic || !(mass > 0) || std::isinf(mass) != prescribed) return false;
        if (prescribed && (b.kind[i] == Kind::fixed) != (velocity_of(m) == Vec3{})) return false;
        if ((b.kind[i] == Kind::held) != b.holds.contains(b.slot[i])) return false;
    }
    return true;
}

template <class Real>
bool Engine<Real>::flights_are_sound() const {
    const Bodies<Real>& b = state_.bodies;
    for (std::size_t k = 0; k < b.recent_flights.size(); ++k) {
        const auto& [slot, flight] = b.recent_flights[k];
        check_finite(flight.last_impact, "flight", k);
        if (slot >= b.slots.size() || b.slots[slot] == no_index || flight.quick_impacts == 0) return false;
        if (k > 0 && b.recent_flights[k - 1].slot >= slot) return false;
    }
    return true;
}

template <class Real>
bool Engine<Real>::holds_are_sound() const {
    const Bodies<Real>& b = state_.bodies;
    const auto stands = [&](const Support& s) {
        check_finite(s.normal, "support");
        if (s.is_wall()) return s.wall() < state_.bounds.first_facet();
        return s.code < b.slots.size() && b.slots[s.code] != no_index && b.kind[b.slots[s.code]] == Kind::fixed;
    };
    return std::all_of(b.holds.begin(), b.holds.end(), [&](const auto& entry) {
        const auto& [slot, hold] = entry;
        check_finite(hold.acceleration, "hold");
        check_finite(hold.friction, "hold");
        const bool exists = slot < b.slots.size() && b.slots[slot] != no_index;
        return exists && !hold.supports.empty() && std::all_of(hold.supports.begin(), hold.supports.end(), stands);
    });
}

template <class Real>
bool Engine<Real>::contacts_are_sound() const {
    const Bodies<Real>& b = state_.bodies;
    check_not_negative(b.piece_rate, "piece_rate");
    check_not_negative(b.calm, "calm");
    check_not_negative(b.list_age, "list_age");
    check_not_negative(b.list_margin, "list_margin");
    const auto exists = [&b](std::uint32_t slot) { return slot < b.slots.size() && b.slots[slot] != no_index; };
    // One that was struck in the last piece is awake already, its island in the next.
    const auto sleeps = [&](std::uint32_t slot) { return exists(slot) && leans(b.kind[b.slots[slot]]); };
    const auto can_lean = [](Kind kind) { return !is_still(kind) && !is_prescribed(kind); };
    if (!b.listed.empty() && b.list_edge == 0) return false;
    std::vector<bool> is_listed(b.slots.size(), false);
    for (const ListedBody& l : b.listed) {
        check_not_negative(l.still, "listed");
        if (!exists(l.slot) || is_listed[l.slot] || !can_lean(b.kind[b.slots[l.slot]])) return false;
        is_listed[l.slot] = true;
    }
    const auto can_bear = [&](std::uint32_t slot) {
        return exists(slot) && (b.listed.empty() || is_listed[slot] || is_prescribed(b.kind[b.slots[slot]]));
    };
    const auto are_sound = [&](const std::vector<ContactForce>& contacts, const auto& is_lower, const auto& bears) {
        return std::all_of(contacts.begin(), contacts.end(), [&](const ContactForce& c) {
            check_not_negative(c.normal, "contact");
            check_finite(c.friction, "contact");
            check_not_negative(c.plastic, "contact");
            const bool is_wall = (c.code & Support::wall_bit) != 0;
            return is_lower(c.a) && (is_wall ? (c.code & ~Support::wall_bit) < state_.bounds.size() : bears(c.code));
        });
    };
    const auto is_awake = [&](std::uint32_t slot) { return can_bear(slot) && !is_prescribed(b.kind[b.slots[slot]]); };
    const auto bears_sleepers = [&](std::uint32_t slot) {
        return sleeps(slot) || (exists(slot) && is_still(b.kind[b.slots[slot]]));
    };
    return are_sound(b.contacts, is_awake, can_bear) && are_sound(b.sleeping, sleeps, bears_sleepers);
}

template <class Real>
bool Engine<Real>::attractors_are_sound() const {
    for (const Attractor& a : attractors_) {
        check_finite(a.strength, "attractor.strength");
        check_not_negative(a.softening, "attractor.softening");
        if (a.body.is_set() && !contains(a.body)) return false;
    }
    return attractor_places_.size() == attractors_.size();
}

template <class Real>
bool Engine<Real>::walls_are_sound() const {
    const auto& walls = state_.bounds.walls();
    return std::all_of(walls.begin(), walls.end(), [](const Bounds::Wall& wall) {
        return std::isfinite(wall.offset) && std::isfinite(wall.phase.value());
    });
}

template <class Real>
std::uint64_t Engine<Real>::hash() const {
    Hasher hasher;
    hasher(clock_.seconds());
    for (std::uint32_t slot = 0; slot < state_.bodies.slots.size(); ++slot) {
        const Index i = state_.bodies.slots[slot];
        if (i == no_index) continue;
        hasher(slot);
        hasher.vector(state_.bodies.motion[i].x);
        hasher.vector(state_.bodies.motion[i].v);
        if (growth_of(state_.bodies, i) != 0) hasher(state_.bodies.growth[i].radius, state_.bodies.growth[i].rate);
        if (leans(state_.bodies.kind[i])) hasher(state_.bodies.kind[i]);
        if (state_.bodies.kind[i] != Kind::held) continue;
        for (const Support& support : hold_of(state_.bodies, i).supports) hasher(support.code);
    }
    hasher(state_.bodies.piece_rate, state_.bodies.calm, state_.bodies.list_age, state_.bodies.list_margin,
           state_.bodies.list_edge);
    for (const auto* contacts : {&state_.bodies.contacts, &state_.bodies.sleeping}) {
        for (const ContactForce& c : *contacts) {
            hasher(c.a, c.code, c.normal, c.plastic);
            hasher.vector(c.friction);
        }
    }
    for (const Bounds::Wall& wall : state_.bounds.walls()) {
        if (wall.is_driven || wall.offset != 0) hasher(wall.offset, wall.phase.value());
    }
    for (const auto& [slot, flight] : state_.bodies.recent_flights) {
        hasher(slot, flight.last_impact, flight.quick_impacts, flight.still_impacts, flight.still_bounces);
    }
    return hasher.value();
}

#define CAROM_INSTANTIATE(Real)                                                                                        \
    template std::vector<std::byte> Engine<Real>::save() const;                                                        \
    template void Engine<Real>::load(std::span<const std::byte>);                                                      \
    template std::uint64_t Engine<Real>::hash() const;
CAROM_INSTANTIATE(float)
CAROM_INSTANTIATE(double)
#undef CAROM_INSTANTIATE

} // namespace carom::core
