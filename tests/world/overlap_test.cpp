// Bodies that overlap: refused and accepted, without room to move, and what it costs to look for them.

#include "world/refusals.hpp"

#include <carom/collision.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <random>

namespace carom {

namespace {

using test::expect_refused;

class Overlaps : public test::BothPrecisions {};

INSTANTIATE_TEST_SUITE_P(Precisions, Overlaps, test::both_precisions(), test::precision_name);

/// Expects an overlap error whose message contains a text.
void expect_overlap(World& world, std::size_t index, const std::string& text, const std::function<void(World&)>& call) {
    expect_refused(world, {ErrorCode::overlap, "position", index}, text, [&](World& w) {
        try {
            call(w);
        } catch (const Error& error) {
            EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
            throw;
        }
    });
}

TEST_P(Overlaps, OverlapIsRefusedAtAddAndSet) {
    World world = open_world();
    const BodyId a = world.add({.position = {0, 0, 0}});
    const BodyId b = world.add({.position = {3, 0, 0}});
    expect_overlap(world, 0, "slot 1", [](World& w) { w.add({.position = {3.9, 0, 0}}); });
    expect_overlap(world, 0, "slot 0", [&](World& w) { w.set(b, {.position = {0.5, 0.5, 0}}); });
    // The first is as large as before.
    expect_overlap(world, 1, "slot 0", [&](World& w) { w.set(std::array{a, b}, {.radius = std::array{0.5, 2.6}}); });
    // Bodies that change places do not meet on the way.
    world.set(std::array{a, b}, {.position = std::array{Vec3{3, 0, 0}, Vec3{0, 0, 0}}});
    EXPECT_EQ(world.get(a).position.x, 3);
}

TEST_P(Overlaps, OfSeveralTheLowestSlotIsNamedWhereverItLies) {
    World world = open_world();
    const BodyId first = world.add({.position = {50, 0, 0}});
    const BodyId second = world.add({.position = {0, 0, 0}});
    world.add({.position = {1, 0, 0}});
    world.add({.position = {0.5, 0.9, 0}});
    // The last one comes to the first place in memory, before those in slots 1 and 2.
    world.remove(first);
    expect_overlap(world, 0, "slot 1", [](World& w) { w.add({.position = {0.5, 0.3, 0}}); });
    world.remove(second);
    expect_overlap(world, 0, "slot 2", [](World& w) { w.add({.position = {0.5, 0.3, 0}}); });
}

TEST_P(Overlaps, AStaticBodyMayOverlapUntilItIsLetLoose) {
    World world = open_world();
    const BodyId a = world.add({.mass = infinite_mass});
    world.add({.position = {0.5, 0, 0}, .mass = infinite_mass});
    expect_overlap(world, 0, "slot 1", [&](World& w) { w.set(std::array{a}, {.mass = std::array{1.0}}); });
    world.set(std::array{a}, {.mass = std::array{1.0}}, Overlap::accept);
    EXPECT_EQ(world.get(a).mass, 1);
}

TEST_P(Overlaps, OverlapWithinOneCallNamesWhich) {
    World world = open_world();
    world.add({.position = {50, 0, 0}});
    std::vector<Vec3> positions{{0, 0, 0}, {4, 0, 0}, {8, 0, 0}, {12, 0, 0}, {16, 0, 0}, {8.5, 0, 0}};
    expect_overlap(world, 5, "body 2 of this call", [&](World& w) { w.add({.position = positions}); });
    positions[3] = {50, 0.5, 0};
    expect_overlap(world, 3, "slot 0", [&](World& w) { w.add({.position = positions}); });
}

TEST_P(Overlaps, WallsAreRespected) {
    Box box{{0, 0, 0}, {10, 10, 10}};
    box.faces[1].kind = FaceKind::open;
    World world({.region = box, .precision = GetParam()});
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool high : {false, true}) {
            Body body{.position = {5, 5, 5}};
            double& x = axis == 0 ? body.position.x : axis == 1 ? body.position.y : body.position.z;
            x = high ? 9.6 : 0.4;
            const int face = 2 * axis + (high ? 1 : 0);
            if (face != 1) {
                expect_overlap(world, 0, "face " + std::to_string(face), [&](World& w) { w.add(body); });
            }
            x = high ? 9.5 : 0.5;
            world.remove(world.add(body));
        }
    }
    world.add({.position = {20, 5, 5}});
    World sphere({.region = Shell{.radius = 2}, .precision = GetParam()});
    expect_overlap(sphere, 0, "face 0", [](World& w) { w.add({.position = {0, 1, 1.2}}); });
    sphere.add({.position = {0, 0, 1.5}});
    World planes(
        {.region = std::vector<Plane>{{}, {.point = {0, 0, 9}, .normal = {0, 0, -1}}}, .precision = GetParam()});
    expect_overlap(planes, 0, "face 1", [](World& w) { w.add({.position = {0, 0, 8.6}}); });
    // Static bodies may stand in walls and in each other.
    planes.add({.position = {0, 0, 0}, .mass = infinite_mass});
    planes.add({.position = {0.2, 0, 0}, .mass = infinite_mass});
    expect_overlap(planes, 0, "slot 0", [](World& w) { w.add({.position = {-0.5, 0, 0.5}}); });
}

