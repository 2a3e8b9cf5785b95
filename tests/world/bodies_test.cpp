// Bodies in and out: round trips, ids, rest and attractors that end, overlaps refused and accepted.

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

class Bodies : public test::BothPrecisions {
protected:
    [[nodiscard]] static World open_world() { return World({.precision = GetParam()}); }
    [[nodiscard]] static World world_with_floor(double gravity = -10) {
        return World({.gravity = {0, 0, gravity}, .region = std::vector<Plane>{{}}, .precision = GetParam()});
    }
    /// Relative rounding of a number that the world keeps.
    [[nodiscard]] static double rounding() { return is_single() ? 6e-8 : 0; }
};

INSTANTIATE_TEST_SUITE_P(Precisions, Bodies, test::both_precisions(), test::precision_name);

/// The k-th of many bodies that do not overlap, every field different.
Body example_body(std::size_t k) {
    const auto x = static_cast<double>(k);
    return {.position = {3 * x, -2 * x, 0.1 * x},
            .velocity = {0.3 * x, 1 / (1 + x), -x},
            .mass = 0.1 + x,
            .radius = 1 / (2 + x),
            .restitution = 1 / (1 + x),
            .friction = 0.7 * x,
            .material = static_cast<std::uint32_t>(7 * k),
            .user_data = 0xfedcba9876543210U + k};
}

void expect_same(const Body& actual, const Body& expected, double rounding, double resolution) {
    const auto near = [](const Vec3& a, const Vec3& b, double tolerance) { return length(a - b) <= tolerance; };
    EXPECT_TRUE(near(actual.position, expected.position, resolution));
    EXPECT_TRUE(near(actual.velocity, expected.velocity, rounding * length(expected.velocity)));
    EXPECT_NEAR(actual.mass, expected.mass, rounding * expected.mass);
    EXPECT_NEAR(actual.radius, expected.radius, rounding * expected.radius);
    EXPECT_NEAR(actual.restitution, expected.restitution, rounding);
    EXPECT_NEAR(actual.friction, expected.friction, rounding * expected.friction);
    EXPECT_EQ(actual.material, expected.material);
    EXPECT_EQ(actual.user_data, expected.user_data);
}

/// All columns of some bodies.
struct Columns {
    std::vector<Vec3> position, velocity;
    std::vector<double> mass, radius, restitution, friction;
    std::vector<std::uint32_t> material;
    std::vector<std::uint64_t> user_data;

    explicit Columns(std::size_t count)
        : position(count), velocity(count), mass(count), radius(count), restitution(count), friction(count),
          material(count), user_data(count) {}

    void put(std::size_t k, const Body& b) {
        position[k] = b.position;
        velocity[k] = b.velocity;
        mass[k] = b.mass;
        radius[k] = b.radius;
        restitution[k] = b.restitution;
        friction[k] = b.friction;
        material[k] = b.material;
        user_data[k] = b.user_data;
    }
    [[nodiscard]] Body body(std::size_t k) const {
        return {position[k], velocity[k], mass[k], radius[k], restitution[k], friction[k], material[k], user_data[k]};
    }
    [[nodiscard]] ConstBodyColumns input() const {
        return {position, velocity, mass, radius, restitution, friction, material, user_data};
    }
    [[nodiscard]] BodyColumns output() {
        return {position, velocity, mass, radius, restitution, friction, material, user_data};
    }
};

TEST_P(Bodies, OneComesOutAsItWentIn) {
    World world = open_world();
    for (std::size_t k = 0; k < 20; ++k) {
        const BodyId id = world.add(example_body(k));
        expect_same(world.get(id), example_body(k), rounding(), world.resolution());
    }
    EXPECT_EQ(world.size(), 20U);
}

