// Observers of worlds whose every number is known beforehand.

#include "scene/random.hpp"

#include <carom/observers.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

namespace carom {
namespace {

Box cube(double side, FaceKind kind) {
    Box box{.min = {0, 0, 0}, .max = {side, side, side}};
    for (Face& face : box.faces) face.kind = kind;
    return box;
}

Sample sample_of(const World& world) {
    Sample sample;
    sample.read(world);
    return sample;
}

TEST(Observers, SampleFollowsBodiesThatComeAndGo) {
    World world;
    const BodyId first = world.add({.position = {1, 0, 0}, .mass = 2});
    const BodyId second = world.add({.position = {5, 0, 0}, .radius = 0.25});
    Sample sample = sample_of(world);
    EXPECT_EQ(sample.position.size(), 2U);
    EXPECT_EQ(sample.mass[0], 2);
    EXPECT_FALSE(sample.box);
    world.remove(first);
    world.add({.position = {9, 0, 0}, .radius = 0.125});
    sample.read(world);
    ASSERT_EQ(sample.radius.size(), 2U);
    world.remove(second);
    sample.read(world);
    ASSERT_EQ(sample.position.size(), 1U);
    EXPECT_EQ(sample.position[0].x, 9);
}

// Two unit masses meet head-on at 1 m/s each: an impulse of 2 N s at a contact distance of 1 m.
TEST(Observers, PressureIsTheVirialOfImpacts) {
    World world({.region = cube(10, FaceKind::periodic)});
    world.add({.position = {4, 5, 5}, .velocity = {1, 0, 0}});
    world.add({.position = {6, 5, 5}, .velocity = {-1, 0, 0}});
    ImpactStatistics impacts(world);
    world.step(2);
    impacts.observe(world);
    EXPECT_EQ(impacts.count(), 1U);
    EXPECT_DOUBLE_EQ(impacts.duration(), 2);
    EXPECT_DOUBLE_EQ(impacts.collision_rate().value, 0.5);
    EXPECT_NEAR(impacts.virial_rate(0).value, 1, 1e-12);
    EXPECT_NEAR(impacts.virial_rate(1).value, 0, 1e-12);
    EXPECT_NEAR(impacts.pressure().value, (2 * 1.0 + 1) / 3000, 1e-15);
}

// A ball of radius 0.5 m goes to and fro in a box of 10 m at 3 m/s: 6 N s every 6 s on either wall.
TEST(Observers, WallsBearTheMomentumLeftThere) {
    World world({.region = cube(10, FaceKind::reflecting)});
    world.add({.position = {5, 5, 5}, .velocity = {3, 0, 0}});
    ImpactStatistics impacts(world);
    for (int i = 0; i < 60; ++i) {
        world.step(0.5);
        impacts.observe(world);
    }
    EXPECT_NEAR(impacts.face_force(0).value, 1, 1e-9);
    EXPECT_NEAR(impacts.face_force(1).value, 1, 1e-9);
    EXPECT_EQ(impacts.face_force(2).value, 0);
}

// Obstacles are counted on from the faces: a ball of 2 kg that turns at 3 m/s on a disc leaves 12 N s there.
TEST(Observers, ObstaclesBearTheMomentumLeftThere) {
    World world({.region = cube(10, FaceKind::reflecting),
                 .obstacles = {Frustum{.base = {5, 5, 2}, .height = 0, .base_radius = 2, .top_radius = 0}}});
    world.add({.position = {5, 5, 4}, .velocity = {0, 0, -3}, .mass = 2});
    ImpactStatistics impacts(world);
    ASSERT_EQ(impacts.faces(), 7U);
    world.step(1);
    impacts.observe(world);
    EXPECT_NEAR(impacts.face_force(6).value, 12, 1e-9);
    EXPECT_EQ(impacts.face_force(4).value, 0);
}

/// 60 balls of 2 kg that fall into a box of smooth walls, and stay.
World falling_balls(bool serial) {
    World world({.gravity = {0, 0, -9.81}, .region = Box{{0, 0, 0}, {4, 4, 30}}, .serial_reference = serial});
    for (int k = 0; k < 60; ++k) {
        const int row = k / 3 % 3;
        const int layer = k / 9;
        world.add({.position = {0.7 + 1.2 * (k % 3), 0.7 + 1.2 * row + 0.02 * (k % 5), 0.7 + 1.2 * layer},
                   .mass = 2,
                   .restitution = 0.5});
    }
    return world;
}

// Neither at the start nor at the end do they move: the floor has given, all in all, the momentum that gravity took.
TEST(Observers, AFloorWeighsWhatFallsOnItAndLies) {
    constexpr double weight = 60 * 2 * 9.81;
    const auto run = [](World& world, ImpactStatistics& impacts, double until) {
        while (world.time() < until) {
            world.step(1.0 / 60);
            impacts.observe(world);
        }
        return impacts.face_force(4);
    };
    std::vector<Estimate> found;
    for (const bool serial : {false, true}) {
        World world = falling_balls(serial);
        ImpactStatistics landing(world);
        found.push_back(run(world, landing, 6));
        EXPECT_GT(world.report().contacts, 100U);
        EXPECT_NEAR(found.back().value, weight, 3 * found.back().standard_error);
        EXPECT_LT(found.back().standard_error, 0.06 * weight);
        World loaded = World::load(world.save());
        for (World* resumed : {&world, &loaded}) {
            ImpactStatistics lying(*resumed);
            found.push_back(run(*resumed, lying, 8));
            // They still creep, at less than 1e-3 m/s: that is the change of momentum of 2 s.
            EXPECT_NEAR(found.back().value, weight, 60 * 2 * 1e-3 / 2);
            EXPECT_EQ(lying.face_force(5).value, 0);
        }
        EXPECT_EQ(found.end()[-1].value, found.end()[-2].value);
    }
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(found[i].value, found[i + 3].value);
}

TEST(Observers, EnergiesAndMomentum) {
    World world({.gravity = {0, 0, -10}});
    world.add({.position = {0, 0, 3}, .velocity = {2, 0, 0}, .mass = 4});
    Energies energies;
    energies.observe(world);
    energies.observe(world);
    EXPECT_DOUBLE_EQ(energies.kinetic().value, 8);
    EXPECT_DOUBLE_EQ(energies.potential().value, 120);
    EXPECT_DOUBLE_EQ(energies.total().value, 128);
    EXPECT_EQ(energies.total().standard_error, 0);
    EXPECT_DOUBLE_EQ(energies.momentum(0).value, 8);
}

TEST(Observers, SpeedsAndTheirMoments) {
    World world;
    world.add({.position = {0, 0, 0}, .velocity = {3, 0, 0}});
    world.add({.position = {5, 0, 0}, .velocity = {0, 3, 4}});
    world.add({.position = {9, 0, 0}, .mass = infinite_mass});
    Speeds speeds(4, 8);
    speeds.observe(sample_of(world));
    EXPECT_DOUBLE_EQ(speeds.moment(1).value, 4);
    EXPECT_DOUBLE_EQ(speeds.moment(2).value, 17);
    EXPECT_DOUBLE_EQ(speeds.moment(4).value, 353);
    EXPECT_DOUBLE_EQ(speeds.temperature().value, 17.0 / 3);
    EXPECT_NEAR(speeds.a2().value, 0.6 * 353 / (17.0 * 17) - 1, 1e-15);
    EXPECT_DOUBLE_EQ(speeds.speed(6), 3.25);
    EXPECT_DOUBLE_EQ(speeds.density(6).value, 1); // one of two in half a metre a second; the other is beyond
    EXPECT_EQ(speeds.density(7).value, 0);
}

TEST(Observers, ProfilesAlongAnAxis) {
    World world;
    world.add({.position = {0, 0, 1}, .velocity = {1, 0, 2}, .mass = 1});
    world.add({.position = {5, 0, 1}, .velocity = {1, 0, -2}, .mass = 1});
    world.add({.position = {0, 0, 3}, .velocity = {0, 7, 0}, .mass = 2});
    world.add({.position = {0, 0, 9}});
    Profile profile(2, 0, 4, 2, 10);
    profile.observe(sample_of(world));
    EXPECT_DOUBLE_EQ(profile.position(1), 3);
    EXPECT_DOUBLE_EQ(profile.density(0).value, 0.1);
    EXPECT_DOUBLE_EQ(profile.density(1).value, 0.05);
    EXPECT_DOUBLE_EQ(profile.velocity(0, 0).value, 1);
    EXPECT_DOUBLE_EQ(profile.velocity(0, 2).value, 0);
    EXPECT_DOUBLE_EQ(profile.velocity(1, 1).value, 7);
    EXPECT_NEAR(profile.temperature(0).value, 4.0 / 3, 1e-15);
    EXPECT_NEAR(profile.temperature(1).value, 0, 1e-14);
}

/// Points at random: g(r) is 1 whatever the faces are.
TEST(Observers, RadialDistributionOfPointsIsOne) {
    for (const FaceKind kind : {FaceKind::periodic, FaceKind::reflecting}) {
        World world({.region = cube(10, kind)});
        scene::Random random(3);
        for (int i = 0; i < 4000; ++i) {
            const double x = random.uniform(0, 10);
            const double y = random.uniform(0, 10);
            world.add({.position = {x, y, random.uniform(0, 10)}, .radius = 0});
        }
        RadialDistribution radial(2.5, 5);
        radial.observe(sample_of(world));
        for (std::size_t shell = 1; shell < 5; ++shell) EXPECT_NEAR(radial.g(shell).value, 1, 0.03) << shell;
        EXPECT_NEAR(radial.g(0).value, 1, 0.1);
    }
}

/// In a periodic lattice of n^3 spheres each has 6, 12 and 8 neighbours, at 1, sqrt 2 and sqrt 3 lattice constants.
TEST(Observers, RadialDistributionCountsEachPairOnce) {
    for (const int n : {3, 4, 7}) {
        World world({.region = cube(1.25 * n, FaceKind::periodic)});
        for (int i = 0; i < n * n * n; ++i) {
            const int row = i / n;
            const int layer = row / n;
            world.add({.position = {1.25 * (i % n), 1.25 * (row % n), 1.25 * layer}});
        }
        const double most = 1.25 * 1.45;
        RadialDistribution radial(most, 2);
        radial.observe(sample_of(world));
        const double bodies = n * n * n;
        const double volume = 4 * std::numbers::pi / 3 * std::pow(most, 3);
        const double density = (bodies - 1) / std::pow(1.25 * n, 3);
        EXPECT_NEAR(radial.g(0).value, 0, 1e-15);
        EXPECT_NEAR(radial.g(1).value * density * volume * 7 / 8, 18, 1e-9) << n;
    }
}

/// Touching spheres in a cubic lattice of 4^3 in open space: 3 at corners, 4 along edges, 5 in faces, 6 inside.
TEST(Observers, CoordinationCountsWhatTouches) {
    World world;
    for (int i = 0; i < 64; ++i) {
        const int row = i / 4;
        const int layer = row / 4;
        world.add({.position = {1.0 * (i % 4), 1.0 * (row % 4), 1.0 * layer}});
    }
    Coordination coordination(1e-9);
    coordination.observe(sample_of(world));
    EXPECT_DOUBLE_EQ(coordination.mean().value, 4.5);
    EXPECT_DOUBLE_EQ(coordination.share(3).value, 8.0 / 64);
    EXPECT_DOUBLE_EQ(coordination.share(6).value, 8.0 / 64);
    EXPECT_DOUBLE_EQ(coordination.mean_without_rattlers().value, (24 * 4 + 24 * 5 + 8 * 6) / 56.0);
}

TEST(Observers, SlabsShareASphere) {
    World world;
    world.add({.position = {0, 0, 0}, .radius = 1});
    const Sample sample = sample_of(world);
    const auto fraction = [&](double low, double high) {
        SlabPacking packing(2, low, high, 5);
        packing.observe(sample);
        return packing.fraction().value * 5 * (high - low);
    };
    const double whole = 4 * std::numbers::pi / 3;
    EXPECT_NEAR(fraction(-2, 2), whole, 1e-14);
    EXPECT_NEAR(fraction(0, 3), whole / 2, 1e-14);
    EXPECT_NEAR(fraction(0.5, 3), std::numbers::pi * 0.25 * 2.5 / 3, 1e-14); // a cap of height 0.5
    EXPECT_NEAR(fraction(-3, -0.3) + fraction(-0.3, 0.2) + fraction(0.2, 1), whole, 1e-14);
    EXPECT_EQ(fraction(1, 3), 0);
}

/// Free flight through periodic faces: displacements grow as v t, velocities stay.
TEST(Observers, CorrelationsOfFreeFlight) {
    World world({.region = cube(5, FaceKind::periodic)});
    world.add({.position = {1, 1, 1}, .velocity = {3, 0, 0}, .radius = 0});
    world.add({.position = {1, 3, 3}, .velocity = {0, -1, 2}, .radius = 0});
    Correlations correlations(20, 3);
    Sample sample;
    for (int i = 0; i < 100; ++i) {
        sample.read(world);
        correlations.observe(sample);
        world.step(0.25);
    }
    for (std::size_t lag = 0; lag <= 20; ++lag) {
        const double t = 0.25 * static_cast<double>(lag);
        EXPECT_NEAR(correlations.time(lag), t, 1e-12);
        EXPECT_NEAR(correlations.squared_displacement(lag).value, 7 * t * t, 1e-9);
        EXPECT_NEAR(correlations.velocity_correlation(lag).value, 7, 1e-12);
    }
}

TEST(Observers, MeanFreePathIsSpeedByRate) {
    World world({.region = cube(10, FaceKind::periodic)});
    world.add({.position = {4, 5, 5}, .velocity = {1, 0, 0}});
    world.add({.position = {6, 5, 5}, .velocity = {-1, 0, 0}});
    ImpactStatistics impacts(world);
    Speeds speeds(2, 1);
    EXPECT_TRUE(std::isinf(mean_free_path(speeds, impacts).value));
    world.step(2);
    impacts.observe(world);
    speeds.observe(sample_of(world));
    EXPECT_NEAR(mean_free_path(speeds, impacts).value, 2, 1e-12);
}

void expect_refused(const std::function<void()>& call, ErrorCode code, const std::string& field,
                    const std::string& value) {
    try {
        call();
        FAIL() << "not refused: " << field;
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), code) << field;
        EXPECT_EQ(error.field(), field);
        EXPECT_NE(std::string(error.what()).find(value), std::string::npos) << error.what();
    }
}

