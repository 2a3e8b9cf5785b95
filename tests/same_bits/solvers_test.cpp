// Islands do as the one queue does, bit for bit: in small random worlds with everything in them that a world may have,
// cut into windows, on threads, and meddled with between steps.

#include "same_bits/disorderly_executor.hpp"

#include <carom/carom.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <variant>
#include <vector>

namespace {

using carom::BodyId;
using carom::Box;
using carom::Impact;
using carom::Vec3;
using carom::World;
using carom::WorldOptions;
using carom::test::Disorder;
using carom::test::DisorderlyExecutor;

class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}
    std::uint32_t below(std::uint32_t end) { return static_cast<std::uint32_t>(engine_()) % end; }
    /// Multiples of 1/1024: the same on every machine.
    double within(double low, double high) { return low + (high - low) * (below(1025) / 1024.0); }
    Vec3 vector(double size) { return {within(-size, size), within(-size, size), within(-size, size)}; }
    bool chance(std::uint32_t one_in) { return below(one_in) == 0; }

private:
    std::mt19937 engine_;
};

constexpr double half_side = 6;

carom::Region random_region(Random& random) {
    Box box{{-half_side, -half_side, -half_side}, {half_side, half_side, half_side}};
    switch (random.below(6)) {
    case 0:
        return carom::OpenSpace{};
    case 1:
        return carom::Shell{.radius = 2 * half_side};
    case 2:
        return std::vector<carom::Plane>{{.point = {0, 0, -half_side}},
                                         {.point = {0, 0, half_side}, .normal = {0.25, 0, -1}}};
    case 3:
        for (std::size_t face = 0; face < 6; ++face) box.faces[face].kind = carom::FaceKind::periodic;
        return box;
    case 4:
        for (const std::size_t face : {0U, 1U}) box.faces[face].kind = carom::FaceKind::periodic;
        return box;
    default:
        return box;
    }
}

carom::FaceMotion random_motion(Random& random) {
    carom::FaceMotion motion;
    if (random.chance(2)) motion.velocity = random.within(-0.5, 0.5);
    if (random.chance(2)) {
        motion.amplitude = random.within(0, 0.25);
        motion.angular_frequency = random.within(0, 60);
        motion.phase = random.within(-4, 4);
    }
    return motion;
}

/// Lets the faces of a region move.
void drive(carom::Region& region, Random& random) {
    if (auto* box = std::get_if<Box>(&region)) {
        for (carom::Face& face : box->faces) {
            if (face.kind == carom::FaceKind::reflecting) face.motion = random_motion(random);
        }
        if (box->faces[4].kind == carom::FaceKind::reflecting) {
            box->faces[4].motion.surface_velocity = {random.within(-2, 2), random.within(-2, 2), 0};
        }
    }
    if (auto* planes = std::get_if<std::vector<carom::Plane>>(&region)) {
        for (carom::Plane& plane : *planes) plane.motion = random_motion(random);
    }
}

bool is_periodic(const carom::Region& region) {
    const auto* box = std::get_if<Box>(&region);
    return box != nullptr && box->faces[0].kind == carom::FaceKind::periodic;
}

/// A roof of two triangles, and a frustum, which turns if it is driven.
std::vector<carom::Obstacle> random_obstacles(Random& random, bool is_driven) {
    const Vec3 ridge = random.vector(3);
    carom::Mesh roof{.vertices = {ridge, ridge + Vec3{6, 1, 0} + random.vector(1), ridge + Vec3{2, 5, -2},
                                  ridge + Vec3{3, -4, -3} + random.vector(1)},
                     .triangles = {{0, 1, 2}, {1, 0, 3}}};
    if (random.chance(2)) roof.surface = {.restitution = 0.5, .friction = 0.2};
    const carom::Frustum frustum{.base = random.vector(4),
                                 .axis = Vec3{0, 0, 1.5} + random.vector(1),
                                 .height = random.within(0, 4),
                                 .base_radius = random.within(0.5, 4),
                                 .top_radius = random.within(0, 3),
                                 .angular_velocity = is_driven ? random.within(-2, 2) : 0};
    return {roof, frustum};
}

WorldOptions random_options(Random& random, bool is_driven) {
    WorldOptions options;
    options.region = random_region(random);
    if (is_driven) drive(options.region, random);
    options.precision = random.chance(2) ? carom::Precision::single_precision : carom::Precision::double_precision;
    if (random.chance(2)) options.gravity = random.vector(10);
    if (!is_periodic(options.region) && random.chance(3)) options.obstacles = random_obstacles(random, is_driven);
    if (random.chance(4)) options.drag = {.linear = 0.1, .quadratic = 0.05};
    if (random.chance(3)) options.collapse_time = 0.05;
    // The material of every third body.
    if (random.chance(4)) options.materials = {{.key = 1, .restitution = carom::Viscoelastic{0.02, 1e3}}};
    return options;
}

