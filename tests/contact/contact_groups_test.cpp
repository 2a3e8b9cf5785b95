// What one pass does to a group of contacts, in closed form and for every instruction set.

#include "contact/contact_groups.hpp"
#include "same_bits/keeps_simd_target.hpp"

#include <carom/executor.hpp>
#include <carom/time_of_impact.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace {

using carom::Vec3;
using carom::Vector3;
using carom::core::group_size;
using carom::core::put_into;
using carom::core::vector_in;
using carom::detail::wide;

constexpr std::size_t movers = 2 * group_size;
constexpr double frequency = 480;

/// Eight pairs of bodies, contact k between k and k + 8.
template <class Real>
struct Scene {
    carom::core::ContactGroup<Real> group{};
    std::array<carom::core::Mover<Real>, movers> bodies{};
    std::array<carom::core::Place<Real>, movers> places{};
    std::array<std::uint8_t, movers> carried{};
    double loss = 0;

    Scene() {
        for (std::uint32_t k = 0; k < group_size; ++k) {
            group.a[k] = k;
            group.b[k] = k + static_cast<std::uint32_t>(group_size);
            group.touching[k] = 1;
            group.mass[k] = static_cast<Real>(0.5);
            bodies[k].inverse_mass = bodies[group.b[k]].inverse_mass = 1;
            put_into(group.apart, k, {1, 0, 0});
            put_into(group.normal, k, {1, 0, 0});
        }
    }
    [[nodiscard]] carom::core::ContactRun<Real> run(bool rubs) {
        return {{&group, 1}, bodies.data(), places.data(), carried.data(), rubs};
    }
    void solve_hard(bool rubs) {
        carom::core::group_solver<Real>().solve_hard(run(rubs), static_cast<Real>(frequency));
    }
    void solve_softly(const carom::core::Softness<Real>& softness, bool rubs) {
        loss = carom::core::group_solver<Real>().solve_softly(run(rubs), softness);
    }
    /// m/s, of b relative to a.
    [[nodiscard]] Vec3 slip(std::size_t k) const { return wide(bodies[k + group_size].v) - wide(bodies[k].v); }
    /// Everything that a pass may change.
    [[nodiscard]] std::vector<double> bits() const {
        std::vector<double> all{loss};
        const auto add = [&all](const Vec3& v) { all.insert(all.end(), {v.x, v.y, v.z}); };
        for (std::size_t k = 0; k < group_size; ++k) {
            add(wide(vector_in(group.normal, k)));
            add(wide(vector_in(group.rub, k)));
            add(wide(vector_in(group.sprung, k)));
            all.insert(all.end(), {static_cast<double>(group.gap[k]), static_cast<double>(group.impulse[k]),
                                   static_cast<double>(group.plastic[k])});
        }
        for (std::size_t k = 0; k < movers; ++k) {
            add(wide(bodies[k].v));
            all.insert(all.end(), {static_cast<double>(carried[k]), static_cast<double>(places[k].pressing)});
        }
        return all;
    }
};

template <class Real>
class ContactGroups : public testing::Test {
protected:
    template <class F>
    void for_each_target(F&& f) {
        const carom::test::KeepsSimdTarget keeper;
        for (const std::string_view target : carom::simd_targets()) {
            SCOPED_TRACE(std::string(target));
            carom::use_simd_target(target);
            f();
        }
    }
    /// A few roundings of numbers of about 1.
    static constexpr double rounding = 8.0 * static_cast<double>(std::numeric_limits<Real>::epsilon());
};

using Reals = testing::Types<float, double>;
TYPED_TEST_SUITE(ContactGroups, Reals);

