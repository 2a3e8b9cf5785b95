// Times of impact of spheres, outside (two spheres) and inside (a shell).

#include "gap_reference.hpp"
#include "random_input.hpp"

#include <carom/collision.hpp>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

namespace carom::test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

Gap outside_sphere(const Trial& trial, double radius) {
    return {Motion(trial.p, trial.v, trial.a), radius, [radius](const Wide& x) { return length(x) - Real(radius); },
            [](const Wide& x) { return x / length(x); }};
}

Gap inside_sphere(const Trial& trial, double clearance) {
    return {Motion(trial.p, trial.v, trial.a), clearance,
            [clearance](const Wide& x) { return Real(clearance) - length(x); },
            [](const Wide& x) { return x / -length(x); }};
}

/// Most of the paths meet the unit sphere or just miss it, the others start in touch with it or deep in it.
Trial random_trial() {
    const Vec3 normal = direction();
    if (chance(0.7)) {
        const double gap = chance(0.5) ? 0 : between(-1, 1) * decades(-16, -1);
        return path_through(normal * (1 + gap), heading_against(normal));
    }
    return parting_from(normal * (chance(0.5) ? 1 : between(0.01, 1)), normal);
}

Real judged(const Trial& trial, const Gap& gap, double time) {
    const Verdict verdict = Judge(gap).check(time, trial.horizon);
    RC_LOG() << describe(trial, time, verdict);
    RC_ASSERT(verdict.fault.empty());
    return verdict.error;
}

Real judged_sphere(const Trial& trial, double radius) {
    const double time = time_to_spheres(trial.p, trial.v, trial.a, radius, trial.horizon);
    return judged(trial, outside_sphere(trial, radius), time);
}

TEST(SphereTime, ClosesTheGapOnParabolas) {
    measure(unit_of_gap, [] {
        const double metre = decades(-6, 6);
        return judged_sphere(random_trial().in_units(metre, decades(-6, 6)), metre);
    });
}

TEST(SphereTime, ClosesTheGapOnStraightPaths) {
    measure(unit_of_gap, [] {
        const double metre = decades(-6, 6);
        Trial trial = random_trial().in_units(metre, decades(-6, 6));
        trial.a = {};
        const double straight = time_to_spheres(trial.p, trial.v, metre, trial.horizon);
        RC_ASSERT(straight == time_to_spheres(trial.p, trial.v, trial.a, metre, trial.horizon));
        return judged_sphere(trial, metre);
    });
}

Trial random_trial_in_a_shell() {
    Trial trial = random_trial();
    if (chance(0.7)) {
        trial.p = direction() * between(0, 1);
    } else {
        trial.v = -trial.v;
    }
    if (chance(0.2)) {
        trial.a = {};
    }
    return trial;
}

TEST(SphereTime, ClosesTheGapInsideAShell) {
    measure(unit_of_gap, [] {
        const double metre = decades(-6, 6);
        const Trial trial = random_trial_in_a_shell().in_units(metre, decades(-6, 6));
        const double time = time_to_shell_inside(trial.p, trial.v, trial.a, metre, trial.horizon);
        return judged(trial, inside_sphere(trial, metre), time);
    });
}

RC_GTEST_PROP(SphereTime, MirroredInputGivesTheSameBits, ()) {
    const Mirror mirror = Mirror::random();
    const Trial t = random_trial();
    RC_ASSERT(time_to_spheres(t.p, t.v, 1.0, t.horizon) == time_to_spheres(mirror(t.p), mirror(t.v), 1.0, t.horizon));
    RC_ASSERT(time_to_spheres(t.p, t.v, t.a, 1.0, t.horizon) ==
              time_to_spheres(mirror(t.p), mirror(t.v), mirror(t.a), 1.0, t.horizon));
    RC_ASSERT(time_to_shell_inside(t.p, t.v, t.a, 1.0, t.horizon) ==
              time_to_shell_inside(mirror(t.p), mirror(t.v), mirror(t.a), 1.0, t.horizon));
}

RC_GTEST_PROP(SphereTime, ExchangingTheBodiesGivesTheSameBits, ()) {
    const Trial t = random_trial();
    RC_ASSERT(time_to_spheres(t.p, t.v, 1.0, t.horizon) == time_to_spheres(-t.p, -t.v, 1.0, t.horizon));
    RC_ASSERT(time_to_spheres(t.p, t.v, t.a, 1.0, t.horizon) == time_to_spheres(-t.p, -t.v, -t.a, 1.0, t.horizon));
    RC_ASSERT(time_to_shell_outside(t.p, t.v, t.a, 1.0, t.horizon) == time_to_spheres(t.p, t.v, t.a, 1.0, t.horizon));
}