/// `is_driven`: with what moves as prescribed.
World random_world(unsigned seed, bool is_driven = false) {
    Random random(seed);
    World world(random_options(random, is_driven));
    const double speed = random.chance(3) ? 0.5 : 20;
    const double e = random.chance(3) ? 1 : random.within(0, 1);
    const bool grow = is_driven && random.chance(2);
    for (int k = 0; k < 64; ++k) {
        const int row = k / 4 % 4;
        const int layer = k / 16;
        const Vec3 lattice{2.8 * (k % 4) - 4.2, 2.8 * row - 4.2, 2.8 * layer - 4.2};
        carom::Body body{.position = lattice + random.vector(0.3),
                         .velocity = random.vector(speed),
                         .mass = random.within(0.5, 3),
                         .radius = random.within(0.1, 0.9),
                         .restitution = e,
                         .friction = random.chance(2) ? 0 : 0.3,
                         .material = k % 3 == 0 ? 1U : 0U};
        if (random.chance(16)) body.velocity = random.vector(2000);
        if (random.chance(8)) {
            body.mass = std::numeric_limits<double>::infinity();
            body.velocity = is_driven && random.chance(2) ? random.vector(5) : Vec3{};
        }
        if (grow) body.growth = random.within(-0.05, 0.1);
        world.add(body, carom::Overlap::accept);
    }
    if (random.chance(4)) {
        const std::array attractor{carom::Attractor{.strength = 50, .softening = 1}};
        world.set_attractors(attractor);
    }
    return world;
}

/// What a game may do between two steps.
void meddle(World& world, unsigned seed) {
    Random random(seed);
    const std::vector<BodyId> ids = world.ids();
    const BodyId id = ids[random.below(static_cast<std::uint32_t>(ids.size()))];
    const bool is_static = std::isinf(world.get(id).mass);
    switch (random.below(7)) {
    case 0:
        if (!is_static) world.change_velocities({{id}}, {{random.vector(30)}});
        break;
    case 1:
        if (ids.size() > 8) world.remove(id);
        break;
    case 2:
        world.add({.position = random.vector(half_side / 2), .radius = 0.2}, carom::Overlap::accept);
        break;
    case 3: {
        carom::Body body = world.get(id);
        body.position += random.vector(0.5);
        if (!is_static) body.velocity = random.vector(5);
        try {
            world.set(id, body, carom::Overlap::accept);
        } catch (const carom::Error& error) {
            ASSERT_EQ(error.code(), carom::ErrorCode::overlap) << error.what();
        }
        break;
    }
    case 4:
        try {
            world.set_face_motion(static_cast<std::int32_t>(random.below(6)), random_motion(random));
        } catch (const carom::Error& error) {
            ASSERT_EQ(error.field(), "face") << error.what();
        }
        break;
    default:
        break;
    }
}

bool same(const Impact& x, const Impact& y) {
    return x.offset == y.offset && x.a == y.a && x.b == y.b && x.face == y.face && x.impulse == y.impulse &&
           x.normal == y.normal && x.position == y.position && x.energy_lost == y.energy_lost;
}

/// Steps both in the same way; the impacts made.
std::size_t expect_same(World& one, World& other, unsigned seed, const std::string& what) {
    Random random(seed);
    std::size_t impacts = 0;
    for (unsigned i = 0; i < 24; ++i) {
        const double dt = random.chance(4) ? random.within(0.001, 0.2) : 1.0 / 60;
        one.step(dt);
        other.step(dt);
        const auto a = one.impacts();
        const auto b = other.impacts();
        impacts += a.size();
        EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end(), same)) << what << ", step " << i;
        EXPECT_EQ(one.hash(), other.hash()) << what << ", step " << i;
        EXPECT_EQ(one.ledger(), other.ledger()) << what << ", step " << i;
        if (testing::Test::HasFailure()) return impacts;
        if (random.chance(3)) {
            meddle(one, 1000 * seed + i);
            meddle(other, 1000 * seed + i);
        }
    }
    return impacts;
}

std::size_t compare_in_random_worlds(unsigned worlds, bool are_driven) {
    std::size_t impacts = 0;
    for (unsigned seed = 0; seed < worlds; ++seed) {
        World reference = random_world(seed, are_driven);
        World islands = reference;
        reference.set_serial_reference(true);
        reference.set_work_cap(20000);
        islands.set_work_cap(20000);
        const std::array<std::uint32_t, 3> windows{1, 2, 7};
        islands.set_min_windows(windows[seed % windows.size()]);
        if (seed % 4 == 1) islands.set_executor(carom::make_thread_executor(3));
        if (seed % 4 == 2) islands.set_executor(std::make_shared<DisorderlyExecutor>(Disorder::reversed));
        if (seed % 4 == 3) islands.set_executor(std::make_shared<DisorderlyExecutor>(Disorder::shuffled));
        impacts += expect_same(reference, islands, seed, "world " + std::to_string(seed));
        if (testing::Test::HasFailure()) break;
    }
    return impacts;
}

