#include "contact/rest.hpp"

#include <carom/collision.hpp>

#include <array>

namespace carom::core {

namespace {

/// What rounding makes of a direction along a support: a blow in it does not lift a body.
constexpr double along_rounding = 1e-8;

/// The part of a vector that is square to the normals of at most three supports. By an orthonormal base of what they
/// span (Gram and Schmidt): sweeps over the normals would hardly brake what runs into a wedge of almost opposite ones.
Vec3 along_supports(const Vec3& vector, const std::vector<Support>& supports) {
    std::array<Vec3, 3> base;
    std::size_t rank = 0;
    const auto square_to_base = [&](Vec3 v) {
        for (std::size_t i = 0; i < rank; ++i) v -= base[i] * dot(v, base[i]);
        return v;
    };
    for (const Support& s : supports) {
        // Twice: what is left of a normal that almost lies in the span has its rounding.
        const Vec3 rest = square_to_base(square_to_base(s.normal));
        const double size = length(rest);
        if (rank < base.size() && size > along_rounding) base[rank++] = rest / size;
    }
    return rank == base.size() ? Vec3{} : square_to_base(vector);
}

template <class Real>
Vec3 normal_of(const State<Real>& state, Index body, const Support& support) {
    const Int3& x = state.bodies.motion[body].x;
    if (support.is_wall()) return state.bounds.normal(state.bounds.walls()[support.wall()], x, {}, state.resolution);
    const Motion<Real>& other = state.bodies.motion[state.bodies.slots[support.code]];
    return contact_normal(separation(state, state.bodies.motion[body], other, {}, {}), Vec3{});
}

/// m between a body's surface and a support.
template <class Real>
double gap_to(const State<Real>& state, Index body, const Support& support) {
    const Motion<Real>& m = state.bodies.motion[body];
    const auto radius = static_cast<double>(m.radius);
    if (support.is_wall()) {
        return state.bounds.gap(state.bounds.walls()[support.wall()], m.x, {}, radius, m.t, state.resolution);
    }
    const Motion<Real>& other = state.bodies.motion[state.bodies.slots[support.code]];
    return length(separation(state, m, other, {}, {})) - radius - static_cast<double>(other.radius);
}

/// A support as it is now, derived from its code.
template <class Real>
Support derived(const State<Real>& state, Index body, const Support& support) {
    const Motion<Real>& m = state.bodies.motion[body];
    const Vec3 normal = normal_of(state, body, support);
    Support now;
    if (support.is_wall()) {
        now = support_by_wall(state, support.wall(), normal, m, 0);
        now.friction = encounter_of(state, body, state.bounds.surface(support.wall()), 0).friction;
    } else {
        const Index fixed = state.bodies.slots[support.code];
        now = support_by_body(support.code, normal, m, state.bodies.motion[fixed], 0);
        now.friction = encounter_of(state, body, fixed, 0).friction;
    }
    return now;
}

/// Changes the velocity of a body that its supports turn, and enters the impulse.
template <class Real>
void set_and_book(State<Real>& state, Index body, const Vec3& v, Entry& entry) {
    Motion<Real>& motion = state.bodies.motion[body];
    const Vec3 before = velocity_of(motion);
    motion.v = rounded<Real>(v);
    entry.outer_impulse += (velocity_of(motion) - before) * static_cast<double>(state.bodies.mass[body]);
}

/// How a held body moves: along its supports, slowed by friction, which brings it to a stop but never turns it back.
template <class Real>
void derive_motion(State<Real>& state, Index body, Hold& hold, double duration, Entry& entry) {
    Motion<Real>& motion = state.bodies.motion[body];
    const Vec3 before = velocity_of(motion);
    const Vec3 v = along_supports(before, hold.supports);
    set_and_book(state, body, v, entry);
    const double lost = length_squared(before) - length_squared(velocity_of(motion));
    entry.lost_to_restitution += 0.5 * static_cast<double>(state.bodies.mass[body]) * lost;
    const Vec3 all = state.laws.gravity + attraction(state, body);
    const Vec3 pull = along_supports(all, hold.supports);
    const Vec3 slide = along_supports(state.laws.gravity, hold.supports);
    double mu = 0;
    for (const Support& s : hold.supports) mu = std::max(mu, s.friction);
    const double grip = mu * length(all - pull);
    const double speed = length(v);
    hold.sticks = mu > 0 && duration > 0 && (grip - length(pull)) * duration >= speed;
    if (hold.sticks) {
        hold.friction = v / -duration - slide;
    } else if (mu > 0 && (speed > 0 || pull != Vec3{})) {
        const Vec3 slip = speed > 0 ? v / speed : pull / length(pull);
        // A body that slides up a slope turns on the way, and its friction would then drive it: no more of it than
        // takes energy up to the end.
        const double most = duration > 0 ? std::max(0.0, 2 * speed / duration + dot(slip, pull)) : grip;
        hold.friction = slip * -std::min(grip, most);
    } else {
        hold.friction = {};
    }
    hold.acceleration = slide + hold.friction;
}

/// Whether a held body is pressed into a support: by what acts on it, or by sliding along its other supports.
template <class Real>
bool presses(const State<Real>& state, Index body, const Hold& hold, const Support& support) {
    const Motion<Real>& motion = state.bodies.motion[body];
    const std::uint32_t slot = state.bodies.slot[body];
    if (pressure_on(state, motion, slot, support, velocity_of(motion)).acceleration > 0) return true;
    std::vector<Support> others = hold.supports;
    std::erase_if(others, [&](const Support& s) { return s.code == support.code; });
    const Vec3 all = state.laws.gravity + attraction(state, body);
    return !others.empty() && dot(along_supports(all, others), support.normal) > along_rounding * length(all);
}

} // namespace

void set_contact_time(Laws& laws, const Resolution& resolution) {
    // What a contact gives way by is not to be rounded away.
    constexpr double least_units = 2;
    // A bounce at the contact speed takes 16 contact times on a level floor, and on a slope of 14 degrees 64.
    constexpr double remembered = 64;
    const double gravity = length(laws.gravity);
    laws.contact_time =
        gravity > 0 ? std::max(laws.quick_time, std::sqrt(2 * least_units * resolution.metres / gravity)) : 0;
    laws.collapse_time = std::max(laws.quick_time, remembered * laws.contact_time);
}

template <class Real>
Support support_by_wall(const State<Real>& state, std::uint32_t wall, const Vec3& normal, const Motion<Real>& motion,
                        double growth) {
    const bool is_shell = state.bounds.shape() == Bounds::Shape::shell;
    const auto radius = static_cast<double>(motion.radius);
    const Bounds::Wall& face = state.bounds.walls()[wall];
    return {.code = Support::wall_bit | wall,
            .normal = normal,
            .bend = is_shell ? 1 / (state.bounds.shell_radius() - radius) : 0,
            .is_driven = face.is_driven || growth != 0,
            .velocity = Bounds::velocity(face, motion.x, {}, motion.t) - normal * growth,
            .acceleration = Bounds::acceleration(face, motion.t)};
}

template <class Real>
Support support_by_facet(const State<Real>& state, std::uint32_t wall, const Touch& touch, const Motion<Real>& motion,
                         const Vec3& d, const Vec3& velocity, double growth) {
    const std::uint32_t facet = wall - state.bounds.first_facet();
    const Obstacles& obstacles = *state.bounds.obstacles();
    return {.code = Support::wall_bit | wall,
            .normal = touch.normal,
            .bend = obstacles.bend(facet, motion.x, d, velocity),
            .is_driven = growth != 0,
            .velocity =
                obstacles.surface_velocity(facet, motion.x, d, static_cast<double>(motion.radius), touch.normal) -
                touch.normal * growth};
}

template <class Real>
Support support_by_body(std::uint32_t slot, const Vec3& normal, const Motion<Real>& motion, const Motion<Real>& fixed,
                        double growth) {
    const double distance = static_cast<double>(motion.radius) + static_cast<double>(fixed.radius);
    const Vec3 velocity = velocity_of(fixed) - normal * growth;
    return {
        .code = slot, .normal = normal, .bend = -1 / distance, .is_driven = velocity != Vec3{}, .velocity = velocity};
}

template <class Real>
Pressure pressure_on(const State<Real>& state, const Motion<Real>& motion, std::uint32_t slot, const Support& support,
                     const Vec3& velocity) {
    const Vec3 pull = attraction(state, motion.x, slot);
    const Vec3& n = support.normal;
    const double across = dot(velocity, n);
    const double slide_squared = std::max(0.0, length_squared(velocity) - across * across);
    const double kick = std::max(0.0, dot(pull, n)) * state.laws.kick_interval;
    return {dot(state.laws.gravity + pull - support.acceleration, n) + support.bend * slide_squared, kick};
}

template <class Real>
void hold_against(State<Real>& state, Index body, const Support& support, double remaining, Entry& entry) {
    state.bodies.kind[body] = Kind::held;
    Hold& hold = state.bodies.holds[state.bodies.slot[body]];
    constexpr std::size_t most = 3;
    if (hold.supports.size() == most) hold.supports.erase(hold.supports.begin());
    hold.supports.push_back(support);
    derive_motion(state, body, hold, remaining, entry);
}

template <class Real>
Yielding yield_to(const State<Real>& state, Index body, const Vec3& velocity, const Vec3& blow) {
    if (state.bodies.kind[body] != Kind::held) return {.change = blow};
    const Hold& hold = hold_of(state.bodies, body);
    const Vec3 free = along_supports(blow, hold.supports);
    if (dot(velocity, free) < 0) return {.change = free};
    double mu = 0;
    for (const Support& s : hold.supports) mu = std::max(mu, s.friction);
    const double grip = mu * length(blow - free);
    const double push = length(free);
    const Vec3 friction = grip < push ? free * (-grip / push) : -free;
    return {.change = free + friction, .friction = friction};
}

template <class Real>
bool stays_on_supports(const State<Real>& state, Index body, const Vec3& direction) {
    if (state.bodies.kind[body] != Kind::held) return true;
    const auto& supports = hold_of(state.bodies, body).supports;
    return std::all_of(supports.begin(), supports.end(),
                       [&](const Support& s) { return dot(direction, s.normal) >= -along_rounding; });
}

template <class Real>
bool moves_along_supports(const State<Real>& state, Index body, const Vec3& direction) {
    return state.bodies.kind[body] == Kind::held && stays_on_supports(state, body, direction) &&
           stays_on_supports(state, body, -direction);
}

template <class Real>
void refresh_hold(State<Real>& state, Index body, double remaining, Entry& entry) {
    derive_motion(state, body, state.bodies.holds[state.bodies.slot[body]], remaining, entry);
}

template <class Real>
void refresh_holds(State<Real>& state, double duration, std::vector<Index>& released) {
    Bodies<Real>& bodies = state.bodies;
    for (auto it = bodies.holds.begin(); it != bodies.holds.end();) {
        Hold& hold = it->second;
        const Index body = bodies.slots[it->first];
        for (Support& s : hold.supports) s = derived(state, body, s);
        const Hold all = hold;
        std::erase_if(hold.supports, [&](const Support& s) { return !presses(state, body, all, s); });
        if (hold.supports.empty()) {
            released.push_back(body);
            bodies.kind[body] = Kind::free;
            it = bodies.holds.erase(it);
            continue;
        }
        Entry entry;
        derive_motion(state, body, hold, duration, entry);
        state.books.add(entry);
        ++it;
    }
}

template <class Real>
void settle_holds(State<Real>& state) {
    Bodies<Real>& bodies = state.bodies;
    for (auto& [slot, hold] : bodies.holds) {
        const Index body = bodies.slots[slot];
        Motion<Real>& motion = bodies.motion[body];
        Entry entry;
        for (Support& s : hold.supports) {
            if (s.is_wall() && state.bounds.walls()[s.wall()].axis >= 0) continue;
            s.normal = normal_of(state, body, s);
            const double gap = gap_to(state, body, s);
            // Less than the resolution waits for more to come: rounded away each time, it would be energy gone astray.
            const Int3 shift =
                std::abs(gap) > state.resolution.metres ? round_to_units(s.normal * gap, state.resolution) : Int3{};
            motion.x = motion.x + shift;
            // A support does no work: the body gets the speed that gravity gives it on the whole way. Attractors' kicks
            // before and after the way keep their own balance.
            const Vec3 v = velocity_of(motion);
            const double gain = 2 * dot(state.laws.gravity, to_metres(shift, state.resolution));
            const Vec3 along = v - s.normal * dot(v, s.normal);
            const double speed = length(along);
            const double settled = std::sqrt(std::max(0.0, length_squared(v) + gain));
            if (speed > 0) set_and_book(state, body, along * (settled / speed), entry);
            // A body that its contacts in a pile pressed into the support comes out of it at more than its speed pays.
            const double given = length_squared(velocity_of(motion)) - length_squared(v) - gain;
            entry.lost_to_restitution -= 0.5 * static_cast<double>(state.bodies.mass[body]) * given;
        }
        state.books.add(entry);
    }
}

template <class Real>
Vec3 kick_along_supports(const State<Real>& state, Index body, Vec3 kick) {
    const Hold& hold = hold_of(state.bodies, body);
    return hold.sticks ? Vec3{} : along_supports(kick, hold.supports);
}

template <class Real>
void release_from(Bodies<Real>& bodies, std::uint32_t slot) {
    for (auto it = bodies.holds.begin(); it != bodies.holds.end();) {
        const Index body = bodies.slots[it->first];
        std::erase_if(it->second.supports, [slot](const Support& s) { return s.code == slot; });
        if (!it->second.supports.empty()) {
            ++it;
            continue;
        }
        bodies.kind[body] = Kind::free;
        it = bodies.holds.erase(it);
    }
}

#define CAROM_INSTANTIATE(Real)                                                                                        \
    template Support support_by_wall(const State<Real>&, std::uint32_t, const Vec3&, const Motion<Real>&, double);     \
    template Support support_by_facet(const State<Real>&, std::uint32_t, const Touch&, const Motion<Real>&,            \
                                      const Vec3&, const Vec3&, double);                                               \
    template Support support_by_body(std::uint32_t, const Vec3&, const Motion<Real>&, const Motion<Real>&, double);    \
    template Pressure pressure_on(const State<Real>&, const Motion<Real>&, std::uint32_t, const Support&,              \
                                  const Vec3&);                                                                        \
    template void hold_against(State<Real>&, Index, const Support&, double, Entry&);                                   \
    template Yielding yield_to(const State<Real>&, Index, const Vec3&, const Vec3&);                                   \
    template bool stays_on_supports(const State<Real>&, Index, const Vec3&);                                           \
    template bool moves_along_supports(const State<Real>&, Index, const Vec3&);                                        \
    template void refresh_hold(State<Real>&, Index, double, Entry&);                                                   \
    template void refresh_holds(State<Real>&, double, std::vector<Index>&);                                            \
    template void settle_holds(State<Real>&);                                                                          \
    template Vec3 kick_along_supports(const State<Real>&, Index, Vec3);                                                \
    template void release_from(Bodies<Real>&, std::uint32_t);
CAROM_INSTANTIATE(float)
CAROM_INSTANTIATE(double)
#undef CAROM_INSTANTIATE

} // namespace carom::core
