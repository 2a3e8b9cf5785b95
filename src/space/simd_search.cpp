#include "space/simd_search.hpp"

#include <carom/base.hpp>
#include <carom/executor.hpp>

// Vectors of a size that the compiler does not know cannot be kept in a struct: NEON does.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "space/simd_search.cpp" // this file again, once for each instruction set
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <cstddef>

// clang-format off: it comes after Highway, which says for which instruction set
#include "space/simd_transpose.hpp"
// clang-format on

// Where a vector has one lane only, the plain searches below do.
#if HWY_TARGET != HWY_SCALAR

HWY_BEFORE_NAMESPACE();
namespace carom::core::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

#    if HWY_TARGET == HWY_AVX2

/// For each set of lanes their numbers, in order.
struct LaneNumbers {
    std::array<std::array<std::int32_t, 8>, 256> of_set{};
};
constexpr LaneNumbers lane_numbers = [] {
    LaneNumbers numbers;
    for (std::uint32_t set = 0; set < 256; ++set) {
        std::size_t count = 0;
        for (std::int32_t lane = 0; lane < 8; ++lane) {
            if ((set >> lane & 1U) != 0) numbers.of_set[set][count++] = lane;
        }
    }
    return numbers;
}();

/// Writes the lanes of the mask, in order, and other values behind them; returns how many. Highway 1.0.3 would copy its
/// table to the stack, each time: a third of all of a gas.
template <class D, class M, class T>
HWY_ATTR std::size_t write_lanes(D lanes, hn::Vec<D> v, M mask, T* out) {
    std::array<std::uint8_t, 8> set{};
    hn::StoreMaskBits(lanes, mask, set.data());
    hn::StoreU(hn::TableLookupLanes(v, hn::SetTableIndices(lanes, lane_numbers.of_set[set[0]].data())), lanes, out);
    return hn::CountTrue(lanes, mask);
}

#    else

/// Writes the lanes of the mask, in order, and other values behind them; returns how many.
template <class D, class M, class T>
HWY_ATTR std::size_t write_lanes(D lanes, hn::Vec<D> v, M mask, T* out) {
    hn::StoreU(hn::Compress(v, mask), lanes, out);
    return hn::CountTrue(lanes, mask);
}

#    endif

void pack_balls(const BallArrays& balls, const std::array<Tick, 3>& origin, const Run* runs, std::size_t run_count,
                const PackedBalls& out) {
    using Floats = hn::CappedTag<float, simd_padding>;
    const Floats floats;
    const hn::RebindToUnsigned<Floats> indices;
    const hn::RebindToSigned<Floats> integers;
    const auto see = [&](const Tick* ticks, std::size_t axis, float* seen) HWY_ATTR {
        const auto d = hn::Sub(hn::LoadU(indices, ticks), hn::Set(indices, origin[axis]));
        const auto metres =
            hn::Mul(hn::ConvertTo(floats, hn::BitCast(integers, d)), hn::Set(floats, balls.scale[axis]));
        hn::StoreU(metres, floats, seen);
    };
    std::size_t size = 0;
    for (std::size_t r = 0; r < run_count; ++r) {
        const std::size_t count = runs[r].to - runs[r].from;
        for (std::size_t k = 0; k < count; k += hn::Lanes(floats)) {
            const std::size_t from = runs[r].from + k;
            const std::size_t to = size + k;
            see(balls.x + from, 0, out.x + to);
            see(balls.y + from, 1, out.y + to);
            see(balls.z + from, 2, out.z + to);
            hn::StoreU(hn::LoadU(floats, balls.radius + from), floats, out.radius + to);
            hn::StoreU(hn::LoadU(indices, balls.body + from), indices, out.body + to);
        }
        size += count;
    }
}