TEST(Observers, RefuseWhatIsNoNumberOrNoRange) {
    const double nan = std::nan("");
    using enum ErrorCode;
    expect_refused([&] { Speeds(nan, 3); }, not_finite, "most", "nan");
    expect_refused([] { Speeds(-2.5, 3); }, out_of_range, "most", "-2.5");
    expect_refused([] { Speeds(1, 0); }, out_of_range, "bins", "0");
    expect_refused([] { Profile(3, 0, 1, 1, 1); }, out_of_range, "axis", "3");
    expect_refused([] { Profile(0, 2, 1, 1, 1); }, out_of_range, "high", "1");
    expect_refused([&] { Profile(0, nan, 1, 1, 1); }, not_finite, "low", "nan");
    expect_refused([] { Profile(0, 0, 1, 0, 1); }, out_of_range, "slices", "0");
    expect_refused([] { SlabPacking(0, 0, 1, 0); }, out_of_range, "area", "0");
    expect_refused([] { RadialDistribution(0, 5); }, out_of_range, "most", "0");
    expect_refused([] { RadialDistribution(1, 0); }, out_of_range, "shells", "0");
    expect_refused([] { Coordination(-0.125); }, out_of_range, "gap", "-0.125");
    expect_refused([] { Correlations(0, 1); }, out_of_range, "most_lag", "0");
    expect_refused([] { Correlations(1, 0); }, out_of_range, "origin_every", "0");
}

