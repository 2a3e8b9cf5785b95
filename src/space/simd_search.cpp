#include "space/simd_search.hpp"

#include <carom/error.hpp>
#include <carom/executor.hpp>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "space/simd_search.cpp" // this file again, once for each instruction set
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <cstddef>

HWY_BEFORE_NAMESPACE();
namespace carom::core::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

// No multiply-add here: it would be fused on some machines only, and candidates are counted in reports.
Index* find_meeting(const BallArrays& arrays, const Ball& ball, Index self, const Run* runs, std::size_t run_count,
                    Index* out) {
    using Floats = hn::CappedTag<float, simd_padding>;
    const Floats floats;
    const hn::RebindToUnsigned<Floats> indices;
    const hn::RebindToSigned<Floats> integers;
    const auto distance = [&](const Tick* ticks, Tick from, float scale) HWY_ATTR {
        const auto d = hn::Sub(hn::LoadU(indices, ticks), hn::Set(indices, from));
        return hn::Mul(hn::ConvertTo(floats, hn::BitCast(integers, d)), hn::Set(floats, scale));
    };
    const auto own = hn::Set(indices, self);
    const auto radius = hn::Set(floats, ball.radius);
    for (std::size_t r = 0; r < run_count; ++r) {
        for (std::size_t k = runs[r].from; k < runs[r].to; k += hn::Lanes(floats)) {
            const auto x = distance(arrays.x + k, ball.centre[0], arrays.scale[0]);
            const auto y = distance(arrays.y + k, ball.centre[1], arrays.scale[1]);
            const auto z = distance(arrays.z + k, ball.centre[2], arrays.scale[2]);
            const auto squares = hn::Add(hn::Add(hn::Mul(x, x), hn::Mul(y, y)), hn::Mul(z, z));
            const auto reach = hn::Add(hn::LoadU(floats, arrays.radius + k), radius);
            const auto bodies = hn::LoadU(indices, arrays.body + k);
            const auto meets = hn::RebindMask(indices, hn::Le(squares, hn::Mul(reach, reach)));
            const auto in_run = hn::FirstN(indices, runs[r].to - k);
            const auto found = hn::And(hn::And(meets, in_run), hn::Ne(bodies, own));
            out += hn::CompressStore(bodies, found, indices, out);
        }
    }
    return out;
}

