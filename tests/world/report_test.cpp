// What a step tells afterwards: impacts in order and with the right numbers, counts, books that balance, and time.

#include "world/clock.hpp"
#include "world/refusals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace carom {

namespace {

using test::expect_refused;

class Reports : public test::BothPrecisions {
protected:
    [[nodiscard]] static WorldOptions options(WorldOptions options = {}) {
        options.precision = GetParam();
        return options;
    }
    /// Relative error that rounding of velocities may leave.
    [[nodiscard]] static double rounding() { return is_single() ? 1e-6 : 1e-14; }
};

INSTANTIATE_TEST_SUITE_P(Precisions, Reports, test::both_precisions(), test::precision_name);

void expect_near(const Vec3& a, const Vec3& b, double tolerance, const char* what) {
    EXPECT_NEAR(a.x, b.x, tolerance) << what;
    EXPECT_NEAR(a.y, b.y, tolerance) << what;
    EXPECT_NEAR(a.z, b.z, tolerance) << what;
}

// ---------------------------------------------------------------------------------------------------------------------
// Impacts
// ---------------------------------------------------------------------------------------------------------------------

/// Head-on with e = 1/2: m_ab = 3/4 kg, 3 m/s, so j = 1.5 * 3/4 * 3 N s and the loss is 3/4 * (1 - 1/4) * 9 / 2 J.
TEST_P(Reports, TheNumbersOfAnImpactBetweenBodies) {
    for (const bool heavy_first : {false, true}) {
        World world(options());
        const Body light{.position = {0, 1, 0}, .velocity = {2, 0, 0}, .mass = 1, .restitution = 0.5};
        const Body heavy{.position = {3, 1, 0}, .velocity = {-1, 0, 0}, .mass = 3, .restitution = 0.25};
        const BodyId a = world.add(heavy_first ? heavy : light);
        const BodyId b = world.add(heavy_first ? light : heavy);
        world.step(0.25);
        EXPECT_TRUE(world.impacts().empty());
        world.step(0.5);
        ASSERT_EQ(world.impacts().size(), 1U);
        const Impact& impact = world.impacts()[0];
        EXPECT_NEAR(impact.time, 2.0 / 3, rounding());
        EXPECT_NEAR(impact.offset, 2.0 / 3 - 0.25, rounding());
        EXPECT_EQ(impact.a, a);
        EXPECT_EQ(impact.b, b);
        EXPECT_EQ(impact.face, -1);
        expect_near(impact.position, {4.0 / 3 + 0.5, 1, 0}, 2 * world.resolution(), "point of contact");
        expect_near(impact.normal, {heavy_first ? -1.0 : 1.0, 0, 0}, 1e-15, "normal");
        EXPECT_NEAR(impact.impulse, 3.375, 3.375 * rounding());
        EXPECT_NEAR(impact.approach_speed, 3, 3 * rounding());
        EXPECT_NEAR(impact.energy_lost, 2.53125, 2.53125 * rounding());
        EXPECT_EQ(world.report().impacts, 1U);
        EXPECT_EQ(world.report().face_impacts, 0U);
    }
}

/// A ball that a static body stops: 45 degrees, e = 1/2, mu = 1/10 of the impulse.
TEST_P(Reports, TheNumbersOfAnImpactWithFriction) {
    World world(options());
    world.add({.position = {0, 0, -1}, .mass = infinite_mass, .radius = 1, .friction = 0.1});
    const BodyId ball = world.add(
        {.position = {-1, 0, 1.5}, .velocity = {1, 0, -1}, .mass = 2, .restitution = 0.5, .friction = 0.1});
    world.set(world.ids()[0], {.position = {0, 0, -1}, .mass = infinite_mass, .radius = 1, .restitution = 0, .friction = 0.1});
    world.step(2);
    ASSERT_EQ(world.impacts().size(), 1U);
    const Impact& impact = world.impacts()[0];
    EXPECT_NEAR(impact.time, 1, 1e-6);
    expect_near(impact.position, {0, 0, 0}, 2 * world.resolution(), "point of contact");
    expect_near(impact.normal, {0, 0, 1}, 1e-5, "from the static body, which has the lower id");
    EXPECT_EQ(impact.b, ball);
    EXPECT_NEAR(impact.impulse, 2 * 1.5, 1e-5);
    // Across, mu (1 + e) = 0.15 of 1 m/s is lost.
    EXPECT_NEAR(impact.energy_lost, (1 - 0.25) + (1 - 0.85 * 0.85), 1e-5);
    expect_near(world.get(ball).velocity, {0.85, 0, 0.5}, 1e-5, "velocity");
    EXPECT_NEAR(world.ledger().lost_to_friction, 1 - 0.85 * 0.85, 1e-5);
    EXPECT_NEAR(world.ledger().lost_to_restitution, 0.75, 1e-5);
}

TEST_P(Reports, TheNumbersOfAnImpactWithAFace) {
    for (int face = 0; face < 6; ++face) {
        World world(options({.region = Box{{-2, -2, -2}, {2, 2, 2}}}));
        const double sign = face % 2 == 0 ? -1 : 1;
        const Vec3 outwards{face / 2 == 0 ? sign : 0, face / 2 == 1 ? sign : 0, face / 2 == 2 ? sign : 0};
        const BodyId id = world.add({.velocity = 4.0 * outwards, .mass = 3, .restitution = 0.5});
        world.step(1);
        ASSERT_EQ(world.impacts().size(), 1U);
        const Impact& impact = world.impacts()[0];
        EXPECT_EQ(impact.face, face);
        EXPECT_EQ(impact.a, id);
        EXPECT_FALSE(impact.b.is_set());
        EXPECT_NEAR(impact.time, 1.5 / 4, rounding());
        expect_near(impact.position, 2.0 * outwards, 2 * world.resolution(), "point of contact");
        EXPECT_EQ(impact.normal, outwards);
        EXPECT_NEAR(impact.impulse, 3 * 1.5 * 4, 18 * rounding());
        EXPECT_NEAR(impact.energy_lost, 0.5 * 3 * (16 - 4), 18 * rounding());
        EXPECT_EQ(world.report().face_impacts, 1U);
        EXPECT_EQ(world.report().impacts, 0U);
    }
}

TEST_P(Reports, PlanesAndShellsNameTheirFaces) {
    World planes(options({.region = std::vector<Plane>{{}, {.point = {0, 0, 9}, .normal = {0, -3, -3}}}}));
    planes.add({.position = {0, -5, 5}, .velocity = {0, 2, 2}, .radius = 0});
    planes.step(3);
    ASSERT_EQ(planes.impacts().size(), 1U);
    EXPECT_EQ(planes.impacts()[0].face, 1);
    expect_near(planes.impacts()[0].normal, Vec3{0, 1, 1} / std::sqrt(2.0), 1e-15, "into the face");
    World shell(options({.region = Shell{{1, 0, 0}, 3}}));
    shell.add({.position = {1, 0, 0}, .velocity = {0, 0, -1}, .radius = 1});
    shell.step(2.5);
    ASSERT_EQ(shell.impacts().size(), 1U);
    EXPECT_EQ(shell.impacts()[0].face, 0);
    expect_near(shell.impacts()[0].position, {1, 0, -3}, 2 * shell.resolution(), "point of contact");
}

/// A gas of bodies of different sizes and materials, in a box with gravity where wanted.
World gas(const WorldOptions& options, int count, double least_restitution, double most_friction) {
    World world(options);
    std::mt19937 random(5); // NOLINT(cert-msc51-cpp): fixed
    const auto number = [&random](double low, double high) {
        return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
    };
    while (world.size() < static_cast<std::size_t>(count)) {
        const Body body{.position = {number(0.5, 9.5), number(0.5, 9.5), number(0.5, 9.5)},
                        .velocity = {number(-3, 3), number(-3, 3), number(-3, 3)},
                        .mass = number(0.1, 2),
                        .radius = number(0.05, 0.5),
                        .restitution = number(least_restitution, 1),
                        .friction = number(0, most_friction)};
        try {
            world.add(body);
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::overlap);
        }
    }
    return world;
}

