// What an impact does to velocities: the laws of section "3-D" and "1-D" of the collision header, over masses of
// 1 : 10^12 and speeds over 12 decades, in both precisions.

#include "random_input.hpp"
#include "scene/random.hpp"

#include <carom/collision.hpp>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace carom::test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

template <class T>
constexpr Real tolerance = 16 * static_cast<Real>(eps<T>);

template <class T>
Wide momentum(const Encounter<T>& pair) {
    return widened(pair.v_a) * static_cast<Real>(pair.m_a) + widened(pair.v_b) * static_cast<Real>(pair.m_b);
}

template <class T>
Real kinetic_energy(const Encounter<T>& pair) {
    return (static_cast<Real>(pair.m_a) * length_squared(widened(pair.v_a)) +
            static_cast<Real>(pair.m_b) * length_squared(widened(pair.v_b))) /
           2;
}

template <class T>
Real approach_speed(const Encounter<T>& pair) {
    return dot(widened(pair.v_a) - widened(pair.v_b), widened(pair.n));
}

// The unit of each law is that of the largest speed: eps times it, for momentum times the total mass, for energy times
// the total mass and the speed once more.

constexpr Real most = 16;

template <class T>
Real unit_of_momentum(const Encounter<T>& pair) {
    return eps<T> * (static_cast<Real>(pair.m_a) + static_cast<Real>(pair.m_b)) * pair.largest_speed();
}

template <class T>
Real momentum_error() {
    const Encounter<T> before = random_encounter<T>();
    Encounter<T> after = before;
    after.respond();
    const Real error = length(momentum(after) - momentum(before)) / unit_of_momentum(before);
    RC_ASSERT(error <= most);
    return error;
}
TEST(Response, KeepsMomentum) {
    measure("momentum, double, in eps of the largest speed", momentum_error<double>);
    measure("momentum, single, in eps of the largest speed", momentum_error<float>);
}

template <class T>
Real energy_error() {
    Encounter<T> before = random_encounter<T>();
    before.e = 1;
    before.mu = 0;
    Encounter<T> after = before;
    RC_ASSERT(after.respond().energy_lost() == T{0});
    const Real error =
        std::abs(kinetic_energy(after) - kinetic_energy(before)) / (unit_of_momentum(before) * before.largest_speed());
    RC_ASSERT(error <= most);
    return error;
}
TEST(Response, KeepsEnergyWhenElastic) {
    measure("energy, double, in eps of the largest speed", energy_error<double>);
    measure("energy, single, in eps of the largest speed", energy_error<float>);
}

template <class T>
Real restitution_error() {
    const Encounter<T> before = random_encounter<T>();
    Encounter<T> after = before;
    after.respond();
    const Real expected = -static_cast<Real>(before.e) * approach_speed(before);
    const Real error = std::abs(approach_speed(after) - expected) / (eps<T> * before.largest_speed());
    RC_ASSERT(error <= most);
    return error;
}
TEST(Response, RestitutionInIsRestitutionOut) {
    measure("e in - e out, double, in eps of the largest speed", restitution_error<double>);
    measure("e in - e out, single, in eps of the largest speed", restitution_error<float>);
}

template <class T>
void check_energy_balance() {
    const Encounter<T> before = random_encounter<T>();
    Encounter<T> after = before;
    const Response<T> response = after.respond();
    const Real mass = static_cast<Real>(before.m_a) + static_cast<Real>(before.m_b);
    const Real scale = mass * before.largest_speed() * before.largest_speed();
    const Real lost = kinetic_energy(before) - kinetic_energy(after);
    RC_ASSERT(response.restitution_loss >= 0 && response.friction_loss >= 0);
    RC_ASSERT(std::abs(lost - static_cast<Real>(response.energy_lost())) <= tolerance<T> * scale);
}
RC_GTEST_PROP(Response, ReportsTheEnergyThatIsMissing, ()) { check_energy_balance<double>(); }
RC_GTEST_PROP(Response, ReportsTheEnergyThatIsMissingInSingle, ()) { check_energy_balance<float>(); }

