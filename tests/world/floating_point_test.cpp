// Results do not depend on the floating-point environment of the caller, who finds it again as it was.

#include "world/refusals.hpp"

#include <array>
#include <cfenv>
#include <random>

#ifdef __SSE2__
#    include <pmmintrin.h>
#    include <xmmintrin.h>
#endif

namespace carom {

namespace {

/// A caller's environment for the length of a scope: another rounding, and denormals counted as zero.
class OtherEnvironment {
public:
    explicit OtherEnvironment(int rounding) {
        std::fegetenv(&former_);
        std::fesetround(rounding);
#ifdef __SSE2__
        _mm_setcsr(_mm_getcsr() | _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON);
#endif
    }
    ~OtherEnvironment() { std::fesetenv(&former_); }
    OtherEnvironment(const OtherEnvironment&) = delete;
    OtherEnvironment& operator=(const OtherEnvironment&) = delete;

private:
    std::fenv_t former_{};
};

/// Rounding, and whether denormals count as zero.
struct Environment {
    int rounding = std::fegetround();
#ifdef __SSE2__
    unsigned denormals = _mm_getcsr() & (_MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON);
#endif

    friend bool operator==(const Environment&, const Environment&) = default;
};

/// What a caller sees of a world's run, to the last bit.
struct Results {
    std::vector<std::byte> snapshot;
    std::uint64_t hash = 0;
    std::vector<Vec3> vectors;
    std::vector<double> numbers;
};

void fill(World& world) {
    std::mt19937 random(19); // NOLINT(cert-msc51-cpp): fixed
    const auto number = [&random](double low, double high) {
        // Exact in every rounding mode: multiples of 2^-10.
        return low + static_cast<double>(random() % 1024) * ((high - low) / 1024);
    };
    for (int x = 0; x < 5; ++x) {
        for (int y = 0; y < 5; ++y) {
            world.add({.position = {1.0 + 1.5 * x, 1.0 + 1.5 * y, number(1, 7)},
                       .velocity = {number(-4, 4), number(-4, 4), number(-4, 4)},
                       .mass = 1 + number(0, 4),
                       .radius = 0.5,
                       .restitution = number(0.5, 1),
                       .friction = number(0, 0.5)});
        }
    }
    // Velocities that are denormal in either precision.
    world.add({.position = {9, 9, 9}, .velocity = {1e-310, 1e-40, 0}, .mass = 1e-20});
}

World empty_world(Precision precision) {
    return World({.gravity = {0, 0, -9.81},
                  .region = Box{{0, 0, 0}, {10, 10, 10}},
                  .precision = precision,
                  .drag = {.linear = 0.1, .quadratic = 0.01},
                  .interpolation = true});
}

Results run(World world) {
    fill(world);
    world.set_attractors(std::array{Attractor{.position = {0.1, 0.2, 0.3}, .strength = 1.0 / 3, .softening = 0.1}});
    world.change_velocities(std::array{world.ids()[0]}, std::array{Vec3{0.1, 0.2, 0.3}});
    world.apply_impulses(std::array{world.ids()[1]}, std::array{Vec3{0.1, 0.2, 0.3}});
    for (int i = 0; i < 15; ++i) world.step(1.0 / 60);
    world.step_until(0.7, 0.013);
    world.set_origin({7, 8, 9});

    Results results;
    results.snapshot = world.save();
    World loaded = World::load(results.snapshot);
    loaded.step(0.01);
    results.hash = loaded.hash();
    const Energy energy = world.energy();
    const Ledger& ledger = world.ledger();
    results.numbers = {energy.kinetic,      energy.potential,           world.time(),           world.report().advanced,
                       ledger.lost_to_drag, ledger.lost_to_restitution, ledger.lost_to_friction};
    results.vectors = {world.momentum(), world.angular_momentum({0.1, 0, 0}), world.centre_of_mass(),
                       ledger.outer_impulse};
    for (const BodyId id : world.ids()) {
        results.vectors.insert(results.vectors.end(), {world.get(id).position, world.get(id).velocity});
    }
    std::vector<Vec3> between(world.size());
    // A constant: the caller's own arithmetic would follow the caller's rounding.
    world.positions_at(0.695, world.ids(), between);
    results.vectors.insert(results.vectors.end(), between.begin(), between.end());
    for (const Impact& impact : world.impacts()) {
        results.numbers.insert(results.numbers.end(), {impact.time, impact.impulse, impact.energy_lost});
    }
    return results;
}

class FloatingPoint : public test::BothPrecisions {};

INSTANTIATE_TEST_SUITE_P(Precisions, FloatingPoint, test::both_precisions(), test::precision_name);

/// To be called in the default environment: in another one denormals equal zero.
void expect_same(const Results& results, const Results& expected, int rounding) {
    EXPECT_EQ(results.hash, expected.hash) << rounding;
    EXPECT_TRUE(results.snapshot == expected.snapshot) << rounding;
    EXPECT_TRUE(results.vectors == expected.vectors) << rounding;
    EXPECT_EQ(results.numbers, expected.numbers) << rounding;
}

TEST_P(FloatingPoint, ResultsAreTheSameInEveryEnvironment) {
    const World empty = empty_world(GetParam());
    const Results expected = run(empty);
    for (const int rounding : {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
        const Results results = [&] {
            const OtherEnvironment other(rounding);
            return run(empty);
        }();
        expect_same(results, expected, rounding);
    }
}

TEST_P(FloatingPoint, AWorldMadeInAnotherEnvironmentIsTheSame) {
    const Results expected = run(empty_world(GetParam()));
    for (const int rounding : {FE_TONEAREST, FE_UPWARD, FE_DOWNWARD, FE_TOWARDZERO}) {
        Results results = [&] {
            const OtherEnvironment other(rounding);
            return run(empty_world(GetParam()));
        }();
        // A snapshot names the world whose ids it keeps, so no two worlds share one.
        results.snapshot = expected.snapshot;
        expect_same(results, expected, rounding);
    }
}

/// Calls every function once, and looks at the environment after each.
TEST_P(FloatingPoint, TheCallersEnvironmentIsRestored) {
    for (const int rounding : {FE_UPWARD, FE_TOWARDZERO}) {
        const OtherEnvironment other(rounding);
        const Environment expected;
        ASSERT_EQ(expected.rounding, rounding);
        const auto after = [&](const char* what, auto&& call) {
            call();
            EXPECT_TRUE(Environment{} == expected) << what;
        };
        World world({.precision = GetParam(), .interpolation = true});
        BodyId id;
        Vec3 vector;
        after("add", [&] { id = world.add(Body{}); });
        after("get", [&] { static_cast<void>(world.get(id)); });
        after("set", [&] { world.set(id, {.velocity = {1, 0, 0}}); });
        after("change_velocities", [&] { world.change_velocities({&id, 1}, {&vector, 1}); });
        after("apply_impulses", [&] { world.apply_impulses({&id, 1}, {&vector, 1}); });
        after("step", [&] { world.step(0.1); });
        after("step_until", [&] { world.step_until(0.2); });
        after("time", [&] { static_cast<void>(world.time()); });
        after("positions_at", [&] { world.positions_at(0.2, {&id, 1}, {&vector, 1}); });
        after("sums", [&] { static_cast<void>(world.energy().total() + world.momentum().x); });
        after("load", [&] { World::load(world.save()); });
        after("hash", [&] { static_cast<void>(world.hash()); });
        after("set_origin", [&] { world.set_origin({1, 2, 3}); });
        after("remove", [&] { world.remove(id); });
    }
}

TEST_P(FloatingPoint, TheCallersEnvironmentIsRestoredAfterAnError) {
    const OtherEnvironment other(FE_DOWNWARD);
    const Environment expected;
    const auto after_error = [&](const char* what, auto&& call) {
        EXPECT_THROW(call(), Error) << what;
        EXPECT_TRUE(Environment{} == expected) << what;
    };
    World world({.precision = GetParam()});
    world.add({.velocity = {1e30, 0, 0}});
    const double bad = test::not_a_number;
    after_error("World", [&] { const World refused({.gravity = {bad, 0, 0}}); });
    after_error("add", [&] { world.add({.mass = bad}); });
    after_error("add, overlapping", [&] { world.add(Body{}); });
    after_error("set", [&] { world.set(world.ids()[0], {.radius = bad}); });
    after_error("get", [&] { static_cast<void>(world.get(BodyId{})); });
    after_error("remove", [&] { world.remove(BodyId{}); });
    after_error("step", [&] { world.step(bad); });
    after_error("step, leaving the world", [&] { world.step(1); });
    after_error("step_until", [&] { world.step_until(bad); });
    after_error("positions_at", [&] { world.positions_at(0, {}, {}); });
    after_error("load", [&] { World::load({}); });
    after_error("set_gravity", [&] { world.set_gravity({0, bad, 0}); });
}

} // namespace

} // namespace carom
