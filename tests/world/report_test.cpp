// What a step reports, and what an impact says: against closed formulas.

#include "world/nearness.hpp"
#include "world/refusals.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <random>
#include <string>
#include <tuple>

namespace carom {

namespace {

using test::eps;
using test::expect_near;

class Reports : public test::BothPrecisions {};

INSTANTIATE_TEST_SUITE_P(Precisions, Reports, test::both_precisions(), test::precision_name);

bool same(const Impact& x, const Impact& y) {
    return x.time == y.time && x.offset == y.offset && x.a == y.a && x.b == y.b && x.face == y.face &&
           x.position == y.position && x.normal == y.normal && x.impulse == y.impulse &&
           x.approach_speed == y.approach_speed && x.energy_lost == y.energy_lost;
}

/// 125 bodies of many kinds in a box, one in five at some 40 m/s.
World gas(Precision precision, const WorldOptions& base = {}) {
    WorldOptions options = base;
    options.precision = precision;
    options.region = Box{{0, 0, 0}, {10, 10, 10}};
    World world(options);
    std::mt19937 random(7); // NOLINT(cert-msc51-cpp): fixed
    const auto number = [&random](double low, double high) {
        return low + static_cast<double>(random() % 65536) * ((high - low) / 65536);
    };
    for (int k = 0; k < 125; ++k) {
        const int layer = k / 25;
        const double speed = k % 5 == 0 ? 40 : 4;
        world.add({.position = {2.0 * (k % 5) + 1, 2.0 * ((k / 5) % 5) + 1, 2.0 * layer + 1},
                   .velocity = {number(-speed, speed), number(-speed, speed), number(-speed, speed)},
                   .mass = number(0.5, 8),
                   .radius = number(0.25, 0.75),
                   .restitution = number(0.5, 1),
                   .friction = number(0, 0.5)});
    }
    return world;
}

// ---------------------------------------------------------------------------------------------------------------------
// Impacts
// ---------------------------------------------------------------------------------------------------------------------

/// Two bodies of radius 2.5 m that meet after 4 s when they are (4, 3, 0) m apart; all numbers before that are exact.
struct ObliquePair {
    static constexpr double mass_a = 2;
    static constexpr double mass_b = 6;
    static constexpr double reduced = 1.5;
    static constexpr double e = 0.5;
    static constexpr double approach = 3.2;   ///< m/s, 4 * 4/5
    static constexpr double tangential = 2.4; ///< m/s, 4 * 3/5
    static constexpr double impulse = (1 + e) * reduced * approach;
    static constexpr double restitution_loss = (1 - e * e) * reduced * approach * approach / 2;
    Vec3 normal{0.8, 0.6, 0}; ///< from a to b

    World world;
    BodyId a, b;