TYPED_TEST(ContactGroups, AHardPassTakesOutAllApproachAndClosesGapsWithinThePiece) {
    this->for_each_target([this] {
        Scene<TypeParam> scene;
        for (std::size_t k = 0; k < group_size; ++k) {
            // Overlapping, touching and apart; approaching at 1 m/s, or parting.
            const double gap = 1e-3 * (static_cast<double>(k % 4) - 1);
            put_into(scene.group.apart, k, {1 + gap, 0, 0});
            scene.bodies[k].v.x = static_cast<TypeParam>(k < 4 ? 1 : -1);
        }
        scene.solve_hard(false);
        for (std::size_t k = 0; k < group_size; ++k) {
            const double gap = 1e-3 * (static_cast<double>(k % 4) - 1);
            // Distances of about 1 m are rounded, and divided by the piece.
            const double parting = k < 4 ? -std::max(0.0, gap) * frequency : 1;
            EXPECT_NEAR(scene.slip(k).x, parting, frequency * this->rounding) << k;
            EXPECT_NEAR(static_cast<double>(scene.group.impulse[k]), 0.5 * (k < 4 ? 1 + parting : 0),
                        frequency * this->rounding);
            EXPECT_EQ(scene.carried[k], k < 4 && scene.group.impulse[k] > 0 ? 1 : 0);
        }
    });
}

TYPED_TEST(ContactGroups, ImpulsesTurnAlongWithTheNormals) {
    this->for_each_target([this] {
        Scene<TypeParam> scene;
        for (std::size_t k = 0; k < group_size; ++k) {
            scene.group.impulse[k] = 2;
            // b has gone a quarter round a.
            scene.places[k + group_size].x = {-1, 1, 0};
        }
        scene.solve_hard(false);
        for (std::size_t k = 0; k < group_size; ++k) {
            // b had (2, 0, 0) N s of it, and is to have (0, 2, 0).
            EXPECT_NEAR(length(wide(scene.bodies[k + group_size].v) - Vec3{-2, 2, 0}), 0, this->rounding);
            EXPECT_NEAR(length(wide(scene.bodies[k].v) - Vec3{2, -2, 0}), 0, this->rounding);
            EXPECT_EQ(static_cast<double>(scene.group.impulse[k]), 2);
            EXPECT_EQ(wide(vector_in(scene.group.normal, k)), (Vec3{0, 1, 0}));
        }
    });
}

TYPED_TEST(ContactGroups, FrictionStretchesUntilItSlipsAndTellsWhatItTook) {
    this->for_each_target([this] {
        Scene<TypeParam> scene;
        for (std::size_t k = 0; k < group_size; ++k) {
            scene.group.friction[k] = static_cast<TypeParam>(0.25);
            scene.bodies[k].v = {1, 0, 0};
            scene.bodies[k + group_size].v = {0, static_cast<TypeParam>(k < 4 ? 0.125 : 2), 0};
        }
        scene.solve_softly({.mass = 1, .frequency = frequency, .stick = 0.5}, true);
        double taken = 0;
        for (std::size_t k = 0; k < group_size; ++k) {
            // Half of what would stop the sliding; but an impulse of 1/2 N s bears 1/8 N s, which change it by 1/4 m/s.
            const double after = k < 4 ? 0.0625 : 1.75;
            const double friction = k < 4 ? 0.5 * 0.5 * 0.125 : 0.125;
            EXPECT_NEAR(length(scene.slip(k) - Vec3{0, after, 0}), 0, this->rounding) << k;
            EXPECT_NEAR(length(wide(vector_in(scene.group.rub, k)) - Vec3{0, -friction, 0}), 0, this->rounding);
            taken += friction * after;
        }
        EXPECT_NEAR(scene.loss, taken, 8 * this->rounding);
    });
}

