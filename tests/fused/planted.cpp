// What tests/fused/find_fused.py has to find: instructions that round once where others round twice.
#include <cmath>
#include <cstddef>

namespace planted {

double one(double a, double b, double c) { return std::fma(a, b, c); }

// A loop for the vectoriser.
void many(float* sum, const float* factor, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) sum[i] = std::fma(factor[i], 3.0F, sum[i]);
}

} // namespace planted