TEST_P(Bodies, ManyComeOutAsTheyWentIn) {
    World world = open_world();
    constexpr std::size_t count = 50;
    Columns in(count);
    for (std::size_t k = 0; k < count; ++k) in.put(k, example_body(k));
    const std::vector<BodyId> ids = world.add(in.input());
    ASSERT_EQ(ids.size(), count);
    Columns out(count);
    world.get(ids, out.output());
    for (std::size_t k = 0; k < count; ++k) {
        expect_same(out.body(k), example_body(k), rounding(), world.resolution());
        expect_same(world.get(ids[k]), example_body(k), rounding(), world.resolution());
    }
    // Steps and sorting in memory move the bodies, not what belongs to an id.
    for (int i = 0; i < 40; ++i) world.step(1e-3);
    world.get(ids, out.output());
    for (std::size_t k = 0; k < count; ++k) EXPECT_EQ(out.user_data[k], example_body(k).user_data);
}

TEST_P(Bodies, ColumnsLeftOutAreDefaultsWhenAdded) {
    World world = open_world();
    const std::array<Vec3, 2> position{Vec3{}, Vec3{5, 0, 0}};
    const std::vector<BodyId> ids = world.add({.position = position});
    Body expected;
    expected.position = position[1];
    expect_same(world.get(ids[1]), expected, 0, 0);
    EXPECT_TRUE(world.add(ConstBodyColumns{}).empty());
}

TEST_P(Bodies, ColumnsLeftOutStayWhenSet) {
    World world = open_world();
    const std::array<BodyId, 2> ids{world.add(example_body(3)), world.add(example_body(4))};
    const auto expect_change = [&](const ConstBodyColumns& columns, const std::function<void(Body&)>& change) {
        std::array<Body, 2> expected{world.get(ids[0]), world.get(ids[1])};
        world.set(ids, columns);
        for (std::size_t k = 0; k < 2; ++k) {
            change(expected[k]);
            expect_same(world.get(ids[k]), expected[k], rounding(), world.resolution());
        }
    };
    const std::array<Vec3, 2> far{Vec3{100, 0, 0}, Vec3{100, 0, 0}};
    const std::array<double, 2> halves{0.5, 0.5};
    const std::array<std::uint32_t, 2> keys{9, 9};
    const std::array<std::uint64_t, 2> data{8, 8};
    expect_change({.velocity = far}, [](Body& b) { b.velocity = {100, 0, 0}; });
    expect_change({.mass = halves}, [](Body& b) { b.mass = 0.5; });
    expect_change({.radius = halves}, [](Body& b) { b.radius = 0.5; });
    expect_change({.restitution = halves}, [](Body& b) { b.restitution = 0.5; });
    expect_change({.friction = halves}, [](Body& b) { b.friction = 0.5; });
    expect_change({.material = keys}, [](Body& b) { b.material = 9; });
    expect_change({.user_data = data}, [](Body& b) { b.user_data = 8; });
    expect_change({}, [](Body&) {});
    world.set(std::array{ids[1]}, {.position = std::array{Vec3{-7, 1, 2}}});
    EXPECT_EQ(world.get(ids[1]).position, (Vec3{-7, 1, 2}));
}