// No multiply-add here: it would be fused on some machines only, and candidates are counted in reports.
Index* find_meeting(const PackedBalls& balls, std::size_t count, const SeenBall& ball, Index* out) {
    using Floats = hn::CappedTag<float, simd_padding>;
    const Floats floats;
    const hn::RebindToUnsigned<Floats> indices;
    const float* const xs = balls.x;
    const float* const ys = balls.y;
    const float* const zs = balls.z;
    const float* const radii = balls.radius;
    const Index* const bodies = balls.body;
    const auto ball_x = hn::Set(floats, ball.x);
    const auto ball_y = hn::Set(floats, ball.y);
    const auto ball_z = hn::Set(floats, ball.z);
    const auto radius = hn::Set(floats, ball.radius);
    const auto own = hn::Set(indices, ball.body);
    for (std::size_t k = 0; k < count; k += hn::Lanes(floats)) {
        const auto x = hn::Sub(hn::LoadU(floats, xs + k), ball_x);
        const auto y = hn::Sub(hn::LoadU(floats, ys + k), ball_y);
        const auto z = hn::Sub(hn::LoadU(floats, zs + k), ball_z);
        const auto squares = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
        const auto reach = hn::Add(hn::LoadU(floats, radii + k), radius);
        const auto others = hn::LoadU(indices, bodies + k);
        const auto meets = hn::RebindMask(indices, hn::Le(squares, hn::Mul(reach, reach)));
        const auto in_list = hn::FirstN(indices, count - k);
        out += write_lanes(indices, others, hn::And(hn::And(meets, in_list), hn::Ne(others, own)), out);
    }
    return out;
}

/// Several tracks, word by word.
template <class V>
struct TrackWords {
    std::array<V, 3> start;
    V reach;
    std::array<V, 3> speed;
};

/// The tracks of as many bodies of a list as a vector has lanes; the last one again behind the list's end. Whole tracks
/// are loaded and transposed, which is faster than gathering them word by word.
template <class D>
HWY_INLINE HWY_ATTR TrackWords<hn::Vec<D>> load_tracks(D floats, const float* tracks, const Index* bodies,
                                                       std::size_t count) {
    constexpr std::size_t words = sizeof(Track) / sizeof(float);
    static_assert(words == 8 && offsetof(Track, reach) == 12 && offsetof(Track, speed) == 16);
    const auto half_track = [&](std::size_t k, std::size_t half) HWY_ATTR {
        const auto at = [&](std::size_t lane) {
            return tracks + words * std::size_t{bodies[std::min(lane, count - 1)]} + 4 * half;
        };
        if constexpr (hn::MaxLanes(D()) == 4) {
            return hn::LoadU(floats, at(k));
        } else {
            static_assert(hn::MaxLanes(D()) == 8);
            const hn::Half<D> block;
            return hn::Combine(floats, hn::LoadU(block, at(k + 4)), hn::LoadU(block, at(k)));
        }
    };
    auto x = half_track(0, 0);
    auto y = half_track(1, 0);
    auto z = half_track(2, 0);
    auto reach = half_track(3, 0);
    transpose(floats, x, y, z, reach);
    auto u = half_track(0, 1);
    auto v = half_track(1, 1);
    auto w = half_track(2, 1);
    auto room = half_track(3, 1);
    transpose(floats, u, v, w, room);
    return {{x, y, z}, reach, {u, v, w}};
}