TEST_P(Overlaps, OverlapIsSeenAcrossAPeriodicFace) {
    Box box{{0, 0, 0}, {10, 10, 10}};
    for (Face& face : box.faces) face.kind = FaceKind::periodic;
    World world({.region = box, .precision = GetParam()});
    world.add({.position = {0.2, 0.1, 9.9}});
    expect_overlap(world, 0, "slot 0", [](World& w) { w.add({.position = {9.9, 9.8, 0.2}}); });
    // A position outside the box is the same as its image inside.
    const BodyId id = world.add({.position = {-5, 25, 5}});
    EXPECT_EQ(world.get(id).position, (Vec3{5, 5, 5}));
}

TEST_P(Overlaps, TouchingIsNoOverlap) {
    const double radius = 0.5;
    const double tolerance = std::max((is_single() ? 1e-6 : 1e-9) * 2 * radius, 2 * open_world().resolution());
    World world = world_with_floor(0);
    world.add({.position = {0, 0, 5}});
    world.add({.position = {1, 0, 5}});
    world.add({.position = {0, 1 - 0.9 * tolerance, 5}});
    expect_overlap(world, 0, "slot 0", [&](World& w) { w.add({.position = {-1 + 2.1 * tolerance, 0, 5}}); });
    world.add({.position = {10, 0, radius - 0.9 * tolerance}});
    expect_overlap(world, 0, "face 0", [&](World& w) { w.add({.position = {20, 0, radius - 2.1 * tolerance}}); });
}

TEST_P(Overlaps, RefusedBodiesLeaveNoTrace) {
    World world = open_world();
    const BodyId first = world.add(Body{});
    for (int i = 0; i < 300; ++i) {
        EXPECT_THROW(world.add({.position = {0.001 * i, 0, 0}}), Error);
        EXPECT_THROW(world.add({.position = std::array{Vec3{100, 0, 0}, Vec3{200, 0, 0}, Vec3{0.5, 0, 0}}}), Error);
    }
    // Where refused bodies were to be, there is room.
    const BodyId second = world.add({.position = {100, 0, 0}});
    const BodyId third = world.add({.position = {200, 0, 0}});
    EXPECT_EQ(second.slot, first.slot + 1);
    EXPECT_EQ(third.slot, first.slot + 2);
    expect_overlap(world, 0, "slot 1", [](World& w) { w.add({.position = {100.5, 0, 0}}); });
    world.remove(second);
    world.add({.position = {100.5, 0, 0}});
    expect_overlap(world, 0, "slot 2", [](World& w) { w.add({.position = {200, 0.5, 0}}); });
}

/// Adds, removes and moves bodies at random; every answer about overlap is that of a plain search over all.
TEST_P(Overlaps, OverlapIsFoundAsByPlainSearch) {
    World world = open_world();
    std::mt19937 random(7); // NOLINT(cert-msc51-cpp): fixed
    const auto number = [&random](double low, double high) {
        return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
    };
    std::vector<BodyId> ids;
    int refused = 0;
    for (int i = 0; i < 3000; ++i) {
        const Body body{.position = {number(0, 12), number(0, 12), number(0, 12)}, .radius = number(0.1, 1)};
        const bool moves = !ids.empty() && i % 3 == 0;
        const BodyId moved = moves ? ids[random() % ids.size()] : BodyId{};
        const bool overlaps = std::any_of(ids.begin(), ids.end(), [&](BodyId id) {
            const Body other = world.get(id);
            return id != moved && length(other.position - body.position) < other.radius + body.radius;
        });
        if (i % 5 == 0 && ids.size() > 3) {
            world.remove(ids[random() % 3]);
            ids = world.ids();
            continue;
        }
        try {
            if (moves) {
                world.set(moved, body);
            } else {
                ids.push_back(world.add(body));
            }
            EXPECT_FALSE(overlaps) << i;
        } catch (const Error&) {
            EXPECT_TRUE(overlaps) << i;
            ++refused;
        }
    }
    EXPECT_GT(refused, 500);
    EXPECT_GT(ids.size(), 50U);
}

