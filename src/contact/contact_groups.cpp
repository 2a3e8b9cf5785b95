#include "contact/contact_groups.hpp"

#include <carom/executor.hpp>

// Vectors of a size that the compiler does not know cannot be kept in a struct.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "contact/contact_groups.cpp" // this file again, once for each instruction set
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <string_view>

// clang-format off: it comes after Highway, which says for which instruction set
#include "space/simd_transpose.hpp"
// clang-format on

// No multiply-add here, and no Min or Max: the sign of their zeros depends on the machine.

HWY_BEFORE_NAMESPACE();
namespace carom::core::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

template <class D>
using Number = hn::TFromD<D>;

template <class D>
struct Vectors {
    hn::Vec<D> x, y, z;
};

template <class D>
HWY_INLINE HWY_ATTR Vectors<D> operator+(const Vectors<D>& a, const Vectors<D>& b) {
    return {hn::Add(a.x, b.x), hn::Add(a.y, b.y), hn::Add(a.z, b.z)};
}
template <class D>
HWY_INLINE HWY_ATTR Vectors<D> operator-(const Vectors<D>& a, const Vectors<D>& b) {
    return {hn::Sub(a.x, b.x), hn::Sub(a.y, b.y), hn::Sub(a.z, b.z)};
}
template <class D, class V>
HWY_INLINE HWY_ATTR Vectors<D> scaled(const Vectors<D>& a, V s) {
    return {hn::Mul(a.x, s), hn::Mul(a.y, s), hn::Mul(a.z, s)};
}
template <class D>
HWY_INLINE HWY_ATTR auto dot(const Vectors<D>& a, const Vectors<D>& b) {
    return hn::Add(hn::Add(hn::Mul(a.x, b.x), hn::Mul(a.y, b.y)), hn::Mul(a.z, b.z));
}
template <class D, class M>
HWY_INLINE HWY_ATTR Vectors<D> chosen(M mask, const Vectors<D>& yes, const Vectors<D>& no) {
    return {hn::IfThenElse(mask, yes.x, no.x), hn::IfThenElse(mask, yes.y, no.y), hn::IfThenElse(mask, yes.z, no.z)};
}

/// The lanes from `lane` on.
template <class D>
HWY_INLINE HWY_ATTR auto load(D lanes, const std::array<Number<D>, group_size>& values, std::size_t lane) {
    return hn::LoadU(lanes, values.data() + lane);
}
template <class D>
HWY_INLINE HWY_ATTR Vectors<D> load(D lanes, const std::array<std::array<Number<D>, group_size>, 3>& values,
                                    std::size_t lane) {
    return {load(lanes, values[0], lane), load(lanes, values[1], lane), load(lanes, values[2], lane)};
}
template <class D>
HWY_INLINE HWY_ATTR void store(D lanes, hn::Vec<D> v, std::array<Number<D>, group_size>& values, std::size_t lane) {
    hn::StoreU(v, lanes, values.data() + lane);
}
template <class D>
HWY_INLINE HWY_ATTR void store(D lanes, const Vectors<D>& v, std::array<std::array<Number<D>, group_size>, 3>& values,
                               std::size_t lane) {
    store(lanes, v.x, values[0], lane);
    store(lanes, v.y, values[1], lane);
    store(lanes, v.z, values[2], lane);
}

/// Movers and places are four numbers each. Whole ones are loaded and transposed, which is faster than gathering them
/// number by number.
template <class D>
struct Fours {
    Vectors<D> xyz;
    hn::Vec<D> w;
};

#if HWY_TARGET == HWY_SCALAR

template <class D>
Fours<D> load_fours(D lanes, const Number<D>* from, const std::uint32_t* indices) {
    const Number<D>* const four = from + 4 * std::size_t{*indices};
    return {{hn::Set(lanes, four[0]), hn::Set(lanes, four[1]), hn::Set(lanes, four[2])}, hn::Set(lanes, four[3])};
}

template <class D>
void store_fours(D lanes, const Fours<D>& fours, Number<D>* to, const std::uint32_t* indices) {
    Number<D>* const four = to + 4 * std::size_t{*indices};
    hn::StoreU(fours.xyz.x, lanes, four);
    hn::StoreU(fours.xyz.y, lanes, four + 1);
    hn::StoreU(fours.xyz.z, lanes, four + 2);
    hn::StoreU(fours.w, lanes, four + 3);
}

#else

inline constexpr std::size_t block_bytes = 16;