std::size_t find_tracks(const Track* tracks, const TrackScale& scale, const Track& track, const Index* bodies,
                        std::size_t count, float from, float to, const TrackMeetings& out) {
    using Floats = hn::CappedTag<float, 8>;
    const Floats floats;
    const hn::RebindToUnsigned<Floats> indices;
    const hn::RebindToSigned<Floats> integers;
    const auto* const words = reinterpret_cast<const float*>(tracks);
    std::size_t found = 0;
    for (std::size_t k = 0; k < count; k += hn::Lanes(floats)) {
        const auto in_list = hn::FirstN(indices, count - k);
        const auto other = load_tracks(floats, words, bodies + k, count - k);
        const auto speed_to = [&](std::size_t axis)
                                  HWY_ATTR { return hn::Sub(other.speed[axis], hn::Set(floats, track.speed[axis])); };
        const auto w0 = speed_to(0);
        const auto w1 = speed_to(1);
        const auto w2 = speed_to(2);
        const auto start = hn::Set(floats, from);
        const auto place = [&](std::size_t axis, auto w) HWY_ATTR {
            const auto ticks = hn::Sub(hn::BitCast(indices, other.start[axis]), hn::Set(indices, track.start[axis]));
            const auto metres =
                hn::Mul(hn::ConvertTo(floats, hn::BitCast(integers, ticks)), hn::Set(floats, scale.metres[axis]));
            return hn::Add(metres, hn::Mul(w, start));
        };
        const auto p0 = place(0, w0);
        const auto p1 = place(1, w1);
        const auto p2 = place(2, w2);
        const auto zero = hn::Zero(floats);
        const auto reach = hn::Add(hn::Abs(other.reach), hn::Set(floats, std::abs(track.reach)));
        const auto reach_squared = hn::Mul(reach, reach);
        const auto dot = [&](auto a0, auto a1, auto a2, auto b0, auto b1, auto b2)
                             HWY_ATTR { return hn::Add(hn::Add(hn::Mul(a0, b0), hn::Mul(a1, b1)), hn::Mul(a2, b2)); };
        const auto outside = hn::Sub(dot(p0, p1, p2, p0, p1, p2), reach_squared);
        const auto closing = hn::Neg(dot(p0, p1, p2, w0, w1, w2));
        const auto speed = dot(w0, w1, w2, w0, w1, w2);
        const auto closing_squared = hn::Mul(closing, closing);
        const auto least_reach = hn::Min(other.reach, hn::Set(floats, track.reach));
        const auto is_inside = hn::Le(outside, zero);
        const auto tolerance = hn::Set(floats, scale.tolerance * scale.tolerance);
        const auto speed_error = hn::Set(floats, scale.speed_error * scale.speed_error);
        const auto unsure = hn::Add(hn::Mul(speed, tolerance), hn::Mul(reach_squared, speed_error));
        const auto parts =
            hn::And(hn::And(hn::Lt(closing, zero), hn::Gt(least_reach, zero)), hn::Gt(closing_squared, unsure));
        const auto margin =
            hn::Mul(hn::Set(floats, discriminant_margin), hn::Add(closing_squared, hn::Mul(speed, reach_squared)));
        const auto discriminant = hn::Add(hn::Sub(closing_squared, hn::Mul(speed, outside)), margin);
        const auto passes = hn::Or(hn::Le(closing, zero), hn::Lt(discriminant, zero));
        const auto raw = hn::Add(start, hn::Div(outside, hn::Add(closing, hn::Sqrt(discriminant))));
        const auto comes = hn::Not(hn::Or(passes, hn::Gt(raw, hn::Set(floats, to))));
        // Also from where it is not a number.
        const auto time = hn::IfThenElse(hn::AndNot(is_inside, hn::Ge(raw, start)), raw, start);
        const auto meets = hn::Or(hn::AndNot(parts, is_inside), hn::AndNot(is_inside, comes));
        const auto hits = hn::And(hn::RebindMask(indices, meets), in_list);
        write_lanes(floats, time, hn::RebindMask(floats, hits), out.times + found);
        found += write_lanes(indices, hn::LoadU(indices, bodies + k), hits, out.bodies + found);
    }
    return found;
}

} // namespace carom::core::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

#if HWY_ONCE

#    include <atomic>
#    include <cstdlib>
#    include <string>