// A float's time is the double's time, rounded.
RC_GTEST_PROP(SphereTime, SingleIsTheRoundedDouble, ()) {
    const Trial t = random_trial();
    const auto p = rounded_to<float>(t.p);
    const auto v = rounded_to<float>(t.v);
    const auto a = rounded_to<float>(t.a);
    const auto horizon = static_cast<float>(t.horizon);
    const double time =
        time_to_spheres(detail::wide(p), detail::wide(v), detail::wide(a), 1.0, static_cast<double>(horizon));
    RC_ASSERT(time_to_spheres(p, v, a, 1.0F, horizon) == static_cast<float>(time));
}

// The horizon cuts impacts off, and changes nothing else. The search on a parabola starts from the horizon, so the last
// bits of its time may depend on it: what counts is that the gap is right.
RC_GTEST_PROP(SphereTime, HorizonOnlyCutsOff, ()) {
    const Trial trial = random_trial();
    const double straight = time_to_spheres(trial.p, trial.v, 1.0, infinity);
    RC_ASSERT(time_to_spheres(trial.p, trial.v, 1.0, trial.horizon) ==
              (straight <= trial.horizon ? straight : no_impact));

    const double endless = time_to_spheres(trial.p, trial.v, trial.a, 1.0, infinity);
    const double time = endless <= trial.horizon ? endless : no_impact;
    judged(trial, outside_sphere(trial, 1), time);
}

// An elastic collision run backwards retraces itself. A position is rounded by eps times the lengths involved, which a
// normal turned by eps length / R carries into the velocity, and the flight back into the position, once more each; a
// hit within 5 degrees of a graze is left out, there the time itself is badly conditioned.
RC_GTEST_PROP(SphereTime, ElasticCollisionReversesInTime, ()) {
    const Vec3 normal = direction();
    const Vec3 v_a = direction() * decades(-1, 1);
    const Vec3 v_b = direction() * decades(-1, 1);
    const Vec3 relative = v_b - v_a;
    RC_PRE(-dot(relative, normal) > 0.1 * length(relative));
    const double before = decades(-1, 2);
    const double after = decades(-1, 2);
    const Vec3 start_a = -(v_a * before);
    const Vec3 start_b = normal - v_b * before;

    const auto collide = [&](Vec3& x_a, Vec3& u_a, Vec3& x_b, Vec3& u_b, double rest) {
        const double time = time_to_spheres(x_b - x_a, u_b - u_a, 1.0, infinity);
        x_a += u_a * time;
        x_b += u_b * time;
        respond(contact_normal(x_b - x_a, u_b - u_a), 1.0, u_a, 3.0, u_b, 1.0);
        x_a += u_a * rest;
        x_b += u_b * rest;
        return time;
    };
    Vec3 x_a = start_a;
    Vec3 x_b = start_b;
    Vec3 u_a = v_a;
    Vec3 u_b = v_b;
    const double there = collide(x_a, u_a, x_b, u_b, after);
    u_a = -u_a;
    u_b = -u_b;
    const double back = collide(x_a, u_a, x_b, u_b, there);

    const double speed = length(v_a) + length(v_b);
    const double travelled = 1 + speed * (before + after);
    const double unit = eps<double> * travelled * travelled * 10;
    RC_ASSERT(std::abs(back - after) * length(relative) <= 16 * unit);
    RC_ASSERT(length(u_a + v_a) + length(u_b + v_b) <= 16 * unit * speed);
    RC_ASSERT(length(x_a - start_a) + length(x_b - start_b) <= 16 * unit * travelled);
}