/// Loads a vector block by block: the one with the number b from at(b).
template <class D, class F>
HWY_INLINE HWY_ATTR hn::Vec<D> load_blocks(D lanes, F&& at, std::size_t first = 0) {
    if constexpr (sizeof(Number<D>) * hn::MaxLanes(D()) == block_bytes) {
        return hn::LoadU(lanes, at(first));
    } else {
        const hn::Half<D> half;
        constexpr std::size_t blocks = sizeof(Number<D>) * hn::MaxLanes(hn::Half<D>()) / block_bytes;
        const auto lower = load_blocks(half, at, first);
        return hn::Combine(lanes, load_blocks(half, at, first + blocks), lower);
    }
}
template <class D, class F>
HWY_INLINE HWY_ATTR void store_blocks(D lanes, hn::Vec<D> v, F&& at, std::size_t first = 0) {
    if constexpr (sizeof(Number<D>) * hn::MaxLanes(D()) == block_bytes) {
        hn::StoreU(v, lanes, at(first));
    } else {
        const hn::Half<D> half;
        constexpr std::size_t blocks = sizeof(Number<D>) * hn::MaxLanes(hn::Half<D>()) / block_bytes;
        store_blocks(half, hn::LowerHalf(half, v), at, first);
        store_blocks(half, hn::UpperHalf(half, v), at, first + blocks);
    }
}

template <class D>
HWY_INLINE HWY_ATTR Fours<D> load_fours(D lanes, const Number<D>* from, const std::uint32_t* indices) {
    if constexpr (sizeof(Number<D>) == sizeof(float)) { // a block is a whole element
        const auto row = [&](std::size_t k) HWY_ATTR {
            return load_blocks(lanes,
                               [&](std::size_t block) { return from + 4 * std::size_t{indices[4 * block + k]}; });
        };
        auto x = row(0);
        auto y = row(1);
        auto z = row(2);
        auto w = row(3);
        transpose(lanes, x, y, z, w);
        return {{x, y, z}, w};
    } else { // half an element
        const auto row = [&](std::size_t k, std::size_t half) HWY_ATTR {
            return load_blocks(
                lanes, [&](std::size_t block) { return from + 4 * std::size_t{indices[2 * block + k]} + 2 * half; });
        };
        const auto xy_even = row(0, 0);
        const auto xy_odd = row(1, 0);
        const auto zw_even = row(0, 1);
        const auto zw_odd = row(1, 1);
        return {{hn::InterleaveLower(lanes, xy_even, xy_odd), hn::InterleaveUpper(lanes, xy_even, xy_odd),
                 hn::InterleaveLower(lanes, zw_even, zw_odd)},
                hn::InterleaveUpper(lanes, zw_even, zw_odd)};
    }
}

template <class D>
HWY_INLINE HWY_ATTR void store_fours(D lanes, const Fours<D>& fours, Number<D>* to, const std::uint32_t* indices) {
    if constexpr (sizeof(Number<D>) == sizeof(float)) {
        auto [x, y, z] = fours.xyz;
        auto w = fours.w;
        transpose(lanes, x, y, z, w);
        const auto put = [&](std::size_t k, hn::Vec<D> row) HWY_ATTR {
            store_blocks(lanes, row, [&](std::size_t block) { return to + 4 * std::size_t{indices[4 * block + k]}; });
        };
        put(0, x);
        put(1, y);
        put(2, z);
        put(3, w);
    } else {
        const auto& [x, y, z] = fours.xyz;
        const auto put = [&](std::size_t k, std::size_t half, hn::Vec<D> row) HWY_ATTR {
            store_blocks(lanes, row,
                         [&](std::size_t block) { return to + 4 * std::size_t{indices[2 * block + k]} + 2 * half; });
        };
        put(0, 0, hn::InterleaveLower(lanes, x, y));
        put(0, 1, hn::InterleaveLower(lanes, z, fours.w));
        put(1, 0, hn::InterleaveUpper(lanes, x, y));
        put(1, 1, hn::InterleaveUpper(lanes, z, fours.w));
    }
}

#endif

/// The movers of one side of some contacts.
template <class D>
struct Side {
    Vectors<D> v;
    hn::Vec<D> inverse_mass;
};

template <class D>
HWY_INLINE HWY_ATTR Side<D> load_side(D lanes, const Mover<Number<D>>* movers,
                                      const std::array<std::uint32_t, group_size>& indices, std::size_t lane) {
    const auto fours = load_fours(lanes, reinterpret_cast<const Number<D>*>(movers), indices.data() + lane);
    return {fours.xyz, fours.w};
}

