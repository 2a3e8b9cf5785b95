// Times of impact with planes and boxes, inside and outside.

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
// Plane
// ---------------------------------------------------------------------------------------------------------------------

/// The motion along z, over the plane z = 0.
Gap above_plane(double gap, double v, double a) {
    return {Motion({0, 0, gap}, {0, 0, v}, {0, 0, a}), 0, [](const Wide& x) { return x.z; },
            [](const Wide&) { return Wide{0, 0, 1}; }};
}

Real judged_plane() {
    const double metre = decades(-6, 6);
    const double second = decades(-6, 6);
    // Grazing from above now and then: v^2 = 2 a g.
    const double v = between(-1, 1);
    const double a = chance(0.2) ? 0 : between(-1, 1) * decades(-4, 1);
    const double gap =
        chance(0.2) && a != 0 ? v * v / (2 * a) * (1 + between(-1, 1) * decades(-17, -1)) : between(-0.2, 1);
    const double horizon = decades(-1, 3) * second;
    const Gap judged = above_plane(gap * metre, v * metre / second, a * metre / (second * second));
    const double time = time_to_plane(gap * metre, v * metre / second, a * metre / (second * second), horizon);
    const Verdict verdict = Judge(judged).check(time, horizon);
    RC_LOG() << verdict.fault << ", gap " << gap << ", v " << v << ", a " << a << ", time " << time / second;
    RC_ASSERT(verdict.fault.empty());
    return verdict.error;
}

TEST(PlaneTime, ClosesTheGap) { measure(unit_of_gap, judged_plane); }

TEST(PlaneTime, SimpleNumbers) {
    EXPECT_EQ(time_to_plane(3.0, -2.0, 0.0, infinity), 1.5);
    EXPECT_EQ(time_to_plane(3.0, -2.0, 0.0, 1.5), 1.5);
    EXPECT_EQ(time_to_plane(3.0, -2.0, 0.0, 1.4), no_impact);
    EXPECT_EQ(time_to_plane(3.0, 2.0, 0.0, infinity), no_impact);
    EXPECT_EQ(time_to_plane(3.0, 0.0, 0.0, infinity), no_impact);
    EXPECT_EQ(time_to_plane(4.0, 0.0, -2.0, infinity), 2);
    EXPECT_EQ(time_to_plane(4.0, 3.0, -2.0, infinity), 4);
    EXPECT_EQ(time_to_plane(4.0, -3.0, -2.0, infinity), 1);
    EXPECT_EQ(time_to_plane(2.0, -3.0, 2.0, infinity), 1);
    EXPECT_EQ(time_to_plane(1.0, -2.0, 2.0, infinity), no_impact) << "grazing";
    EXPECT_EQ(time_to_plane(2.0, -2.0, 2.0, infinity), no_impact);
    EXPECT_EQ(time_to_plane(2.0, 2.0, 2.0, infinity), no_impact);
    EXPECT_EQ(time_to_plane(infinity, -2.0, -2.0, infinity), no_impact);
    EXPECT_EQ(time_to_plane(infinity, 0.0, 0.0, 1.0), no_impact);
    EXPECT_EQ(time_to_plane(4.0F, 3.0F, -2.0F, 10.0F), 4.0F);
}

TEST(PlaneTime, TouchRule) {
    EXPECT_EQ(time_to_plane(0.0, -1.0, 0.0, 0.0), 0);
    EXPECT_EQ(time_to_plane(-1.0, -1.0, 5.0, 0.0), 0);
    EXPECT_EQ(time_to_plane(0.0, -1.0, 0.0, -1.0), no_impact);
    EXPECT_EQ(time_to_plane(0.0, 0.0, -1.0, infinity), 0) << "pressed at rest";
    EXPECT_EQ(time_to_plane(0.0, 0.0, 0.0, infinity), no_impact);
    EXPECT_EQ(time_to_plane(0.0, 0.0, 1.0, infinity), no_impact);
    EXPECT_EQ(time_to_plane(-1.0, 1.0, 0.0, infinity), no_impact);
    EXPECT_EQ(time_to_plane(-1.0, 1.0, 1.0, infinity), no_impact);
    EXPECT_EQ(time_to_plane(0.0, 3.0, -2.0, infinity), 3);
    EXPECT_EQ(time_to_plane(0.0, 3.0, -2.0, 2.9), no_impact);
    EXPECT_EQ(time_to_plane(-2.0, 3.0, -2.0, infinity), 2) << "gets clear, 1/4 high";
    EXPECT_EQ(time_to_plane(-3.0, 3.0, -2.0, infinity), 3) << "never gets clear";
}