TEST(SphereTime, StraightCasesWithSimpleNumbers) {
    EXPECT_EQ(time_to_spheres(Vec3{3, 0, 0}, Vec3{-2, 0, 0}, 1.0, infinity), 1);
    EXPECT_EQ(time_to_spheres(Vec3{3, 0, 0}, Vec3{-2, 0, 0}, 1.0, 1.0), 1);
    EXPECT_EQ(time_to_spheres(Vec3{3, 0, 0}, Vec3{-2, 0, 0}, 1.0, 0.99), no_impact);
    EXPECT_EQ(time_to_spheres(Vec3{3, 0, 0}, Vec3{2, 0, 0}, 1.0, infinity), no_impact);
    EXPECT_EQ(time_to_spheres(Vec3{3, 0, 0}, Vec3{}, 1.0, infinity), no_impact);
    EXPECT_EQ(time_to_spheres(Vec3{3, 1, 0}, Vec3{-1, 0, 0}, 1.0, infinity), no_impact) << "grazing";
    EXPECT_EQ(time_to_spheres(Vec3{1e9, 0, 0}, Vec3{-1e-3, 0, 0}, 1.0, infinity), (1e9 - 1) / 1e-3);
}

TEST(SphereTime, TouchRuleOnStraightPaths) {
    EXPECT_EQ(time_to_spheres(Vec3{1, 0, 0}, Vec3{-1, 0, 0}, 1.0, 0.0), 0);
    EXPECT_EQ(time_to_spheres(Vec3{0.9, 0, 0}, Vec3{-1, 0, 0}, 1.0, infinity), 0);
    EXPECT_EQ(time_to_spheres(Vec3{0.9, 0, 0}, Vec3{1, 0, 0}, 1.0, infinity), no_impact);
    EXPECT_EQ(time_to_spheres(Vec3{0.9, 0, 0}, Vec3{0, 1, 0}, 1.0, infinity), no_impact);
    EXPECT_EQ(time_to_spheres(Vec3{0.9, 0, 0}, Vec3{}, 1.0, infinity), no_impact);
    EXPECT_EQ(time_to_spheres(Vec3{}, Vec3{1, 0, 0}, 1.0, infinity), no_impact) << "coincident centres part";
    EXPECT_EQ(time_to_spheres(Vec3{1, 0, 0}, Vec3{-1, 0, 0}, 1.0, -1.0), no_impact);
}

TEST(SphereTime, PointsMeetOnlyHeadOn) {
    EXPECT_EQ(time_to_spheres(Vec3{3, 4, 0}, Vec3{-6, -8, 0}, 0.0, infinity), 0.5);
    EXPECT_EQ(time_to_spheres(Vec3{3, 1e-9, 0}, Vec3{-1, 0, 0}, 0.0, infinity), no_impact);
    EXPECT_EQ(time_to_spheres(Vec3{0, 0, 2}, Vec3{}, Vec3{0, 0, -4}, 0.0, infinity), 1);
    EXPECT_EQ(time_to_spheres(Vec3{}, Vec3{0, 0, 2}, Vec3{0, 0, -4}, 0.0, infinity), 1);
    EXPECT_EQ(time_to_spheres(Vec3{}, Vec3{0, 0, 2}, Vec3{0, 0, -4}, 0.0, 0.5), no_impact);
    EXPECT_EQ(time_to_spheres(Vec3{}, Vec3{0, 0, 2}, Vec3{0, 1, -4}, 0.0, infinity), no_impact);
    EXPECT_EQ(time_to_spheres(Vec3{0, 0, 2}, Vec3{0, 1e-9, 0}, Vec3{0, 0, -4}, 0.0, infinity), no_impact);
}

TEST(SphereTime, TouchRuleOnParabolas) {
    const Vec3 above{0, 0, 1};
    const Vec3 down{0, 0, -2};
    EXPECT_EQ(time_to_spheres(above, Vec3{}, down, 1.0, infinity), 0) << "pressed at rest";
    EXPECT_EQ(time_to_spheres(above, Vec3{}, -down, 1.0, infinity), no_impact) << "pulled away";
    EXPECT_EQ(time_to_spheres(above, Vec3{1, 0, 0}, down, 1.0, infinity), 0) << "slides slower than it falls";
    EXPECT_EQ(time_to_spheres(above, Vec3{2, 0, 0}, down, 1.0, infinity), no_impact) << "slides off";
    EXPECT_NEAR(time_to_spheres(above, Vec3{0, 0, 3}, down, 1.0, infinity), 3, 3 * eps<double>) << "thrown up";
    EXPECT_EQ(time_to_spheres(above, Vec3{0, 0, 3}, down, 1.0, 2.9), no_impact);
    // Overlapped by 1/2: up to 1/4 above the start it never gets clear and counts from where it is.
    const Vec3 deep{0, 0, 0.5};
    EXPECT_NEAR(time_to_spheres(deep, Vec3{0, 0, 1}, down, 1.0, infinity), 1, 2 * eps<double>);
    EXPECT_NEAR(time_to_spheres(deep, Vec3{0, 0, 2}, down, 1.0, infinity), 1 + std::sqrt(0.5), 4 * eps<double>);
    EXPECT_EQ(time_to_spheres(Vec3{}, Vec3{}, down, 1.0, infinity), no_impact) << "pulled out of coincidence";
}