/// Gives b an impulse, and a the opposite.
template <class D>
HWY_INLINE HWY_ATTR void push(D lanes, const ContactRun<Number<D>>& run, const ContactGroup<Number<D>>& group,
                              std::size_t lane, const Side<D>& a, const Side<D>& b, const Vectors<D>& impulse) {
    auto* const movers = reinterpret_cast<Number<D>*>(run.movers);
    store_fours(lanes, {a.v - scaled(impulse, a.inverse_mass), a.inverse_mass}, movers, group.a.data() + lane);
    store_fours(lanes, {b.v + scaled(impulse, b.inverse_mass), b.inverse_mass}, movers, group.b.data() + lane);
}

/// Where balls are now, and the normal and the gap between them.
template <class D>
struct Sight {
    Fours<D> a;
    Fours<D> b;
    Vectors<D> normal;
    hn::Vec<D> gap;
};

template <class D>
HWY_INLINE HWY_ATTR Sight<D> look(D lanes, const ContactRun<Number<D>>& run, const ContactGroup<Number<D>>& group,
                                  std::size_t lane) {
    const auto zero = hn::Zero(lanes);
    const auto* const places = reinterpret_cast<const Number<D>*>(run.places);
    const auto a = load_fours(lanes, places, group.a.data() + lane);
    const auto b = load_fours(lanes, places, group.b.data() + lane);
    const auto apart = load(lanes, group.apart, lane);
    const auto delta = apart + (b.xyz - a.xyz);
    const auto distance = hn::Sqrt(dot(delta, delta));
    const auto touching = load(lanes, group.touching, lane);
    const auto is_seen = hn::Ge(touching, zero);
    const auto has_normal = hn::And(is_seen, hn::Gt(distance, zero));
    const auto divisor = hn::IfThenElse(has_normal, distance, hn::Set(lanes, Number<D>{1}));
    const Vectors<D> unit{hn::Div(delta.x, divisor), hn::Div(delta.y, divisor), hn::Div(delta.z, divisor)};
    return {a, b, chosen(has_normal, unit, chosen(is_seen, load(lanes, group.normal, lane), apart)),
            hn::IfThenElse(is_seen, hn::Sub(distance, touching), load(lanes, group.gap, lane))};
}

template <class D>
HWY_INLINE HWY_ATTR auto not_negative(D lanes, hn::Vec<D> v) {
    return hn::IfThenElseZero(hn::Gt(v, hn::Zero(lanes)), v);
}

/// What friction can do of what is wanted.
template <class D>
HWY_INLINE HWY_ATTR Vectors<D> at_most(D lanes, const Vectors<D>& wanted, hn::Vec<D> most) {
    const auto one = hn::Set(lanes, Number<D>{1});
    const auto size = hn::Sqrt(dot(wanted, wanted));
    const auto slips = hn::Gt(size, most);
    return scaled(wanted, hn::IfThenElse(slips, hn::Div(most, hn::IfThenElse(slips, size, one)), one));
}

/// Adds the energies, J, that friction takes of what slides to `losses`: one by one, whatever the vector's size.
template <class D>
HWY_INLINE HWY_ATTR void add_losses(D lanes, const Vectors<D>& friction, const Vectors<D>& sliding, double& losses) {
    HWY_ALIGN std::array<Number<D>, group_size> taken{};
    hn::StoreU(hn::Neg(dot(friction, sliding)), lanes, taken.data());
    for (std::size_t k = 0; k < hn::Lanes(lanes); ++k) losses += static_cast<double>(taken[k]);
}

/// Calls f(group, lane) for the lanes of all groups, as many at once as a vector has.
template <class D, class F>
HWY_INLINE HWY_ATTR void for_each_vector(D lanes, const ContactRun<Number<D>>& run, F&& f) {
    for (ContactGroup<Number<D>>& group : run.groups) {
        for (std::size_t lane = 0; lane < group_size; lane += hn::Lanes(lanes)) f(group, lane);
    }
}

/// What a contact gave way to, and bears nothing, it does not get back.
template <class D>
HWY_INLINE HWY_ATTR void store_gap(D lanes, hn::Vec<D> gap, ContactGroup<Number<D>>& group, std::size_t lane) {
    store(lanes, gap, group.gap, lane);
    const auto plastic = load(lanes, group.plastic, lane);
    store(lanes, not_negative(lanes, hn::Min(plastic, hn::Neg(gap))), group.plastic, lane);
}

template <class Real>
HWY_ATTR void measure(const ContactRun<Real>& run) {
    const hn::CappedTag<Real, group_size> lanes;
    for_each_vector(lanes, run, [&](ContactGroup<Real>& group, std::size_t lane) HWY_ATTR {
        const auto sight = look(lanes, run, group, lane);
        store(lanes, sight.normal, group.normal, lane);
        store_gap(lanes, sight.gap, group, lane);
    });
}

