// Grains that fall into a narrow box with rough walls. Friction keeps some of the forces of their landing, but no more
// than in grains that are elastic: LAMMPS (gran/hooke/history without rotation, k_t = 2/7 k_n, e = 0.3, mu = 0.5, other
// random places) finds that the floor of a box of four diameters bears 0.58 to 0.91 of the weight of 400 grains after a
// fall of their own height (six pours; k_n = 1e5 N/m), and 1.0 to 2.2 after one of 8 m (two pours; 1e5 and 1e6 N/m). In
// a box of eight diameters it bears 1.07 to 1.36 of the weight of 800 grains (six pours; 1e5 N/m).

#include <carom/carom.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <numbers>
#include <random>
#include <vector>

namespace {

using carom::Vec3;
using carom::World;

constexpr double g = 9.81;

struct Pour {
    std::size_t count = 400;
    double radius = 0.01; ///< m
    double side = 0.08;   ///< m, of the box
    double height = 1.1;  ///< m, in which they are
    double friction = 0.5;
};

/// Grains of glass at random places of a box, at rest.
World poured(const Pour& pour, unsigned seed) {
    const double r = pour.radius;
    World world({.gravity = {0, 0, -g}, .region = carom::Box{{0, 0, 0}, {pour.side, pour.side, 100}}});
    std::mt19937 engine(seed);
    const auto within = [&](double high) { return r + (high - 2 * r) * (static_cast<double>(engine()) / 0x1p32); };
    std::vector<Vec3> places;
    while (places.size() < pour.count) {
        const Vec3 x{within(pour.side), within(pour.side), within(pour.height)};
        const auto is_near = [&](const Vec3& y) { return length(y - x) < 2.0002 * r; };
        if (std::none_of(places.begin(), places.end(), is_near)) places.push_back(x);
    }
    const double mass = 2500 * 4 * std::numbers::pi / 3 * r * r * r;
    for (const Vec3& x : places) {
        world.add({.position = x, .mass = mass, .radius = r, .restitution = 0.3, .friction = pour.friction});
    }
    return world;
}

/// The part of the weight that the floor bears.
double borne(const World& world) {
    double force = 0;
    for (const carom::Contact& contact : world.contacts()) {
        if (contact.face == 4) force += contact.force;
    }
    return force / (g * static_cast<double>(world.size()) * world.get(world.ids()[0]).mass);
}

double mean_borne(const Pour& pour, unsigned pours, double seconds) {
    double sum = 0;
    for (unsigned seed = 0; seed < pours; ++seed) {
        World world = poured(pour, seed);
        while (world.time() < seconds) world.step(1.0 / 120);
        EXPECT_LT(world.energy().kinetic, 1e-6);
        sum += borne(world);
    }
    const double mean = sum / pours;
    std::printf("figure: the floor below %zu grains from up to %g m bears %.3f of their weight\n", pour.count,
                pour.height, mean);
    return mean;
}

TEST(Column, KeepsNoMoreOfItsLandingThanElasticGrains) {
    EXPECT_LT(mean_borne({}, 6, 1.5), 1);
    EXPECT_LT(mean_borne({.height = 8}, 2, 3), 3);
    // Friction that does not stretch keeps 1.43.
    EXPECT_LT(mean_borne({.count = 800, .side = 0.16, .height = 0.55}, 6, 1.5), 1.36);
}

/// What falls a short way at a time is borne by the walls: Janssen's law, and LAMMPS', is 0.3 to 0.5.
TEST(Column, WallsBearWhatIsPouredBitByBit) {
    const Pour layer{.count = 8, .height = 0.06};
    World world = poured(layer, 1);
    const carom::Body grain = world.get(world.ids()[0]);
    for (unsigned seed = 2; seed < 50; ++seed) {
        for (int k = 0; k < 12; ++k) world.step(1.0 / 120);
        double top = 0;
        for (const carom::BodyId id : world.ids()) top = std::max(top, world.get(id).position.z);
        const World next = poured(layer, seed);
        for (const carom::BodyId id : next.ids()) {
            carom::Body body = grain;
            body.velocity = {};
            body.position = next.get(id).position + Vec3{0, 0, top + 0.02};
            world.add(body);
        }
    }
    for (int k = 0; k < 240; ++k) world.step(1.0 / 120);
    EXPECT_NEAR(borne(world), 0.4, 0.1);
}

/// Contacts that get stiffer for a load keep what they gave way to: a state of its own.
TEST(Column, GoesOnFromASnapshotWhileContactsGetStiffer) {
    World world = poured({.count = 200, .height = 2}, 1);
    World loaded(world);
    std::uint32_t most = 0;
    for (int k = 0; k < 120; ++k) {
        world.step(1.0 / 120);
        loaded.step(1.0 / 120);
        loaded = World::load(loaded.save());
        ASSERT_EQ(loaded.hash(), world.hash()) << k;
        most = std::max(most, world.report().pieces);
    }
    EXPECT_GT(most, 4U); // 480 pieces a second, and more
}

/// As games do it: no two steps are of the same length.
TEST(Column, ComesToRestInStepsOfAnyLength) {
    World world = poured({.count = 300, .radius = 0.125, .side = 2, .height = 6}, 3);
    std::mt19937 engine(1);
    while (world.time() < 8) world.step(1.0 / 60 * (0.5 + static_cast<double>(engine()) / 0x1p32));
    EXPECT_GT(world.report().asleep, 290U);
    EXPECT_LT(world.energy().kinetic, 1e-12);
}

/// Neither a body that a pile let go, and that lies on the floor beside it, keeps it awake, nor bodies that come to
/// lean on each other in turn, each let go as the others do.
TEST(Column, HeapsFallAsleep) {
    for (const double friction : {0.3, 0.5}) {
        for (unsigned seed = 0; seed < 30; ++seed) {
            World world = poured({.count = 80, .radius = 0.5, .side = 6, .height = 30, .friction = friction}, seed);
            while (world.time() < 12) world.step(1.0 / 60);
            EXPECT_GT(world.report().asleep, 0U) << friction << ' ' << seed;
        }
    }
}

/// On a plate a body is carried as in a pile. What friction takes of it stands in the books as friction's: but for the
/// first piece of 1/480 s.
TEST(Column, FrictionTakesWhatSlides) {
    const carom::Mesh plate{.vertices = {{-5, -5, 0}, {15, -5, 0}, {0, 19, 0}}, .triangles = {{0, 1, 2}}};
    World world({.gravity = {0, 0, -g}, .obstacles = {plate}});
    const carom::BodyId id = world.add({.position = {0, 0, 0.5}, .restitution = 0.2, .friction = 0.3});
    for (int k = 0; k < 60; ++k) world.step(1.0 / 60);
    world.set({{id}}, {.velocity = {{Vec3{1, 0, 0}}}});
    const double before = world.ledger().lost_to_friction;
    for (int k = 0; k < 60; ++k) world.step(1.0 / 60);
    EXPECT_EQ(world.get(id).velocity, Vec3{});
    EXPECT_NEAR(world.ledger().lost_to_friction - before, 0.5, 1.01 * 0.3 * g / 480);
}

} // namespace
