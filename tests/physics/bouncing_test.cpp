// A ball on the floor: heights, Zeno times and coming to rest (closed formulas), and energy over long times.

#include <carom/carom.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace {

using carom::Vec3;
using carom::World;
using carom::WorldOptions;

constexpr double gravity = 9.81;
constexpr double radius = 0.1;

WorldOptions floor_under_gravity() {
    WorldOptions options;
    options.gravity = {0, 0, -gravity};
    options.region = std::vector<carom::Plane>{{.point = {0, 0, 0}, .normal = {0, 0, 1}}};
    return options;
}

/// A ball whose lowest point is `height` above the floor.
carom::Body ball_at(double height, double restitution) {
    return {.position = {0, 0, radius + height}, .radius = radius, .restitution = restitution};
}

/// s until a ball dropped from `height` has bounced infinitely often: t1 (1 + e) / (1 - e).
double zeno_time(double height, double e) { return std::sqrt(2 * height / gravity) * (1 + e) / (1 - e); }

TEST(Bouncing, ComesToRestAtTheZenoTimeWhateverTheStep) {
    for (const double e : {0.5, 0.7, 0.8, 0.9, 0.95}) {
        double earliest = 0;
        for (const double dt : {1.0 / 1000, 1.0 / 240, 1.0 / 60, 1.0 / 10}) {
            World world(floor_under_gravity());
            const carom::BodyId ball = world.add(ball_at(1, e));
            double last_impact = 0;
            while (!world.held(ball) && world.time() < 30) {
                world.step(dt);
                if (!world.impacts().empty()) last_impact = world.impacts().back().time;
            }
            EXPECT_TRUE(world.held(ball)) << "e " << e << " dt " << dt;
            // It rests at the impact whose remaining bounces would last less than rest_time.
            EXPECT_LE(last_impact, zeno_time(1, e) + 1e-9) << "e " << e << " dt " << dt;
            EXPECT_GE(last_impact, zeno_time(1, e) - world.options().rest_time) << "e " << e << " dt " << dt;
            EXPECT_NEAR(world.get(ball).position.z, radius, 2 * world.resolution());
            EXPECT_EQ(world.get(ball).velocity, Vec3{});
            earliest = std::max(earliest, zeno_time(1, e) - last_impact);
        }
        std::printf("figure: ball with e = %g rests %.2g s before its Zeno time %.9f s (at most 1/120 s)\n", e,
                    earliest, zeno_time(1, e));
    }
}

TEST(Bouncing, ZenoTimesOfTheLiterature) {
    EXPECT_NEAR(zeno_time(1, 0.5), 1.354570923, 1e-9);
    EXPECT_NEAR(zeno_time(1, 0.7), 2.558633966, 1e-9);
    EXPECT_NEAR(zeno_time(1, 0.8), 4.063712769, 1e-9);
    EXPECT_NEAR(zeno_time(1, 0.9), 8.578949179, 1e-9);
    EXPECT_NEAR(zeno_time(1, 0.95), 17.609421998, 1e-9);
}

TEST(Bouncing, OnAStaticBodyAsOnAFloorWhicheverCameFirst) {
    // Straight down onto a static body: the same heights, times and impacts as on the floor, all within one step.
    constexpr double e = 0.8;
    constexpr double duration = 2;
    World floor(floor_under_gravity());
    const carom::BodyId expected = floor.add(ball_at(1, e));
    floor.step(duration);
    const carom::Body support{.position = {0, 0, -3}, .mass = carom::infinite_mass, .radius = 3, .restitution = e};
    for (const bool support_first : {true, false}) {
        for (const bool serial : {true, false}) {
            WorldOptions options;
            options.gravity = {0, 0, -gravity};
            options.serial_reference = serial;
            World world(options);
            if (support_first) world.add(support);
            const carom::BodyId ball = world.add(ball_at(1, e));
            if (!support_first) world.add(support);
            const carom::StepReport& report = world.step(duration);
            EXPECT_GT(report.impacts, 2U);
            EXPECT_EQ(report.impacts, floor.report().face_impacts) << support_first << serial;
            // Heights of about 1 m, after some ten impacts rounded to 2^-40 m each, which the bounces scale by 1 / e.
            EXPECT_NEAR(world.get(ball).position.z, floor.get(expected).position.z, 1e-9) << support_first << serial;
        }
    }
}

