/// \file
/// Storage of all bodies: arrays in spatial order, and the table of ids that finds them there.
#pragma once

#include "space/column.hpp"
#include "space/line_vector.hpp"
#include "space/motion.hpp"
#include "space/prefetch.hpp"

#include <carom/body.hpp>

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace carom::core {

using Index = std::uint32_t; ///< place of a body in the arrays; changes when bodies are put in spatial order
inline constexpr Index no_index = std::numeric_limits<Index>::max();

/// What moves a body between impacts.
enum class Kind : std::uint8_t {
    free,   ///< uniform gravity
    fixed,  ///< nothing: a static body
    held,   ///< its Hold: it rests against faces or static bodies
    piled,  ///< its contacts, as it leans on bodies that move: straight on at a velocity that they give it now and then
    asleep, ///< nothing: it is piled, but its whole island has lain still until something arrives
    kinematic, ///< its prescribed velocity: straight on, through faces and static bodies, and takes any momentum
};

/// Whether nothing that happens changes how a body moves: its mass is infinite.
constexpr bool is_prescribed(Kind kind) { return kind == Kind::fixed || kind == Kind::kinematic; }
/// Whether a body leans on others that may move.
constexpr bool leans(Kind kind) { return kind == Kind::piled || kind == Kind::asleep; }
/// Whether something carries a body, so that it is not in free flight.
constexpr bool rests(Kind kind) { return kind == Kind::held || leans(kind); }
/// Whether nothing moves a body unless it is struck.
constexpr bool is_still(Kind kind) { return kind == Kind::fixed || kind == Kind::asleep; }

/// Counts a body's impacts in quick succession: state of the TC rule and of the jam rule.
struct Flight {
    double last_impact = 0;          ///< s since the start of the step; means nothing while `quick_impacts` is 0
    std::uint32_t quick_impacts = 0; ///< impacts so far whose flights in between were shorter than collapse_time
    std::uint16_t still_impacts = 0; ///< the last ones of these, between which nothing moved by more than rounding
    std::uint16_t still_bounces = 0; ///< the last ones of those, all with faces or static bodies, e < 1
};

/// The flight of a body that met something within collapse_time: all others have none to remember.
struct RecentFlight {
    std::uint32_t slot = 0;
    Flight flight{};
};

/// Whether the TC rule still counts from a flight at `now` (s since the start of the step).
inline bool is_recent(const Flight& flight, double now, double collapse_time) {
    return flight.quick_impacts > 0 && now - flight.last_impact <= collapse_time;
}

inline void sort_by_slot(std::vector<RecentFlight>& flights) {
    std::sort(flights.begin(), flights.end(),
              [](const RecentFlight& a, const RecentFlight& b) { return a.slot < b.slot; });
}

/// What a solver keeps of a body while it resolves a window.
struct Course {
    Flight flight{};
    std::uint32_t version = 0; ///< changes with every impact of the body: outdates its events
};

/// What a held body rests against.
struct Support {
    std::uint32_t code = 0; ///< wall_bit | index of a wall of the Bounds, or the slot of a static body
    Vec3 normal{};          ///< unit vector from the body into the support
    double bend = 0;        ///< 1/m, of the path of a body that slides along it; positive where it presses the body on
    double friction = 0;    ///< between the two
    // Of a support that moves as prescribed. A held body has none of them.
    bool is_driven = false;
    Vec3 velocity{};     ///< m/s, of its surface where the body touches it
    Vec3 acceleration{}; ///< m/s^2

    static constexpr std::uint32_t wall_bit = 0x80000000U;
    [[nodiscard]] bool is_wall() const { return (code & wall_bit) != 0; }
    [[nodiscard]] std::uint32_t wall() const { return code & ~wall_bit; }
};

/// Why a held body does not fall, and how it moves meanwhile. Derived from the supports' codes and the body's motion
/// at the start of each step, and when the body comes to rest.
struct Hold {
    std::vector<Support> supports; ///< one to three
    Vec3 acceleration{};           ///< m/s^2, along the supports
    Vec3 friction{};               ///< m/s^2, the part of it that is friction
    bool sticks = false;           ///< friction outweighs what pulls along the supports
};

/// The force between a piled body and what it touches, kept from one step to the next.
struct ContactForce {
    std::uint32_t a = 0;    ///< slot of a piled body; of two, the lower one
    std::uint32_t code = 0; ///< the other's slot, or Support::wall_bit | index of a wall of the Bounds
    double normal = 0;      ///< N, >= 0, pushes them apart
    Vec3 friction{};        ///< N, on the other
    double plastic = 0;     ///< m, of the overlap, what bears nothing
};

/// A piled body where it was when its contacts were listed.
struct ListedBody {
    std::uint32_t slot = 0;
    Int3 x{};             ///< units
    double still = 0;     ///< s, how long it has lain still
    bool is_borne = true; ///< a contact carried it in the last piece, or it is new
};

/// What is known in a piece of how its contacts load a body; nothing of one that is not piled, or only just.
template <class Real>
struct Load {
    Vector3<Real> given{}; ///< m/s, the velocity that they gave it
    Vector3<Real> pull{};  ///< m/s^2, what all forces, those of the contacts too, last did to it
    Real pressing = 0;     ///< m/s^2, what the strongest of its contacts does to it
    bool is_told = false;  ///< all that it can meet of its pile in the piece is among its contacts, unless it is struck
};

/// A radius that grows.
struct Growth {
    double radius = 0; ///< m, at the start of the step
    double rate = 0;   ///< m/s
};

/// All bodies of a world, one element of each array per body.
template <class Real>
struct Bodies {
    LineVector<Motion<Real>> motion;
    std::vector<Kind> kind; ///< on its own: predictions read it of every neighbour, and it stays in the cache
    std::vector<std::uint32_t> slot;
    Column<Real> mass; ///< kg; infinity for static bodies
    Column<Real> restitution;
    Column<Real> friction;
    Column<std::uint32_t> material;
    Column<std::uint64_t> user_data;
    std::vector<Growth> growth; ///< empty as long as no body grows
    double top_growth = 0;      ///< m/s, the largest rate in size
    std::vector<Int3> previous; ///< units, at the start of the last step; in use only if `interpolating`
    bool interpolating = false;

    std::map<std::uint32_t, Hold> holds;      ///< of the held bodies, by slot
    std::set<std::uint32_t> kinematics;       ///< slots of the kinematic bodies
    std::vector<ListedBody> listed;           ///< whose contacts are listed
    std::vector<ContactForce> contacts;       ///< the list, in its order; also what may touch, and bears nothing yet
    double list_age = 0;                      ///< s since it was made
    double list_margin = 0;                   ///< m, gaps up to this are in it
    std::uint64_t list_edge = 0;              ///< units, of the cells that give it its order
    std::vector<ContactForce> sleeping;       ///< contacts of the bodies that are asleep
    std::vector<Load<Real>> loads;            ///< per body, inside a step with contacts
    double piece_rate = 0;                    ///< 1/s, of pieces, and four times that of a contact's swinging
    double calm = 0;                          ///< s, for which that has been more than the loads ask for
    bool newly_piled = false;                 ///< bodies were piled that Pile does not know of yet
    std::vector<RecentFlight> recent_flights; ///< between windows; in the order of slots
    std::vector<Course> course;               ///< per body, only while a solver works on these bodies
    std::vector<Index> slots;                 ///< the table of ids: where the body is; no_index if the slot is free
    std::vector<std::uint16_t> generations;   ///< of each slot
    std::vector<std::uint32_t> free_slots;    ///< last in, first out

    [[nodiscard]] std::size_t size() const { return motion.size(); }

    /// Calls f with every per-body array that is in use.
    template <class F>
    void for_each_array(F&& f) {
        f(motion);
        f(kind);
        f(slot);
        if (interpolating) f(previous);
        if (!growth.empty()) f(growth);
        for_each_column([&f](auto& column) {
            if (!column.array().empty()) f(column.array());
        });
    }
    template <class F>
    void for_each_column(F&& f) {
        f(mass);
        f(restitution);
        f(friction);
        f(material);
        f(user_data);
    }
};

/// m, `time` s after the start of the step; not from before the body's last impact.
template <class Real>
double radius_at(const Bodies<Real>& bodies, Index i, double time) {
    if (bodies.growth.empty()) return static_cast<double>(bodies.motion[i].radius);
    return bodies.growth[i].radius + bodies.growth[i].rate * time;
}

/// m/s
template <class Real>
double growth_of(const Bodies<Real>& bodies, Index i) {
    return bodies.growth.empty() ? 0 : bodies.growth[i].rate;
}

/// Finds the largest rate of growth anew. Without any there is no growth.
template <class Real>
void update_top_growth(Bodies<Real>& bodies) {
    bodies.top_growth = 0;
    for (const Growth& growth : bodies.growth) bodies.top_growth = std::max(bodies.top_growth, std::abs(growth.rate));
    if (bodies.top_growth == 0) bodies.growth.clear();
}

template <class Real>
const Hold& hold_of(const Bodies<Real>& bodies, Index index) {
    return bodies.holds.find(bodies.slot[index])->second;
}

/// The flight that is remembered of a body.
template <class Real>
Flight recent_flight(const Bodies<Real>& bodies, std::uint32_t slot) {
    const auto& flights = bodies.recent_flights;
    const auto place = std::lower_bound(flights.begin(), flights.end(), slot,
                                        [](const RecentFlight& f, std::uint32_t s) { return f.slot < s; });
    return place != flights.end() && place->slot == slot ? place->flight : Flight{};
}

/// A body leans on another that moves, or another on it.
template <class Real>
void pile_up(Bodies<Real>& bodies, Index index) {
    if (bodies.kind[index] == Kind::held) bodies.holds.erase(bodies.slot[index]);
    bodies.kind[index] = Kind::piled;
    bodies.newly_piled = true;
}

/// Wakes a body that something meets; the others of its island are woken with the next piece.
template <class Real>
bool wake(Bodies<Real>& bodies, Index index) {
    if (bodies.kind[index] != Kind::asleep) return false;
    pile_up(bodies, index);
    return true;
}

/// Wakes all, since what they lie on may have changed.
template <class Real>
void wake_all(Bodies<Real>& bodies) {
    if (bodies.sleeping.empty()) return;
    for (Kind& kind : bodies.kind) {
        if (kind == Kind::asleep) kind = Kind::piled;
    }
    bodies.contacts.insert(bodies.contacts.end(), bodies.sleeping.begin(), bodies.sleeping.end());
    bodies.sleeping.clear();
    bodies.listed.clear();
    bodies.newly_piled = true;
}

/// Lets a held body go; any other stays as it is.
template <class Real>
void release(Bodies<Real>& bodies, Index index) {
    if (bodies.kind[index] != Kind::held) return;
    bodies.holds.erase(bodies.slot[index]);
    bodies.kind[index] = Kind::free;
}

/// Ends a body's rest, whatever it rests on.
template <class Real>
void let_go(Bodies<Real>& bodies, Index index) {
    release(bodies, index);
    if (bodies.kind[index] == Kind::piled) bodies.kind[index] = Kind::free;
}

/// Takes the body at `index` out; the last body moves into its place. The slot becomes free.
template <class Real>
void remove_body(Bodies<Real>& bodies, Index index) {
    let_go(bodies, index);
    const std::uint32_t slot = bodies.slot[index];
    std::erase_if(bodies.recent_flights, [slot](const RecentFlight& f) { return f.slot == slot; });
    bodies.kinematics.erase(slot);
    bodies.slots[bodies.slot.back()] = index;
    bodies.for_each_array([index](auto& array) {
        array[index] = array.back();
        array.pop_back();
    });
    bodies.slots[slot] = no_index;
    // A slot whose generations are used up is given out no more: old ids must stay stale.
    if (++bodies.generations[slot] != 0) bodies.free_slots.push_back(slot);
}

/// The contacts are to be listed anew: what is changed from outside may touch other bodies, or in another way.
template <class Real>
void drop_contact_list(Bodies<Real>& bodies) {
    bodies.newly_piled = bodies.newly_piled || !bodies.listed.empty();
    bodies.listed.clear();
}

/// Forgets the contacts of a body that no contact holds up any more.
template <class Real>
void drop_contacts_of(Bodies<Real>& bodies, std::uint32_t slot) {
    std::erase_if(bodies.contacts, [slot](const ContactForce& c) { return c.a == slot || c.code == slot; });
}

/// Forgets the contacts of bodies that are gone.
template <class Real>
void drop_stale_contacts(Bodies<Real>& bodies) {
    const auto is_gone = [&bodies](std::uint32_t slot) { return bodies.slots[slot] == no_index; };
    const std::size_t stale = std::erase_if(bodies.contacts, [&](const ContactForce& c) {
        return is_gone(c.a) || ((c.code & Support::wall_bit) == 0 && is_gone(c.code));
    });
    const bool is_stale =
        std::any_of(bodies.listed.begin(), bodies.listed.end(), [&](const ListedBody& l) { return is_gone(l.slot); });
    if (stale != 0 || is_stale) drop_contact_list(bodies);
}

/// Puts the bodies into the order of the list, which is a permutation: body `order[k]` comes to place k. Cycle by
/// cycle, in place: a second copy of the arrays would double the memory. Uses the list up.
template <class Real>
void reorder(Bodies<Real>& bodies, std::span<Index> order) {
    for (Index first = 0; first < order.size(); ++first) {
        for (Index k = first; order[k] != k;) {
            const Index next = std::exchange(order[k], k);
            if (next == first) break;
            bodies.for_each_array([&](auto& array) { std::swap(array[k], array[next]); });
            k = next;
        }
    }
    for (Index k = 0; k < order.size(); ++k) bodies.slots[bodies.slot[k]] = k;
}

} // namespace carom::core
