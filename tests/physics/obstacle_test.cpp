// Obstacles: impacts and contacts with frustums and meshes.

#include "physics/lattice.hpp"

#include <carom/carom.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <string>
#include <vector>

namespace {

using carom::Body;
using carom::BodyId;
using carom::Contact;
using carom::Frustum;
using carom::Mesh;
using carom::Vec3;
using carom::World;
using carom::WorldOptions;
using carom::test::lattice;

constexpr double g = 9.81;
constexpr double dt = 1.0 / 60;

/// A sphere of triangles around the origin: an octahedron whose faces are halved `times` times.
Mesh sphere(double radius, int times) {
    Mesh mesh;
    mesh.vertices = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    mesh.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
    for (int k = 0; k < times; ++k) {
        std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> middles;
        const auto middle = [&](std::uint32_t a, std::uint32_t b) {
            const auto [place, is_new] =
                middles.emplace(std::minmax(a, b), static_cast<std::uint32_t>(mesh.vertices.size()));
            if (is_new) {
                const Vec3 sum = mesh.vertices[a] + mesh.vertices[b];
                mesh.vertices.push_back(sum / length(sum));
            }
            return place->second;
        };
        std::vector<std::array<std::uint32_t, 3>> finer;
        for (const auto& [a, b, c] : mesh.triangles) {
            const std::uint32_t ab = middle(a, b);
            const std::uint32_t bc = middle(b, c);
            const std::uint32_t ca = middle(c, a);
            finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
        }
        mesh.triangles = finer;
    }
    for (Vec3& v : mesh.vertices) v = v * radius;
    return mesh;
}

/// A square floor of 2 n^2 triangles at height 0, from -half to +half; heights by a function of x and y.
template <class Height>
Mesh terrain(double half, std::uint32_t n, Height height) {
    Mesh mesh;
    for (std::uint32_t j = 0; j <= n; ++j) {
        for (std::uint32_t i = 0; i <= n; ++i) {
            const double x = half * (2.0 * i / n - 1);
            const double y = half * (2.0 * j / n - 1);
            mesh.vertices.push_back({x, y, height(x, y)});
        }
    }
    const auto at = [n](std::uint32_t i, std::uint32_t j) { return j * (n + 1) + i; };
    for (std::uint32_t j = 0; j < n; ++j) {
        for (std::uint32_t i = 0; i < n; ++i) {
            mesh.triangles.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return mesh;
}
Mesh floor_of(double half, std::uint32_t n) {
    return terrain(half, n, [](double, double) { return 0.0; });
}

/// Uniform numbers and directions from a fixed seed.
class Random {
public:
    explicit Random(unsigned seed) : engine_(seed) {}
    double between(double low, double high) { return low + (high - low) * unit_(engine_); }
    std::size_t below(std::size_t end) { return engine_() % end; }
    Vec3 vector(double size) {
        const double x = between(-size, size);
        const double y = between(-size, size);
        return {x, y, between(-size, size)};
    }
    Vec3 direction() {
        for (;;) {
            const Vec3 v = vector(1);
            if (length(v) > 0.1 && length(v) < 1) return v / length(v);
        }
    }

private:
    std::mt19937 engine_;
    std::uniform_real_distribution<double> unit_{0, 1};
};

void run(World& world, double seconds, double step = dt) {
    const double end = world.time() + seconds;
    while (world.time() < end - step / 2) world.step(step);
}

/// What keeps bodies in: obstacles around the origin, and how far out one may be.
struct Prison {
    std::vector<carom::Obstacle> walls;
    double inner; ///< m, a ball around the origin inside
    std::function<bool(const Vec3&)> holds;
};

Prison mesh_prison() {
    return {{sphere(2, 1)}, 1.3, [](const Vec3& x) { return length(x) < 2; }};
}

/// A cylinder with two lids.
Prison drum_prison() {
    return {{Frustum{.base = {0, 0, -1.5}, .height = 3, .base_radius = 2, .top_radius = 2},
             Frustum{.base = {0, 0, -1.5}, .height = 0, .base_radius = 2, .top_radius = 0},
             Frustum{.base = {0, 0, 1.5}, .height = 0, .base_radius = 0, .top_radius = 2}},
            1.5,
            [](const Vec3& x) { return std::hypot(x.x, x.y) < 2 && std::abs(x.z) < 1.5; }};
}

/// Two cones, mouth to mouth, between which nothing is left open.
Prison cone_prison() {
    return {{Frustum{.base = {0, 0, -2}, .height = 2, .base_radius = 0, .top_radius = 2},
             Frustum{.base = {0, 0, 0}, .height = 2, .base_radius = 2, .top_radius = 0}},
            1.4,
            [](const Vec3& x) { return std::hypot(x.x, x.y) + std::abs(x.z) < 2; }};
}

// ---------------------------------------------------------------------------------------------------------------------
// Impacts
// ---------------------------------------------------------------------------------------------------------------------

/// Shoots bodies of any size, at 1 to 10^6 m/s, from inside at points of a closed surface.
template <class Aim>
void shoot_out_of(const Prison& prison, double gravity, unsigned shots, Aim aim) {
    Random random(7);
    for (unsigned k = 0; k < shots; ++k) {
        const double radius = k % 4 == 0 ? 0 : std::pow(10, random.between(-6, -0.5));
        const Vec3 start = random.direction() * random.between(0, prison.inner - 1.01 * radius);
        const double speed = std::pow(10, random.between(0, 6));
        const double e = k % 3 == 0 ? 1 : random.between(0, 1);
        World world({.gravity = {0, 0, -gravity},
                     .obstacles = prison.walls,
                     .precision = k % 2 == 0 ? carom::Precision::double_precision : carom::Precision::single_precision,
                     .work_cap = 2000});
        const Vec3 way = aim(random) - start;
        const BodyId id =
            world.add({.position = start, .velocity = way * (speed / length(way)), .radius = radius, .restitution = e});
        for (int step = 0; step < 3; ++step) {
            // As far as some twenty impacts take it.
            world.step(std::min(20 * prison.inner / speed, gravity > 0 ? 0.05 : 26));
            ASSERT_TRUE(prison.holds(world.get(id).position))
                << "shot " << k << ", radius " << radius << ", speed " << speed << ", e " << e << ", step " << step;
        }
        // Under gravity the slow ones have not come there yet.
        ASSERT_TRUE(world.ledger().face_impacts > 0 || gravity > 0) << k;
    }
}

TEST(Obstacles, NothingTunnelsThroughAnEdgeOrACornerOfAMesh) {
    const Mesh mesh = sphere(2, 1);
    const auto aim = [&mesh](Random& random) {
        const auto& [a, b, c] = mesh.triangles[random.below(mesh.triangles.size())];
        const std::array places{0.0, 0.5, random.between(0, 1)};
        const double place = places[random.below(3)];
        if (random.below(4) == 0) return (mesh.vertices[a] + mesh.vertices[b] + mesh.vertices[c]) / 3;
        return mesh.vertices[a] + (mesh.vertices[b] - mesh.vertices[a]) * place;
    };
    shoot_out_of(mesh_prison(), 0, 10000, aim);
    shoot_out_of(mesh_prison(), g, 1000, aim);
}

TEST(Obstacles, NothingTunnelsWhereFrustumsMeet) {
    const auto aim_at_seam = [](double radius, double height) {
        return [radius, height](Random& random) {
            if (random.below(4) == 0) return Vec3{0, 0, height};
            const double angle = random.between(0, 2 * std::numbers::pi);
            return Vec3{radius * std::cos(angle), radius * std::sin(angle), height};
        };
    };
    constexpr unsigned shots = 100;
    shoot_out_of(drum_prison(), 0, shots, aim_at_seam(2, 1.5));
    shoot_out_of(drum_prison(), 0, shots, aim_at_seam(2, 0.3));
    shoot_out_of(cone_prison(), 0, shots, aim_at_seam(2, 0));
    shoot_out_of(cone_prison(), 0, shots, aim_at_seam(0, 2));
}

TEST(Obstacles, GasStaysInsideAndKeepsItsEnergy) {
    for (const Prison& prison :
         {Prison{{sphere(2, 2)}, 1.8, [](const Vec3& x) { return length(x) < 2; }}, drum_prison(), cone_prison()}) {
        World world({.obstacles = prison.walls});
        Random random(1);
        for (int added = 0; added < 100;) {
            const Vec3 place = random.vector(prison.inner / std::sqrt(3.0) - 0.06);
            const std::vector<BodyId> ids = world.ids();
            const bool is_taken = std::any_of(ids.begin(), ids.end(),
                                              [&](BodyId id) { return length(world.get(id).position - place) < 0.13; });
            if (is_taken) continue;
            world.add({.position = place, .velocity = random.vector(3), .radius = 0.06});
            ++added;
        }
        const double before = world.energy().kinetic;
        run(world, 20);
        EXPECT_GT(world.ledger().face_impacts, 1500U);
        EXPECT_NEAR(world.energy().kinetic / before, 1, 1e-12);
        for (const BodyId id : world.ids()) EXPECT_TRUE(prison.holds(world.get(id).position));
    }
}

// In a cylinder without gravity a ball is a billiard in a circle: each chord has the same length, so the impacts come
// at equal times, at the same approach speed, and turn round the axis by the same angle.
TEST(Obstacles, ABallInACylinderIsABilliardInACircle) {
    const double room = 2 - 0.25;
    // Roundings of positions add up along the way.
    World world({.obstacles = {Frustum{.base = {0, 0, -50}, .height = 100, .base_radius = 2, .top_radius = 2}},
                 .resolution = std::ldexp(1.0, -50)});
    world.add({.position = {room * 0.5, 0, 0}, .velocity = {0, 3, 0.5}, .radius = 0.25});
    const double half_chord = room * std::sqrt(0.75);
    std::vector<carom::Impact> impacts;
    for (int k = 0; k < 600; ++k) {
        world.step(dt);
        impacts.insert(impacts.end(), world.impacts().begin(), world.impacts().end());
    }
    ASSERT_GT(impacts.size(), 9U);
    for (std::size_t k = 0; k < impacts.size(); ++k) {
        const auto n = static_cast<double>(k);
        EXPECT_NEAR(impacts[k].time, (2 * n + 1) * half_chord / 3, 1e-10);
        EXPECT_NEAR(impacts[k].approach_speed, 3 * half_chord / room, 1e-11);
        const double angle = std::numbers::pi / 3 + n * 2 * std::numbers::pi / 3;
        EXPECT_NEAR(impacts[k].normal.x, std::cos(angle), 1e-10);
        EXPECT_NEAR(impacts[k].normal.y, std::sin(angle), 1e-10);
        EXPECT_EQ(impacts[k].face, 0);
    }
}

TEST(Obstacles, FacesAreCountedOnFromThoseOfTheRegion) {
    const Frustum table{.base = {5, 5, 2}, .height = 0, .base_radius = 0, .top_radius = 1};
    const auto face_hit = [](const WorldOptions& options) {
        World world(options);
        world.add({.position = {5, 5, 3}, .velocity = {0, 0, -10}, .radius = 0.25});
        world.step(0.1);
        return world.impacts().size() == 1 ? world.impacts()[0].face : -2;
    };
    EXPECT_EQ(face_hit({.obstacles = {table}}), 0);
    EXPECT_EQ(face_hit({.region = carom::Box{{}, {10, 10, 10}}, .obstacles = {sphere(1, 0), table}}), 7);
    EXPECT_EQ(face_hit({.region = std::vector<carom::Plane>(3), .obstacles = {table}}), 3);
    EXPECT_EQ(face_hit({.region = carom::Shell{.radius = 100}, .obstacles = {table}}), 1);
}

// ---------------------------------------------------------------------------------------------------------------------
// Contacts
// ---------------------------------------------------------------------------------------------------------------------

// The contact gives way by g / w^2, with w a quarter of the rate of the pieces: 1.7e-5 m at 480 a second.
constexpr double give = 2e-5;

TEST(Obstacles, ABallSlidesOverTheInnerEdgesOfAFloor) {
    for (const double speed : {1e-3, 1.0, 30.0}) {
        World world({.gravity = {0, 0, -g}, .obstacles = {floor_of(40, 37)}});
        const Vec3 start{speed * 0.8, speed * 0.6, 0};
        const BodyId id =
            world.add({.position = {-15.1, 0.3, 0.5}, .velocity = start, .radius = 0.5, .restitution = 0.5});
        for (int k = 0; k < 60; ++k) {
            world.step(dt);
            const Body ball = world.get(id);
            EXPECT_NEAR(ball.velocity.x, start.x, 1e-6 * speed);
            EXPECT_NEAR(ball.velocity.y, start.y, 1e-6 * speed);
            EXPECT_NEAR(ball.position.z, 0.5, 5 * give) << "at " << speed << " m/s";
            EXPECT_EQ(world.report().face_impacts, 0U) << "at " << speed << " m/s, step " << k;
        }
    }
}

TEST(Obstacles, BouncesOffAFlatMeshLikeOffAPlane) {
    const Body ball{.position = {0.31, 0.17, 2}, .velocity = {0.7, -0.4, 0}, .radius = 0.5, .restitution = 0.9};
    World meshed({.gravity = {0, 0, -g}, .obstacles = {floor_of(8, 13)}});
    World flat({.gravity = {0, 0, -g}, .region = std::vector<carom::Plane>(1)});
    const BodyId a = meshed.add(ball);
    const BodyId b = flat.add(ball);
    for (int k = 0; k < 240; ++k) {
        meshed.step(dt);
        flat.step(dt);
        EXPECT_LT(length(meshed.get(a).position - flat.get(b).position), 1e-10) << k;
    }
    EXPECT_GT(meshed.ledger().face_impacts, 4U);
}

/// N, with which bodies press on a face of the API.
Vec3 force_on(const World& world, std::int32_t face) {
    Vec3 sum{};
    for (const Contact& c : world.contacts()) {
        if (c.face == face) sum += c.normal * c.force + c.friction;
    }
    return sum;
}

void expect_at_rest(const World& world, double weight, const std::string& where) {
    for (const BodyId id : world.ids()) {
        EXPECT_TRUE(world.held(id)) << where;
        EXPECT_LT(length(world.get(id).velocity), 1e-3) << where;
    }
    EXPECT_LT(length(force_on(world, 0) - Vec3{0, 0, -weight}), 1e-3 * weight) << where;
    double along_normals = 0;
    for (const Contact& c : world.contacts()) along_normals += c.face == 0 ? c.force : 0;
    EXPECT_NEAR(world.face_forces().at(0), along_normals, 1e-12 * weight) << where;
}

TEST(Obstacles, BallsComeToRestOnThemAndAreCarried) {
    const auto rest = [](const carom::Obstacle& obstacle, const std::vector<Vec3>& places, const std::string& where) {
        World world({.gravity = {0, 0, -g}, .obstacles = {obstacle}});
        double weight = 0;
        for (const Vec3& place : places) {
            world.add({.position = place, .mass = 2, .radius = 0.25, .restitution = 0.4, .friction = 0.5});
            weight += 2 * g;
        }
        run(world, 15);
        expect_at_rest(world, weight, where);
        return world;
    };
    const Frustum funnel{.height = 4, .base_radius = 0, .top_radius = 4};
    const World tip = rest(funnel, {{0.01, 0.003, 3}}, "in the tip of a cone");
    // It touches all round: its centre is r sqrt(2) above the tip.
    EXPECT_NEAR(tip.get(tip.ids()[0]).position.z, 0.25 * std::sqrt(2.0), 2 * give);
    std::vector<Vec3> many(60);
    for (std::size_t k = 0; k < many.size(); ++k) many[k] = lattice(k, 3) * 0.6 + Vec3{-0.6, -0.61, 3};
    rest(funnel, many, "sixty in a cone");
    const Frustum trough{.base = {-4, 0, 0}, .axis = {1, 0, 0}, .height = 8, .base_radius = 1, .top_radius = 1};
    rest(trough, {{0, 0.3, 0}, {1, -0.2, 0}, {-2, 0, 0.1}}, "in a lying cylinder");
    rest(Frustum{.base = {0, 0, 1}, .height = 0, .base_radius = 0.2, .top_radius = 3}, {{0.01, 0, 2}},
         "in the hole of a ring");
    rest(Frustum{.height = 3, .base_radius = 0.1, .top_radius = 0.1}, {{0.01, 0.01, 4}}, "on a pipe");
    rest(terrain(4, 9, [](double x, double y) { return 0.3 * std::abs(x) + 0.2 * std::abs(y); }),
         {{0.5, 0.7, 2}, {-0.6, 0.2, 2}}, "in a valley of a mesh");
    rest(floor_of(3, 5), many, "sixty on a mesh");
}

// Inelastic ones, and friction, take their energy: bounces that get lower without end must not get more without end,
// nor those of what is squeezed between spheres, walls and others.
TEST(Obstacles, ElasticBallsAmongOthersHaveNoImpactsWithoutEnd) {
    constexpr std::uint64_t cap = 200000; // a jam takes 10 000 impacts
    for (unsigned seed = 0; seed < 16; ++seed) {
        Random random(seed);
        const auto precision = seed % 2 == 0 ? carom::Precision::single_precision : carom::Precision::double_precision;
        WorldOptions options{.gravity = {0, 0, -g},
                             .region = carom::Box{.min = {-3, -3, -1}, .max = {3, 3, 8}},
                             .precision = precision,
                             .work_cap = cap};
        const bool has_ground = seed % 4 < 2;
        if (has_ground) options.obstacles = {terrain(3, 6, [&](double, double) { return random.between(-0.5, 0.5); })};
        World world(options);
        const auto surface = [&](bool is_elastic) {
            return Body{.restitution = is_elastic ? 1 : random.between(0, 0.9),
                        .friction = random.below(2) == 0 ? 0 : random.between(0, 0.5)};
        };
        for (std::size_t k = 0; k < 9 && !has_ground; ++k) {
            Body sphere = surface(k % 2 == 0);
            sphere.position = 2 * lattice(k, 3) - Vec3{2, 2, 0};
            sphere.mass = carom::infinite_mass;
            sphere.radius = 0.9;
            world.add(sphere);
        }
        for (std::size_t k = 0; k < 48; ++k) {
            Body ball = surface(k % 3 == 0);
            ball.position = lattice(k, 4) + Vec3{-1.5, -1.5, 2.2} + random.vector(0.1);
            ball.velocity = random.vector(2);
            ball.radius = random.between(0.1, 0.25);
            world.add(ball, carom::Overlap::accept);
        }
        for (int step = 0; step < 1200; ++step) {
            ASSERT_FALSE(world.step(dt).work_cap_reached) << "seed " << seed << ", step " << step;
        }
    }
}

// Coulomb: what lies on a slope of 20 degrees stays there if mu > tan 20, and slides with g (sin - mu cos) if less.
TEST(Obstacles, FrictionHoldsOnASlopeOfAMesh) {
    const double slope = std::tan(20 * std::numbers::pi / 180);
    const Mesh mesh = terrain(40, 21, [slope](double x, double) { return slope * x; });
    const Vec3 normal = Vec3{-slope, 0, 1} / std::hypot(slope, 1);
    for (const double part : {0.99, 1.01}) {
        World world({.gravity = {0, 0, -g}, .obstacles = {mesh}});
        const BodyId id =
            world.add({.position = normal * 0.5, .radius = 0.5, .restitution = 0.2, .friction = part * slope});
        run(world, 4);
        const double pull = g * std::sin(std::atan(slope));
        const double expected = part < 1 ? (1 - part) * pull * 4 : 0;
        // It begins on the seam of two triangles. Where the second takes it over from the first, friction is not
        // stretched yet: what pulls it in that piece stays if it slides.
        const double taken_over = part < 1 ? pull / 480 : 0;
        EXPECT_NEAR(length(world.get(id).velocity), expected, 0.01 * expected + taken_over + 1e-6) << part;
    }
}

// On a curved surface the normal turns by v h / R in a piece of h = 1/480 s. Forces a whole such turn off would brake
// by g h / R, to 0.66 of the height in 30 s; half a turn off, to 0.81. What is left is a small part of that.
TEST(Obstacles, ABallSwingsInACylinder) {
    World world({.gravity = {0, 0, -g},
                 .obstacles = {
                     Frustum{.base = {-4, 0, 0}, .axis = {1, 0, 0}, .height = 8, .base_radius = 2, .top_radius = 2}}});
    const BodyId id =
        world.add({.position = {0, 1.5 * std::sin(0.5), -1.5 * std::cos(0.5)}, .radius = 0.5, .restitution = 0.5});
    double highest = -2;
    run(world, 30);
    for (int k = 0; k < 300; ++k) {
        world.step(dt);
        highest = std::max(highest, world.get(id).position.z);
    }
    std::printf("figure: after 30 s of swinging 1 - cos(angle) is %.4f of what it was\n",
                (highest + 1.5) / (1.5 * (1 - std::cos(0.5))));
    EXPECT_NEAR((highest + 1.5) / (1.5 * (1 - std::cos(0.5))), 1, 0.01);
}

// A ball that slides down the outside of a cylinder leaves it where cos(angle) is 2/3 of that at which it began. It may
// be held on for a piece of h = 1/480 s longer, or less, in which its speed changes by g h.
TEST(Obstacles, ABallLeavesACylinderWhereItShould) {
    constexpr double reach = 2.5;
    for (const double start : {0.05, 0.5}) {
        World world({.gravity = {0, 0, -g},
                     .obstacles = {Frustum{
                         .base = {-4, 0, 0}, .axis = {1, 0, 0}, .height = 8, .base_radius = 2, .top_radius = 2}}});
        const BodyId id = world.add(
            {.position = {0, reach * std::sin(start), reach * std::cos(start)}, .radius = 0.5, .restitution = 0.5});
        for (int k = 0; k < 600 && world.get(id).position.z > 0.5; ++k) world.step(dt);
        const double leaves = 2.0 / 3 * std::cos(start);
        const double speed = std::sqrt(2 * g * reach * (std::cos(start) - leaves));
        EXPECT_NEAR(world.get(id).velocity.y, speed * leaves, g / 480) << start;
    }
}

TEST(Obstacles, BodiesRunOutOfAHopper) {
    World world({.gravity = {0, 0, -g},
                 .region = std::vector<carom::Plane>{{.point = {0, 0, -2}, .surface = {.restitution = 0}}},
                 .obstacles = {Frustum{.height = 2, .base_radius = 0.5, .top_radius = 2.5}}});
    for (std::size_t k = 0; k < 150; ++k) {
        world.add({.position = lattice(k, 5) * 0.3 + Vec3{-0.6, -0.61, 1.4}, .radius = 0.1, .restitution = 0.3});
    }
    run(world, 12);
    for (const BodyId id : world.ids()) EXPECT_LT(world.get(id).position.z, 0);
}

// ---------------------------------------------------------------------------------------------------------------------
// The same bits, snapshots, bad input
// ---------------------------------------------------------------------------------------------------------------------

/// Balls fall into a funnel over a terrain, in a box. The funnel turns (rad/s).
World busy_world(WorldOptions options, double turning = 0) {
    options.gravity = {0, 0, -g};
    options.region = carom::Box{{-3, -3, -1}, {3, 3, 6}};
    options.obstacles = {
        Frustum{.base = {0, 0, 1.5}, .height = 1.5, .base_radius = 0.3, .top_radius = 2, .angular_velocity = turning},
        terrain(3, 7, [](double x, double y) { return 0.3 * std::sin(2 * x) * std::cos(3 * y); })};
    World world(options);
    Random random(3);
    for (std::size_t k = 0; k < 120; ++k) {
        world.add({.position = lattice(k, 5) * 0.4 + Vec3{-0.8, -0.8, 3} + random.vector(0.03),
                   .velocity = random.vector(k % 10 == 0 ? 30 : 1),
                   .radius = random.between(0.08, 0.16),
                   .restitution = k % 7 == 0 ? 1 : 0.5,
                   .friction = 0.3});
    }
    return world;
}

TEST(Obstacles, NoResultDependsOnSolverThreadsOrWindows) {
    for (const carom::Precision precision : {carom::Precision::single_precision, carom::Precision::double_precision}) {
        const double turning = precision == carom::Precision::single_precision ? 0 : 3;
        World islands = busy_world({.precision = precision, .threads = 1}, turning);
        World serial = busy_world({.precision = precision, .serial_reference = true}, turning);
        World windows = busy_world({.precision = precision, .min_windows = 7, .threads = 3}, turning);
        for (int k = 0; k < 240; ++k) {
            for (World* world : {&islands, &serial, &windows}) world->step(dt);
            ASSERT_EQ(islands.hash(), serial.hash()) << "step " << k;
            ASSERT_EQ(islands.hash(), windows.hash()) << "step " << k;
        }
        EXPECT_GT(islands.report().held, 20U);
    }
}

TEST(Obstacles, SnapshotsKeepThem) {
    World world = busy_world({}, 3);
    run(world, 2);
    World again = World::load(world.save());
    EXPECT_EQ(again.options().obstacles.size(), 2U);
    EXPECT_EQ(again.hash(), world.hash());
    EXPECT_EQ(again.save(), world.save());
    World copy = world;
    for (World* w : {&world, &again, &copy}) run(*w, 1);
    EXPECT_EQ(again.hash(), world.hash());
    EXPECT_EQ(copy.hash(), world.hash());
}

void expect_refused(const WorldOptions& options, const std::string& message) {
    try {
        const World world(options);
        ADD_FAILURE() << "not refused: " << message;
    } catch (const carom::Error& error) {
        EXPECT_EQ(error.what(), message);
    }
}

TEST(Obstacles, BadOnesAreRefused) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const Mesh good = floor_of(1, 1);
    const auto with = [](const carom::Obstacle& bad) { return WorldOptions{.obstacles = {Frustum{}, bad}}; };
    expect_refused(with(Frustum{.angular_velocity = nan}), "obstacles[1].angular_velocity: must be finite, got nan");
    Mesh mesh = good;
    mesh.triangles[1] = {0, 1, 4};
    expect_refused(with(mesh), "obstacles[1].triangles[1]: must be indices of the 4 vertices, got 4");
    mesh.triangles[1] = {0, 1, 0};
    expect_refused(with(mesh), "obstacles[1].triangles[1]: must have corners that are not in one line");
    mesh.triangles.clear();
    expect_refused(with(mesh), "obstacles[1].triangles: must not be empty");
    mesh = good;
    mesh.vertices[2].y = nan;
    expect_refused(with(mesh), "obstacles[1].vertices[2]: must be finite, got nan");
    mesh = good;
    mesh.surface.restitution = 2;
    expect_refused(with(mesh), "obstacles[1].surface.restitution: must lie in [0, 1], got 2");
    expect_refused(with(Frustum{.base_radius = -1}), "obstacles[1].base_radius: must be >= 0, got -1");
    expect_refused(with(Frustum{.top_radius = nan}), "obstacles[1].top_radius: must be finite, got nan");
    expect_refused(with(Frustum{.height = -1}), "obstacles[1].height: must be >= 0, got -1");
    expect_refused(with(Frustum{.axis = {}}), "obstacles[1].axis: must not be zero");
    expect_refused(with(Frustum{.height = 0}), "obstacles[1].height: must be > 0 where the two radii are the same");
    expect_refused(with(Frustum{.base_radius = 0, .top_radius = 0}),
                   "obstacles[1].base_radius: must be > 0, or top_radius must be");
    carom::Box box{{}, {9, 9, 9}};
    box.faces[0].kind = box.faces[1].kind = carom::FaceKind::periodic;
    expect_refused({.region = box, .obstacles = {good}}, "obstacles: must not stand in a region with periodic faces");
    try {
        const World world(with(Frustum{.base = {1e9, 0, 0}}));
        ADD_FAILURE();
    } catch (const carom::Error& error) {
        EXPECT_EQ(error.code(), carom::ErrorCode::out_of_world);
        EXPECT_TRUE(error.field().starts_with("obstacles[1]"));
    }
}

TEST(Obstacles, BodiesMustNotBeginInThem) {
    World world({.obstacles = {Frustum{}, floor_of(4, 3)}});
    try {
        world.add({.position = {2, 2, 0.25}, .radius = 0.5});
        ADD_FAILURE();
    } catch (const carom::Error& error) {
        EXPECT_STREQ(error.what(), "position[0]: reaches 0.25 m into obstacle 1");
    }
    EXPECT_EQ(world.size(), 0U);
    world.add({.position = {2, 2, 0.5}, .radius = 0.5});
    world.add({.position = {-2, 2, -0.5}, .radius = 0.5});
    world.add({.position = {0, 0, 0.3}, .radius = 0.3});
    EXPECT_EQ(world.size(), 3U);
}

} // namespace