const Box ten_metres{{0, 0, 0}, {10, 10, 10}};

TEST_P(Reports, ImpactsComeInTheOrderOfTime) {
    World world = gas(options({.region = ten_metres, .min_windows = 3}), 200, 0.5, 0.2);
    std::uint64_t impacts = 0;
    for (int i = 0; i < 20; ++i) {
        const double start = world.time();
        const StepReport report = world.step(0.05);
        EXPECT_EQ(world.impacts().size(), report.impacts + report.face_impacts);
        EXPECT_GE(report.windows, 3U);
        EXPECT_GE(report.predictions, report.impacts);
        double last = 0;
        for (const Impact& impact : world.impacts()) {
            EXPECT_GE(impact.offset, last);
            EXPECT_LE(impact.offset, 0.05);
            EXPECT_EQ(impact.time, start + impact.offset);
            EXPECT_GT(impact.approach_speed, 0);
            EXPECT_GE(impact.impulse, 0);
            EXPECT_GE(impact.energy_lost, 0);
            EXPECT_EQ(impact.b.is_set(), impact.face < 0);
            if (impact.b.is_set()) {
                EXPECT_LT(impact.a, impact.b);
            }
            last = impact.offset;
        }
        impacts += report.impacts;
    }
    EXPECT_GT(impacts, 300U);
    EXPECT_EQ(world.ledger().impacts, impacts);
    EXPECT_EQ(world.step_count(), 20U);
}

