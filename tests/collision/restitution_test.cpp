// Restitution by approach speed: published figures, the equation of motion, and limits.

#include "collision/restitution.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace carom::core {
namespace {

/// x of two spheres with a reduced mass of 1 kg and a reduced radius of 1 m at 1 m/s is `dissipation`, s.
constexpr Yielder unit{1, 1};
Viscoelastic with_x(double x) { return {.dissipation = x / 1.5, .modulus = 1.5}; }

double viscoelastic(double x) { return restitution_by(with_x(x), unit, 1); }

/// VALIDATION 10: the equation of motion, solved elsewhere, to nine digits.
TEST(Viscoelastic, FiguresToNineDigits) {
    struct Figure {
        double x, e;
    };
    for (const Figure& f : {Figure{0.01, 0.988544819}, Figure{0.1, 0.892147587}, Figure{0.2, 0.797550062},
                            Figure{0.3, 0.714044880}, Figure{0.5, 0.573824629}}) {
        EXPECT_NEAR(viscoelastic(f.x), f.e, 5.1e-10) << f.x;
    }
}

/// e by steps of Runge and Kutta's fourth order through u' = w, w' = -2 u^4 - 2 x u^2 w, with u the square root of the
/// overlap and w the speed, until u is zero again; the last step goes there by Newton's method.
double integrated(double x, double h) {
    struct Point {
        double u, w;
    };
    const auto slope = [x](const Point& p) {
        const double square = p.u * p.u;
        return Point{p.w, -2 * square * (square + x * p.w)};
    };
    const auto moved = [](const Point& p, const Point& by, double time) {
        return Point{p.u + by.u * time, p.w + by.w * time};
    };
    const auto stepped = [&](const Point& p, double time) {
        const Point a = slope(p);
        const Point b = slope(moved(p, a, time / 2));
        const Point c = slope(moved(p, b, time / 2));
        const Point d = slope(moved(p, c, time));
        return moved(p, {a.u + 2 * b.u + 2 * c.u + d.u, a.w + 2 * b.w + 2 * c.w + d.w}, time / 6);
    };
    Point p = stepped({0, 1}, h);
    for (Point next = p; next.u > 0; next = stepped(p, h)) p = next;
    double rest = -p.u / p.w;
    for (int i = 0; i < 8; ++i) {
        const Point end = stepped(p, rest);
        rest -= end.u / end.w;
    }
    return -stepped(p, rest).w;
}

/// The integration's error falls with h^4: about 1e-12 here, by halving h.
TEST(Viscoelastic, SolvesTheEquationOfMotion) {
    for (const double x : {1e-4, 0.03, 0.7, 1.0, 1.5, 1.9999}) {
        EXPECT_NEAR(viscoelastic(x) / integrated(x, 1e-3), 1, 3e-12) << x;
    }
    for (const double x : {2.0001, 3.0, 4.5, 5.9999, 6.0001, 9.0}) {
        EXPECT_NEAR(viscoelastic(x) / integrated(x, 1e-3), 1, 3e-8) << x;
    }
}

/// Brilliantov and Poeschel's series: e = 1 - C1 x + C2 x^2 - ..., C1 = 1.153449, C2 = 3/5 C1^2.
TEST(Viscoelastic, BeginsAsTheSeries) {
    const double x = 1e-4;
    constexpr double c1 = 1.153449;
    EXPECT_NEAR(viscoelastic(x), 1 - c1 * x + 0.6 * c1 * c1 * x * x, 1e-10);
}

/// x depends on (modulus sqrt(radius) / mass)^(2/5) and speed^(1/5).
TEST(Viscoelastic, ScalesWithMassRadiusAndSpeed) {
    const double e = viscoelastic(0.4);
    EXPECT_NEAR(restitution_by(Viscoelastic{0.4 / 1.5, 3}, {2, 1}, 1), e, 1e-14);
    EXPECT_NEAR(restitution_by(Viscoelastic{0.4 / 1.5, 3}, {8, 16}, 1), e, 1e-14);
    EXPECT_NEAR(restitution_by(Viscoelastic{0.4 / 1.5, 1.5}, {4, 1}, 16), e, 1e-14);
    EXPECT_NEAR(restitution_by(Viscoelastic{0.2 / 1.5, 1.5}, unit, 32), e, 1e-14);
}

TEST(PowerLaws, FollowThePower) {
    const PowerLaw ice{0.32, 0.01, 0.234};
    EXPECT_NEAR(restitution_by(ice, unit, 0.01), 0.32, 1e-15);
    for (const double v : {1e-4, 1e-3, 0.1, 3.0}) {
        EXPECT_NEAR(restitution_by(ice, unit, v), std::min(1.0, 0.32 * std::pow(100 * v, -0.234)), 1e-15) << v;
    }
    EXPECT_EQ(restitution_by(ice, unit, 1e-5), 1);
}

TEST(Laws, StayWithinZeroAndOne) {
    constexpr double largest = std::numeric_limits<double>::max();
    constexpr double smallest = std::numeric_limits<double>::denorm_min();
    constexpr std::array extremes{0.0, smallest, 1e-300, 1.0, 1e300, largest};
    for (const double a : extremes) {
        for (const double b : extremes) {
            for (const double speed : {0.0, -1.0, smallest, 1e-20, 1.0, 1e20, largest}) {
                for (const Yielder& yielder :
                     {Yielder{1, 0}, Yielder{1, 1}, Yielder{smallest, 1e30}, Yielder{1e300, 1}}) {
                    const double e = restitution_by(Viscoelastic{a, b}, yielder, speed);
                    EXPECT_TRUE(e >= 0 && e <= 1) << a << ' ' << b << ' ' << speed << ": " << e;
                }
                if (a == 0) continue;
                const double e = restitution_by(PowerLaw{std::min(a, 1.0), a, b}, unit, speed);
                EXPECT_TRUE(e >= 0 && e <= 1) << a << ' ' << b << ' ' << speed << ": " << e;
            }
        }
    }
}

TEST(Yielders, AreReduced) {
    const Yielder two = reduced({3, 2}, {6, 0.5});
    EXPECT_EQ(two.mass, 2);
    EXPECT_EQ(two.radius, 0.4);
    const Yielder fixed = reduced({3, 2}, {infinite_mass, 2});
    EXPECT_EQ(fixed.mass, 3);
    EXPECT_EQ(fixed.radius, 1);
    EXPECT_EQ(reduced({1, 0}, {1, 0}).radius, 0);
}

} // namespace
} // namespace carom::core