template <class T>
void check_impulse() {
    const Encounter<T> before = random_encounter<T>();
    Encounter<T> after = before;
    const Response<T> response = after.respond();
    const Wide impulse = widened(before.n) * static_cast<Real>(response.impulse) + widened(response.friction_impulse);
    const Wide change_a = (widened(after.v_a) - widened(before.v_a)) * static_cast<Real>(before.m_a);
    const Wide change_b = (widened(after.v_b) - widened(before.v_b)) * static_cast<Real>(before.m_b);
    // A velocity is rounded at its own size, which the mass carries into the momentum.
    const Real unit_a = tolerance<T> * static_cast<Real>(before.m_a) * before.largest_speed();
    const Real unit_b = tolerance<T> * static_cast<Real>(before.m_b) * before.largest_speed();
    RC_ASSERT(length(change_a + impulse) <= unit_a);
    RC_ASSERT(length(change_b - impulse) <= unit_b);
}
RC_GTEST_PROP(Response, ImpulsesAreWhatChangedTheMomenta, ()) { check_impulse<double>(); }
RC_GTEST_PROP(Response, ImpulsesAreWhatChangedTheMomentaInSingle, ()) { check_impulse<float>(); }

RC_GTEST_PROP(Response, FrictionObeysCoulombAndNeverReverses, ()) {
    Encounter<double> before = random_encounter<double>();
    before.mu = decades(-3, 1);
    Encounter<double> after = before;
    const Response<double> response = after.respond();
    const auto tangential = [](const Encounter<double>& pair) {
        const Wide relative = widened(pair.v_a) - widened(pair.v_b);
        return relative - widened(pair.n) * dot(relative, widened(pair.n));
    };
    const Real unit = tolerance<double> * before.largest_speed();
    const double mass = reduced_mass(before.m_a, before.m_b);
    const double size = length(response.friction_impulse);
    const double limit = std::min(before.mu * response.impulse, mass * double(length(tangential(before))));
    RC_ASSERT(size <= limit * (1 + 8 * eps<double>)+mass * double(unit));
    RC_ASSERT(size >= limit * (1 - 8 * eps<double>)-mass * double(unit));
    RC_ASSERT(length(tangential(after)) <= length(tangential(before)) + unit);
    RC_ASSERT(dot(tangential(after), tangential(before)) >= -unit * before.largest_speed() * 4);
}

RC_GTEST_PROP(Response, MirroredInputGivesMirroredBits, ()) {
    const Mirror mirror = Mirror::random();
    Encounter<double> here = random_encounter<double>();
    Encounter<double> there = here;
    there.n = mirror(here.n);
    there.v_a = mirror(here.v_a);
    there.v_b = mirror(here.v_b);
    const Response<double> response = here.respond();
    const Response<double> mirrored = there.respond();
    RC_ASSERT(there.v_a == mirror(here.v_a));
    RC_ASSERT(there.v_b == mirror(here.v_b));
    RC_ASSERT(mirrored.impulse == response.impulse);
    RC_ASSERT(mirrored.friction_impulse == mirror(response.friction_impulse));
    RC_ASSERT(mirrored.energy_lost() == response.energy_lost());
}

RC_GTEST_PROP(Response, ExchangingTheBodiesGivesTheSameBits, ()) {
    Encounter<double> here = random_encounter<double>();
    Encounter<double> there{-here.n, here.m_b, here.m_a, here.v_b, here.v_a, here.e, here.mu};
    here.respond();
    there.respond();
    RC_ASSERT(there.v_a == here.v_b);
    RC_ASSERT(there.v_b == here.v_a);
}

// Adding u to both velocities rounds each by eps/2 (S + |u|), S the largest speed, and the same again in the result;
// the response carries input errors over with factors of at most 1 + (1 + e) + (1 + e) mu < 2 + 2 + 2 mu.
Real boost_error() {
    Encounter<double> here = random_encounter<double>();
    const Vec3 boost = direction() * decades(-6, 6);
    Encounter<double> there = here;
    there.v_a += boost;
    there.v_b += boost;
    const double unit = eps<double> * (double(here.largest_speed()) + length(boost)) * (1 + here.mu);
    RC_PRE(dot(there.v_a - there.v_b, there.n) > 0);
    here.respond();
    there.respond();
    const double error = std::max(length(there.v_a - boost - here.v_a), length(there.v_b - boost - here.v_b)) / unit;
    RC_ASSERT(error <= 16);
    return error;
}
TEST(Response, IsTheSameForAnyInertialObserver) {
    measure("boosted by up to 10^6 m/s, in eps of the largest speed and the boost", boost_error);
}