// A bounce far below the rounding of the distance takes its full flight time, however small, from any contact gap that
// rounding leaves: else a ball on the ground would sink into it.
TEST(SphereTime, TinyBouncesTakeTheirTime) {
    const double g = 9.81;
    for (const double distance : {1.0, 1 - eps<double>, 0.7}) {
        for (int power = -30; power < -10; ++power) {
            const double speed = 3 * std::pow(10.0, power);
            const double expected = 2 * speed / g;
            const double outside = time_to_spheres(Vec3{0, 0, distance}, Vec3{0, 0, speed}, Vec3{0, 0, -g}, 1.0, 1.0);
            EXPECT_NEAR(outside, expected, 4 * eps<double> * expected) << distance << " " << speed;
            const double inside =
                time_to_shell_inside(Vec3{0, 0, -2 + distance}, Vec3{0, 0, speed}, Vec3{0, 0, -g}, 1.0, 1.0);
            EXPECT_NEAR(inside, expected, 4 * eps<double> * expected) << distance << " " << speed;
        }
    }
}

TEST(SphereTime, ShellCasesWithSimpleNumbers) {
    const Vec3 none{};
    EXPECT_EQ(time_to_shell_inside(none, Vec3{2, 0, 0}, none, 3.0, infinity), 1.5);
    EXPECT_EQ(time_to_shell_inside(none, none, none, 3.0, infinity), no_impact);
    EXPECT_EQ(time_to_shell_inside(none, none, Vec3{0, 0, -2}, 4.0, infinity), 2);
    EXPECT_EQ(time_to_shell_inside(Vec3{3, 0, 0}, Vec3{1, 0, 0}, none, 3.0, infinity), 0);
    EXPECT_EQ(time_to_shell_inside(Vec3{3, 0, 0}, Vec3{-1, 0, 0}, none, 3.0, infinity), 6);
    EXPECT_EQ(time_to_shell_inside(Vec3{3, 0, 0}, Vec3{0, 1, 0}, none, 3.0, infinity), 0) << "rolls along";
    EXPECT_EQ(time_to_shell_inside(Vec3{5, 0, 0}, Vec3{-1, 0, 0}, none, 3.0, infinity), 8) << "gets clear";
    EXPECT_EQ(time_to_shell_inside(Vec3{3, 4, 0}, Vec3{-1, 0, 0}, none, 3.0, infinity), 6) << "never gets clear";
    EXPECT_EQ(time_to_shell_inside(Vec3{0, 1, 0}, Vec3{1, 0, 0}, none, 1.0, infinity), 0);
    EXPECT_EQ(time_to_shell_inside(none, Vec3{1, 0, 0}, none, -1.0, infinity), 0) << "does not fit";
}

TEST(SphereTime, ExtremeTimesEndAndStayExact) {
    EXPECT_NEAR(time_to_spheres(Vec3{2, 0, 0}, Vec3{-1e-60, 0, 0}, 1.0, infinity), 1e60, 1e60 * eps<double>);
    // v t = 2 d, and the acceleration only matters long after.
    EXPECT_NEAR(time_to_spheres(Vec3{2, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 0, 1e-30}, 1.0, infinity), 1, 4 * eps<double>);
    // Thrown away and pulled back: after 2 v / a.
    EXPECT_NEAR(time_to_spheres(Vec3{2, 0, 0}, Vec3{1, 0, 0}, Vec3{-1e-9, 0, 0}, 1.0, infinity), 2e9 + 1, 1e-6);
    EXPECT_EQ(time_to_spheres(Vec3{2, 0, 0}, Vec3{1, 0, 0}, Vec3{-1e-9, 0, 0}, 1.0, 1e9), no_impact);
    EXPECT_EQ(time_to_spheres(Vec3{2, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 0, 1}, 1.0, 0.0), no_impact);
    EXPECT_EQ(time_to_spheres(Vec3{2, 0, 0}, Vec3{-1, 0, 0}, Vec3{0, 0, 1}, 1.0, -1.0), no_impact);
}

} // namespace
} // namespace carom::test