TYPED_TEST(ContactGroups, AHardPassKeepsTheFrictionThatItsImpulsesBear) {
    this->for_each_target([this] {
        Scene<TypeParam> scene;
        for (std::size_t k = 0; k < group_size; ++k) {
            scene.group.friction[k] = static_cast<TypeParam>(0.25);
            scene.group.impulse[k] = 1;
            put_into(scene.group.rub, k, {0, 0.125, 0.125});
            put_into(scene.group.sprung, k, {0, 0.125, 0.125});
            // Parting takes half of the impulse.
            scene.bodies[k + group_size].v = {static_cast<TypeParam>(k < 4 ? 0 : 1), 0, 0};
        }
        scene.solve_hard(true);
        for (std::size_t k = 0; k < group_size; ++k) {
            const double kept = k < 4 ? 0.125 : 0.125 / std::sqrt(2.0);
            EXPECT_NEAR(length(wide(vector_in(scene.group.rub, k)) - Vec3{0, kept, kept}), 0, this->rounding) << k;
            EXPECT_NEAR(length(wide(vector_in(scene.group.sprung, k)) - Vec3{0, kept, kept}), 0, this->rounding);
            EXPECT_NEAR(length(scene.slip(k) - Vec3{0, 2 * (kept - 0.125), 2 * (kept - 0.125)}), 0, this->rounding);
        }
    });
}

TYPED_TEST(ContactGroups, WhatFrictionDampsIsGivenBackUnlessItSlips) {
    this->for_each_target([this] {
        Scene<TypeParam> scene;
        for (std::size_t k = 0; k < group_size; ++k) {
            scene.group.friction[k] = static_cast<TypeParam>(0.25);
            scene.group.impulse[k] = 1;
            scene.bodies[k + group_size].v = {0, static_cast<TypeParam>(k < 4 ? 0.125 : 2), 0};
        }
        scene.solve_hard(true);
        for (std::size_t k = 0; k < group_size; ++k) {
            const double friction = k < 4 ? 0.0625 : 0.25;
            EXPECT_NEAR(scene.slip(k).y, k < 4 ? 0 : 1.5, this->rounding) << k;
            EXPECT_NEAR(static_cast<double>(scene.group.rub[1][k]), -friction, this->rounding);
            EXPECT_NEAR(static_cast<double>(scene.group.sprung[1][k]), k < 4 ? 0 : -0.25, this->rounding);
        }
        scene.solve_softly({.impulse = 0, .frequency = frequency, .stick = 0.5}, true);
        for (std::size_t k = 0; k < group_size; ++k) {
            EXPECT_NEAR(scene.slip(k).y, k < 4 ? 0.0625 : 1.5, this->rounding) << k;
            EXPECT_NEAR(static_cast<double>(scene.group.sprung[1][k]), k < 4 ? -0.03125 : -0.25, this->rounding);
        }
    });
}

TYPED_TEST(ContactGroups, PlasticOverlapBearsNothingAndDoesNotComeBack) {
    this->for_each_target([this] {
        Scene<TypeParam> scene;
        constexpr double plastic = 1.0 / 128;
        for (std::size_t k = 0; k < group_size; ++k) {
            const double overlap = k < 4 ? 2 * plastic : 0.5 * plastic;
            scene.group.plastic[k] = static_cast<TypeParam>(plastic);
            scene.group.gap[k] = static_cast<TypeParam>(-overlap);
            put_into(scene.group.apart, k, {1 - overlap, 0, 0});
        }
        scene.solve_softly({.rate = 32, .mass = 1, .frequency = frequency}, false);
        for (std::size_t k = 0; k < group_size; ++k) {
            EXPECT_NEAR(scene.slip(k).x, k < 4 ? 32 * plastic : 0, this->rounding) << k;
        }
        scene.solve_hard(false);
        for (std::size_t k = 0; k < group_size; ++k) {
            const double left = k < 4 ? plastic : 0.5 * plastic;
            EXPECT_NEAR(static_cast<double>(scene.group.plastic[k]), left, this->rounding) << k;
        }
    });
}

