#include "collision/restitution.hpp"

#include "collision/portable_math.hpp"

#include <carom/collision.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace carom::core {

namespace {

/// A polynomial in Chebyshev's form.
struct Chebyshev {
    double low;
    double high;
    std::span<const double> coefficients;

    /// By Clenshaw's recurrence.
    [[nodiscard]] double at(double x) const {
        const double t = (2 * x - low - high) / (high - low);
        double next = 0;
        double after = 0;
        for (std::size_t i = coefficients.size(); i-- > 1;) {
            const double here = coefficients[i] + 2 * t * next - after;
            after = next;
            next = here;
        }
        return coefficients[0] + t * next - after;
    }
};

// e^(-1/5) of viscoelastic spheres over x, interpolated in Chebyshev's points between solutions of
// s'' = -s^(3/2) - x s^(1/2) s', s(0) = 0, s'(0) = 1, by power series in sqrt(s) with the time that makes them regular.
constexpr std::array weak{1.2734466188663125,      0.2951115504875831,      0.02636610621115382,
                          0.004936495956256411,    2.6412808675922868e-04,  1.6523378999205243e-05,
                          -1.4074863838790344e-05, -2.3541676490928468e-06, -5.7974860063265192e-07,
                          -1.832152824516382e-08,  2.2322665197786287e-09,  3.9408910209222841e-09,
                          6.325068123579235e-10,   1.4294048660761719e-10,  4.4580388763253924e-13,
                          -1.666703812001439e-12,  -1.3379174311643914e-12, -2.0419468585133573e-13};
constexpr std::array strong{
    2.9122617924197227,       1.3844173180801622,       0.04059253203259611,      -0.022759745326750753,
    0.00894010307098066,      -0.0015239361123130142,   -8.02297185638604416e-04, 7.08375456163645723e-04,
    -1.73049152058587119e-04, -7.57378089377517552e-05, 7.37788917355430840e-05,  -1.52617860032141124e-05,
    -1.05492541117024885e-05, 8.07298768220239898e-06,  -9.23583710815689685e-07, -1.50996836930280165e-06,
    8.40468455803877745e-07,  8.80762353790605709e-09,  -2.00640330720129129e-07, 7.99450503389624039e-08,
    1.43307531628537408e-08,  -2.43464697476566024e-08, 6.25205719140264904e-09,  2.58399830352362692e-09};

/// e of viscoelastic spheres over x.
double viscoelastic(double x) {
    constexpr double weak_end = 2;
    constexpr double strong_end = 6;
    constexpr double creeping = 5.158381704267685; // e x^5 of large x, reached to 1e-10 at strong_end
    const auto to_fifth = [](double y) { return (y * y) * (y * y) * y; };
    if (x < weak_end) return 1 / to_fifth(Chebyshev{0, weak_end, weak}.at(x));
    if (x < strong_end) return 1 / to_fifth(Chebyshev{weak_end, strong_end, strong}.at(x));
    return creeping / to_fifth(x);
}

double restitution_at(const Viscoelastic& law, const Yielder& yielder, double speed) {
    const double rho = 2.0 / 3 * law.modulus * std::sqrt(yielder.radius);
    if (!(rho > 0 && law.dissipation > 0)) return 1;
    // v^(1/5) under the power: one power is cheaper than two.
    const double x = law.dissipation * (1.5 * detail::pow(rho / yielder.mass * std::sqrt(speed), 0.4));
    return std::min(viscoelastic(x), 1.0);
}

double restitution_at(const PowerLaw& law, const Yielder& /*yielder*/, double speed) {
    return std::min(law.restitution * detail::pow(speed / law.speed, -law.exponent), 1.0);
}

} // namespace

Yielder reduced(const Yielder& a, const Yielder& b) {
    const double sum = a.radius + b.radius;
    return {carom::detail::reduced_mass(a.mass, b.mass), sum > 0 ? a.radius * b.radius / sum : 0};
}

double restitution_by(const RestitutionLaw& law, const Yielder& yielder, double speed) {
    if (!(speed > 0)) return 1;
    return std::visit([&](const auto& parameters) { return restitution_at(parameters, yielder, speed); }, law);
}

} // namespace carom::core
