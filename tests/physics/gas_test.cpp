// The elastic gas: energy, overlaps, and that neither the step, nor windows, nor a shift of the world matter.

#include "scene/overlap_search.hpp"
#include "scene/workloads.hpp"

#include <carom/carom.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

namespace {

using carom::Impact;
using carom::Precision;
using carom::Vec3;
using carom::World;

carom::scene::Scene gas(std::uint64_t bodies, Precision precision = Precision::double_precision) {
    return carom::scene::workload("gas", bodies, precision).scene;
}

void expect_energy_and_gaps(Precision precision, double drift_bound, double overlap_bound) {
    World world = carom::scene::make_world(gas(10000, precision));
    carom::scene::OverlapSearch search(world);
    const double start = world.energy().kinetic;
    double largest = 0;
    for (int i = 0; i < 600; ++i) {
        world.step(1.0 / 60);
        largest = std::max(largest, search.find(world).largest);
    }
    const double drift = (world.energy().kinetic + world.ledger().lost_to_restitution - start) / start;
    const char* name = precision == Precision::single_precision ? "single" : "double";
    std::printf(
        "figure: gas of 10 000 in %s, 600 steps: energy drift %.3g (at most %g), largest overlap %.3g diameters (%g)\n",
        name, drift, drift_bound, largest, overlap_bound);
    EXPECT_LE(std::abs(drift), drift_bound);
    EXPECT_LE(largest, overlap_bound);
    EXPECT_GT(world.ledger().impacts, 200000U);
}

TEST(Gas, KeepsEnergyAndGapsInDouble) { expect_energy_and_gaps(Precision::double_precision, 1e-12, 1e-9); }
TEST(Gas, KeepsEnergyAndGapsInSingle) { expect_energy_and_gaps(Precision::single_precision, 1e-5, 1e-5); }

struct Meeting {
    std::uint32_t partner = 0; ///< slot, or 2^32 - 1 - face
    double time = 0;
};

/// Each body's partners in order, over one second.
std::vector<std::vector<Meeting>> partners(int steps) {
    World world = carom::scene::make_world(gas(10000));
    std::vector<std::vector<Meeting>> meetings(world.size());
    for (int i = 0; i < steps; ++i) {
        world.step(1.0 / steps);
        for (const Impact& impact : world.impacts()) {
            const bool at_face = impact.face >= 0;
            const std::uint32_t other = at_face ? 0xffffffffU - static_cast<std::uint32_t>(impact.face) : impact.b.slot;
            meetings[impact.a.slot].push_back({other, impact.time});
            if (!at_face) meetings[impact.b.slot].push_back({impact.a.slot, impact.time});
        }
    }
    return meetings;
}

TEST(Gas, TheStepDoesNotMatter) {
    const auto reference = partners(60);
    for (const int steps : {30, 240}) {
        const auto other = partners(steps);
        double largest = 0;
        for (std::size_t i = 0; i < reference.size(); ++i) {
            ASSERT_EQ(other[i].size(), reference[i].size()) << "body " << i << ", " << steps << " steps";
            for (std::size_t k = 0; k < reference[i].size(); ++k) {
                ASSERT_EQ(other[i][k].partner, reference[i][k].partner) << "body " << i << ", " << steps << " steps";
                largest = std::max(largest, std::abs(other[i][k].time - reference[i][k].time));
            }
        }
        std::printf("figure: gas for 1 s, 60 against %d steps: same partners, times differ by %.3g s (at most 1e-7)\n",
                    steps, largest);
        EXPECT_LE(largest, 1e-7);
    }
}

bool same(const Impact& x, const Impact& y) {
    return x.offset == y.offset && x.a.slot == y.a.slot && x.b.slot == y.b.slot && x.face == y.face &&
           x.impulse == y.impulse && x.normal == y.normal;
}

/// Steps both worlds and compares their impacts one by one.
void expect_same_impacts(World& one, World& other, double dt, int steps) {
    for (int i = 0; i < steps; ++i) {
        one.step(dt);
        other.step(dt);
        const auto a = one.impacts();
        const auto b = other.impacts();
        ASSERT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end(), same)) << "step " << i;
    }
}

TEST(Gas, WindowsDoNotMatter) {
    for (const char* name : {"gas", "dense_gas", "polydisperse", "bullets", "open_space"}) {
        for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
            const carom::scene::Scene scene = carom::scene::workload(name, 2000, precision).scene;
            World one = carom::scene::make_world(scene);
            World two = carom::scene::make_world(scene);
            World seven = carom::scene::make_world(scene);
            two.set_min_windows(2);
            seven.set_min_windows(7);
            expect_same_impacts(one, two, scene.run.dt, 10);
            for (int i = 0; i < 10; ++i) seven.step(scene.run.dt);
            EXPECT_EQ(one.hash(), two.hash()) << name;
            EXPECT_EQ(one.hash(), seven.hash()) << name;
        }
    }
}