TEST(Observers, RefusePlacesThatTheyDoNotHave) {
    World world({.region = cube(10, FaceKind::periodic)});
    world.add({.position = {4, 5, 5}, .velocity = {1, 0, 0}});
    ImpactStatistics impacts(world);
    using enum ErrorCode;
    expect_refused([] { (void)Energies().momentum(3); }, out_of_range, "axis", "less than 3, got 3");
    expect_refused([&] { (void)impacts.virial_rate(3); }, out_of_range, "axis", "less than 3, got 3");
    expect_refused([] { (void)Speeds(1, 5).density(5); }, out_of_range, "bin", "less than 5, got 5");
    for (const std::size_t power : {0U, 5U}) {
        expect_refused([&] { (void)Speeds(1, 5).moment(power); }, out_of_range, "power", std::to_string(power));
    }
    expect_refused([] { (void)Profile(0, 0, 1, 2, 1).density(2); }, out_of_range, "slice", "less than 2, got 2");
    expect_refused([] { (void)Profile(0, 0, 1, 2, 1).temperature(2); }, out_of_range, "slice", "2");
    expect_refused([] { (void)Profile(0, 0, 1, 2, 1).velocity(2, 0); }, out_of_range, "slice", "2");
    expect_refused([] { (void)RadialDistribution(1, 4).g(9); }, out_of_range, "shell", "9");
    expect_refused([] { (void)Coordination(0).share(17); }, out_of_range, "contacts", "17");
    const Correlations correlations(2, 1);
    expect_refused([&] { (void)correlations.time(3); }, out_of_range, "lag", "3");
    expect_refused([&] { (void)correlations.squared_displacement(3); }, out_of_range, "lag", "3");
    expect_refused([&] { (void)correlations.velocity_correlation(3); }, out_of_range, "lag", "3");
    world.add({.position = {6, 5, 5}, .velocity = {-1, 0, 0}});
    world.step(2);
    expect_refused([&] { impacts.observe(world); }, out_of_range, "body", "less than 1, got 1");
}