template <class Real>
HWY_ATTR void warm_up(const ContactRun<Real>& run) {
    const hn::CappedTag<Real, group_size> lanes;
    for_each_vector(lanes, run, [&](ContactGroup<Real>& group, std::size_t lane) HWY_ATTR {
        const auto impulse = scaled(load(lanes, group.normal, lane), load(lanes, group.impulse, lane));
        const auto all = run.rubs ? impulse + load(lanes, group.rub, lane) : impulse;
        push(lanes, run, group, lane, load_side(lanes, run.movers, group.a, lane),
             load_side(lanes, run.movers, group.b, lane), all);
    });
}

template <class Real>
HWY_ATTR double solve_softly(const ContactRun<Real>& run, const Softness<Real>& softness) {
    const hn::CappedTag<Real, group_size> lanes;
    const auto zero = hn::Zero(lanes);
    const auto rate = hn::Set(lanes, softness.rate);
    const auto mass_part = hn::Set(lanes, softness.mass);
    const auto impulse_part = hn::Set(lanes, softness.impulse);
    const auto frequency = hn::Set(lanes, softness.frequency);
    const auto stick = hn::Set(lanes, softness.stick);
    double losses = 0;
    for_each_vector(lanes, run, [&](ContactGroup<Real>& group, std::size_t lane) HWY_ATTR {
        const auto a = load_side(lanes, run.movers, group.a, lane);
        const auto b = load_side(lanes, run.movers, group.b, lane);
        const auto normal = load(lanes, group.normal, lane);
        const auto gap = load(lanes, group.gap, lane);
        const auto mass = load(lanes, group.mass, lane);
        const auto before = load(lanes, group.impulse, lane);
        const auto slip = b.v - a.v;
        const auto parting = dot(slip, normal);
        // As fast as they just do not touch at the end of the piece; or what the overlap asks for.
        const auto is_apart = hn::Gt(gap, zero);
        const auto overlap = hn::Min(hn::Add(gap, load(lanes, group.plastic, lane)), zero);
        const auto undone = hn::IfThenElse(is_apart, hn::Mul(frequency, gap), hn::Mul(rate, overlap));
        const auto wanted = hn::Mul(mass, hn::Add(parting, undone));
        const auto softened = hn::Add(hn::Mul(wanted, mass_part), hn::Mul(before, impulse_part));
        const auto after = not_negative(lanes, hn::Sub(before, hn::IfThenElse(is_apart, wanted, softened)));
        store(lanes, after, group.impulse, lane);
        auto impulse = scaled(normal, hn::Sub(after, before));
        if (run.rubs) {
            // What the damper of the piece before gave is given back.
            const auto former = load(lanes, group.rub, lane);
            const auto sprung = load(lanes, group.sprung, lane);
            const auto inverse = hn::Div(hn::Set(lanes, Real{1}), mass);
            const auto sliding = slip - scaled(normal, parting);
            const auto undamped = sliding + scaled(sprung - former, inverse);
            const auto most = hn::Mul(load(lanes, group.friction, lane), after);
            const auto rub = at_most(lanes, sprung - scaled(undamped, hn::Mul(mass, stick)), most);
            const auto change = rub - former;
            store(lanes, rub, group.rub, lane);
            store(lanes, rub, group.sprung, lane);
            add_losses(lanes, rub, sliding + scaled(change, inverse), losses);
            impulse = impulse + change;
        }
        push(lanes, run, group, lane, a, b, impulse);
    });
    return losses;
}

/// Notes whom contacts between two bodies carried.
template <class D, class M>
HWY_INLINE HWY_ATTR void note_carried(D lanes, const ContactRun<Number<D>>& run, const ContactGroup<Number<D>>& group,
                                      std::size_t lane, M carries) {
    std::array<std::uint8_t, group_size> bytes{};
    hn::StoreMaskBits(lanes, carries, bytes.data());
    for (std::uint32_t bits = bytes[0], k = 0; bits != 0; bits >>= 1U, ++k) {
        if ((bits & 1U) != 0) run.carried[group.a[lane + k]] = run.carried[group.b[lane + k]] = 1;
    }
}

template <class D>
HWY_INLINE HWY_ATTR void note_pressing(D lanes, const ContactRun<Number<D>>& run,
                                       const std::array<std::uint32_t, group_size>& movers, std::size_t lane,
                                       const Fours<D>& place, hn::Vec<D> pressing) {
    const auto larger = hn::IfThenElse(hn::Gt(pressing, place.w), pressing, place.w);
    store_fours(lanes, {place.xyz, larger}, reinterpret_cast<Number<D>*>(run.places), movers.data() + lane);
}