/// Pairs that meet at one and the same instant come in the order of their ids, wherever they are.
TEST_P(Reports, SimultaneousImpactsComeInTheOrderOfIds) {
    World world(options({.region = std::vector<Plane>{{}}}));
    constexpr int pairs = 40;
    std::vector<int> order;
    for (int k = 0; k < 2 * pairs; ++k) order.push_back(k);
    std::mt19937 random(3); // NOLINT(cert-msc51-cpp): fixed
    std::shuffle(order.begin(), order.end(), random);
    for (const int k : order) {
        const double side = k % 2 == 0 ? -1 : 1;
        const bool falls = k / 2 % 4 == 0; // onto the floor, at the same instant
        world.add({.position = {2 * side + 8.0 * (k / 2 % 7), 3.0 * (k / 14), falls ? 2.0 : 5.0},
                   .velocity = falls ? Vec3{0, 0, -1} : Vec3{-side, 0, 0}});
    }
    world.step(1.75);
    ASSERT_EQ(world.impacts().size(), 50U);
    const auto key = [](const Impact& i) { return std::pair(i.a, i.b); };
    EXPECT_TRUE(std::is_sorted(world.impacts().begin(), world.impacts().end(),
                               [&](const Impact& x, const Impact& y) { return key(x) < key(y); }));
    for (const Impact& impact : world.impacts()) EXPECT_EQ(impact.offset, 1.5);
}

TEST_P(Reports, OffsetsStayExactLate) {
    const auto offset_after = [&](double waiting) {
        World world(options());
        for (double left = waiting; left > 0; left -= 1e6) world.step(1e6);
        world.add({.velocity = {1, 0, 0}});
        world.add({.position = {1 + 1.0 / 3, 0, 0}});
        world.step(1);
        EXPECT_EQ(world.impacts().size(), 1U);
        return world.impacts()[0].offset;
    };
    EXPECT_EQ(offset_after(1e9), offset_after(0));
}

TEST_P(Reports, RecordingChangesNothingElse) {
    World all = gas(options({.region = ten_metres}), 100, 0.5, 0.1);
    World none = gas(options({.region = ten_metres, .record_impacts = false}), 100, 0.5, 0.1);
    World strong = gas(options({.region = ten_metres, .least_recorded_impulse = 2}), 100, 0.5, 0.1);
    World later = none;
    later.set_recording(true, 2);
    for (int i = 0; i < 10; ++i) {
        all.step(0.1);
        none.step(0.1);
        strong.step(0.1);
        later.step(0.1);
        std::vector<double> expected;
        for (const Impact& impact : all.impacts()) {
            if (impact.impulse >= 2) expected.push_back(impact.time);
        }
        EXPECT_GT(expected.size(), 5U);
        EXPECT_LT(expected.size(), all.impacts().size());
        for (const World* world : {&strong, &later}) {
            ASSERT_EQ(world->impacts().size(), expected.size());
            for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_EQ(world->impacts()[k].time, expected[k]);
        }
        EXPECT_TRUE(none.impacts().empty());
        for (const World* world : {&none, &strong, &later}) {
            EXPECT_EQ(world->report().impacts, all.report().impacts);
            EXPECT_EQ(world->report().face_impacts, all.report().face_impacts);
            EXPECT_EQ(world->hash(), all.hash());
            EXPECT_TRUE(world->ledger() == all.ledger());
        }
    }
}

