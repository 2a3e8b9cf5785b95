// Times of impact with triangles and frustums: surfaces without thickness.

#include "collision/surface_time.hpp"
#include "gap_reference.hpp"
#include "random_input.hpp"

#include <carom/collision.hpp>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace carom::test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// ---------------------------------------------------------------------------------------------------------------------
// Nearest points, by other ways than the header's
// ---------------------------------------------------------------------------------------------------------------------

struct Corners {
    Wide a, b, c;
};

/// By barycentric coordinates of the foot, and, where that lies outside, the nearest of three segments.
Wide nearest_of_triangle(const Corners& t, const Wide& p) {
    const Wide u = t.b - t.a;
    const Wide v = t.c - t.a;
    const Wide w = p - t.a;
    const Real uu = dot(u, u);
    const Real uv = dot(u, v);
    const Real vv = dot(v, v);
    const Real det = uu * vv - uv * uv;
    const Real beta = (vv * dot(w, u) - uv * dot(w, v)) / det;
    const Real gamma = (uu * dot(w, v) - uv * dot(w, u)) / det;
    if (beta >= 0 && gamma >= 0 && beta + gamma <= 1) {
        return t.a + u * beta + v * gamma;
    }
    Wide nearest = t.a;
    const std::array<std::array<Wide, 2>, 3> edges{{{t.a, t.b}, {t.b, t.c}, {t.c, t.a}}};
    for (const auto& [from, to] : edges) {
        const Wide along = to - from;
        const Wide foot = from + along * std::clamp<Real>(dot(p - from, along) / dot(along, along), 0, 1);
        if (length(p - foot) < length(p - nearest)) {
            nearest = foot;
        }
    }
    return nearest;
}

struct Turned {
    Wide base, axis;
    Real height, base_radius, top_radius;
};

/// On the meridian of p: the nearest point of a segment in space.
Wide nearest_of_frustum(const Turned& f, const Wide& p) {
    const Wide w = p - f.base;
    Wide across = w - f.axis * dot(w, f.axis);
    if (across == Wide{}) {
        across = std::abs(f.axis.x) < 0.5L ? cross(f.axis, Wide{1, 0, 0}) : cross(f.axis, Wide{0, 1, 0});
    }
    const Wide outward = across / length(across);
    const Wide from = f.base + outward * f.base_radius;
    const Wide along = f.axis * f.height + outward * (f.top_radius - f.base_radius);
    return from + along * std::clamp<Real>(dot(p - from, along) / dot(along, along), 0, 1);
}

/// `size`: m, how far the surface reaches from the origin. Places are rounded by that, too.
template <class Nearest>
Gap gap_to(const Trial& trial, double radius, double size, Nearest nearest) {
    return {Motion(trial.p, trial.v, trial.a), radius + size + length(trial.p),
            [nearest, radius](const Wide& x) { return length(x - nearest(x)) - radius; },
            [nearest](const Wide& x) {
                const Wide away = x - nearest(x);
                return away / length(away);
            }};
}

// ---------------------------------------------------------------------------------------------------------------------
// Triangle
// ---------------------------------------------------------------------------------------------------------------------

/// How thin triangles may be: their normals are no better than eps times that.
constexpr double thinness = 1000;

struct Flake {
    Vec3 a, b, c;

    static Flake random() {
        for (;;) {
            const Flake flake{direction() * decades(-1, 1), direction() * decades(-1, 1), direction() * decades(-1, 1)};
            const double area = length(cross(flake.b - flake.a, flake.c - flake.a));
            const double longest =
                std::max({length(flake.b - flake.a), length(flake.c - flake.b), length(flake.a - flake.c)});
            if (area * thinness > longest * longest) {
                return flake;
            }
        }
    }
    [[nodiscard]] Gap gap(const Trial& trial, double radius) const {
        const Corners corners{widened(a), widened(b), widened(c)};
        return gap_to(trial, radius, std::max({length(a), length(b), length(c)}),
                      [corners](const Wide& x) { return nearest_of_triangle(corners, x); });
    }
    /// A point of the face, of an edge, or a corner.
    [[nodiscard]] Vec3 point() const {
        double beta = unit();
        double gamma = (1 - beta) * unit();
        if (chance(0.3)) {
            gamma = 0;
        } else if (chance(0.3)) {
            beta = 0;
        }
        if (chance(0.2)) {
            beta = gamma = 0;
        }
        return a + (b - a) * beta + (c - a) * gamma;
    }
    [[nodiscard]] SurfaceImpact<double> impact(const Trial& trial, double radius) const {
        return time_to_triangle(trial.p, trial.v, trial.a, radius, a, b, c, trial.horizon);
    }
    [[nodiscard]] double time_growing(const Trial& trial, double radius, double growth) const {
        return detail::time_to_surface(detail::Triangle(a, b, c), {trial.p, trial.v, trial.a}, radius, growth,
                                       trial.horizon);
    }
};

