// Bodies in and out: round trips, ids, rest and attractors that end.

#include "world/refusals.hpp"

#include <carom/collision.hpp>

#include <array>
#include <random>

namespace carom {

namespace {

using test::expect_refused;

class Bodies : public test::BothPrecisions {
protected:
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

TEST_P(Bodies, BecomeKinematicAndStaticAndMoveAgain) {
    World world({.gravity = {0, 0, -10}, .precision = GetParam()});
    const BodyId id = world.add({.position = {0, 0, 5}, .velocity = {1, 0, 0}});
    const std::array<double, 1> infinite{infinite_mass};
    const std::array<double, 1> finite{2};
    const std::array<Vec3, 1> still{Vec3{}};
    const std::array<BodyId, 1> ids{id};
    world.set(ids, {.mass = infinite});
    world.step(1);
    EXPECT_EQ(world.get(id).position, (Vec3{1, 0, 5}));
    world.set(ids, {.velocity = still, .mass = infinite});
    world.step(1);
    EXPECT_EQ(world.get(id).position, (Vec3{1, 0, 5}));
    world.set(ids, {.velocity = std::array{Vec3{0, 0, 1}}});
    world.step(1);
    EXPECT_EQ(world.get(id).position, (Vec3{1, 0, 6}));
    world.set(ids, {.velocity = still, .mass = finite});
    world.step(1);
    EXPECT_NEAR(world.get(id).position.z, 1, world.resolution());
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
    options.material_rules = {{.a = 1, .b = 2, .restitution = 0.125}, {.a = 3, .b = 3, .restitution = 0.25}};
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
    const std::array<Vec3, 1> place{Vec3{0.25, 0, 0.5}};
    const std::array<Vec3, 1> slow{Vec3{0, 0, -1e-3}};
    const std::array<double, 1> two{2};
    const std::array<double, 1> half{0.5};
    const std::array<double, 1> quarter{0.25};
    for (const ConstBodyColumns& columns :
         {ConstBodyColumns{.velocity = slow}, ConstBodyColumns{.position = place}, ConstBodyColumns{.mass = two}}) {
        world_.set(ids, columns);
        EXPECT_FALSE(world_.held(on_floor_));
        world_.step(0.01);
        EXPECT_TRUE(world_.held(on_floor_)) << "it touches the floor again";
    }
    world_.set(ids, {.radius = quarter});
    EXPECT_FALSE(world_.held(on_floor_));
    for (int k = 0; k < 100; ++k) world_.step(0.01);
    EXPECT_TRUE(world_.held(on_floor_)) << "it has fallen onto the floor";
    // Nor does what says how it is already.
    const Body as_it_is = world_.get(on_floor_);
    world_.set(on_floor_, as_it_is);
    EXPECT_TRUE(world_.held(on_floor_));
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

TEST_P(Bodies, AKinematicBodyMayBeSetAsItIs) {
    World world = open_world();
    const BodyId ram = world.add({.velocity = {1, 0, 0}, .mass = infinite_mass});
    const Body as_it_is = world.get(ram);
    world.set(ram, as_it_is);
    EXPECT_EQ(World::load(world.save()).hash(), world.hash());
    world.step(1);
    EXPECT_EQ(world.get(ram).position, (Vec3{1, 0, 0}));
}

TEST_P(Bodies, WhatIsTooLightForThePrecisionIsRefused) {
    World world = open_world();
    const double least = is_single() ? 2.9e-39 : 5.6e-309; // a little less than the inverse of the largest number
    expect_refused(world, {ErrorCode::out_of_range, "mass", 0}, "too light",
                   [&](World& w) { w.add({.mass = 0.9 * least}); });
    world.add({.mass = 1.1 * least});
}

TEST_P(Bodies, EachOfManyIsPulledByAllAttractorsButItsOwn) {
    World world = open_world();
    std::vector<BodyId> ids;
    for (std::size_t k = 0; k < 70; ++k) {
        const auto x = static_cast<double>(k);
        ids.push_back(world.add({.position = {x, 0.25 * (x - 30) * (x - 30), -0.5 * x}, .radius = 0.01}));
    }
    const std::array attractors{Attractor{.strength = 9, .body = ids[40]},
                                Attractor{.position = world.get(ids[50]).position, .strength = -4, .softening = 0.5},
                                Attractor{.position = {3, 4, 5}, .strength = 7, .softening = 2}};
    world.set_attractors(attractors);
    constexpr double dt = 1e-4;
    world.step(dt);
    for (std::size_t k = 0; k < ids.size(); ++k) {
        const Body body = world.get(ids[k]);
        Vec3 expected{};
        for (const Attractor& attractor : attractors) {
            if (attractor.body == ids[k]) continue;
            const Vec3 d =
                (attractor.body.is_set() ? world.get(attractor.body).position : attractor.position) - body.position;
            const double r = std::hypot(length(d), attractor.softening);
            expected += d * (attractor.strength / (r * r * r));
        }
        // Within a step bodies move by some 1e-8 m, and nobody but its own is nearer than 1 m to an attractor.
        EXPECT_LE(length(body.velocity / dt - expected), 1e-6 * length(expected)) << k;
    }
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

} // namespace

} // namespace carom