TEST(Bouncing, ApexesShrinkByESquared) {
    World world(floor_under_gravity());
    const double e = 0.8;
    world.add(ball_at(1, e));
    std::vector<double> speeds;
    while (world.time() < 3) {
        world.step(1.0 / 60);
        for (const carom::Impact& impact : world.impacts()) speeds.push_back(impact.approach_speed);
    }
    ASSERT_GE(speeds.size(), 6U);
    for (std::size_t n = 0; n < 6; ++n) {
        const double height = speeds[n] * speeds[n] / (2 * gravity);
        EXPECT_NEAR(height, std::pow(e, 2 * static_cast<double>(n)), 1e-10);
    }
}

TEST(Bouncing, ElasticApexStaysOverAThousandBounces) {
    World world(floor_under_gravity());
    world.add(ball_at(1, 1));
    std::size_t bounces = 0;
    double largest = 0;
    while (bounces < 1000) {
        world.step(1.0 / 60);
        for (const carom::Impact& impact : world.impacts()) {
            ++bounces;
            largest = std::max(largest, std::abs(impact.approach_speed * impact.approach_speed / (2 * gravity) - 1));
        }
    }
    std::printf("figure: apex at e = 1 over 1000 bounces: %.3g m off (at most 1e-9)\n", largest);
    EXPECT_LE(largest, 1e-9);
}

/// Its position is rounded at each impact, at one height always the same way: on a floor and on a static sphere.
TEST(Bouncing, LowElasticBouncesGainNothingByRounding) {
    constexpr double height = 1e-4;
    for (const bool on_sphere : {false, true}) {
        for (const double size : {0.05, 0.1, 0.3}) {
            WorldOptions options = floor_under_gravity();
            if (on_sphere) options.region = carom::OpenSpace{};
            World world(options);
            if (on_sphere) world.add({.position = {0, 0, -1}, .mass = carom::infinite_mass, .radius = 1});
            world.add({.position = {0, 0, size + height}, .radius = size, .restitution = 1});
            const double before = world.energy().total();
            constexpr int steps = 2000;
            for (int k = 0; k < steps; ++k) world.step(0.05);
            EXPECT_GT(world.ledger().impacts + world.ledger().face_impacts, 10000U);
            // The ends of steps are rounded at other places each time, by up to 2^-41 m: a random walk, of which four
            // standard deviations are allowed.
            const double walk = gravity * 0x1p-41 * std::sqrt(steps / 3.0);
            EXPECT_NEAR(world.energy().total(), before, 4 * walk) << on_sphere << ' ' << size;
        }
    }
}

// SimBenchmark "bouncing" (github.com/leggedrobotics/SimBenchmark, data/bouncing): 49 elastic balls, 20 s. Metric: mean
// over all steps of the squared energy error. Published at dt = 1e-3: RaiSim 0.0186, ODE 185, Bullet 75 245 J^2.
TEST(Bouncing, SimBenchmarkEnergyError) {
    for (const double dt : {1e-4, 1e-3, 1e-2, 1e-1}) {
        World world(floor_under_gravity());
        for (int i = 0; i < 49; ++i) {
            const int row = i / 7;
            world.add({.position = {2.0 * (i % 7), 2.0 * row, 5}, .mass = 10, .radius = 0.1});
        }
        const double reference = 49 * 10 * gravity * 5;
        ASSERT_NEAR(reference, 24034.5, 1e-9);
        const int steps = static_cast<int>(std::lround(20 / dt));
        double sum = 0;
        for (int i = 0; i < steps; ++i) {
            world.step(dt);
            const double error = world.energy().total() - reference;
            sum += error * error;
        }
        std::printf("figure: SimBenchmark bouncing, dt %g s: %.3g J^2 (at most 1e-12)\n", dt, sum / steps);
        EXPECT_LT(sum / steps, 1e-12) << "dt " << dt;
    }
}

} // namespace