TEST(Observers, RefuseWorldsThatDoNotHaveWhatTheyNeed) {
    using enum ErrorCode;
    World open;
    open.add(Body{});
    open.add({.position = {3, 0, 0}});
    RadialDistribution radial(1, 5);
    expect_refused([&] { radial.observe(sample_of(open)); }, not_available, "region", "box");
    expect_refused([&] { return ImpactStatistics(open).pressure(); }, not_available, "region", "box");
    expect_refused([&] { return ImpactStatistics(open).face_force(0); }, out_of_range, "face", "0");
    World small({.region = cube(4, FaceKind::periodic)});
    small.add({.position = {1, 1, 1}});
    RadialDistribution wide(2.25, 5);
    expect_refused([&] { wide.observe(sample_of(small)); }, out_of_range, "most", "2.25");
    open.set_recording(false);
    expect_refused([&] { ImpactStatistics{open}; }, not_available, "record_impacts", "false");
    open.set_recording(true, 0.5);
    expect_refused([&] { ImpactStatistics{open}; }, not_available, "least_recorded_impulse", "0.5");
    Correlations correlations(3, 1);
    correlations.observe(sample_of(open));
    open.add({.position = {9, 0, 0}});
    expect_refused([&] { correlations.observe(sample_of(open)); }, size_mismatch, "sample", "3");
}

} // namespace
} // namespace carom