TEST(Gas, IslandsDoAsTheSerialReference) {
    for (const carom::scene::WorkloadInfo& info : carom::scene::workload_list()) {
        for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
            for (const double stretch : {1.0, 5.0}) {
                const carom::scene::Scene scene = carom::scene::workload(info.name, 2000, precision).scene;
                World islands = carom::scene::make_world(scene);
                World reference = carom::scene::make_world(scene);
                islands.set_serial_reference(false);
                reference.set_serial_reference(true);
                expect_same_impacts(islands, reference, stretch * scene.run.dt, 20);
                EXPECT_EQ(islands.hash(), reference.hash()) << info.name << stretch;
                EXPECT_GT(islands.report().islands, 0U) << info.name;
                EXPECT_EQ(reference.report().islands, 0U) << info.name;
            }
        }
    }
}

TEST(Gas, AShiftedWorldDoesTheSame) {
    const Vec3 shift{std::ldexp(1, 30), -std::ldexp(1, 29), std::ldexp(1, 28)};
    carom::scene::Scene here = gas(3000, Precision::single_precision);
    // Positions that both places represent: the shift leaves 2^-20 m of a double.
    carom::scene::Scene there = here;
    auto& box = std::get<carom::Box>(here.options.region);
    const double grid = std::ldexp(1, -20);
    const auto on_grid = [grid](const Vec3& v) {
        return Vec3{std::round(v.x / grid) * grid, std::round(v.y / grid) * grid, std::round(v.z / grid) * grid};
    };
    box.min = on_grid(box.min);
    box.max = on_grid(box.max);
    auto& shifted_box = std::get<carom::Box>(there.options.region);
    shifted_box.min = box.min + shift;
    shifted_box.max = box.max + shift;
    for (std::size_t i = 0; i < here.bodies.size(); ++i) {
        here.bodies.position[i] = on_grid(here.bodies.position[i]);
        there.bodies.position[i] = here.bodies.position[i] + shift;
    }
    World one = carom::scene::make_world(here);
    World other = carom::scene::make_world(there);
    expect_same_impacts(one, other, 1.0 / 60, 120);
    std::printf("figure: gas of 3 000 shifted by (2^30, -2^29, 2^28) m: the same bits after %llu impacts\n",
                static_cast<unsigned long long>(one.ledger().impacts));
    for (const carom::BodyId id : one.ids()) {
        const carom::Body a = one.get(id);
        const carom::Body b = other.get(other.ids()[id.slot]);
        ASSERT_EQ(a.position + shift, b.position);
        ASSERT_EQ(a.velocity, b.velocity);
    }
}

TEST(Gas, GravityAndLowBouncesKeepEnergy) {
    carom::scene::Scene scene = gas(1000);
    scene.options.gravity = {0, 0, -9.81};
    World world = carom::scene::make_world(scene);
    const double start = world.energy().total();
    for (int i = 0; i < 600; ++i) world.step(1.0 / 60);
    const double drift = (world.energy().total() - start) / world.energy().kinetic;
    std::printf("figure: gas of 1 000 under gravity, 600 steps: energy drift %.3g\n", drift);
    EXPECT_LE(std::abs(drift), 1e-12);
}

TEST(Gas, PeriodicCornersAndSmallWorlds) {
    for (const std::uint64_t count : {3U, 8U, 30U}) {
        carom::WorldOptions options;
        carom::Box box{{0, 0, 0}, {4.5, 4.5, 4.5}};
        for (carom::Face& face : box.faces) face.kind = carom::FaceKind::periodic;
        options.region = box;
        World one(options);
        World five(options);
        five.set_min_windows(5);
        std::uint64_t added = 0;
        for (int k = 0; k < 64 && added < count; ++k) {
            const int layer = k / 16;
            const Vec3 corner{(k % 4) * 1.125, ((k / 4) % 4) * 1.125, layer * 1.125};
            const Vec3 velocity{std::sin(k * 1.7) * 30, std::cos(k * 2.3) * 30, std::sin(k * 0.9 + 1) * 30};
            one.add({.position = corner, .velocity = velocity});
            five.add({.position = corner, .velocity = velocity});
            ++added;
        }
        const double start = one.energy().kinetic;
        const Vec3 momentum = one.momentum();
        expect_same_impacts(one, five, 1.0 / 30, 100);
        EXPECT_EQ(one.hash(), five.hash());
        EXPECT_NEAR(one.energy().kinetic / start, 1, 1e-12);
        EXPECT_NEAR(carom::length(one.momentum() - momentum), 0, 1e-10);
        EXPECT_GT(one.ledger().impacts, 10U);
        carom::scene::OverlapSearch search(one);
        EXPECT_LE(search.find(one).largest, 1e-9);
    }
}

} // namespace