/// A path that touches a surface near one of its points, or one that begins in touch.
Trial path_to(const Vec3& point, double radius) {
    const Vec3 normal = direction();
    if (chance(0.2)) {
        return parting_from(point + normal * (radius * (1 - (chance(0.5) ? decades(-16, -2) : 0))), normal);
    }
    return path_through(point + normal * radius, heading_against(normal));
}

template <class Shape>
Real judged() {
    const Shape shape = Shape::random();
    const double radius = decades(-1, 1);
    const Trial trial = path_to(shape.point(), radius);
    const SurfaceImpact<double> impact = shape.impact(trial, radius);
    const Gap gap = shape.gap(trial, radius);
    const Verdict verdict = Judge(gap).check(impact.time, trial.horizon);
    RC_LOG() << describe(trial, impact.time, verdict) << ", radius " << radius;
    RC_ASSERT(verdict.fault.empty());
    if (impact.time < no_impact) {
        const Wide normal = gap.gradient(gap.motion.at(impact.time));
        RC_ASSERT(length(normal - widened(impact.normal)) <
                  64 * gap.unit(impact.time) / radius + thinness * eps<double>);
    }
    return verdict.error;
}

/// Of a radius that grows or shrinks by a part of itself, or by twice itself.
template <class Shape>
Real judged_growing() {
    const Shape shape = Shape::random();
    const double radius = decades(-1, 1);
    const Trial trial = path_to(shape.point(), radius);
    const double growth = between(-0.9, 2) * radius / trial.horizon;
    const double time = shape.time_growing(trial, radius, growth);
    Gap gap = shape.gap(trial, radius);
    gap.growth = growth;
    const Verdict verdict = Judge(gap).check(time, trial.horizon);
    RC_LOG() << describe(trial, time, verdict) << ", radius " << radius << ", growth " << growth;
    RC_ASSERT(verdict.fault.empty());
    return verdict.error;
}

TEST(TriangleTime, ClosesTheGap) { measure(unit_of_gap, judged<Flake>); }

TEST(TriangleTime, ClosesTheGapOfWhatGrows) { measure(unit_of_gap, judged_growing<Flake>); }

RC_GTEST_PROP(TriangleTime, MirroredInputGivesTheSameBits, ()) {
    const Flake flake = Flake::random();
    const double radius = decades(-1, 1);
    const Trial trial = path_to(flake.point(), radius);
    const Mirror mirror = Mirror::random();
    const auto seen = time_to_triangle(mirror(trial.p), mirror(trial.v), mirror(trial.a), radius, mirror(flake.a),
                                       mirror(flake.b), mirror(flake.c), trial.horizon);
    const auto plain = flake.impact(trial, radius);
    RC_ASSERT(seen.time == plain.time);
    RC_ASSERT(seen.normal == mirror(plain.normal));
}

TEST(TriangleTime, SimpleNumbers) {
    const Vec3 a{0, 0, 0};
    const Vec3 b{4, 0, 0};
    const Vec3 c{0, 4, 0};
    const auto falling = [&](const Vec3& p, const Vec3& v, const Vec3& acceleration = {}) {
        return time_to_triangle(p, v, acceleration, 0.5, a, b, c, infinity);
    };
    EXPECT_EQ(falling({1, 1, 3}, {0, 0, -2}).time, 1.25);
    EXPECT_EQ(falling({1, 1, 3}, {0, 0, -2}).normal, (Vec3{0, 0, 1}));
    EXPECT_EQ(falling({1, 1, -3}, {0, 0, 2}).time, 1.25) << "from below";
    EXPECT_EQ(falling({1, 1, -3}, {0, 0, 2}).normal, (Vec3{0, 0, -1}));
    EXPECT_EQ(falling({1, 1, 1.5}, {}, {0, 0, -2}).time, 1);
    EXPECT_EQ(falling({1, -2, 0}, {0, 1, 0}).time, 1.5) << "edge on";
    EXPECT_EQ(falling({1, -2, 0}, {0, 1, 0}).normal, (Vec3{0, -1, 0}));
    EXPECT_NEAR(falling({-2, -2, 0}, {1, 1, 0}).time, 2 - 0.5 / std::sqrt(2.0), 1e-15) << "corner on";
    EXPECT_EQ(falling({1, 1, 3}, {0, 0, 2}).time, no_impact);
    EXPECT_EQ(falling({1, -0.75, 3}, {0, 0, -2}).time, no_impact) << "beside it";
    EXPECT_EQ(falling({1, 1, 0.5}, {0, 0, -1}).time, 0) << "touching and approaching";
    EXPECT_EQ(falling({1, 1, 0.5}, {}, {0, 0, -1}).time, 0) << "pressed at rest";
    EXPECT_EQ(falling({1, 1, 0.5}, {0, 0, 3}, {0, 0, -2}).time, 3) << "comes back";
    EXPECT_EQ(falling({1, 1, 0.5}, {1, 0, 0}).time, no_impact) << "slides along";
}