TEST_P(Bodies, PositionsAreRoundedSymmetrically) {
    World world = open_world();
    const double unit = world.resolution();
    const auto rounded = [&](double x) {
        return world.get(world.add({.position = {x, -x, 0}, .radius = 0}, Overlap::accept)).position;
    };
    for (const double units : {0.49, 0.5, 0.51, 1.5, 2.5, 1234567.75}) {
        const Vec3 there = rounded(units * unit);
        EXPECT_EQ(there.x, std::rint(units) * unit);
        EXPECT_EQ(there.y, -there.x);
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Ids
// ---------------------------------------------------------------------------------------------------------------------

TEST_P(Bodies, IdsComeInOrder) {
    World world = open_world();
    Columns columns(30);
    for (std::size_t k = 0; k < 30; ++k) columns.put(k, example_body(k));
    const std::vector<BodyId> ids = world.add(columns.input());
    EXPECT_TRUE(std::is_sorted(ids.begin(), ids.end()));
    for (int i = 0; i < 20; ++i) world.step(1e-3);
    EXPECT_EQ(world.ids(), ids);
    world.remove(std::array{ids[3], ids[20], ids[29]});
    std::vector<BodyId> rest = ids;
    rest.erase(rest.begin() + 29);
    rest.erase(rest.begin() + 20);
    rest.erase(rest.begin() + 3);
    EXPECT_EQ(world.ids(), rest);
    EXPECT_EQ(world.size(), 27U);
    for (const BodyId id : rest) EXPECT_EQ(world.get(id).user_data, example_body(id.slot).user_data);
}

TEST_P(Bodies, ASlotIsUsedAgainWithAnotherGeneration) {
    World world = open_world();
    const BodyId first = world.add(Body{});
    world.remove(first);
    EXPECT_FALSE(world.contains(first));
    const BodyId second = world.add(Body{});
    EXPECT_EQ(second.slot, first.slot);
    EXPECT_NE(second.generation, first.generation);
    EXPECT_NE(second, first);
    EXPECT_TRUE(world.contains(second));
    EXPECT_FALSE(world.contains(first));
}

/// Generations have 16 bits: an id must not come back to life after 65536 bodies in its slot.
TEST_P(Bodies, AnOldIdStaysStaleForEver) {
    World world = open_world();
    std::vector<BodyId> given;
    for (int i = 0; i < 70000; ++i) {
        given.push_back(world.add(Body{}));
        world.remove(given.back());
    }
    const BodyId last = world.add(Body{});
    EXPECT_FALSE(std::any_of(given.begin(), given.end(), [&](BodyId id) { return world.contains(id) || id == last; }));
    EXPECT_LE(last.slot, 1U);
}

TEST_P(Bodies, RemovingWhileOthersMoveInMemory) {
    World world = open_world();
    std::vector<BodyId> ids(100);
    for (std::size_t k = 0; k < ids.size(); ++k) ids[k] = world.add(example_body(k));
    std::mt19937 random(1); // NOLINT(cert-msc51-cpp): fixed
    std::shuffle(ids.begin(), ids.end(), random);
    while (ids.size() > 10) {
        world.remove(std::span(ids).last(3));
        ids.resize(ids.size() - 3);
        world.step(1e-3);
        for (const BodyId id : ids) EXPECT_EQ(world.get(id).user_data, example_body(id.slot).user_data);
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Static bodies and materials
// ---------------------------------------------------------------------------------------------------------------------

TEST_P(Bodies, StaticBodiesTakeAnyMomentum) {
    World world({.gravity = {0, 0, -10}, .precision = GetParam()});
    const BodyId wall = world.add({.mass = infinite_mass, .radius = 1, .restitution = 0});
    const BodyId ball = world.add({.position = {-3, 0, 0}, .velocity = {2, 0, 0}, .mass = 1e6, .restitution = 0.5});
    EXPECT_EQ(world.get(wall).mass, infinite_mass);
    world.set_gravity({});
    world.step(1);
    EXPECT_EQ(world.get(wall).position, Vec3{});
    EXPECT_EQ(world.get(wall).velocity, Vec3{});
    EXPECT_NEAR(world.get(ball).velocity.x, -1, 1e-12);
    EXPECT_EQ(world.energy().kinetic, 0.5 * 1e6);
}

TEST_P(Bodies, BecomeStaticAndMoveAgain) {
    World world({.gravity = {0, 0, -10}, .precision = GetParam()});
    const BodyId id = world.add({.position = {0, 0, 5}, .velocity = {1, 0, 0}});
    const std::array<double, 1> infinite{infinite_mass};
    const std::array<double, 1> finite{2};
    const std::array<Vec3, 1> still{Vec3{}};
    const std::array<BodyId, 1> ids{id};
    expect_refused(world, {ErrorCode::out_of_range, "velocity", 0}, "static, but moving",
                   [&](World& w) { w.set(ids, {.mass = infinite}); });
    world.set(ids, {.velocity = still, .mass = infinite});
    world.step(1);
    EXPECT_EQ(world.get(id).position, (Vec3{0, 0, 5}));
    expect_refused(world, {ErrorCode::out_of_range, "velocity", 0}, "static, to move",
                   [&](World& w) { w.set(ids, {.velocity = std::array{Vec3{1, 0, 0}}}); });
    world.set(ids, {.mass = finite});
    world.step(1);
    EXPECT_NEAR(world.get(id).position.z, 0, world.resolution());
    EXPECT_EQ(world.get(id).velocity.z, -10);
}

/// The approach of two bodies of the given materials along x, and what it comes to.
double speed_ratio(const WorldOptions& options, const Body& like_a, const Body& like_b) {
    World world(options);
    Body a = like_a;
    Body b = like_b;
    a.position = {-1, 0, 0};
    b.position = {1, 0, 0};
    a.velocity = {1, 0, 0};
    b.velocity = {-1, 0, 0};
    const BodyId id_a = world.add(a);
    const BodyId id_b = world.add(b);
    world.step(1);
    return (world.get(id_b).velocity.x - world.get(id_a).velocity.x) / 2;
}

TEST_P(Bodies, MaterialRulesGoBeforeCombining) {
    WorldOptions options{.precision = GetParam()};
    options.material_rules = {{.a = 1, .b = 2, .restitution = 0.125},
                              {.a = 3, .b = 3, .restitution = 0.25},
                              {.a = 1, .b = 2, .restitution = 1}};
    const auto body = [](std::uint32_t material, double e) { return Body{.restitution = e, .material = material}; };
    const auto ratio = [&](const Body& a, const Body& b) { return speed_ratio(options, a, b); };
    EXPECT_NEAR(ratio(body(1, 0.5), body(2, 0.75)), 0.125, 1e-7);
    EXPECT_NEAR(ratio(body(2, 0.5), body(1, 0.75)), 0.125, 1e-7);
    EXPECT_NEAR(ratio(body(3, 0.5), body(3, 0.75)), 0.25, 1e-7);
    EXPECT_NEAR(ratio(body(1, 0.5), body(3, 0.75)), 0.75, 1e-7);
    EXPECT_NEAR(ratio(body(1, 0.5), body(1, 0.25)), 0.5, 1e-7);
}

TEST_P(Bodies, AFaceUsesItsOwnSurfaceOrTheBodys) {
    for (const bool own : {true, false}) {
        Shell shell{.radius = 2};
        if (own) shell.surface.restitution = 0.25;
        World world({.region = shell, .precision = GetParam()});
        const BodyId id = world.add({.velocity = {4, 0, 0}, .restitution = 0.5});
        world.step(0.5);
        EXPECT_NEAR(world.get(id).velocity.x, own ? -1 : -2, 1e-6);
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Rest that ends
// ---------------------------------------------------------------------------------------------------------------------

class Rest : public Bodies {
protected:
    World world_ = world_with_floor();
    BodyId pillar_ = world_.add({.position = {10, 0, 5}, .mass = infinite_mass, .radius = 1, .restitution = 0});
    BodyId on_pillar_ = world_.add({.position = {10, 0, 6.5}, .restitution = 0});
    BodyId on_floor_ = world_.add({.position = {0, 0, 0.5}, .restitution = 0});

    void SetUp() override {
        world_.step(0.01);
        ASSERT_TRUE(world_.held(on_pillar_));
        ASSERT_TRUE(world_.held(on_floor_));
        ASSERT_FALSE(world_.held(pillar_));
        ASSERT_EQ(world_.report().held, 2U);
    }
};

INSTANTIATE_TEST_SUITE_P(Precisions, Rest, test::both_precisions(), test::precision_name);

TEST_P(Rest, EndsWithASetVelocityPositionMassOrRadius) {
    const std::array<BodyId, 1> ids{on_floor_};
    const std::array<Vec3, 1> place{Vec3{0, 0, 0.5}};
    const std::array<Vec3, 1> still{Vec3{}};
    const std::array<double, 1> one{1};
    const std::array<double, 1> half{0.5};
    for (const ConstBodyColumns& columns : {ConstBodyColumns{.velocity = still}, ConstBodyColumns{.position = place},
                                            ConstBodyColumns{.mass = one}, ConstBodyColumns{.radius = half}}) {
        world_.set(ids, columns);
        EXPECT_FALSE(world_.held(on_floor_));
        world_.step(0.01);
        EXPECT_TRUE(world_.held(on_floor_)) << "it touches the floor again";
    }
    for (const ConstBodyColumns& columns :
         {ConstBodyColumns{.restitution = half}, ConstBodyColumns{.friction = half}, ConstBodyColumns{}}) {
        world_.set(ids, columns);
        EXPECT_TRUE(world_.held(on_floor_));
    }
    EXPECT_TRUE(world_.held(on_pillar_));
}

TEST_P(Rest, EndsWithAnImpulseOrAVelocityChange) {
    const std::array<Vec3, 1> up{Vec3{0, 0, 3}};
    world_.apply_impulses(std::array{on_floor_}, up);
    world_.change_velocities(std::array{on_pillar_}, up);
    EXPECT_FALSE(world_.held(on_floor_));
    EXPECT_FALSE(world_.held(on_pillar_));
    world_.step(0.1);
    EXPECT_NEAR(world_.get(on_floor_).position.z, 0.5 + 0.3 - 0.05, 1e-5);
    EXPECT_NEAR(world_.get(on_pillar_).position.z, 6.5 + 0.3 - 0.05, 1e-5);
}

TEST_P(Rest, EndsWhenTheSupportGoes) {
    world_.remove(pillar_);
    EXPECT_FALSE(world_.held(on_pillar_));
    EXPECT_TRUE(world_.held(on_floor_));
    world_.step(0.1);
    EXPECT_NEAR(world_.get(on_pillar_).position.z, 6.5 - 0.05, 1e-5);
}

TEST_P(Rest, EndsWhenTheSupportIsMovedOrComesAlive) {
    const std::array<BodyId, 1> ids{pillar_};
    for (const bool comes_alive : {false, true}) {
        World world = world_;
        if (comes_alive) {
            world.set(ids, {.mass = std::array{5.0}});
        } else {
            world.set(ids, {.position = std::array{Vec3{20, 0, 5}}});
        }
        EXPECT_FALSE(world.held(on_pillar_));
        world.step(0.1);
        EXPECT_NEAR(world.get(on_pillar_).position.z, 6.5 - 0.05, 1e-5);
        EXPECT_NEAR(world.get(pillar_).position.z, comes_alive ? 5 - 0.05 : 5, 1e-5);
    }
}

TEST_P(Rest, EndsWhenTheBodyBecomesStaticOrIsRemoved) {
    world_.set(std::array{on_floor_}, {.mass = std::array{infinite_mass}});
    EXPECT_FALSE(world_.held(on_floor_));
    world_.remove(on_pillar_);
    world_.step(0.1);
    EXPECT_EQ(world_.report().held, 0U);
    EXPECT_NEAR(world_.get(on_floor_).position.z, 0.5, world_.resolution());
}

TEST_P(Rest, EndsWhenStruck) {
    const BodyId striker = world_.add({.position = {-2, 0, 0.5}, .velocity = {10, 0, 0}});
    world_.step(0.2);
    EXPECT_NEAR(world_.get(on_floor_).velocity.x, 10, 1e-5);
    EXPECT_NEAR(world_.get(striker).velocity.x, 0, 1e-5);
}

TEST_P(Rest, ASetThatIsRefusedDoesNotEndIt) {
    expect_refused(world_, {ErrorCode::overlap, "position", 0}, "into the floor",
                   [&](World& world) { world.set(std::array{on_floor_}, {.position = std::array{Vec3{0, 0, 0.3}}}); });
    EXPECT_TRUE(world_.held(on_floor_));
}

// ---------------------------------------------------------------------------------------------------------------------
// Attractors, impulses
// ---------------------------------------------------------------------------------------------------------------------

TEST_P(Bodies, AnAttractorEndsWithTheBodyThatCarriesIt) {
    World world = open_world();
    const BodyId star = world.add({.mass = infinite_mass});
    const BodyId planet = world.add({.position = {10, 0, 0}});
    const BodyId moon = world.add({.position = {14, 0, 0}});
    world.set_attractors(std::array{Attractor{.strength = 3, .body = planet}, Attractor{.strength = 2, .body = star},
                                    Attractor{.position = {0, 9, 0}, .strength = 1}});
    world.remove(planet);
    ASSERT_EQ(world.attractors().size(), 2U);
    EXPECT_EQ(world.attractors()[0].body, star);
    EXPECT_EQ(world.attractors()[1].position, (Vec3{0, 9, 0}));
    const BodyId successor = world.add({.position = {10, 0, 0}});
    EXPECT_EQ(successor.slot, planet.slot);
    world.remove(star);
    world.step(1);
    // Only the one at (0, 9, 0) is left to pull, with 1 / |d|^2.
    const Vec3 d = Vec3{0, 9, 0} - Vec3{14, 0, 0};
    const Vec3 v = world.get(moon).velocity;
    EXPECT_NEAR(length(v), 1 / length_squared(d), 1e-4);
    EXPECT_NEAR(dot(v, d), length(v) * length(d), 1e-6);
}

TEST_P(Bodies, ACarriedAttractorMovesWithItsBodyAndSparesIt) {
    World world = open_world();
    const BodyId star = world.add({.velocity = {0, 100, 0}, .mass = 1e-3});
    const BodyId planet = world.add({.position = {10, 100, 0}});
    world.set_attractors(std::array{Attractor{.strength = 4, .body = star}});
    world.step(1);
    EXPECT_EQ(world.get(star).velocity, (Vec3{0, 100, 0}));
    const Vec3 v = world.get(planet).velocity;
    // Half a kick from (0, 0), half a kick from (0, 100).
    EXPECT_NEAR(v.x, -0.5 * 4 / 100.0 - 0.5 * 4 * 10 / std::pow(10100, 1.5), 1e-4);
    EXPECT_NEAR(v.y, -0.5 * 4 * 100 / std::pow(10100, 1.5), 1e-5);
}

TEST_P(Bodies, ImpulsesAndVelocityChangesAdd) {
    World world = open_world();
    const BodyId a = world.add({.velocity = {1, 0, 0}, .mass = 4});
    const BodyId b = world.add({.position = {0, 5, 0}, .mass = 0.5});
    const std::array<BodyId, 3> ids{a, b, a};
    const std::array<Vec3, 3> by{Vec3{2, 0, 0}, Vec3{0, 1, 0}, Vec3{0, 0, 8}};
    world.apply_impulses(ids, by);
    EXPECT_EQ(world.get(a).velocity, (Vec3{1.5, 0, 2}));
    EXPECT_EQ(world.get(b).velocity, (Vec3{0, 2, 0}));
    world.change_velocities(ids, by);
    EXPECT_EQ(world.get(a).velocity, (Vec3{3.5, 0, 10}));
    EXPECT_EQ(world.get(b).velocity, (Vec3{0, 3, 0}));
    world.apply_impulses({}, {});
}

// ---------------------------------------------------------------------------------------------------------------------
// Overlap
// ---------------------------------------------------------------------------------------------------------------------

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

TEST_P(Bodies, OverlapIsRefusedAtAddAndSet) {
    World world = open_world();
    const BodyId a = world.add({.position = {0, 0, 0}});
    const BodyId b = world.add({.position = {3, 0, 0}});
    expect_overlap(world, 0, "slot 1", [](World& w) { w.add({.position = {3.9, 0, 0}}); });
    expect_overlap(world, 0, "slot 0", [&](World& w) { w.set(b, {.position = {0.5, 0.5, 0}}); });
    expect_overlap(world, 0, "slot 1", [&](World& w) { w.set(std::array{a, b}, {.radius = std::array{0.5, 2.6}}); });
    // Bodies that change places do not meet on the way.
    world.set(std::array{a, b}, {.position = std::array{Vec3{3, 0, 0}, Vec3{0, 0, 0}}});
    EXPECT_EQ(world.get(a).position.x, 3);
}

TEST_P(Bodies, OverlapWithinOneCallNamesWhich) {
    World world = open_world();
    world.add({.position = {50, 0, 0}});
    std::vector<Vec3> positions{{0, 0, 0}, {4, 0, 0}, {8, 0, 0}, {12, 0, 0}, {16, 0, 0}, {8.5, 0, 0}};
    expect_overlap(world, 5, "body 2 of this call", [&](World& w) { w.add({.position = positions}); });
    positions[3] = {50, 0.5, 0};
    expect_overlap(world, 3, "slot 0", [&](World& w) { w.add({.position = positions}); });
}

TEST_P(Bodies, WallsAreRespected) {
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

TEST_P(Bodies, OverlapIsSeenAcrossAPeriodicFace) {
    Box box{{0, 0, 0}, {10, 10, 10}};
    for (Face& face : box.faces) face.kind = FaceKind::periodic;
    World world({.region = box, .precision = GetParam()});
    world.add({.position = {0.2, 0.1, 9.9}});
    expect_overlap(world, 0, "slot 0", [](World& w) { w.add({.position = {9.9, 9.8, 0.2}}); });
    // A position outside the box is the same as its image inside.
    const BodyId id = world.add({.position = {-5, 25, 5}});
    EXPECT_EQ(world.get(id).position, (Vec3{5, 5, 5}));
}

TEST_P(Bodies, TouchingIsNoOverlap) {
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

TEST_P(Bodies, RefusedBodiesLeaveNoTrace) {
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
TEST_P(Bodies, OverlapIsFoundAsByPlainSearch) {
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
TEST_P(Bodies, AcceptedPairsPartFreely) {
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

TEST_P(Bodies, ASetMayBeAcceptedToo) {
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

TEST_P(Bodies, CoincidentCentresGiveNumbers) {
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

/// Between two faces there are impacts without end at one instant. The body stops instead.
TEST_P(Bodies, ABodyThatFillsItsBoxComesToAStop) {
    for (const double radius : {0.5, 0.75}) {
        for (const double e : {1.0, 0.5, 0.0}) {
            World world({.region = Box{{0, 0, 0}, {1, 10, 10}}, .precision = GetParam()});
            const BodyId id =
                world.add({.position = {0.5, 5, 5}, .velocity = {1, 0.25, 0}, .radius = radius, .restitution = e},
                          Overlap::accept);
            const StepReport& report = world.step(1);
            EXPECT_EQ(report.behind, 0);
            EXPECT_LT(report.face_impacts, 100U);
            EXPECT_NEAR(world.get(id).position.x, 0.5, 1e-5);
            EXPECT_NEAR(world.get(id).position.y, 5.25, 1e-5);
            EXPECT_NEAR(world.ledger().lost_to_restitution, 0.5, 1e-9);
        }
    }
}

TEST_P(Bodies, ABodySqueezedByStaticBodiesComesToAStop) {
    World world = open_world();
    world.add({.position = {-1, 0, 0}, .mass = infinite_mass});
    world.add({.position = {1, 0, 0}, .mass = infinite_mass});
    const BodyId id = world.add({.velocity = {1, 0, 0}});
    EXPECT_LT(world.step(1).impacts, 100U);
    EXPECT_EQ(world.get(id).position, Vec3{});
}

TEST_P(Bodies, ARowThatFillsItsBoxComesToAStop) {
    World world({.region = Box{{0, 0, 0}, {3, 10, 10}}, .precision = GetParam()});
    for (int k = 0; k < 3; ++k) {
        world.add({.position = {0.5 + k, 5, 5}, .velocity = {k == 1 ? 1.0 : 0.0, 0, 0}, .restitution = 0.5});
    }
    EXPECT_EQ(world.step(1).behind, 0);
    EXPECT_LT(world.energy().kinetic, 1e-9);
}

/// A row that has room is a cradle, and takes its many impacts at one instant without loss.
TEST_P(Bodies, ManyImpactsAtOnceThatDoEndLoseNothing) {
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