/// How far a pair that was put into each other gets apart, and that it comes no closer on the way.
TEST_P(Overlaps, AcceptedPairsPartFreely) {
    World world = open_world();
    const BodyId a = world.add({.velocity = {1, 0, 0}, .restitution = 0.5});
    const BodyId b =
        world.add({.position = {0.4, 0.1, 0}, .velocity = {-1, 0, 0}, .restitution = 0.5}, Overlap::accept);
    double distance = length(world.get(b).position - world.get(a).position);
    std::uint64_t impacts = 0;
    for (int i = 0; i < 100; ++i) {
        impacts += world.step(0.01).impacts;
        const double now = length(world.get(b).position - world.get(a).position);
        EXPECT_GT(now, distance - 2 * world.resolution());
        distance = now;
    }
    EXPECT_EQ(impacts, 1U);
    const Vec3 apart = world.get(b).velocity - world.get(a).velocity;
    EXPECT_NEAR(dot(apart, Vec3{0.4, 0.1, 0}) / length(Vec3{0.4, 0.1, 0}), 0.5 * 2 * 0.4 / length(Vec3{0.4, 0.1, 0}),
                1e-6);
    EXPECT_GT(distance, 1);
}

TEST_P(Overlaps, ASetMayBeAcceptedToo) {
    World world = open_world();
    world.add(Body{});
    const BodyId b = world.add({.position = {5, 0, 0}});
    world.set(b, {.position = {0.25, 0, 0}, .velocity = {1, 0, 0}}, Overlap::accept);
    EXPECT_EQ(world.step(1).impacts, 0U);
    EXPECT_EQ(world.get(b).position.x, 1.25);
    // What is no longer in the way is no overlap; what is, is.
    world.add({.position = {5, 0, 0}});
    expect_overlap(world, 0, "slot 1", [](World& w) { w.add({.position = {1.5, 0.8, 0}}); });
}

