// Three touching static spheres of radius R leave a hole for bodies of less than (2 / sqrt 3 - 1) R = 0.154701 R. One
// that is larger by little and aimed at the hole gets between them, has many impacts, and comes back, or stays: it must
// not come through, whatever ends or converts impacts that follow on each other.

#include "scene/random.hpp"

#include <carom/world.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

namespace {

using carom::Precision;
using carom::Vec3;
using carom::World;

constexpr double sphere_radius = 0.5; // m
constexpr double dt = 1.0 / 64;

struct Shot {
    Vec3 aim{};        ///< m from the middle of the hole
    double way = 0;    ///< m in a step
    double radius = 0; ///< in radii of the spheres
    double restitution = 1;
};

bool passes(const Shot& shot, Precision precision, bool serial) {
    World world({.precision = precision, .serial_reference = serial, .threads = 1});
    const double row = 0.5 * std::sqrt(3.0);
    const Vec3 hole{0.5, row / 3, 0};
    for (const Vec3& place : {Vec3{0, 0, 0}, Vec3{1, 0, 0}, Vec3{0.5, row, 0}}) {
        // They overlap by roundings of their places.
        world.add({.position = place, .mass = carom::infinite_mass, .radius = sphere_radius, .restitution = 0},
                  carom::Overlap::accept);
    }
    const carom::BodyId body = world.add({.position = hole + shot.aim + Vec3{0, 0, 1},
                                          .velocity = {0, 0, -shot.way / dt},
                                          .radius = shot.radius * sphere_radius,
                                          .restitution = shot.restitution});
    for (int i = 0; i < std::ceil(3 / shot.way); ++i) world.step(dt);
    const carom::Body end = world.get(body);
    if (shot.restitution == 1) {
        EXPECT_NEAR(length(end.velocity) * dt / shot.way, 1, precision == Precision::double_precision ? 1e-9 : 1e-3)
            << "radius " << shot.radius << ", way " << shot.way << ", aim " << length(shot.aim);
    }
    if (end.position.z > 0) return false;
    // Not past the outer sides of the spheres: since its last impact it has flown straight on.
    const double since = end.velocity.z < 0 ? end.position.z / end.velocity.z : 0;
    return length(end.position - since * end.velocity - hole) < sphere_radius;
}

void expect_none_passes(Precision precision, bool serial) {
    carom::scene::Random random(14);
    int fired = 0;
    int passed = 0;
    for (const double restitution : {1.0, 0.9, 0.5, 0.0}) {
        for (const double radius : {0.15471, 0.1548, 0.155, 0.16, 0.17, 0.2}) {
            for (const double spread : {0.0, 1e-6, 1e-3, 0.02}) {
                for (const double way : {0.1, 1e3, 1e6}) {
                    const Vec3 aim = spread * random.on_circle();
                    ++fired;
                    if (passes({aim, way, radius, restitution}, precision, serial)) ++passed;
                }
            }
        }
    }
    std::printf("figure: %d shots at a hole too small for them in %s, %s: %d passed (none)\n", fired,
                precision == Precision::single_precision ? "single" : "double", serial ? "reference" : "islands",
                passed);
    EXPECT_EQ(passed, 0);
}

TEST(Wedge, HoldsBackWhatIsTooLargeInDouble) {
    for (const bool serial : {false, true}) expect_none_passes(Precision::double_precision, serial);
}

TEST(Wedge, HoldsBackWhatIsTooLargeInSingle) {
    for (const bool serial : {false, true}) expect_none_passes(Precision::single_precision, serial);
}

// It is open for what fits.
TEST(Wedge, LetsSmallerOnesThrough) {
    EXPECT_TRUE(passes({.way = 0.1, .radius = 0.1546}, Precision::double_precision, false));
}

} // namespace