TEST_P(Reports, PhasesTakeTime) {
    World world = gas(options({.region = ten_metres, .drag = {.linear = 0.1}}), 200, 1, 0);
    const PhaseTimes& seconds = world.step(0.1).seconds;
    for (const double phase : {seconds.forces, seconds.cells, seconds.pairs, seconds.impacts, seconds.bodies}) {
        EXPECT_GT(phase, 0);
        EXPECT_LT(phase, 10);
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Books
// ---------------------------------------------------------------------------------------------------------------------

/// Energy and momentum before and after, against what the ledger says in between.
class Audit {
public:
    explicit Audit(const World& world)
        : energy_(world.energy().total()), momentum_(world.momentum()), ledger_(world.ledger()),
          scale_(world.energy().kinetic + std::abs(world.energy().potential)) {}

    [[nodiscard]] double energy_error(const World& world) const {
        const auto lost = [](const Ledger& l) { return l.lost_to_restitution + l.lost_to_friction + l.lost_to_drag; };
        const double change = world.energy().total() - energy_;
        return std::abs(change + lost(world.ledger()) - lost(ledger_)) / scale_;
    }
    [[nodiscard]] double momentum_error(const World& world) const {
        const Vec3 change = world.momentum() - momentum_;
        const Vec3 given = world.ledger().outer_impulse - ledger_.outer_impulse;
        double total = 0;
        for (const BodyId id : world.ids()) {
            const Body body = world.get(id);
            if (!std::isinf(body.mass)) total += body.mass * (length(body.velocity) + 1);
        }
        return length(change - given) / total;
    }

private:
    double energy_;
    Vec3 momentum_;
    Ledger ledger_;
    double scale_;
};

TEST_P(Reports, TheBooksOfAGasBalance) {
    for (const Vec3& gravity : {Vec3{}, Vec3{1, 2, -10}}) {
        World world = gas(options({.gravity = gravity, .region = ten_metres, .collapse_time = 1e-9}), 150, 0.7, 0.3);
        world.add({.position = {-5, 5, 5}, .mass = infinite_mass, .radius = 7}, Overlap::accept);
        const Audit audit(world);
        for (int i = 0; i < 30; ++i) world.step(0.02);
        EXPECT_GT(world.ledger().impacts, 100U);
        EXPECT_GT(world.ledger().face_impacts, 100U);
        EXPECT_GT(world.ledger().lost_to_restitution, 0);
        EXPECT_GT(world.ledger().lost_to_friction, 0);
        EXPECT_EQ(world.ledger().lost_to_drag, 0);
        EXPECT_LT(audit.energy_error(world), is_single() ? 1e-5 : 1e-12);
        EXPECT_LT(audit.momentum_error(world), is_single() ? 1e-5 : 1e-12);
    }
}

TEST_P(Reports, DragIsBooked) {
    World world = gas(options({.region = ten_metres, .drag = {.linear = 0.5, .quadratic = 0.2}}), 80, 0.5, 0.2);
    const Audit audit(world);
    for (int i = 0; i < 50; ++i) world.step(0.02);
    EXPECT_GT(world.ledger().lost_to_drag, 0.1);
    EXPECT_LT(audit.energy_error(world), is_single() ? 1e-5 : 1e-13);
    EXPECT_LT(audit.momentum_error(world), is_single() ? 1e-5 : 1e-13);
}

/// The kicks of attractors are impulses; what they add in energy is right only to the order of the integration.
TEST_P(Reports, TheImpulsesOfAttractorsAreBooked) {
    World world = gas(options({.region = ten_metres, .drag = {.quadratic = 0.05}}), 80, 0.5, 0.2);
    world.set_attractors(std::array{Attractor{.position = {2, 3, 4}, .strength = 20, .softening = 0.5},
                                    Attractor{.strength = -5, .softening = 0.5, .body = world.ids()[7]}});
    const Audit audit(world);
    for (int i = 0; i < 50; ++i) world.step(0.02);
    EXPECT_GT(length(world.ledger().outer_impulse), 1);
    EXPECT_LT(audit.momentum_error(world), is_single() ? 1e-5 : 1e-13);
}

/// One body that slides and comes to rest on a slope, in a bowl, or on a ball.
struct Slide {
    const char* name;
    Region region;
    std::optional<Body> support;
    Body body;
};

std::vector<Slide> slides() {
    return {
        {"slope", std::vector<Plane>{{.normal = {1, 0, 2}}}, {},
         {.position = {0, 0, 0.6}, .velocity = {1, 1, 0}, .restitution = 0.5, .friction = 0.2}},
        {"sticking", std::vector<Plane>{{.normal = {1, 0, 2}}}, {},
         {.position = {0, 0, 0.6}, .velocity = {1, 1, 0}, .restitution = 0.5, .friction = 0.8}},
        {"floor", ten_metres, {},
         {.position = {5, 5, 0.5}, .velocity = {3, 1, 0}, .restitution = 0, .friction = 0.3}},
        {"edge", ten_metres, {}, {.position = {5, 0.5, 0.5}, .velocity = {3, -1, 0}, .restitution = 0}},
        {"bowl", Shell{.radius = 5}, {}, {.position = {2, 1, -3}, .velocity = {0, 1, 0}, .restitution = 0.1}},
        {"rough_bowl", Shell{.radius = 5}, {},
         {.position = {2, 1, -3}, .velocity = {0, 1, 0}, .restitution = 0.1, .friction = 0.1}},
        {"ball", OpenSpace{}, Body{.mass = infinite_mass, .radius = 3, .restitution = 0},
         {.position = {0.2, 0, 3.5}, .restitution = 0}},
    };
}

TEST_P(Reports, TheMomentumOfBodiesThatSlideIsBooked) {
    for (const Slide& slide : slides()) {
        World world(options({.gravity = {0, 0, -10}, .region = slide.region}));
        if (slide.support) world.add(*slide.support);
        const BodyId id = world.add(slide.body);
        const Audit audit(world);
        bool was_held = false;
        for (int i = 0; i < 100; ++i) {
            world.step(0.01);
            was_held = was_held || world.held(id);
        }
        EXPECT_TRUE(was_held) << slide.name;
        EXPECT_LT(audit.momentum_error(world), is_single() ? 2e-5 : 1e-12) << slide.name;
    }
}

/// On plane supports a slide is integrated exactly, on curved ones only to an order of dt.
TEST_P(Reports, TheEnergyOfBodiesThatSlideIsBooked) {
    for (const Slide& slide : slides()) {
        World world(options({.gravity = {0, 0, -10}, .region = slide.region}));
        if (slide.support) world.add(*slide.support);
        world.add(slide.body);
        const Audit audit(world);
        for (int i = 0; i < 100; ++i) world.step(0.01);
        const bool is_curved = slide.support || slide.region.index() == 3;
        EXPECT_LT(audit.energy_error(world), is_curved ? 0.03 : is_single() ? 1e-5 : 1e-11) << slide.name;
    }
}

TEST_P(Reports, TheLedgerIsKeptInSteps) {
    World world = gas(options({.gravity = {0, 0, -10}, .region = ten_metres}), 50, 0.5, 0.2);
    std::uint64_t impacts = 0;
    std::uint64_t face_impacts = 0;
    double lost = 0;
    for (int i = 0; i < 20; ++i) {
        const Ledger before = world.ledger();
        world.step(0.01);
        impacts += world.report().impacts;
        face_impacts += world.report().face_impacts;
        for (const Impact& impact : world.impacts()) lost += impact.energy_lost;
        EXPECT_GE(world.ledger().lost_to_restitution, before.lost_to_restitution);
        EXPECT_GE(world.ledger().lost_to_friction, before.lost_to_friction);
    }
    EXPECT_EQ(world.ledger().impacts, impacts);
    EXPECT_EQ(world.ledger().face_impacts, face_impacts);
    EXPECT_NEAR(world.ledger().lost_to_restitution + world.ledger().lost_to_friction, lost, 1e-9 * lost);
}

// ---------------------------------------------------------------------------------------------------------------------
// Sums
// ---------------------------------------------------------------------------------------------------------------------

TEST_P(Reports, SumsByHand) {
    World world(options({.gravity = {0, 0, -10}}));
    world.add({.position = {1, 2, 3}, .velocity = {1, 0, 0}, .mass = 2});
    world.add({.position = {-4, 0, 1}, .velocity = {0, 3, -4}, .mass = 4});
    world.add({.position = {50, 0, 0}, .mass = infinite_mass});
    EXPECT_EQ(world.energy().kinetic, 1 + 2 * 25.0);
    EXPECT_EQ(world.energy().potential, 10 * (2 * 3 + 4 * 1.0));
    EXPECT_EQ(world.energy().total(), 151);
    EXPECT_EQ(world.momentum(), (Vec3{2, 12, -16}));
    EXPECT_EQ(world.centre_of_mass(), (Vec3{-14, 4, 10} / 6.0));
    const Vec3 spin = cross(Vec3{1, 2, 3}, Vec3{2, 0, 0}) + cross(Vec3{-4, 0, 1}, Vec3{0, 12, -16});
    EXPECT_EQ(world.angular_momentum(), spin);
    const Vec3 about{1, 1, 1};
    expect_near(world.angular_momentum(about), spin - cross(about, world.momentum()), 1e-12, "about a point");
    world.set_gravity({});
    const std::array<Attractor, 2> attractors{
        Attractor{.position = {1, 2, 7}, .strength = 6, .softening = 3},
        Attractor{.strength = 4, .body = world.ids()[1]}, // feels nothing of itself
    };
    world.set_attractors(attractors);
    const double to_first = std::sqrt(25.0 + 4 + 36 + 9);
    const double between = std::sqrt(25.0 + 4 + 4);
    EXPECT_NEAR(world.energy().potential, -2 * 6 / 5.0 - 4 * 6 / to_first - 2 * 4 / between, 1e-13);
    World empty(options());
    EXPECT_EQ(empty.centre_of_mass(), Vec3{});
    EXPECT_EQ(empty.momentum(), Vec3{});
    EXPECT_EQ(empty.energy().total(), 0);
}

// ---------------------------------------------------------------------------------------------------------------------
// Work cap
// ---------------------------------------------------------------------------------------------------------------------

/// Who met whom.
std::vector<std::pair<BodyId, BodyId>> partners(const World& world) {
    std::vector<std::pair<BodyId, BodyId>> list;
    for (const Impact& impact : world.impacts()) list.emplace_back(impact.a, impact.b);
    return list;
}

TEST_P(Reports, TheWorkCapOnlyEndsStepsEarly) {
    World free = gas(options({.region = ten_metres}), 100, 0.8, 0.1);
    World capped = free;
    capped.set_work_cap(5);
    free.step(0.5);
    EXPECT_FALSE(free.report().work_cap_reached);
    EXPECT_EQ(free.report().behind, 0);
    std::vector<std::pair<BodyId, BodyId>> met;
    int early = 0;
    while (capped.time() < 0.5) {
        const double asked = 0.5 - capped.time();
        const double start = capped.time();
        const StepReport report = capped.step(asked);
        ASSERT_LE(report.impacts + report.face_impacts, 5U);
        EXPECT_NEAR(report.advanced + report.behind, asked, 1e-15);
        EXPECT_NEAR(capped.time(), start + report.advanced, 1e-15);
        EXPECT_EQ(report.behind > 0, report.work_cap_reached);
        for (const Impact& impact : capped.impacts()) EXPECT_LE(impact.offset, report.advanced);
        const auto more = partners(capped);
        met.insert(met.end(), more.begin(), more.end());
        early += report.behind > 0 ? 1 : 0;
    }
    EXPECT_GT(early, 10);
    EXPECT_EQ(met, partners(free));
    EXPECT_EQ(capped.ledger().impacts, free.ledger().impacts);
    for (const BodyId id : free.ids()) {
        expect_near(capped.get(id).position, free.get(id).position, is_single() ? 1e-3 : 1e-9, "position");
        expect_near(capped.get(id).velocity, free.get(id).velocity, is_single() ? 1e-3 : 1e-9, "velocity");
    }
}

/// More impacts at one instant than the cap allows: steps that do not advance, until all are done.
TEST_P(Reports, ABurstLargerThanTheCapIsWorkedOff) {
    World world(options({.work_cap = 3}));
    constexpr int count = 20;
    for (int k = 0; k < count; ++k) {
        world.add({.position = {1.0 * k, 0, 0}, .velocity = {k == 0 ? 1.0 : 0.0, 0, 0}});
    }
    std::uint64_t impacts = 0;
    int steps = 0;
    for (; world.time() < 1 && steps < 50; ++steps) impacts += world.step(1 - world.time()).impacts;
    EXPECT_EQ(impacts, count - 1U);
    EXPECT_EQ(steps, 7);
    EXPECT_EQ(world.step_count(), 1U) << "steps that did not advance are none";
    for (int k = 0; k < count; ++k) {
        const Body body = world.get(world.ids()[static_cast<std::size_t>(k)]);
        EXPECT_EQ(body.velocity.x, k == count - 1 ? 1 : 0);
        EXPECT_EQ(body.position.x, k == count - 1 ? k + 1 : k);
    }
}

TEST_P(Reports, StepUntilStopsWhereAStepEndedEarly) {
    World world = gas(options({.region = ten_metres, .work_cap = 10}), 100, 1, 0);
    const StepReport& report = world.step_until(1, 0.25);
    EXPECT_TRUE(report.work_cap_reached);
    EXPECT_LT(world.time(), 1);
    EXPECT_GT(report.behind, 0);
    world.set_work_cap(0);
    EXPECT_EQ(world.step_until(1, 0.25).behind, 0);
    EXPECT_EQ(world.time(), 1);
}

// ---------------------------------------------------------------------------------------------------------------------
// Time
// ---------------------------------------------------------------------------------------------------------------------

TEST(Time, TenMillionStepsDoNotDrift) {
    core::Clock clock;
    for (int i = 0; i < 10'000'000; ++i) clock.advance(0.1);
    EXPECT_EQ(clock.seconds(), 1e6);
    EXPECT_EQ(clock.steps(), 10'000'000U);
}

/// Every change of the interval closes a sum; the errors of these must not add up either.
TEST(Time, ChangingStepsDoNotDrift) {
    core::Clock clock;
    for (int i = 0; i < 1'000'000; ++i) {
        clock.advance(0.1);
        clock.advance(1.0 / 3);
        clock.advance(1e-9);
    }
    // The exact sum, of the doubles that are meant by 0.1, 1/3 and 1e-9.
    const long double exact = 1e6L * (static_cast<long double>(0.1) + static_cast<long double>(1.0 / 3) +
                                      static_cast<long double>(1e-9));
    EXPECT_NEAR(clock.seconds(), static_cast<double>(exact), 1.2e-10 / 2);
}

TEST(Time, TinyStepsLateAreNotLost) {
    World world;
    world.step(1e9);
    for (int i = 0; i < 1'000'000; ++i) world.step(1e-9);
    EXPECT_EQ(world.time(), 1e9 + 1e-3);
    EXPECT_EQ(world.step_count(), 1'000'001U);
}

TEST_P(Reports, StepUntilArrivesExactly) {
    std::mt19937 random(11); // NOLINT(cert-msc51-cpp): fixed
    for (int i = 0; i < 200; ++i) {
        World world(options());
        world.step(1e-3 * static_cast<double>(random() % 1000 + 1));
        const double target = world.time() + 1e-4 * static_cast<double>(random() % 100000 + 1);
        const double most = 0.01 * static_cast<double>(random() % 100 + 1);
        const double length = target - world.time();
        world.step_until(target, most);
        EXPECT_NEAR(world.time(), target, 4e-16 * target);
        EXPECT_LE(static_cast<double>(world.step_count()), std::ceil(length / most) + 2);
        EXPECT_LE(world.report().advanced, most);
    }
    World world(options());
    EXPECT_EQ(world.step_until(2.5).advanced, 2.5);
    EXPECT_EQ(world.step_count(), 1U);
}

// ---------------------------------------------------------------------------------------------------------------------
// Drawing between steps
// ---------------------------------------------------------------------------------------------------------------------

Vec3 position_at(const World& world, double time, BodyId id) {
    Vec3 position;
    world.positions_at(time, {&id, 1}, {&position, 1});
    return position;
}

TEST_P(Reports, PositionsBetweenStepsAreOnTheLine) {
    World world(options({.gravity = {0, 0, -8}, .interpolation = true}));
    const BodyId id = world.add({.velocity = {4, 0, 0}});
    EXPECT_EQ(position_at(world, 0, id), Vec3{});
    world.step(1);
    EXPECT_EQ(position_at(world, 0, id), Vec3{});
    EXPECT_EQ(position_at(world, 0.25, id), (Vec3{1, 0, -1}));
    EXPECT_EQ(position_at(world, 1, id), (Vec3{4, 0, -4}));
    const BodyId late = world.add({.position = {9, 9, 9}, .velocity = {1, 1, 1}});
    EXPECT_EQ(position_at(world, 0.5, late), (Vec3{9, 9, 9})) << "it was not there before";
    world.set(std::array{id}, {.position = std::array{Vec3{100, 0, 0}}});
    EXPECT_EQ(position_at(world, 0.5, id), (Vec3{100, 0, 0})) << "it did not fly there";
    world.step(1);
    EXPECT_NEAR(position_at(world, 1, id).x, 100, 1e-12);
}

TEST_P(Reports, PositionsBetweenStepsTakeTheShortWayRound) {
    Box box = ten_metres;
    for (Face& face : box.faces) face.kind = FaceKind::periodic;
    World world(options({.region = box, .interpolation = true}));
    const BodyId id = world.add({.position = {9.5, 5, 0.25}, .velocity = {1, 0, -1}});
    world.step(1);
    EXPECT_EQ(world.get(id).position, (Vec3{0.5, 5, 9.25}));
    EXPECT_EQ(position_at(world, 0, id), (Vec3{9.5, 5, 0.25}));
    EXPECT_EQ(position_at(world, 0.25, id), (Vec3{9.75, 5, 0}));
    EXPECT_EQ(position_at(world, 0.75, id), (Vec3{0.25, 5, 9.5}));
}

/// The time before a step, the time after it and the times of its impacts are all inside, whatever their rounding.
TEST_P(Reports, TimesOfAStepAreInsideIt) {
    World world = gas(options({.region = ten_metres, .interpolation = true}), 100, 1, 0);
    const BodyId id = world.ids()[3];
    for (int i = 0; i < 60; ++i) {
        const double start = world.time();
        const Vec3 before = world.get(id).position;
        world.step(1.0 / 60);
        EXPECT_EQ(position_at(world, start, id), before);
        EXPECT_EQ(position_at(world, world.time(), id), world.get(id).position);
        for (const Impact& impact : world.impacts()) EXPECT_NO_THROW(position_at(world, impact.time, id));
    }
}

TEST_P(Reports, AStepThatEndedEarlyIsDrawnToWhereItCame) {
    World world = gas(options({.region = ten_metres, .work_cap = 3, .interpolation = true}), 100, 1, 0);
    const BodyId id = world.ids()[3];
    const Vec3 before = world.get(id).position;
    world.step(1);
    ASSERT_TRUE(world.report().work_cap_reached);
    const Vec3 after = world.get(id).position;
    expect_near(position_at(world, 0.5 * world.time(), id), 0.5 * (before + after), 2 * world.resolution(), "half way");
    EXPECT_THROW(position_at(world, 1, id), Error);
}

// ---------------------------------------------------------------------------------------------------------------------
// Origin
// ---------------------------------------------------------------------------------------------------------------------

TEST_P(Reports, MovingTheOriginMovesNothing) {
    WorldOptions setting = options({.gravity = {0, 0, -10}, .region = ten_metres});
    World world = gas(setting, 50, 0.8, 0.1);
    world.set_attractors(std::array{Attractor{.position = {1.0 / 3, 0.7, 0.1}, .strength = 2, .softening = 0.1},
                                    Attractor{.strength = 1, .softening = 0.2, .body = world.ids()[1]}});
    World shifted = world;
    const std::array<std::int64_t, 3> origin{1'048'577, -77, 3'000'000};
    const Vec3 shift{1'048'577, -77, 3'000'000};
    shifted.set_origin(origin);
    EXPECT_EQ(shifted.options().origin, origin);
    EXPECT_EQ(shifted.hash(), world.hash());
    expect_near(shifted.attractors()[0].position, world.attractors()[0].position - shift, 1e-9, "attractor");
    for (int i = 0; i < 20; ++i) {
        world.step(0.05);
        shifted.step(0.05);
        ASSERT_EQ(shifted.hash(), world.hash());
    }
    EXPECT_EQ(shifted.energy().total(), world.energy().total());
    EXPECT_EQ(shifted.momentum(), world.momentum());
    expect_near(shifted.centre_of_mass(), world.centre_of_mass() - shift, 1e-9, "centre of mass");
    ASSERT_FALSE(world.impacts().empty());
    for (std::size_t k = 0; k < world.impacts().size(); ++k) {
        expect_near(shifted.impacts()[k].position, world.impacts()[k].position - shift, 1e-9, "impact");
    }
    for (const BodyId id : world.ids()) {
        expect_near(shifted.get(id).position, world.get(id).position - shift, 1e-9, "position");
        EXPECT_EQ(shifted.get(id).velocity, world.get(id).velocity);
    }
    // The other way round nothing is lost.
    shifted.set_origin({});
    for (const BodyId id : world.ids()) EXPECT_EQ(shifted.get(id).position, world.get(id).position);
    EXPECT_EQ(shifted.attractors()[0].position, world.attractors()[0].position);
}

/// From one end of the world everything at the other end is in sight.
TEST_P(Reports, TheOriginMayBeAtTheEdge) {
    World world(options());
    const std::int64_t edge = is_single() ? 8'000'000'000'000 : 7'500'000;
    const auto far = static_cast<double>(edge);
    const BodyId id = world.add({.position = {far, 0, 0}, .mass = 2});
    world.set_origin({-edge, 0, 0});
    EXPECT_EQ(world.get(id).position, (Vec3{2 * far, 0, 0}));
    EXPECT_EQ(world.centre_of_mass(), (Vec3{2 * far, 0, 0}));
    world.set_gravity({1, 0, 0});
    EXPECT_EQ(world.energy().potential, -2 * far) << "zero is where the origin was at first";
}

} // namespace

} // namespace carom