// With e = 1 the ball leaves with the speed it came with: from a plane that rounding has put above or below it, each
// bounce however small takes 2 v / g, and comes back with v.
TEST(PlaneTime, TinyBouncesKeepTheirSpeed) {
    const double g = 9.81;
    for (const double gap : {0.0, -1e-17, -1e-9, -0.1}) {
        for (int power = -150; power < -10; ++power) {
            const double speed = 3 * std::pow(10.0, power);
            const double time = time_to_plane(gap, speed, -g, 1.0);
            EXPECT_NEAR(g * time - speed, speed, 4 * eps<double> * speed) << gap << " " << speed;
        }
    }
}

// VALIDATION: drop from H = 1 m, g = 9.81: t1 = 0.451523640985731 s.
TEST(PlaneTime, Drop) { EXPECT_NEAR(time_to_plane(1.0, 0.0, -9.81, infinity), 0.451523640985731, 1e-15); }

// ---------------------------------------------------------------------------------------------------------------------
// Box from inside
// ---------------------------------------------------------------------------------------------------------------------

RC_GTEST_PROP(BoxInsideTime, IsTheFirstOfSixPlanes, ()) {
    const Mirror mirror = Mirror::random();
    const Vec3 p{between(-1, 1), between(-1, 1), between(-1, 1)};
    const Vec3 v = direction() * decades(-2, 2);
    const Vec3 a = chance(0.3) ? Vec3{} : direction() * decades(-2, 2);
    const double radius = between(0, 0.5);
    const Vec3 low{-2, -3, -4};
    const Vec3 high{4, 3, 2};
    const double horizon = decades(-2, 2);
    const FaceImpact<double> found = time_to_box_inside(p, v, a, radius, low, high, horizon);

    double first = no_impact;
    for (const double time :
         {time_to_plane(p.x + 2 - radius, v.x, a.x, horizon), time_to_plane(4 - p.x - radius, -v.x, -a.x, horizon),
          time_to_plane(p.y + 3 - radius, v.y, a.y, horizon), time_to_plane(3 - p.y - radius, -v.y, -a.y, horizon),
          time_to_plane(p.z + 4 - radius, v.z, a.z, horizon), time_to_plane(2 - p.z - radius, -v.z, -a.z, horizon)}) {
        first = std::min(first, time);
    }
    RC_ASSERT(found.time == first);
    RC_ASSERT((found.face >= 0) == (first != no_impact));

    const Vec3 corner = mirror(low);
    const Vec3 opposite = mirror(high);
    const Vec3 mirrored_low{std::min(corner.x, opposite.x), std::min(corner.y, opposite.y),
                            std::min(corner.z, opposite.z)};
    const Vec3 mirrored_high{std::max(corner.x, opposite.x), std::max(corner.y, opposite.y),
                             std::max(corner.z, opposite.z)};
    const FaceImpact<double> there =
        time_to_box_inside(mirror(p), mirror(v), mirror(a), radius, mirrored_low, mirrored_high, horizon);
    RC_ASSERT(there.time == found.time);
    if (found.face >= 0) {
        const bool flipped = std::array{mirror.x, mirror.y, mirror.z}[std::size_t(found.face) / 2] < 0;
        RC_ASSERT(there.face == (flipped ? found.face ^ 1 : found.face));
    }
}