TYPED_TEST(ContactGroups, TellsWhatPressesHardest) {
    this->for_each_target([this] {
        Scene<TypeParam> scene;
        constexpr std::size_t pressed_before = 3;
        for (std::size_t k = 0; k < group_size; ++k) {
            scene.bodies[k].v = {static_cast<TypeParam>(0.25 * static_cast<double>(k)), 0, 0};
            scene.bodies[k + group_size].inverse_mass = static_cast<TypeParam>(0.5);
            scene.group.mass[k] = static_cast<TypeParam>(2.0 / 3);
        }
        scene.places[pressed_before].pressing = scene.places[pressed_before + group_size].pressing = 1000;
        scene.solve_hard(false);
        for (std::size_t k = 0; k < group_size; ++k) {
            // m/s^2: an impulse of 2/3 kg times the approach, in a piece, on 1 kg and on 2 kg.
            const double force = 2.0 / 3 * 0.25 * static_cast<double>(k) * frequency;
            const bool is_more = k == pressed_before;
            const double error = frequency * this->rounding;
            EXPECT_NEAR(static_cast<double>(scene.places[k].pressing), is_more ? 1000 : force, error);
            EXPECT_NEAR(static_cast<double>(scene.places[k + group_size].pressing), is_more ? 1000 : force / 2, error);
        }
    });
}

/// Contacts at random, among them closed, given and with anchors.
template <class Real>
Scene<Real> random_scene(std::mt19937& engine) {
    Scene<Real> scene;
    const auto number = [&](double least, double most) {
        return least + (most - least) * static_cast<double>(engine()) / 4294967296.0;
    };
    const auto vector = [&](double size) {
        return Vec3{number(-size, size), number(-size, size), number(-size, size)};
    };
    for (std::size_t k = 0; k < group_size; ++k) {
        carom::core::ContactGroup<Real>& group = scene.group;
        group.a[k] = static_cast<std::uint32_t>(5 * k % movers);
        group.b[k] = static_cast<std::uint32_t>(5 * (k + group_size) % movers);
        put_into(group.apart, k, carom::detail::direction(vector(1)) * number(0.999, 1.001));
        put_into(group.normal, k, carom::detail::direction(vector(1)));
        put_into(group.rub, k, vector(0.1));
        put_into(group.sprung, k, vector(0.1));
        group.impulse[k] = static_cast<Real>(std::max(0.0, number(-1, 1)));
        group.friction[k] = static_cast<Real>(number(0, 1));
        group.gap[k] = static_cast<Real>(number(-1e-3, 1e-3));
        group.plastic[k] = static_cast<Real>(std::max(0.0, number(-1e-3, 1e-3)));
        if (k % 4 == 2) group.touching[k] = -1;
        if (k % 4 == 3) {
            group.touching[k] = -1;
            group.gap[k] = std::numeric_limits<Real>::infinity();
        }
        if (k % 3 == 0) scene.bodies[k + group_size].inverse_mass = 0;
    }
    for (std::size_t k = 0; k < movers; ++k) {
        scene.bodies[k].v = {static_cast<Real>(number(-1, 1)), static_cast<Real>(number(-1, 1)), 0};
        scene.places[k].x = {static_cast<Real>(number(-1e-3, 1e-3)), 0, static_cast<Real>(number(-1e-3, 1e-3))};
    }
    return scene;
}

TYPED_TEST(ContactGroups, EveryInstructionSetGivesTheSameBits) {
    for (std::uint32_t seed = 1; seed <= 100; ++seed) {
        std::vector<std::vector<double>> found;
        this->for_each_target([&] {
            std::mt19937 engine(seed);
            Scene<TypeParam> scene = random_scene<TypeParam>(engine);
            scene.solve_softly({.rate = 35,
                                .mass = static_cast<TypeParam>(0.97),
                                .impulse = static_cast<TypeParam>(0.03),
                                .frequency = static_cast<TypeParam>(frequency),
                                .stick = static_cast<TypeParam>(0.4)},
                               true);
            found.push_back(scene.bits());
            scene.solve_hard(true);
            found.push_back(scene.bits());
        });
        for (std::size_t k = 2; k < found.size(); ++k) EXPECT_EQ(found[k], found[k % 2]) << seed;
    }
}

} // namespace