namespace carom {

namespace core {

namespace {

void pack_balls_plainly(const BallArrays& balls, const std::array<Tick, 3>& origin, const Run* runs,
                        std::size_t run_count, const PackedBalls& out) {
    std::size_t to = 0;
    for (std::size_t r = 0; r < run_count; ++r) {
        for (std::size_t k = runs[r].from; k < runs[r].to; ++k) {
            out.x[to] = tick_distance(origin[0], balls.x[k], balls.scale[0]);
            out.y[to] = tick_distance(origin[1], balls.y[k], balls.scale[1]);
            out.z[to] = tick_distance(origin[2], balls.z[k], balls.scale[2]);
            out.radius[to] = balls.radius[k];
            out.body[to] = balls.body[k];
            ++to;
        }
    }
}

Index* find_meeting_plainly(const PackedBalls& balls, std::size_t count, const SeenBall& ball, Index* out) {
    for (std::size_t k = 0; k < count; ++k) {
        const float x = balls.x[k] - ball.x;
        const float y = balls.y[k] - ball.y;
        const float z = balls.z[k] - ball.z;
        const float reach = balls.radius[k] + ball.radius;
        const bool meets = x * x + y * y + z * z <= reach * reach;
        *out = balls.body[k];
        out += meets && balls.body[k] != ball.body ? 1 : 0;
    }
    return out;
}

std::size_t find_tracks_plainly(const Track* tracks, const TrackScale& scale, const Track& track, const Index* bodies,
                                std::size_t count, float from, float to, const TrackMeetings& out) {
    std::size_t found = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const float time = first_meeting(track, tracks[bodies[k]], from, to, scale);
        out.bodies[found] = bodies[k];
        out.times[found] = time;
        found += time != never ? 1 : 0;
    }
    return found;
}

struct Target {
    std::int64_t bits = 0; ///< as Highway numbers them; 0: everywhere
    std::string_view name;
    BallPacking packing = nullptr;
    BallSearch balls = nullptr;
    TrackSearch tracks = nullptr;
};

constexpr auto targets = std::to_array<Target>({
#    if HWY_TARGETS & HWY_AVX3
    {HWY_AVX3, "avx512", &N_AVX3::pack_balls, &N_AVX3::find_meeting, &N_AVX3::find_tracks},
#    endif
#    if HWY_TARGETS & HWY_AVX2
    {HWY_AVX2, "avx2", &N_AVX2::pack_balls, &N_AVX2::find_meeting, &N_AVX2::find_tracks},
#    endif
#    if HWY_TARGETS & HWY_SSE4
    {HWY_SSE4, "sse4", &N_SSE4::pack_balls, &N_SSE4::find_meeting, &N_SSE4::find_tracks},
#    endif
#    if HWY_TARGETS & HWY_SSSE3
    {HWY_SSSE3, "ssse3", &N_SSSE3::pack_balls, &N_SSSE3::find_meeting, &N_SSSE3::find_tracks},
#    endif
#    if HWY_TARGETS & HWY_NEON
    {HWY_NEON, "neon", &N_NEON::pack_balls, &N_NEON::find_meeting, &N_NEON::find_tracks},
#    endif
    {0, "scalar", &pack_balls_plainly, &find_meeting_plainly, &find_tracks_plainly},
});
#    ifdef HWY_COMPILE_ONLY_SCALAR
static_assert(targets.size() == 1);
#    endif

bool is_supported(const Target& target) {
    return target.bits == 0 || (static_cast<std::int64_t>(HWY_SUPPORTED_TARGETS) & target.bits) != 0;
}

const Target* find_target(std::string_view name) {
    for (const Target& target : targets) {
        if (target.name == name && is_supported(target)) return &target;
    }
    return nullptr;
}

const Target* first_choice() {
    // Read once, before any other thread of a step exists.
    const char* const wanted = std::getenv("CAROM_SIMD"); // NOLINT(concurrency-mt-unsafe)
    if (wanted != nullptr) {
        if (const Target* const target = find_target(wanted)) return target;
    }
    for (const Target& target : targets) {
        if (is_supported(target)) return &target;
    }
    return nullptr;
}

std::atomic<const Target*>& choice() {
    static std::atomic<const Target*> chosen{first_choice()};
    return chosen;
}

} // namespace

BallPacking ball_packing() { return choice().load()->packing; }
BallSearch ball_search() { return choice().load()->balls; }
TrackSearch track_search() { return choice().load()->tracks; }

} // namespace core

std::vector<std::string_view> simd_targets() {
    std::vector<std::string_view> names;
    for (const core::Target& target : core::targets) {
        if (core::is_supported(target)) names.push_back(target.name);
    }
    return names;
}

std::string_view simd_target() { return core::choice().load()->name; }

void use_simd_target(std::string_view name) {
    const core::Target* const target = core::find_target(name);
    if (target != nullptr) {
        core::choice().store(target);
        return;
    }
    std::string known;
    for (const std::string_view other : simd_targets()) known += (known.empty() ? "" : ", ") + std::string(other);
    throw Error(ErrorCode::not_available, "simd", "must be one of " + known + ", got \"" + std::string(name) + "\"");
}

} // namespace carom

#endif