bool is_finite(const Vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

TEST_P(Overlaps, CoincidentCentresGiveNumbers) {
    for (const double gravity : {0.0, -10.0}) {
        World world = world_with_floor(gravity);
        std::vector<BodyId> ids;
        for (const Vec3& velocity : {Vec3{}, Vec3{}, Vec3{1, 0, 0}, Vec3{0, -1, 0}, Vec3{0, 0, 1e-30}}) {
            ids.push_back(
                world.add({.position = {0, 0, 3}, .velocity = velocity, .restitution = 0.5}, Overlap::accept));
        }
        ids.push_back(world.add({.position = {0, 0, 3}, .mass = infinite_mass}, Overlap::accept));
        ids.push_back(world.add({.position = {0, 0, 3}, .radius = 0}, Overlap::accept));
        for (int i = 0; i < 50; ++i) world.step(0.02);
        for (const BodyId id : ids) {
            EXPECT_TRUE(is_finite(world.get(id).position));
            EXPECT_TRUE(is_finite(world.get(id).velocity));
        }
        EXPECT_TRUE(std::isfinite(world.energy().total()));
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Bodies without room to move
// ---------------------------------------------------------------------------------------------------------------------

/// Elastic bodies between spheres or slanted walls need many impacts at one place to come out again (wedge_test.cpp):
/// they are given ten thousand.
constexpr unsigned most_elastic = 10100;

/// Between two faces there are impacts without end at one instant. The body stops instead.
TEST_P(Overlaps, ABodyThatFillsItsBoxComesToAStop) {
    for (const double radius : {0.5, 0.75}) {
        for (const double e : {1.0, 0.5, 0.0}) {
            World world({.region = Box{{0, 0, 0}, {1, 10, 10}}, .precision = GetParam()});
            const BodyId id =
                world.add({.position = {0.5, 5, 5}, .velocity = {1, 0.25, 0}, .radius = radius, .restitution = e},
                          Overlap::accept);
            const StepReport& report = world.step(1);
            EXPECT_EQ(report.behind, 0);
            EXPECT_LT(report.face_impacts, e < 1 ? 100U : most_elastic);
            EXPECT_NEAR(world.get(id).position.x, 0.5, 1e-5);
            EXPECT_NEAR(world.get(id).position.y, 5.25, 1e-5);
            EXPECT_NEAR(world.ledger().lost_to_restitution, 0.5, 1e-9);
        }
    }
}

TEST_P(Overlaps, ABodySqueezedByStaticBodiesComesToAStop) {
    World world = open_world();
    world.add({.position = {-1, 0, 0}, .mass = infinite_mass});
    world.add({.position = {1, 0, 0}, .mass = infinite_mass});
    const BodyId id = world.add({.velocity = {1, 0, 0}});
    EXPECT_LT(world.step(1).impacts, most_elastic);
    EXPECT_EQ(world.get(id).position, Vec3{});
}

TEST_P(Overlaps, ARowThatFillsItsBoxComesToAStop) {
    World world({.region = Box{{0, 0, 0}, {3, 10, 10}}, .precision = GetParam()});
    for (int k = 0; k < 3; ++k) {
        world.add({.position = {0.5 + k, 5, 5}, .velocity = {k == 1 ? 1.0 : 0.0, 0, 0}, .restitution = 0.5});
    }
    EXPECT_EQ(world.step(1).behind, 0);
    EXPECT_LT(world.energy().kinetic, 1e-9);
}

/// A row that has room is a cradle, and takes its many impacts at one instant without loss.
TEST_P(Overlaps, ManyImpactsAtOnceThatDoEndLoseNothing) {
    World world({.region = std::vector<Plane>{{.normal = {1, 0, 0}}}, .precision = GetParam()});
    world.add({.position = {0.5, 0, 0}});
    const double mass = 1e4;
    const BodyId heavy = world.add({.position = {2, 0, 0}, .velocity = {-1, 0, 0}, .mass = mass});
    world.step(2);
    // pi sqrt(k) / 2 impacts on the wall would be needed from afar; from the wall it is half of the angle pi.
    EXPECT_GT(world.report().face_impacts, 60U);
    EXPECT_NEAR(world.energy().kinetic / (0.5 * mass), 1, is_single() ? 1e-4 : 1e-9);
    EXPECT_GT(world.get(heavy).velocity.x, 0.9);
}

// ---------------------------------------------------------------------------------------------------------------------
// Costs
// ---------------------------------------------------------------------------------------------------------------------

/// Processor time in seconds since `start`.
double seconds_since(std::clock_t start) { return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC; }

/// The k-th place of a lattice of `side` * `side` columns, m.
Vec3 lattice_place(int k, int side) {
    const int layer = k / (side * side);
    return {1.1 * (k % side), 1.1 * ((k / side) % side), 1.1 * layer};
}

/// Seconds it takes to add bodies of a lattice one by one, where wanted with a refused call after each.
double seconds_to_add(int count, bool with_refusals) {
    const std::clock_t start = std::clock();
    World world;
    int refused = 0;
    for (int k = 0; k < count; ++k) {
        const Vec3 place = lattice_place(k, 30);
        world.add({.position = place});
        if (!with_refusals) continue;
        try {
            world.add({.position = place + Vec3{0.3, 0, 0}});
        } catch (const Error&) {
            ++refused;
        }
    }
    EXPECT_EQ(refused, with_refusals ? count : 0);
    return seconds_since(start);
}

TEST(CostOfAdding, OneByOneIsCheapForEach) {
    for (const bool with_refusals : {false, true}) {
        seconds_to_add(1000, with_refusals);
        const double half = std::min(seconds_to_add(10'000, with_refusals), seconds_to_add(10'000, with_refusals));
        const double all = std::min(seconds_to_add(20'000, with_refusals), seconds_to_add(20'000, with_refusals));
        // Twice the work if it is O(1) a body, four times if it is O(n); and a bound far above what it takes.
        EXPECT_LT(all, 3.2 * half) << "with refusals: " << with_refusals;
        EXPECT_LT(all, 2);
    }
}

TEST(CostOfAdding, SpawningAndRemovingInAFullWorld) {
    World world;
    std::vector<Vec3> positions(100'000);
    for (std::size_t k = 0; k < positions.size(); ++k) positions[k] = lattice_place(static_cast<int>(k), 47);
    const std::vector<BodyId> ids = world.add({.position = positions});
    const std::clock_t start = std::clock();
    for (std::size_t i = 0; i < 1000; ++i) {
        world.remove(ids[17 * i]);
        world.add({.position = positions[17 * i]});
    }
    // Looking at all bodies each time would take minutes.
    EXPECT_LT(seconds_since(start), 2);
}

} // namespace

} // namespace carom