Real reversal_error() {
    Encounter<double> before = random_encounter<double>();
    before.e = 1;
    before.mu = 0;
    Encounter<double> pair = before;
    pair.respond();
    pair.v_a = -pair.v_a;
    pair.v_b = -pair.v_b;
    pair.respond();
    const double unit = double(eps<double> * before.largest_speed());
    const double error = std::max(length(pair.v_a + before.v_a), length(pair.v_b + before.v_b)) / unit;
    RC_ASSERT(error <= double(most));
    return error;
}
TEST(Response, ElasticImpactReversesInTime) {
    measure("there and back in time, in eps of the largest speed", reversal_error);
}

RC_GTEST_PROP(Response, StaticBodyKeepsItsVelocityExactly, ()) {
    const Encounter<double> before = random_encounter<double>();
    Encounter<double> wall = before;
    wall.m_b = infinity;
    const Response<double> response = wall.respond();
    RC_ASSERT(wall.v_b == before.v_b);
    RC_ASSERT(std::abs(double(approach_speed(wall) + before.e * approach_speed(before))) <=
              double(tolerance<double> * before.largest_speed()));
    RC_ASSERT(response.impulse == before.m_a * ((1 + before.e) * response.approach_speed));

    Encounter<double> both = before;
    both.m_a = both.m_b = infinity;
    RC_ASSERT(both.respond().impulse == 0);
    RC_ASSERT(both.v_a == before.v_a && both.v_b == before.v_b);
}

RC_GTEST_PROP(Response, PartingPairsStayAsTheyAre, ()) {
    Encounter<double> before = random_encounter<double>();
    before.n = -before.n;
    RC_PRE(dot(before.v_a - before.v_b, before.n) <= 0);
    Encounter<double> after = before;
    const Response<double> response = after.respond();
    RC_ASSERT(after.v_a == before.v_a && after.v_b == before.v_b);
    RC_ASSERT(response.impulse == 0 && response.energy_lost() == 0 && response.friction_impulse == Vec3{});
}

RC_GTEST_PROP(OneDimension, AgreesWithThreeDimensionsAndTheTextbook, ()) {
    const double m_a = decades(-6, 6);
    const double m_b = decades(-6, 6);
    const double v_a = between(-1, 1) * decades(-6, 6);
    const double v_b = v_a - decades(-6, 6);
    const double e = unit();
    const Velocities1d<double> line = collide_1d(m_a, v_a, m_b, v_b, e);

    Encounter<double> space{{1, 0, 0}, m_a, m_b, {v_a, 0, 0}, {v_b, 0, 0}, e, 0};
    space.respond();
    const double unit = double(tolerance<double>) * std::max(std::abs(v_a), std::abs(v_b));
    RC_ASSERT(std::abs(line.v_a - space.v_a.x) <= unit);
    RC_ASSERT(std::abs(line.v_b - space.v_b.x) <= unit);

    const Real a = m_a;
    const Real b = m_b;
    const Real textbook_a = ((1 + e) * b * v_b + v_a * (a - e * b)) / (a + b);
    const Real textbook_b = ((1 + e) * a * v_a - v_b * (e * a - b)) / (a + b);
    RC_ASSERT(std::abs(line.v_a - textbook_a) <= unit);
    RC_ASSERT(std::abs(line.v_b - textbook_b) <= unit);
}

TEST(OneDimension, ElasticCasesAreExact) {
    const auto swapped = collide_elastic_1d(1.0, 1.0, 1.0, -0.5);
    EXPECT_EQ(swapped.v_a, -0.5);
    EXPECT_EQ(swapped.v_b, 1.0);
    const auto wall = collide_1d(2.0, 3.0, infinity, -1.0, 0.5);
    EXPECT_EQ(wall.v_a, -3.0);
    EXPECT_EQ(wall.v_b, -1.0);
    const auto two_walls = collide_1d(infinity, 3.0, infinity, -1.0, 0.5);
    EXPECT_EQ(two_walls.v_a, 3.0);
    EXPECT_EQ(two_walls.v_b, -1.0);
    static_assert(collide_elastic_1d(1.0F, 2.0F, 1.0F, 0.0F).v_b == 2.0F);
}

TEST(ReducedMass, LimitsAreExact) {
    EXPECT_EQ(reduced_mass(3.0, infinity), 3.0);
    EXPECT_EQ(reduced_mass(infinity, 3.0), 3.0);
    EXPECT_EQ(reduced_mass(infinity, infinity), infinity);
    EXPECT_EQ(reduced_mass(2.0, 2.0), 1.0);
    EXPECT_EQ(reduced_mass(1e308, 1e308), 0.5e308);
    EXPECT_EQ(reduced_mass(5e-324, 1e308), 5e-324);
    EXPECT_NEAR(reduced_mass(1.0, 1e12), 1 - 1e-12, 2 * eps<double>);
}