std::size_t find_tracks(const Track* tracks, const TrackScale& scale, const Track& track, const Index* bodies,
                        std::size_t count, float from, float to, const TrackMeetings& out) {
    using Floats = hn::CappedTag<float, simd_padding>;
    const Floats floats;
    const hn::RebindToUnsigned<Floats> indices;
    const hn::RebindToSigned<Floats> integers;
    constexpr int words = sizeof(Track) / sizeof(float);
    static_assert(words == 8 && offsetof(Track, reach) == 12 && offsetof(Track, speed) == 16 &&
                  offsetof(Track, bend) == 28);
    const auto* const words_of_tracks = reinterpret_cast<const float*>(tracks);
    std::size_t found = 0;
    for (std::size_t k = 0; k < count; k += hn::Lanes(floats)) {
        const auto in_list = hn::FirstN(indices, count - k);
        const auto list = hn::IfThenElseZero(in_list, hn::LoadU(indices, bodies + k));
        const auto first_word = hn::BitCast(integers, hn::ShiftLeft<3>(list));
        const auto word = [&](int number)
                              HWY_ATTR { return hn::GatherIndex(floats, words_of_tracks + number, first_word); };
        const auto speed_to = [&](std::size_t axis) HWY_ATTR {
            return hn::Sub(word(4 + static_cast<int>(axis)), hn::Set(floats, track.speed[axis]));
        };
        const auto w0 = speed_to(0);
        const auto w1 = speed_to(1);
        const auto w2 = speed_to(2);
        const auto start = hn::Set(floats, from);
        const auto place = [&](std::size_t axis, auto w) HWY_ATTR {
            const auto ticks =
                hn::Sub(hn::BitCast(indices, word(static_cast<int>(axis))), hn::Set(indices, track.start[axis]));
            const auto metres =
                hn::Mul(hn::ConvertTo(floats, hn::BitCast(integers, ticks)), hn::Set(floats, scale.metres[axis]));
            return hn::Add(metres, hn::Mul(w, start));
        };
        const auto p0 = place(0, w0);
        const auto p1 = place(1, w1);
        const auto p2 = place(2, w2);
        const auto zero = hn::Zero(floats);
        const auto reach = hn::Add(word(3), hn::Set(floats, track.reach));
        const auto reach_squared = hn::Mul(reach, reach);
        const auto dot = [&](auto a0, auto a1, auto a2, auto b0, auto b1, auto b2)
                             HWY_ATTR { return hn::Add(hn::Add(hn::Mul(a0, b0), hn::Mul(a1, b1)), hn::Mul(a2, b2)); };
        const auto outside = hn::Sub(dot(p0, p1, p2, p0, p1, p2), reach_squared);
        const auto closing = hn::Neg(dot(p0, p1, p2, w0, w1, w2));
        const auto speed = dot(w0, w1, w2, w0, w1, w2);
        const auto closing_squared = hn::Mul(closing, closing);
        const auto bend = hn::Add(word(7), hn::Set(floats, track.bend));
        const auto is_inside = hn::Le(outside, zero);
        const auto tolerance = hn::Set(floats, scale.tolerance * scale.tolerance);
        const auto parts = hn::And(hn::And(hn::Lt(closing, zero), hn::Eq(bend, zero)),
                                   hn::Gt(closing_squared, hn::Mul(speed, tolerance)));
        const auto root = hn::Sub(closing_squared, hn::Mul(speed, outside));
        const auto passes = hn::Or(hn::Le(closing, zero), hn::Lt(root, zero));
        const auto raw = hn::Add(start, hn::Div(outside, hn::Add(closing, hn::Sqrt(root))));
        const auto comes = hn::Not(hn::Or(passes, hn::Gt(raw, hn::Set(floats, to))));
        // Also from where it is not a number.
        const auto time = hn::IfThenElse(hn::AndNot(is_inside, hn::Ge(raw, start)), raw, start);
        const auto meets = hn::Or(hn::AndNot(parts, is_inside), hn::AndNot(is_inside, comes));
        const auto hits = hn::And(hn::RebindMask(indices, meets), in_list);
        hn::CompressStore(time, hn::RebindMask(floats, hits), floats, out.times + found);
        found += hn::CompressStore(list, hits, indices, out.bodies + found);
    }
    return found;
}

} // namespace carom::core::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#    include <atomic>
#    include <cstdlib>
#    include <string>

namespace carom {

namespace core {

namespace {

Index* find_meeting_plainly(const BallArrays& arrays, const Ball& ball, Index self, const Run* runs,
                            std::size_t run_count, Index* out) {
    for (std::size_t r = 0; r < run_count; ++r) {
        for (std::size_t k = runs[r].from; k < runs[r].to; ++k) {
            const Ball other{{arrays.x[k], arrays.y[k], arrays.z[k]}, arrays.radius[k]};
            *out = arrays.body[k];
            out += balls_meet(ball, other, arrays.scale) && arrays.body[k] != self ? 1 : 0;
        }
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
    BallSearch balls = nullptr;
    TrackSearch tracks = nullptr;
};

constexpr auto targets = std::to_array<Target>({
#    if HWY_TARGETS & HWY_AVX3
    {HWY_AVX3, "avx512", &N_AVX3::find_meeting, &N_AVX3::find_tracks},
#    endif
#    if HWY_TARGETS & HWY_AVX2
    {HWY_AVX2, "avx2", &N_AVX2::find_meeting, &N_AVX2::find_tracks},
#    endif
#    if HWY_TARGETS & HWY_SSE4
    {HWY_SSE4, "sse4", &N_SSE4::find_meeting, &N_SSE4::find_tracks},
#    endif
#    if HWY_TARGETS & HWY_SSSE3
    {HWY_SSSE3, "ssse3", &N_SSSE3::find_meeting, &N_SSSE3::find_tracks},
#    endif
#    if HWY_TARGETS & HWY_SVE
    {HWY_SVE, "sve", &N_SVE::find_meeting, &N_SVE::find_tracks},
#    endif
#    if HWY_TARGETS & HWY_NEON
    {HWY_NEON, "neon", &N_NEON::find_meeting, &N_NEON::find_tracks},
#    endif
    {0, "scalar", &find_meeting_plainly, &find_tracks_plainly},
});

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