// ---------------------------------------------------------------------------------------------------------------------
// Frustum
// ---------------------------------------------------------------------------------------------------------------------

struct Funnel {
    Vec3 base, axis;
    double height, base_radius, top_radius;

    static Funnel random() {
        Funnel f{direction() * unit(), direction(), decades(-1, 1), decades(-1, 1), decades(-1, 1)};
        if (chance(0.2)) {
            f.top_radius = f.base_radius;
        } else if (chance(0.2)) {
            f.top_radius = 0;
        } else if (chance(0.2)) {
            f.height = 0;
        }
        return f;
    }
    [[nodiscard]] Gap gap(const Trial& trial, double radius) const {
        const Turned turned{widened(base), widened(axis) / length(widened(axis)), height, base_radius, top_radius};
        return gap_to(trial, radius, length(base) + height + base_radius + top_radius,
                      [turned](const Wide& x) { return nearest_of_frustum(turned, x); });
    }
    [[nodiscard]] Vec3 point() const {
        const double place = chance(0.3) ? (chance(0.5) ? 0 : 1) : unit();
        const Vec3 across = contact_normal(cross(axis, direction()), Vec3{});
        return base + axis * (height * place) + across * (base_radius + (top_radius - base_radius) * place);
    }
    [[nodiscard]] SurfaceImpact<double> impact(const Trial& trial, double radius) const {
        return time_to_frustum(trial.p, trial.v, trial.a, radius, base, axis, height, base_radius, top_radius,
                               trial.horizon);
    }
    [[nodiscard]] double time_growing(const Trial& trial, double radius, double growth) const {
        return detail::time_to_surface(detail::Frustum(base, detail::direction(axis), height, base_radius, top_radius),
                                       {trial.p, trial.v, trial.a}, radius, growth, trial.horizon);
    }
};

TEST(FrustumTime, ClosesTheGap) { measure(unit_of_gap, judged<Funnel>); }

TEST(FrustumTime, ClosesTheGapOfWhatGrows) { measure(unit_of_gap, judged_growing<Funnel>); }

RC_GTEST_PROP(FrustumTime, MirroredInputGivesTheSameBits, ()) {
    const Funnel f = Funnel::random();
    const double radius = decades(-1, 1);
    const Trial trial = path_to(f.point(), radius);
    const Mirror mirror = Mirror::random();
    const auto seen = time_to_frustum(mirror(trial.p), mirror(trial.v), mirror(trial.a), radius, mirror(f.base),
                                      mirror(f.axis), f.height, f.base_radius, f.top_radius, trial.horizon);
    const auto plain = f.impact(trial, radius);
    RC_ASSERT(seen.time == plain.time);
    RC_ASSERT(seen.normal == mirror(plain.normal));
}

TEST(FrustumTime, SimpleNumbers) {
    const auto cylinder = [](const Vec3& p, const Vec3& v) {
        return time_to_frustum(p, v, {}, 0.5, {}, {0, 0, 3}, 4.0, 2.0, 2.0, infinity);
    };
    EXPECT_NEAR(cylinder({0, 0, 1}, {1, 0, 0}).time, 1.5, 1e-15) << "from inside";
    EXPECT_EQ(cylinder({0.5, 0, 1}, {1, 0, 0}).normal, (Vec3{-1, 0, 0}));
    EXPECT_NEAR(cylinder({-5, 0, 1}, {1, 0, 0}).time, 2.5, 1e-15) << "from outside";
    EXPECT_NEAR(cylinder({2, 0, 9}, {0, 0, -1}).time, 4.5, 1e-15) << "on the rim";
    EXPECT_EQ(cylinder({0, 0, 9}, {0, 0, -1}).time, no_impact) << "through the middle";
    EXPECT_EQ(cylinder({4, 0, 9}, {0, 0, -1}).time, no_impact) << "past it";
    const auto cone =
        time_to_frustum(Vec3{0, 0, 5}, Vec3{0, 0, -1}, Vec3{}, 1.0, Vec3{}, Vec3{0, 0, 1}, 3.0, 0.0, 3.0, infinity);
    EXPECT_NEAR(cone.time, 5 - std::sqrt(2.0), 1e-14) << "all round, in a cone of 45 degrees";
    EXPECT_EQ(cone.normal, (Vec3{0, 0, 1}));
    const auto disc =
        time_to_frustum(Vec3{0.25, 0, 5}, Vec3{0, 0, -1}, Vec3{}, 1.0, Vec3{}, Vec3{0, 0, 1}, 0.0, 0.0, 3.0, infinity);
    EXPECT_EQ(disc.time, 4);
    EXPECT_EQ(disc.normal, (Vec3{0, 0, 1}));
}

} // namespace
} // namespace carom::test