TEST(Solvers, IslandsDoAsTheReferenceInRandomWorlds) {
    const std::size_t impacts = compare_in_random_worlds(400, false);
    std::printf("figure: 400 random worlds, %zu impacts: islands as the reference, bit for bit\n", impacts);
    EXPECT_GT(impacts, 20000U);
}

TEST(Solvers, IslandsDoAsTheReferenceWhereMotionIsPrescribed) {
    const std::size_t impacts = compare_in_random_worlds(200, true);
    std::printf("figure: 200 driven worlds, %zu impacts: islands as the reference, bit for bit\n", impacts);
    EXPECT_GT(impacts, 10000U);
}

/// A thin gas whose paths attractors, drag, gravity, or pushes between steps bend: covers lie ahead of their bodies.
World thin_world(unsigned seed) {
    Random random(seed);
    WorldOptions options;
    options.precision = random.chance(2) ? carom::Precision::single_precision : carom::Precision::double_precision;
    if (random.chance(2)) options.gravity = random.vector(10);
    if (random.chance(3)) options.drag = {.linear = 0.5, .quadratic = 0.05};
    World world(options);
    for (int k = 0; k < 343; ++k) {
        const int row = k / 7 % 7;
        const int layer = k / 49;
        const Vec3 lattice{k % 7 - 3.0, row - 3.0, layer - 3.0};
        world.add({.position = lattice + random.vector(0.3), .velocity = random.vector(3), .radius = 0.1});
    }
    if (random.chance(2)) {
        const std::array attractor{carom::Attractor{.strength = 60.0 * (1 + random.below(4)), .softening = 0.5}};
        world.set_attractors(attractor);
    }
    return world;
}

void push_some(World& world, unsigned seed) {
    Random random(seed);
    for (const BodyId id : world.ids()) {
        if (random.chance(24)) world.change_velocities({{id}}, {{random.vector(8)}});
    }
}

TEST(Solvers, IslandsDoAsTheReferenceWhereImpactsAreRareAndPathsBend) {
    std::size_t impacts = 0;
    for (unsigned seed = 0; seed < 60; ++seed) {
        Random random(seed);
        World reference = thin_world(seed);
        World islands = reference;
        reference.set_serial_reference(true);
        for (unsigned i = 0; i < 40; ++i) {
            const double dt = random.chance(8) ? 1.0 / 30 : 1.0 / 60;
            reference.step(dt);
            islands.step(dt);
            ASSERT_EQ(reference.hash(), islands.hash()) << "world " << seed << ", step " << i;
            impacts += islands.impacts().size();
            if (random.chance(4)) {
                push_some(reference, 100 * seed + i);
                push_some(islands, 100 * seed + i);
            }
        }
    }
    std::printf("figure: 60 thin worlds, %zu impacts: islands as the reference, bit for bit\n", impacts);
    EXPECT_GT(impacts, 2000U);
}

/// A slow body is struck, flies off, comes back from a static one to where it was when the step began, and meets on the
/// way a body that never came near that place.
TEST(Solvers, ABodyThatComesBackMeetsWhoCrossesItsWay) {
    World world({.region = carom::OpenSpace{}, .precision = carom::Precision::double_precision});
    const auto add = [&world](const Vec3& position, const Vec3& velocity, double mass = 1) {
        return world.add({.position = position, .velocity = velocity, .mass = mass});
    };
    const BodyId struck = add({0, 0, 0}, {});
    const BodyId crossing = add({5, -15, 0}, {0, 40, 0});
    add({-3, 0, 0}, {40, 0, 0});
    add({10, 0, 0}, {}, carom::infinite_mass);
    // Most are slow: the places that the step keeps for bodies are small.
    for (int k = 0; k < 400; ++k) {
        add({4.0 * (k % 20) - 40, 4.0 * (k / 20 % 20) - 40, 50}, {0.5, 0, 0.5});
    }
    World reference = world;
    reference.set_serial_reference(true);
    const double dt = 0.495;
    world.step(dt);
    reference.step(dt);
    EXPECT_EQ(world.report().windows, 1U);
    EXPECT_EQ(world.hash(), reference.hash());
    const auto impacts = world.impacts();
    EXPECT_TRUE(
        std::any_of(impacts.begin(), impacts.end(), [&](const Impact& i) { return i.a == struck && i.b == crossing; }));
}

TEST(Solvers, AnExecutorMayNotBeNull) {
    World world;
    EXPECT_THROW(world.set_executor(nullptr), carom::Error);
}

} // namespace
