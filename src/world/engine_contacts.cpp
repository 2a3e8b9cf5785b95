#include "contact/rest.hpp"
#include "space/sum.hpp"
#include "world/engine.hpp"

#include <carom/collision.hpp>

#include <algorithm>
#include <array>
#include <tuple>

namespace carom::core {

namespace {

/// The parts >= 0 along the supports' normals (N) that come nearest to `push` together: Gauss and Seidel.
std::array<double, 3> share_out(const Vec3& push, const std::vector<Support>& supports) {
    constexpr int sweeps = 64;
    std::array<double, 3> shares{};
    Vec3 left = push;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        for (std::size_t k = 0; k < supports.size(); ++k) {
            const double change = std::max(dot(left, supports[k].normal), -shares.at(k));
            shares.at(k) += change;
            left -= supports[k].normal * change;
        }
    }
    return shares;
}

/// The order of contacts. A face's id is not set, which is the last of all.
constexpr auto comes_before = [](const auto& x, const auto& y) {
    return std::tuple(x.a.slot, x.b.slot, x.face) < std::tuple(y.a.slot, y.b.slot, y.face);
};

} // namespace

/// Where and against what a body touches, without the force.
template <class Real>
Contact Engine<Real>::contact_of(Index body, std::uint32_t code) const {
    const Motion<Real>& m = state_.bodies.motion[body];
    Contact contact{.a = id_of(state_.bodies.slot[body])};
    if ((code & Support::wall_bit) != 0) {
        const std::uint32_t wall = code & ~Support::wall_bit;
        contact.face = state_.bounds.face(wall);
        contact.normal = state_.bounds.contact(wall, m.x, static_cast<double>(m.radius), 0, state_.resolution).normal;
    } else {
        contact.b = id_of(code);
        const Motion<Real>& other = state_.bodies.motion[state_.bodies.slots[code]];
        contact.normal = contact_normal(separation(state_, m, other, {}, {}), Vec3{});
    }
    contact.position = api_position(m.x) + contact.normal * static_cast<double>(m.radius);
    return contact;
}

/// What the supports of a held body give: all that presses it on, but what is left to move it.
template <class Real>
void Engine<Real>::add_held(std::uint32_t slot, const Hold& hold, std::span<const PointField> fields,
                            std::vector<Contact>& contacts) const {
    const Index body = state_.bodies.slots[slot];
    const auto mass = static_cast<double>(state_.bodies.mass[body]);
    const Motion<Real>& m = state_.bodies.motion[body];
    Vec3 push = (state_.laws.gravity + attraction(fields, state_.resolution, m.x, slot)) * mass;
    for (const Support& s : hold.supports) push += s.normal * (s.bend * length_squared(velocity_of(m)) * mass);
    const std::array<double, 3> shares = share_out(push, hold.supports);
    double all = 0;
    for (const double share : shares) all += share;
    for (std::size_t k = 0; k < hold.supports.size(); ++k) {
        if (!(shares.at(k) > 0)) continue;
        Contact& contact = contacts.emplace_back(contact_of(body, hold.supports[k].code));
        contact.force = shares.at(k);
        contact.friction = hold.friction * (-mass * shares.at(k) / all);
    }
}

template <class Real>
std::vector<Contact> Engine<Real>::contacts() const {
    std::vector<Contact> contacts;
    contacts.reserve(state_.bodies.contacts.size() + state_.bodies.holds.size());
    for (const auto* forces : {&state_.bodies.contacts, &state_.bodies.sleeping}) {
        for (const ContactForce& force : *forces) {
            if (!(force.normal > 0)) continue;
            const Index body = state_.bodies.slots[force.a];
            if (!leans(state_.bodies.kind[body])) continue;
            Contact& contact = contacts.emplace_back(contact_of(body, force.code));
            contact.force = force.normal;
            contact.friction = force.friction;
        }
    }
    const std::vector<PointField> fields = placed_fields();
    for (const auto& [slot, hold] : state_.bodies.holds) add_held(slot, hold, fields, contacts);
    // A body may touch an obstacle in several places.
    std::stable_sort(contacts.begin(), contacts.end(), comes_before);
    return contacts;
}