template <class Real>
HWY_ATTR void solve_hard(const ContactRun<Real>& run, Real frequency_of_pieces) {
    const hn::CappedTag<Real, group_size> lanes;
    const auto zero = hn::Zero(lanes);
    const auto frequency = hn::Set(lanes, frequency_of_pieces);
    for_each_vector(lanes, run, [&](ContactGroup<Real>& group, std::size_t lane) HWY_ATTR {
        const auto a = load_side(lanes, run.movers, group.a, lane);
        const auto b = load_side(lanes, run.movers, group.b, lane);
        const auto sight = look(lanes, run, group, lane);
        const auto mass = load(lanes, group.mass, lane);
        const auto before = load(lanes, group.impulse, lane);
        const auto slip = b.v - a.v;
        const auto parting = dot(slip, sight.normal);
        const auto wanted = hn::Mul(mass, hn::Add(parting, hn::Mul(not_negative(lanes, sight.gap), frequency)));
        const auto after = not_negative(lanes, hn::Sub(before, wanted));
        auto impulse = scaled(sight.normal, after) - scaled(load(lanes, group.normal, lane), before);
        if (run.rubs) {
            const auto former = load(lanes, group.rub, lane);
            const auto most = hn::Mul(load(lanes, group.friction, lane), after);
            const auto sprung = load(lanes, group.sprung, lane);
            const auto across = sprung - scaled(sight.normal, dot(sprung, sight.normal));
            const auto turned = at_most(lanes, chosen(hn::Gt(before, zero), across, scaled(across, zero)), most);
            // What slides is stopped, as far as friction can; but only what slips stretches the spring further.
            const auto wanted_rub = turned - scaled(slip - scaled(sight.normal, parting), mass);
            const auto rub = at_most(lanes, wanted_rub, most);
            const auto slips = hn::Gt(dot(wanted_rub, wanted_rub), hn::Mul(most, most));
            store(lanes, rub, group.rub, lane);
            store(lanes, chosen(slips, rub, turned), group.sprung, lane);
            impulse = impulse + (rub - former);
        }
        store(lanes, sight.normal, group.normal, lane);
        store_gap(lanes, sight.gap, group, lane);
        store(lanes, after, group.impulse, lane);
        push(lanes, run, group, lane, a, b, impulse);
        const auto carries = hn::And(hn::Gt(hn::Add(before, after), zero), hn::Gt(b.inverse_mass, zero));
        note_carried(lanes, run, group, lane, carries);
        const auto force = hn::Mul(after, frequency);
        note_pressing(lanes, run, group.a, lane, sight.a, hn::Mul(force, a.inverse_mass));
        note_pressing(lanes, run, group.b, lane, sight.b, hn::Mul(force, b.inverse_mass));
    });
}

template <class Real>
constexpr GroupSolver<Real> solver{&measure<Real>, &warm_up<Real>, &solve_softly<Real>, &solve_hard<Real>};

} // namespace carom::core::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace carom::core {

namespace {

template <class Real>
struct Target {
    std::string_view name;
    GroupSolver<Real> solver;
};

/// Named as those of simd_search.cpp.
template <class Real>
constexpr auto targets = std::to_array<Target<Real>>({
#    if HWY_TARGETS & HWY_AVX3
    {"avx512", N_AVX3::solver<Real>},
#    endif
#    if HWY_TARGETS & HWY_AVX2
    {"avx2", N_AVX2::solver<Real>},
#    endif
#    if HWY_TARGETS & HWY_SSE4
    {"sse4", N_SSE4::solver<Real>},
#    endif
#    if HWY_TARGETS & HWY_SSSE3
    {"ssse3", N_SSSE3::solver<Real>},
#    endif
#    if HWY_TARGETS & HWY_NEON
    {"neon", N_NEON::solver<Real>},
#    endif
#    if HWY_TARGETS & HWY_EMU128
    {"scalar", N_EMU128::solver<Real>},
#    elif HWY_TARGETS & HWY_SCALAR
    {"scalar", N_SCALAR::solver<Real>},
#    endif
});

} // namespace

/// Where the scalar one is not compiled, another stands for it.
template <class Real>
const GroupSolver<Real>& group_solver() {
    const auto* const target = std::find_if(targets<Real>.begin(), targets<Real>.end(),
                                            [name = simd_target()](const Target<Real>& t) { return t.name == name; });
    return target == targets<Real>.end() ? targets<Real>.back().solver : target->solver;
}

template const GroupSolver<float>& group_solver();
template const GroupSolver<double>& group_solver();

} // namespace carom::core

#endif