    ObliquePair(Precision precision, double friction, bool b_first = false) : world({.precision = precision}) {
        const Body body_a{.velocity = {3, 0, 0}, .mass = mass_a, .radius = 2.5, .restitution = e, .friction = friction};
        const Body body_b{.position = {20, 3, 0},
                          .velocity = {-1, 0, 0},
                          .mass = mass_b,
                          .radius = 2.5,
                          .restitution = 0.25,
                          .friction = friction};
        if (b_first) b = world.add(body_b);
        a = world.add(body_a);
        if (!b_first) b = world.add(body_b);
    }
};

TEST_P(Reports, AnImpactOfTwoBodies) {
    for (const bool b_first : {false, true}) {
        ObliquePair pair(GetParam(), 0, b_first);
        pair.world.step(1.5);
        pair.world.step(4.5);
        ASSERT_EQ(pair.world.impacts().size(), 1U);
        const Impact& impact = pair.world.impacts().front();
        // A handful of roundings, of numbers up to 20.
        const double tolerance = 8 * 20 * eps;
        EXPECT_NEAR(impact.time, 4, tolerance);
        EXPECT_NEAR(impact.offset, 2.5, tolerance);
        EXPECT_EQ(impact.a, b_first ? pair.b : pair.a);
        EXPECT_EQ(impact.b, b_first ? pair.a : pair.b);
        EXPECT_EQ(impact.face, -1);
        expect_near(impact.position, {14, 1.5, 0}, tolerance, "position");
        expect_near(impact.normal, b_first ? -pair.normal : pair.normal, tolerance, "normal");
        EXPECT_NEAR(impact.approach_speed, ObliquePair::approach, tolerance);
        EXPECT_NEAR(impact.impulse, ObliquePair::impulse, tolerance);
        EXPECT_NEAR(impact.energy_lost, ObliquePair::restitution_loss, tolerance);
        const Vec3 change = pair.normal * ObliquePair::impulse;
        const double rounding = 8 * 4 * kept_eps();
        expect_near(pair.world.get(pair.a).velocity, Vec3{3, 0, 0} - change / ObliquePair::mass_a, rounding, "v_a");
        expect_near(pair.world.get(pair.b).velocity, Vec3{-1, 0, 0} + change / ObliquePair::mass_b, rounding, "v_b");
    }
}

TEST_P(Reports, AnImpactsLossWithFriction) {
    for (const double mu : {0.125, 1.0}) {
        ObliquePair pair(GetParam(), mu);
        const double before = pair.world.energy().kinetic;
        pair.world.step(5);
        // Friction takes at most mu j / m off the tangential speed, and stops it at most.
        const double left = std::max(0.0, ObliquePair::tangential - mu * ObliquePair::impulse / ObliquePair::reduced);
        const double friction_loss =
            ObliquePair::reduced * (ObliquePair::tangential * ObliquePair::tangential - left * left) / 2;
        const double tolerance = 8 * 20 * eps;
        const Ledger& ledger = pair.world.ledger();
        EXPECT_NEAR(ledger.lost_to_restitution, ObliquePair::restitution_loss, tolerance) << mu;
        EXPECT_NEAR(ledger.lost_to_friction, friction_loss, tolerance) << mu;
        EXPECT_NEAR(pair.world.impacts()[0].energy_lost, ObliquePair::restitution_loss + friction_loss, tolerance);
        EXPECT_NEAR(before - pair.world.energy().kinetic, ObliquePair::restitution_loss + friction_loss,
                    8 * 20 * kept_eps());
        EXPECT_EQ(ledger.outer_impulse, Vec3{});
    }
}

TEST_P(Reports, AnImpactAtEachFaceOfABox) {
    const std::array<Vec3, 6> outward{{{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};
    for (std::size_t face = 0; face < outward.size(); ++face) {
        World world({.region = Box{{-8, -8, -8}, {8, 8, 8}}, .precision = GetParam()});
        const Vec3 n = outward[face];
        const BodyId id = world.add({.velocity = n * 7, .mass = 3, .radius = 1, .restitution = 0.5});
        world.step(1.5);
        ASSERT_EQ(world.impacts().size(), 1U);
        const Impact& impact = world.impacts().front();
        EXPECT_EQ(impact.face, static_cast<std::int32_t>(face));
        EXPECT_EQ(impact.time, 1);
        EXPECT_EQ(impact.a, id);
        EXPECT_EQ(impact.b, BodyId{});
        EXPECT_EQ(impact.position, n * 8);
        EXPECT_EQ(impact.normal, n);
        EXPECT_EQ(impact.approach_speed, 7);
        EXPECT_EQ(impact.impulse, 1.5 * 3 * 7);
        EXPECT_EQ(impact.energy_lost, 0.75 * 3 * 49 / 2);
        EXPECT_EQ(world.ledger().outer_impulse, n * -impact.impulse);
    }
}

TEST_P(Reports, AnImpactAtAPlaneAndInAShell) {
    const double tolerance = 8 * 10 * eps;
    World slope({.region = std::vector<Plane>{{.point = {-100, 0, 0}, .normal = {1, 0, 0}}, {.normal = {3, 0, 4}}},
                 .precision = GetParam()});
    slope.add({.position = {6, 0, 8}, .velocity = {-3, 0, -4}, .radius = 1});
    slope.step(2);
    ASSERT_EQ(slope.impacts().size(), 1U);
    EXPECT_EQ(slope.impacts()[0].face, 1);
    EXPECT_NEAR(slope.impacts()[0].time, 9.0 / 5, tolerance);
    expect_near(slope.impacts()[0].normal, {-0.6, 0, -0.8}, tolerance, "slope");
    // The body's own place is rounded to the resolution.
    expect_near(slope.impacts()[0].position, {}, slope.resolution() + tolerance, "slope");

    World shell({.region = Shell{.centre = {1, 2, 3}, .radius = 10}, .precision = GetParam()});
    shell.add({.position = {1, 2, 3}, .velocity = {0, 0, -3}, .radius = 1});
    shell.step(4);
    ASSERT_EQ(shell.impacts().size(), 1U);
    EXPECT_EQ(shell.impacts()[0].face, 0);
    EXPECT_NEAR(shell.impacts()[0].time, 3, tolerance);
    expect_near(shell.impacts()[0].normal, {0, 0, -1}, tolerance, "shell");
    expect_near(shell.impacts()[0].position, {1, 2, -7}, tolerance, "shell");
}

TEST_P(Reports, AStaticBodyTakesTheImpulseAsAnOuterOne) {
    for (const bool static_first : {false, true}) {
        World world({.precision = GetParam()});
        const Body rock{.position = {4, 0, 0}, .mass = infinite_mass};
        if (static_first) world.add(rock);
        world.add({.velocity = {3, 0, 0}, .mass = 2, .restitution = 1});
        if (!static_first) world.add(rock);
        world.step(2);
        ASSERT_EQ(world.impacts().size(), 1U);
        EXPECT_LT(world.impacts()[0].a, world.impacts()[0].b);
        EXPECT_EQ(world.impacts()[0].normal, (Vec3{static_first ? -1.0 : 1.0, 0, 0}));
        EXPECT_EQ(world.impacts()[0].impulse, 12);
        EXPECT_EQ(world.ledger().outer_impulse, (Vec3{-12, 0, 0}));
        EXPECT_EQ(world.ledger().impacts, 1U);
        EXPECT_EQ(world.momentum(), (Vec3{-6, 0, 0}));
    }
}

TEST_P(Reports, ImpactsComeInTheOrderOfTimeAndAreSound) {
    World world = gas(GetParam());
    std::uint64_t pairs = 0;
    std::uint64_t faces = 0;
    double lost = 0;
    for (int i = 0; i < 30; ++i) {
        const double start = world.time();
        const StepReport& report = world.step(1.0 / 60);
        const auto impacts = world.impacts();
        EXPECT_EQ(impacts.size(), report.impacts + report.face_impacts);
        EXPECT_TRUE(std::is_sorted(impacts.begin(), impacts.end(),
                                   [](const Impact& x, const Impact& y) { return x.offset < y.offset; }));
        for (const Impact& impact : impacts) {
            EXPECT_EQ(impact.time, start + impact.offset);
            EXPECT_TRUE(impact.offset >= 0 && impact.offset <= 1.0 / 60);
            EXPECT_TRUE(impact.face >= 0 ? !impact.b.is_set() : impact.a < impact.b);
            // Three squares, their sum and a root round by less than 4 eps.
            EXPECT_NEAR(length(impact.normal), 1, 4 * eps);
            EXPECT_GT(impact.approach_speed, 0);
            EXPECT_GT(impact.impulse, 0);
            EXPECT_GE(impact.energy_lost, 0);
            ++(impact.face >= 0 ? faces : pairs);
            lost += impact.energy_lost;
        }
    }
    EXPECT_GT(pairs, 100U);
    EXPECT_GT(faces, 100U);
    EXPECT_EQ(world.ledger().impacts, pairs);
    EXPECT_EQ(world.ledger().face_impacts, faces);
    // A plain sum of n numbers rounds by less than n eps of it.
    EXPECT_NEAR(world.ledger().lost_to_restitution + world.ledger().lost_to_friction, lost,
                static_cast<double>(pairs + faces) * eps * lost);
}

TEST_P(Reports, ImpactsAtOneTimeComeInTheOrderOfIds) {
    World world({.precision = GetParam()});
    // Pairs (0, 5), (1, 6), ... on lanes that are far from in order in space.
    for (const double x : {0.0, 4.0}) {
        for (const double y : {40.0, -80.0, 0.0, 80.0, -40.0}) {
            world.add({.position = {x, y, 0}, .velocity = {x == 0 ? 1.0 : -1.0, 0, 0}});
        }
    }
    world.step(2);
    ASSERT_EQ(world.impacts().size(), 5U);
    for (std::uint32_t k = 0; k < 5; ++k) {
        EXPECT_EQ(world.impacts()[k].offset, 1.5);
        EXPECT_EQ(world.impacts()[k].a.slot, k);
        EXPECT_EQ(world.impacts()[k].b.slot, k + 5);
    }
}

TEST_P(Reports, WhatIsNotRecordedHappensAllTheSame) {
    World all = gas(GetParam());
    World none = all;
    World strong = all;
    const double least = 20;
    none.set_recording(false);
    strong.set_recording(true, least);
    std::size_t recorded = 0;
    std::size_t seen = 0;
    for (int i = 0; i < 20; ++i) {
        const StepReport expected = all.step(1.0 / 60);
        none.step(1.0 / 60);
        strong.step(1.0 / 60);
        std::vector<Impact> weighty;
        std::copy_if(all.impacts().begin(), all.impacts().end(), std::back_inserter(weighty),
                     [least](const Impact& impact) { return impact.impulse >= least; });
        const auto kept = strong.impacts();
        EXPECT_TRUE(std::equal(kept.begin(), kept.end(), weighty.begin(), weighty.end(), same));
        EXPECT_TRUE(none.impacts().empty());
        for (const World* other : {&none, &strong}) {
            EXPECT_EQ(other->report().impacts, expected.impacts);
            EXPECT_EQ(other->report().face_impacts, expected.face_impacts);
            EXPECT_EQ(other->hash(), all.hash());
            EXPECT_EQ(other->ledger(), all.ledger());
        }
        recorded += kept.size();
        seen += all.impacts().size();
    }
    EXPECT_GT(recorded, 10U);
    EXPECT_GT(seen, recorded + 10U);
}

// ---------------------------------------------------------------------------------------------------------------------
// Reports of a step
// ---------------------------------------------------------------------------------------------------------------------

TEST_P(Reports, ALoneBodyIsNoWork) {
    World world({.precision = GetParam(), .min_windows = 5});
    world.add({.velocity = {1, 2, 3}});
    const StepReport& report = world.step(0.1);
    EXPECT_EQ(report.advanced, 0.1);
    EXPECT_EQ(report.behind, 0);
    EXPECT_FALSE(report.work_cap_reached || report.edge_reached);
    EXPECT_EQ(report.impacts + report.face_impacts + report.predictions + report.tc_conversions + report.held, 0U);
    EXPECT_EQ(report.windows, 5U);
    world.set_min_windows(1);
    EXPECT_EQ(world.step(0.1).windows, 1U);
    EXPECT_EQ(&world.report(), &report);
}

TEST_P(Reports, CountsOfEachStepAndOfAll) {
    World world({.region = Box{{0, 0, 0}, {10, 10, 10}}, .precision = GetParam()});
    world.add({.position = {2, 2, 2}, .velocity = {2, 0, 0}});
    world.add({.position = {4, 2, 2}, .velocity = {-2, 0, 0}});
    world.add({.position = {5, 8, 8}, .velocity = {0, 3, 0}});
    // The pair meets after 1/4 s, the third is at a face after 1/2 s, and the next one there after 5/4 s.
    const StepReport first = world.step(1);
    EXPECT_EQ(first.impacts, 1U);
    EXPECT_EQ(first.face_impacts, 1U);
    EXPECT_GE(first.predictions, 1U);
    const StepReport second = world.step(0.125);
    EXPECT_EQ(second.impacts + second.face_impacts, 0U);
    const StepReport third = world.step(2);
    EXPECT_EQ(world.ledger().impacts, 1U + third.impacts);
    EXPECT_GE(third.face_impacts, 1U);
    EXPECT_EQ(world.ledger().face_impacts, 1U + third.face_impacts);
    EXPECT_EQ(world.step_count(), 3U);
}

TEST_P(Reports, HeldBodiesAreCounted) {
    World world({.gravity = {0, 0, -10}, .region = std::vector<Plane>{{}}, .precision = GetParam()});
    std::vector<BodyId> lying;
    for (const double x : {0.0, 3.0, 6.0}) lying.push_back(world.add({.position = {x, 0, 0.5}, .restitution = 0}));
    world.add({.position = {9, 0, 100}});
    EXPECT_EQ(world.step(0.01).held, 3U);
    EXPECT_TRUE(std::all_of(lying.begin(), lying.end(), [&](BodyId id) { return world.held(id); }));
    world.change_velocities(std::array{lying[1]}, std::array{Vec3{0, 0, 5}});
    EXPECT_EQ(world.step(0.01).held, 2U);
}

/// Three balls in a line with e = 0.03 collapse: McNamara & Young, Phys. Fluids A 4, 496 (1992).
TEST_P(Reports, ConversionsAreTheImpactsThatLoseNothing) {
    World world({.precision = GetParam()});
    for (const double x : {-1.5, 0.0, 1.5}) {
        world.add({.position = {x, 0, 0}, .velocity = {x / -1.5, 0, 0}, .restitution = 0.03});
    }
    std::uint64_t conversions = 0;
    std::uint64_t lossless = 0;
    for (int i = 0; i < 120; ++i) {
        conversions += world.step(1.0 / 60).tc_conversions;
        const auto impacts = world.impacts();
        lossless += static_cast<std::uint64_t>(std::count_if(
            impacts.begin(), impacts.end(), [](const Impact& impact) { return impact.energy_lost == 0; }));
    }
    EXPECT_GT(conversions, 0U);
    EXPECT_EQ(conversions, lossless);
}

TEST_P(Reports, PhasesLastNoLongerThanTheCall) {
    World world = gas(GetParam());
    for (int i = 0; i < 10; ++i) {
        const auto start = std::chrono::steady_clock::now();
        const PhaseTimes& seconds = world.step(1.0 / 60).seconds;
        const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - start;
        const std::array phases{seconds.forces, seconds.contacts, seconds.cells,
                                seconds.pairs,  seconds.impacts,  seconds.bodies};
        double sum = 0;
        for (const double phase : phases) {
            EXPECT_GE(phase, 0);
            sum += phase;
        }
        EXPECT_GT(seconds.impacts, 0);
        // Differences of the clock are whole nanoseconds, a few of them rounded as doubles.
        EXPECT_LE(sum, wall.count() * (1 + 16 * eps));
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Steps that end early
// ---------------------------------------------------------------------------------------------------------------------

TEST_P(Reports, TheWorkCapEndsAStepAtTheNextImpact) {
    for (const std::uint64_t cap : {1U, 7U, 20U}) {
        World capped = gas(GetParam(), {.gravity = {0, 0, -9.81}});
        for (int i = 0; i < 3; ++i) capped.step(0.01);
        World whole = capped;
        capped.set_work_cap(cap);
        const double start = capped.time();
        const double dt = 0.1;
        const StepReport& report = capped.step(dt);
        whole.step(dt);
        const auto expected = whole.impacts();
        ASSERT_GT(expected.size(), cap);
        EXPECT_FALSE(whole.report().work_cap_reached);
        EXPECT_TRUE(report.work_cap_reached);
        EXPECT_FALSE(report.edge_reached);
        EXPECT_EQ(report.impacts + report.face_impacts, cap);
        EXPECT_EQ(report.advanced, expected[cap].offset);
        EXPECT_EQ(report.behind, dt - report.advanced);
        EXPECT_NEAR(capped.time(), start + report.advanced, eps);
        const auto done = capped.impacts();
        EXPECT_TRUE(std::equal(done.begin(), done.end(), expected.begin(),
                               expected.begin() + static_cast<std::ptrdiff_t>(done.size()), same));
    }
}

/// Lanes with two bodies each that bounce between the walls and each other. Places, speeds and times are multiples of
/// 1/64, so that nothing is ever rounded.
World exact_lanes(Precision precision) {
    World world({.region = Box{{0, 0, 0}, {16, 64, 4}}, .precision = precision});
    for (int k = 0; k < 12; ++k) {
        const double speed = 1 << (k % 3);
        const double place = 0.5 + 0.25 * k;
        const double y = 2 + 4.0 * k;
        world.add({.position = {place, y, 2}, .velocity = {speed, 0, 0}});
        world.add({.position = {place + 6.5, y, 2}, .velocity = {-speed, 0, 0}});
    }
    return world;
}

/// Steps to `time` although steps end early; the impacts of all of them.
std::vector<Impact> impacts_until(World& world, double time) {
    std::vector<Impact> impacts;
    while (world.time() < time) {
        const StepReport& report = world.step(time - world.time());
        EXPECT_EQ(report.work_cap_reached, report.behind > 0);
        impacts.insert(impacts.end(), world.impacts().begin(), world.impacts().end());
    }
    return impacts;
}

TEST_P(Reports, GoingOnAfterTheWorkCapIsExactWhereNothingIsRounded) {
    const double end = 8 + 1.0 / 128;
    World whole = exact_lanes(GetParam());
    const std::vector<Impact> expected = impacts_until(whole, end);
    EXPECT_GT(expected.size(), 40U);
    for (const std::uint64_t cap : {1U, 3U, 10U}) {
        World capped = exact_lanes(GetParam());
        capped.set_work_cap(cap);
        const std::vector<Impact> impacts = impacts_until(capped, end);
        ASSERT_EQ(impacts.size(), expected.size()) << cap;
        for (std::size_t k = 0; k < impacts.size(); ++k) {
            const Impact& x = impacts[k];
            const Impact& y = expected[k];
            ASSERT_EQ(std::tie(x.time, x.a.slot, x.b.slot, x.face, x.impulse),
                      std::tie(y.time, y.a.slot, y.b.slot, y.face, y.impulse))
                << cap << ", impact " << k;
        }
        EXPECT_EQ(capped.hash(), whole.hash()) << cap;
        EXPECT_EQ(capped.time(), end);
    }
}

TEST_P(Reports, GoingOnAfterTheWorkCapChangesNoMoreThanRounding) {
    const auto bouncers = [] {
        World world({.gravity = {0, 0, -9.81}, .region = std::vector<Plane>{{}}, .precision = GetParam()});
        for (int k = 0; k < 5; ++k) {
            world.add({.position = {2.0 * k, 0, 0.8 + 0.13 * k}, .restitution = 0.9});
        }
        return world;
    };
    const double end = 1.5;
    World whole = bouncers();
    World capped = bouncers();
    capped.set_work_cap(2);
    const std::vector<Impact> expected = impacts_until(whole, end);
    const std::vector<Impact> impacts = impacts_until(capped, end);
    ASSERT_EQ(impacts.size(), expected.size());
    EXPECT_GT(impacts.size(), 12U);
    // The end of a step rounds a height by half a unit of the resolution and a speed (at most 5 m/s) by half a unit in
    // the last place, which moves heights by some seconds' worth of it. Impacts, at 1.5 m/s or more, come that much
    // earlier or later. Each of these a few times over, for the bounces that pass it on.
    const double rounding = capped.resolution() + 5 * kept_eps() * end;
    const double tolerance = 4 * static_cast<double>(capped.step_count() + impacts.size()) * rounding / 1.5;
    for (std::size_t k = 0; k < impacts.size(); ++k) {
        EXPECT_EQ(impacts[k].a.slot, expected[k].a.slot);
        EXPECT_NEAR(impacts[k].time, expected[k].time, tolerance);
        EXPECT_NEAR(impacts[k].approach_speed, expected[k].approach_speed, 9.81 * tolerance);
    }
    const std::vector<BodyId> ids = capped.ids();
    for (std::size_t k = 0; k < ids.size(); ++k) {
        EXPECT_NEAR(capped.get(ids[k]).position.z, whole.get(whole.ids()[k]).position.z, 5 * tolerance);
    }
    EXPECT_GT(capped.step_count(), 5U);
}

/// A heavy body strikes a light one, which then has twice its speed and would leave the world.
TEST_P(Reports, TheEdgeOfTheWorldEndsAStepAtTheImpact) {
    World world({.precision = GetParam(), .resolution = std::ldexp(1.0, -40)});
    const double far = 5.0e6; // m, of 7.9e6 to the edge
    const double speed = 1.0e6;
    world.add({.position = {far - 16, 0, 0}, .velocity = {speed, 0, 0}, .mass = 1e6});
    const BodyId light = world.add({.position = {far, 0, 0}});
    const StepReport& report = world.step(2);
    EXPECT_TRUE(report.edge_reached);
    EXPECT_FALSE(report.work_cap_reached);
    EXPECT_EQ(report.impacts, 1U);
    // The time of the impact is a quotient; in single precision the speed is exact all the same.
    EXPECT_NEAR(report.advanced, 15 / speed, 4 * eps * 15 / speed);
    EXPECT_EQ(report.behind, 2 - report.advanced);
    EXPECT_EQ(world.time(), report.advanced);
    const double twice = 2 * speed / (1 + 1e-6);
    EXPECT_NEAR(world.get(light).velocity.x, twice, 4 * kept_eps() * twice);
    test::expect_refused(world, {ErrorCode::out_of_world, "position", light.slot}, "too far",
                         [](World& w) { w.step(2); });
    EXPECT_EQ(world.step(0.5).advanced, 0.5);
}

TEST(Report, TheStartOfAStepIsInItHoweverItsTimeIsRounded) {
    World world({.interpolation = true});
    const BodyId id = world.add({.velocity = {1, 0, 0}});
    Vec3 before = world.get(id).position;
    for (int step = 0; step < 200; ++step) {
        world.step(0.05);
        Vec3 start;
        world.positions_at(world.time() - world.report().advanced, {&id, 1}, {&start, 1});
        EXPECT_NEAR(start.x, before.x, 1e-11);
        before = world.get(id).position;
    }
}

} // namespace

} // namespace carom