/// The same as the sum over contacts(), without their places and order.
template <class Real>
std::vector<double> Engine<Real>::face_forces() const {
    const auto faces = static_cast<std::size_t>(state_.bounds.first_obstacle()) + setting_.options.obstacles.size();
    std::vector<ExactSum> sums(faces);
    const auto add = [&](std::int32_t face, double force) { sums[static_cast<std::size_t>(face)].add(force); };
    for (const auto* forces : {&state_.bodies.contacts, &state_.bodies.sleeping}) {
        for (const ContactForce& force : *forces) {
            const bool is_on_wall = (force.code & Support::wall_bit) != 0;
            if (!is_on_wall || !leans(state_.bodies.kind[state_.bodies.slots[force.a]])) continue;
            add(state_.bounds.face(force.code & ~Support::wall_bit), force.normal);
        }
    }
    std::vector<Contact> held;
    const std::vector<PointField> fields = placed_fields();
    for (const auto& [slot, hold] : state_.bodies.holds) add_held(slot, hold, fields, held);
    for (const Contact& contact : held) {
        if (contact.face >= 0) add(contact.face, contact.force);
    }
    std::vector<double> forces(faces);
    std::transform(sums.begin(), sums.end(), forces.begin(), [](const ExactSum& sum) { return sum.value(); });
    return forces;
}

template <class Real>
std::span<const ContactChange> Engine<Real>::contact_changes() const {
    if (setting_.options.record_contacts) return contact_changes_;
    throw Error(ErrorCode::not_available, "record_contacts", "must be true to tell changes of contacts, got false");
}

/// Whom a step finds in contact, in the order of contacts().
template <class Real>
void Engine<Real>::find_touching(std::vector<ContactChange>& touching) const {
    touching.clear();
    for (const Contact& contact : contacts()) touching.push_back({contact.a, contact.b, contact.face});
    touching.erase(std::unique(touching.begin(), touching.end()), touching.end());
}

/// What has changed since the step began.
template <class Real>
void Engine<Real>::note_contact_changes() {
    find_touching(touching_);
    const auto take = [this](ContactChange change, bool has_begun) {
        change.has_begun = has_begun;
        contact_changes_.push_back(change);
    };
    auto before = touched_.begin();
    auto now = touching_.begin();
    while (before != touched_.end() || now != touching_.end()) {
        if (now == touching_.end() || (before != touched_.end() && comes_before(*before, *now))) {
            take(*before++, false);
        } else if (before == touched_.end() || comes_before(*now, *before)) {
            take(*now++, true);
        } else {
            ++before;
            ++now;
        }
    }
}

template Contact Engine<float>::contact_of(Index, std::uint32_t) const;
template Contact Engine<double>::contact_of(Index, std::uint32_t) const;
template void Engine<float>::add_held(std::uint32_t, const Hold&, std::span<const PointField>,
                                      std::vector<Contact>&) const;
template void Engine<double>::add_held(std::uint32_t, const Hold&, std::span<const PointField>,
                                       std::vector<Contact>&) const;
template std::vector<Contact> Engine<float>::contacts() const;
template std::vector<Contact> Engine<double>::contacts() const;
template std::vector<double> Engine<float>::face_forces() const;
template std::vector<double> Engine<double>::face_forces() const;
template std::span<const ContactChange> Engine<float>::contact_changes() const;
template std::span<const ContactChange> Engine<double>::contact_changes() const;
template void Engine<float>::find_touching(std::vector<ContactChange>&) const;
template void Engine<double>::find_touching(std::vector<ContactChange>&) const;
template void Engine<float>::note_contact_changes();
template void Engine<double>::note_contact_changes();

} // namespace carom::core
