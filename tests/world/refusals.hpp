/// \file
/// Calls that are to be refused, and worlds to make them on.
#pragma once

#include <carom/carom.hpp>

#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <string>
#include <vector>

namespace carom::test {

inline constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double denormal = std::numeric_limits<double>::denorm_min();

/// What the error of a refused call is to say.
struct Refusal {
    ErrorCode code{};
    std::string field;
    std::size_t index = Error::no_index;
};

inline const char* name_of(Precision precision) {
    return precision == Precision::single_precision ? "single" : "double";
}

/// A test case for each of the two precisions.
class BothPrecisions : public ::testing::TestWithParam<Precision> {
protected:
    [[nodiscard]] static bool is_single() { return GetParam() == Precision::single_precision; }
    /// Twice the largest relative rounding of what the world keeps.
    [[nodiscard]] static double kept_eps() {
        return is_single() ? static_cast<double>(std::numeric_limits<float>::epsilon())
                           : std::numeric_limits<double>::epsilon();
    }
    [[nodiscard]] static World open_world() { return World({.precision = GetParam()}); }
    [[nodiscard]] static World world_with_floor(double gravity = -10) {
        return World({.gravity = {0, 0, gravity}, .region = std::vector<Plane>{{}}, .precision = GetParam()});
    }
};

inline std::string precision_name(const ::testing::TestParamInfo<Precision>& info) { return name_of(info.param); }

inline auto both_precisions() { return ::testing::Values(Precision::double_precision, Precision::single_precision); }

/// Expects that a call throws the error.
inline void expect_error(const Refusal& refusal, const std::string& what, const std::function<void()>& call) {
    try {
        call();
        ADD_FAILURE() << what << ": not refused";
    } catch (const Error& error) {
        EXPECT_STREQ(to_string(error.code()), to_string(refusal.code)) << what << ": " << error.what();
        EXPECT_EQ(error.field(), refusal.field) << what << ": " << error.what();
        EXPECT_EQ(error.index(), refusal.index) << what << ": " << error.what();
        const std::string message = error.what();
        EXPECT_EQ(message.find(refusal.field), 0U) << "the message does not start with the field: " << message;
    }
}

/// Expects that a call on the world throws the error and changes nothing.
inline void expect_refused(World& world, const Refusal& refusal, const std::string& what,
                           const std::function<void(World&)>& call) {
    const std::vector<std::byte> before = world.save();
    const std::uint64_t hash = world.hash();
    const std::size_t impacts = world.impacts().size();
    const double advanced = world.report().advanced;
    expect_error(refusal, what, [&] { call(world); });
    EXPECT_TRUE(world.save() == before) << what << ": the world has changed";
    EXPECT_EQ(world.hash(), hash) << what;
    EXPECT_EQ(world.impacts().size(), impacts) << what;
    EXPECT_EQ(world.report().advanced, advanced) << what;
}

/// A world with something of everything: a body at rest on a static one, one on the floor, a carried attractor,
/// bodies in flight, an id that was removed, and a few steps behind it.
struct FurnishedWorld {
    World world;
    std::vector<BodyId> movers;
    BodyId fixed;
    BodyId removed;

    explicit FurnishedWorld(Precision precision)
        : world({.gravity = {0, 0, -10},
                 .region = Box{{0, 0, 0}, {20, 20, 20}},
                 .precision = precision,
                 .drag = {.linear = 0.01, .quadratic = 0.02},
                 .material_rules = {{.a = 1, .b = 2, .restitution = 0.5, .friction = 0.25}},
                 .interpolation = true}) {
        fixed = world.add({.position = {10, 10, 5}, .mass = infinite_mass, .radius = 1, .restitution = 0});
        movers = {
            world.add({.position = {10, 10, 6.5}, .restitution = 0}),
            world.add({.position = {3, 3, 0.5}, .restitution = 0, .friction = 0.5}),
            world.add({.position = {3, 8, 9}, .velocity = {1, -2, 0.5}, .restitution = 0.8, .material = 1}),
            world.add({.position = {5, 8, 9}, .velocity = {-2, -2, 0}, .mass = 3, .radius = 0.25, .material = 2}),
        };
        removed = world.add({.position = {18, 18, 18}});
        world.remove(removed);
        const std::vector<Attractor> attractors{
            {.position = {1, 2, 3}, .strength = 0.5, .softening = 0.1},
            {.strength = 2, .softening = 1, .body = movers[2]},
        };
        world.set_attractors(attractors);
        for (int i = 0; i < 100; ++i) world.step(1.0 / 100);
    }
};

} // namespace carom::test
