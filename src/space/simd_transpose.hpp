/// \file
/// Rows of vectors into columns: for each instruction set anew, from files that hwy/foreach_target.h includes again.
/// Vectors of one lane have no such thing.

// Once for each instruction set: Highway turns HWY_TARGET_TOGGLE from one to the next.
#if defined(CAROM_SIMD_TRANSPOSE) == defined(HWY_TARGET_TOGGLE)
#    ifdef CAROM_SIMD_TRANSPOSE
#        undef CAROM_SIMD_TRANSPOSE
#    else
#        define CAROM_SIMD_TRANSPOSE
#    endif

#    include <hwy/highway.h>

#    if HWY_TARGET != HWY_SCALAR

HWY_BEFORE_NAMESPACE();
namespace carom::core::HWY_NAMESPACE {

/// Turns four rows of floats into columns, or columns into rows, in each block of four lanes.
template <class D, class V = hwy::HWY_NAMESPACE::Vec<D>>
HWY_INLINE HWY_ATTR void transpose(D floats, V& a, V& b, V& c, V& d) {
    namespace hn = hwy::HWY_NAMESPACE;
    const hn::RepartitionToWide<D> pairs;
    const auto ab = hn::BitCast(pairs, hn::InterleaveLower(floats, a, b));
    const auto cd = hn::BitCast(pairs, hn::InterleaveLower(floats, c, d));
    const auto ab_upper = hn::BitCast(pairs, hn::InterleaveUpper(floats, a, b));
    const auto cd_upper = hn::BitCast(pairs, hn::InterleaveUpper(floats, c, d));
    a = hn::BitCast(floats, hn::InterleaveLower(pairs, ab, cd));
    b = hn::BitCast(floats, hn::InterleaveUpper(pairs, ab, cd));
    c = hn::BitCast(floats, hn::InterleaveLower(pairs, ab_upper, cd_upper));
    d = hn::BitCast(floats, hn::InterleaveUpper(pairs, ab_upper, cd_upper));
}

} // namespace carom::core::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#    endif
#endif