TEST(Response, ExtremeMassesNeitherOverflowNorVanish) {
    Vec3 v_a{1, 0, 0};
    Vec3 v_b{-1, 0, 0};
    respond({1, 0, 0}, 1.7e308, v_a, 1.7e308, v_b, 1.0);
    EXPECT_EQ(v_a, (Vec3{-1, 0, 0}));
    EXPECT_EQ(v_b, (Vec3{1, 0, 0}));
    respond({-1, 0, 0}, 1e-320, v_a, 1e308, v_b, 1.0);
    EXPECT_EQ(v_a, (Vec3{3, 0, 0}));
    EXPECT_EQ(v_b, (Vec3{1, 0, 0}));
}

TEST(ContactNormal, IsDefinedForEveryPair) {
    EXPECT_EQ(contact_normal(Vec3{0, 0, 2}, Vec3{1, 0, 0}), (Vec3{0, 0, 1}));
    EXPECT_EQ(contact_normal(Vec3{}, Vec3{0, -3, 0}), (Vec3{0, 1, 0}));
    EXPECT_EQ(contact_normal(Vec3{}, Vec3{}), (Vec3{1, 0, 0}));
    EXPECT_EQ(contact_normal(Vector3<float>{}, Vector3<float>{}), (Vector3<float>{1, 0, 0}));
}

RC_GTEST_PROP(ContactNormal, IsAUnitVectorAtAnyScale, ()) {
    const Vec3 along = direction();
    const Vec3 n = contact_normal(along * decades(-300, 300), Vec3{});
    RC_ASSERT(std::abs(double(length(widened(n)) - 1)) <= 2 * eps<double>);
    RC_ASSERT(length(n - along) <= 4 * eps<double>);
}

// Spheres of diameter 1 (or 2, 4, ...) always touch at a length near a power of two: what is too long there on average
// makes a gas hotter, by as much at each impact.
TEST(ContactNormal, IsNotTooLongOnAverage) {
    carom::scene::Random random(3);
    constexpr int trials = 1'000'000;
    for (const double distance : {1.0, 1.3, 2.0}) {
        Real sum = 0;
        for (int i = 0; i < trials; ++i) {
            const double size = distance * (1 + 1e-12 * random.uniform(-1, 1));
            sum += length_squared(widened(contact_normal(size * random.on_sphere(), Vec3{}))) - 1;
        }
        const double mean = static_cast<double>(sum / trials);
        std::printf("figure: normals at a contact distance of %g m: %.2g too long on average (at most 1e-17)\n",
                    distance, mean / 2);
        EXPECT_LE(std::abs(mean / 2), 1e-17) << distance;
    }
}

TEST(ClassicalPair, KeepsItsContractWithoutItsFaults) {
    const Vec3 here{0, 0, 0};
    const Vec3 there{0.9, 0, 0};
    Vec3 v_a{1, 0, 0};
    Vec3 v_b{};

    EXPECT_FALSE(collide_point_masses(here, there, v_a, v_b, 1.0, 1.0, 0.8));
    EXPECT_EQ(v_a, (Vec3{1, 0, 0}));

    EXPECT_TRUE(collide_point_masses(here, there, v_a, v_b, 1.0, 1.0, 1.0));
    EXPECT_EQ(v_a, Vec3{});
    EXPECT_EQ(v_b, (Vec3{1, 0, 0}));

    // The next frame finds them still overlapping, but parting.
    EXPECT_TRUE(collide_point_masses(here, there, v_a, v_b, 1.0, 1.0, 1.0));
    EXPECT_EQ(v_b, (Vec3{1, 0, 0}));

    v_a = {1, 2, 0};
    v_b = {1, 0, 0};
    EXPECT_TRUE(collide_point_masses(here, here, v_a, v_b, 1.0, 1.0, 0.0, 0.5));
    EXPECT_EQ(v_a, (Vec3{1, 0.5, 0}));
    EXPECT_EQ(v_b, (Vec3{1, 1.5, 0}));
}

TEST(Materials, CombineAsDocumented) {
    EXPECT_EQ(combined_restitution(0.25, 0.75), 0.75);
    EXPECT_EQ(combined_friction(0.25, 1.0), 0.5);
    EXPECT_EQ(combined_friction(0.0, 1.0), 0.0);
}

} // namespace
} // namespace carom::test