TEST(BoxInsideTime, NamesTheFace) {
    const Vec3 low{-1, -1, -1};
    const Vec3 high{1, 1, 1};
    const std::array<Vec3, 6> outward{{{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};
    for (int face = 0; face < 6; ++face) {
        const Vec3 velocity = outward[std::size_t(face)];
        const auto hit = time_to_box_inside(Vec3{}, velocity, Vec3{}, 0.5, low, high, 10.0);
        EXPECT_EQ(hit.face, face);
        EXPECT_EQ(hit.time, 0.5);
        const auto open = time_to_box_inside(Vec3{}, velocity, Vec3{}, 0.5, Vec3{-infinity, -infinity, -infinity},
                                             Vec3{infinity, infinity, infinity}, infinity);
        EXPECT_EQ(open.face, -1);
        EXPECT_EQ(open.time, no_impact);
    }
    const auto corner = time_to_box_inside(Vec3{}, Vec3{0, 1, -1}, Vec3{}, 0.5, low, high, 10.0);
    EXPECT_EQ(corner.face, 3);
    const auto single = time_to_box_inside(Vector3<float>{}, Vector3<float>{0, 0, 1}, Vector3<float>{}, 0.5F,
                                           rounded_to<float>(low), rounded_to<float>(high), 10.0F);
    EXPECT_EQ(single.face, 5);
    EXPECT_EQ(single.time, 0.5F);
}

// ---------------------------------------------------------------------------------------------------------------------
// Box from outside
// ---------------------------------------------------------------------------------------------------------------------

struct Solid {
    Vec3 low, high;
    double radius;
};

/// From the nearest point of the box to the given one; zero inside.
Wide away_from(const Solid& box, const Wide& x) {
    const auto beyond = [](Real at, Real low, Real high) {
        return std::max<Real>(at - high, 0) - std::max<Real>(low - at, 0);
    };
    return {beyond(x.x, box.low.x, box.high.x), beyond(x.y, box.low.y, box.high.y), beyond(x.z, box.low.z, box.high.z)};
}

/// How far inside the box a point is; not positive outside.
Real depth_in(const Solid& box, const Wide& x) {
    return std::min(
        {x.x - box.low.x, box.high.x - x.x, x.y - box.low.y, box.high.y - x.y, x.z - box.low.z, box.high.z - x.z});
}

Gap around(const Solid& box, const Trial& trial) {
    const Real size = box.radius + length(widened(box.low)) + length(widened(box.high));
    return {
        Motion(trial.p, trial.v, trial.a), size,
        [box](const Wide& x) { return length(away_from(box, x)) - std::max<Real>(depth_in(box, x), 0) - box.radius; },
        [box, size](const Wide& x) {
            // On the surface itself, where a point without a radius hits, rounding decides the direction.
            const Wide away = away_from(box, x);
            return length(away) > 1e-12L * size ? away / length(away) : Wide{};
        }};
}

struct BoxTrial {
    Solid box;
    Trial path;
};

/// Paths that meet a face, an edge or a corner, or just miss it, or start there.
BoxTrial random_box_trial() {
    const double metre = decades(-6, 6);
    const Solid box{Vec3{-decades(-1, 1), -decades(-1, 1), -decades(-1, 1)} * metre,
                    Vec3{decades(-1, 1), decades(-1, 1), decades(-1, 1)} * metre,
                    chance(0.15) ? 0 : decades(-3, 1) * metre};
    const auto coordinate = [](double low, double high, double normal) {
        return normal == 0 ? between(low, high) : normal > 0 ? high : low;
    };
    Vec3 normal = direction();
    const Vec3 flat{chance(0.5) ? 0.0 : 1.0, chance(0.5) ? 0.0 : 1.0, chance(0.7) ? 0.0 : 1.0};
    normal = contact_normal(Vec3{normal.x * flat.x, normal.y * flat.y, normal.z * flat.z}, Vec3{-1, 0, 0});
    const Vec3 nearest{coordinate(box.low.x, box.high.x, normal.x), coordinate(box.low.y, box.high.y, normal.y),
                       coordinate(box.low.z, box.high.z, normal.z)};
    if (chance(0.7)) {
        const double gap = chance(0.5) ? 0 : between(-1, 1) * decades(-16, -1);
        return {box, path_through((nearest + normal * (box.radius * (1 + gap))) * (1 / metre), heading_against(normal))
                         .in_units(metre, decades(-6, 6))};
    }
    const double height = box.radius * (chance(0.5) ? 1 : between(0.01, 1));
    return {box, parting_from((nearest + normal * height) * (1 / metre), normal).in_units(metre, decades(-6, 6))};
}

BoxImpact<double> time_outside(const BoxTrial& trial) {
    return time_to_box_outside(trial.path.p, trial.path.v, trial.path.a, trial.box.radius, trial.box.low,
                               trial.box.high, trial.path.horizon);
}

Real judged_box() {
    BoxTrial trial = random_box_trial();
    if (chance(0.3)) {
        trial.path.a = {};
    }
    const Wide start = away_from(trial.box, widened(trial.path.p));
    RC_PRE(length(start) > 0);
    const BoxImpact<double> hit = time_outside(trial);
    const Gap gap = around(trial.box, trial.path);
    const Verdict verdict = Judge(gap).check(hit.time, trial.path.horizon);
    RC_LOG() << describe(trial.path, hit.time, verdict) << ", box {" << trial.box.low.x << ", " << trial.box.low.y
             << ", " << trial.box.low.z << "} {" << trial.box.high.x << ", " << trial.box.high.y << ", "
             << trial.box.high.z << "}, radius " << trial.box.radius;
    RC_ASSERT(verdict.fault.empty());
    if (hit.time != no_impact) {
        RC_ASSERT(std::abs(length(hit.normal) - 1) <= 4 * eps<double>);
        const Wide away = away_from(trial.box, gap.motion.at(hit.time));
        const Real unit = gap.unit(hit.time);
        RC_ASSERT(length(away - widened(hit.normal) * length(away)) <= tolerance * unit);
    }
    return verdict.error;
}

TEST(BoxOutsideTime, ClosesTheGap) { measure(unit_of_gap, judged_box); }

RC_GTEST_PROP(BoxOutsideTime, MirroredInputGivesMirroredBits, ()) {
    BoxTrial here = random_box_trial();
    if (chance(0.2)) {
        here.path.v.x = 0; // a number whose sign the mirror cannot change
    }
    BoxTrial there = here;
    there.path.p.x = -here.path.p.x;
    there.path.v.x = -here.path.v.x;
    there.path.a.x = -here.path.a.x;
    there.box.low.x = -here.box.high.x;
    there.box.high.x = -here.box.low.x;
    const BoxImpact<double> hit = time_outside(here);
    const BoxImpact<double> mirrored = time_outside(there);
    RC_ASSERT(mirrored.time == hit.time);
    RC_ASSERT(mirrored.normal == (Mirror{-1, 1, 1}(hit.normal)));
}

// An endless slab is a plane on either side of it.
RC_GTEST_PROP(BoxOutsideTime, SlabIsAPlane, ()) {
    const double gap = decades(-3, 3);
    const Vec3 v = direction();
    const Vec3 a = direction() * decades(-3, 3);
    const double horizon = chance(0.2) ? infinity : decades(-3, 3);
    const Vec3 low{-infinity, -infinity, -1};
    const Vec3 high{infinity, infinity, 0};
    const BoxImpact<double> hit = time_to_box_outside(Vec3{5, 6, gap + 0.5}, v, a, 0.5, low, high, horizon);
    const double expected = time_to_plane(gap + 0.5 - 0.5, v.z, a.z, horizon);
    RC_ASSERT((hit.time == no_impact) == (expected == no_impact));
    if (hit.time != no_impact) {
        RC_ASSERT(hit.normal == (Vec3{0, 0, 1}));
        const Gap plane = above_plane(gap, v.z, a.z);
        RC_ASSERT(std::abs(plane.at(hit.time)) <= tolerance * (plane.unit(hit.time) + eps<double>));
    }
}

constexpr Vec3 cube_low{-1, -1, -1};
constexpr Vec3 cube_high{1, 1, 1};

BoxImpact<double> time_to_cube(const Vec3& p, const Vec3& v, const Vec3& a, double radius, double horizon = infinity) {
    return time_to_box_outside(p, v, a, radius, cube_low, cube_high, horizon);
}

TEST(BoxOutsideTime, FacesEdgesAndCorners) {
    const auto face = time_to_cube({0.5, 0.25, 5}, {0, 0, -2}, {}, 1);
    EXPECT_EQ(face.time, 1.5);
    EXPECT_EQ(face.normal, (Vec3{0, 0, 1}));
    const auto edge = time_to_cube({4, 0.5, 4}, {-1, 0, -1}, {}, std::sqrt(2.0));
    EXPECT_NEAR(edge.time, 2, 4 * eps<double>);
    EXPECT_NEAR(edge.normal.x, std::sqrt(0.5), 4 * eps<double>);
    EXPECT_EQ(edge.normal.y, 0);
    const auto corner = time_to_cube({4, -4, 4}, {-1, 1, -1}, {}, std::sqrt(3.0));
    EXPECT_NEAR(corner.time, 2, 4 * eps<double>);
    EXPECT_NEAR(corner.normal.y, -std::sqrt(1.0 / 3), 4 * eps<double>);
    EXPECT_EQ(time_to_cube({4, 0, 2.01}, {-1, 0, 0}, {}, 1).time, no_impact);
    EXPECT_EQ(time_to_cube({4, 0, 2}, {-1, 0, 0}, {}, 1).time, no_impact) << "grazes along a face";
    EXPECT_EQ(time_to_cube({4, 0, 0}, {-1, 0, 0}, {}, 1, 1.9).time, no_impact);
    EXPECT_EQ(time_to_cube({4, 0, 0}, {-1, 0, 0}, {}, 1, 2.0).time, 2);
    EXPECT_EQ(time_to_cube({4, 0, 0}, {}, {}, 1).time, no_impact);
    EXPECT_EQ(time_to_cube({1.5, 0, 0}, {}, {}, 1).time, no_impact);
    EXPECT_EQ(time_to_cube({4, 0, 0}, {-1, 0, 0}, {}, 1, -1.0).time, no_impact);
}

TEST(BoxOutsideTime, PointsWithoutARadius) {
    const auto face = time_to_cube({0.5, 0.25, 5}, {0, 0, -2}, {}, 0);
    EXPECT_EQ(face.time, 2);
    EXPECT_EQ(face.normal, (Vec3{0, 0, 1}));
    const auto edge = time_to_cube({3, 0.5, 3}, {-1, 0, -1}, {}, 0);
    EXPECT_EQ(edge.time, 2);
    EXPECT_EQ(edge.normal, (Vec3{1, 0, 0}));
    const auto fallen = time_to_cube({0, 0, 2}, {0.5, 0, 0}, {0, 0, -2}, 0);
    EXPECT_EQ(fallen.time, 1);
    EXPECT_EQ(fallen.normal, (Vec3{0, 0, 1}));
    EXPECT_EQ(time_to_cube({0, 0, 2}, {1.5, 0, 0}, {0, 0, -2}, 0).time, no_impact);
    // On the surface after a bounce: back on top of the box, or over its edge and past it.
    EXPECT_EQ(time_to_cube({0, 0, 1}, {0, 0, 2}, {0, 0, -2}, 0).time, 2);
    EXPECT_EQ(time_to_cube({0, 0, 1}, {1, 0, 2}, {0, 0, -2}, 0).time, no_impact);
    EXPECT_EQ(time_to_cube({0, 0, 1}, {0, 0, -2}, {}, 0).time, 0);
    EXPECT_EQ(time_to_cube({0, 0, 1}, {}, {0, 0, -2}, 0).time, 0);
}

TEST(BoxOutsideTime, TouchRule) {
    const Vec3 down{0, 0, -2};
    EXPECT_EQ(time_to_cube({0, 0, 2}, {0, 0, -1}, {}, 1).time, 0);
    EXPECT_EQ(time_to_cube({0, 0, 1.5}, {0, 0, -1}, {}, 1).time, 0);
    EXPECT_EQ(time_to_cube({0, 0, 1.5}, {0, 0, 1}, {}, 1).time, no_impact);
    EXPECT_EQ(time_to_cube({0, 0, 2}, {}, down, 1).time, 0) << "pressed at rest";
    EXPECT_NEAR(time_to_cube({0, 0, 2}, {0, 0, 3}, down, 1).time, 3, 4 * eps<double>);
    EXPECT_NEAR(time_to_cube({0, 0, 1.5}, {0, 0, 1}, down, 1).time, 1, 4 * eps<double>) << "never gets clear";
    // Thrown off the top: comes down beside the box.
    EXPECT_EQ(time_to_cube({0, 0, 2}, {1, 0, 3}, down, 1).time, no_impact);
    for (int power = -30; power < -10; ++power) {
        const double speed = 3 * std::pow(10.0, power);
        EXPECT_NEAR(time_to_cube({0, 0, 2}, {0, 0, speed}, down, 1).time, speed, 4 * eps<double> * speed);
    }
}

TEST(BoxOutsideTime, CentreInsideTheBoxIsDeepInTheNearestFace) {
    const auto inwards = time_to_cube({0, 0, 0.5}, {0, 0, -1}, {}, 1);
    EXPECT_EQ(inwards.time, 0);
    EXPECT_EQ(inwards.normal, (Vec3{0, 0, 1}));
    EXPECT_EQ(time_to_cube({0, 0, 0.5}, {0, 0, 1}, {}, 1).time, no_impact);
    EXPECT_EQ(time_to_cube({0, 0, 0.5}, {}, {}, 1).time, no_impact);
    EXPECT_EQ(time_to_cube({0, 0, 0.5}, {0, 0, 1}, {0, 0, -2}, 1).time, 1);
    // Out of the box, but never clear of it: back to where the centre is at the face.
    const auto half_out = time_to_cube({0, 0, 0.5}, {0, 0, 2}, {0, 0, -2}, 1);
    EXPECT_NEAR(half_out.time, 1 + std::sqrt(0.5), 4 * eps<double>);
    EXPECT_EQ(half_out.normal, (Vec3{0, 0, 1}));
}

} // namespace
} // namespace carom::test
