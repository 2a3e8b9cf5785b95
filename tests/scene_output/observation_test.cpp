// Observers that a scene names: the same numbers as those of the library, in time, and cheap.

#include "scene/observation.hpp"
#include "scene/scene.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <cstdio>
#include <map>
#include <span>
#include <sstream>
#include <string>
#include <tuple>
#include <vector>

namespace carom::scene {
namespace {

/// Elastic spheres in a box that is periodic along x, `side` m there, 1 m more along y and 2 m more along z; all
/// observers look at them.
std::string gas(int count, double side, const std::string& every) {
    std::string text = "seed = 3\n[run]\ndt = 0.02\n[region]\nkind = \"box\"\nmin = [0, 1, 2]\nmax = [" +
                       std::to_string(side) + ", " + std::to_string(side + 2) + ", " + std::to_string(side + 4) +
                       "]\nrestitution = 1\nfaces = { x = \"periodic\" }\n" +
                       "[[bodies]]\ngenerator = \"jittered_lattice\"\ncount = " + std::to_string(count) +
                       "\nvelocity = { distribution = \"maxwell\", kT = 1 }\n";
    for (const char* observer :
         {"kind = \"energies\"", "kind = \"impacts\"", "kind = \"speeds\"\nmost = 5\nbins = 25",
          "kind = \"profile\"\naxis = \"y\"\nslices = 4", "kind = \"radial_distribution\"\nmost = 2\nshells = 10",
          "kind = \"coordination\"\ngap = 0.5",
          "kind = \"slab_packing\"\nname = \"slab\"\naxis = \"z\"\nlow = 3\nhigh = 5",
          "kind = \"correlations\"\nlags = 5\norigin_every = 1"}) {
        text += std::string("[[observe]]\n") + observer + "\n" + every;
    }
    return text;
}

/// observer, quantity and place -> value and standard error.
std::map<std::tuple<std::string, std::string, std::string>, std::pair<std::string, std::string>>
lines_of(const std::string& csv) {
    std::map<std::tuple<std::string, std::string, std::string>, std::pair<std::string, std::string>> lines;
    std::istringstream text(csv);
    std::string line;
    std::getline(text, line);
    EXPECT_EQ(line, "observer,quantity,unit,at,value,standard_error");
    while (std::getline(text, line)) {
        std::vector<std::string> cells(1);
        for (const char c : line) {
            if (c == ',') {
                cells.emplace_back();
            } else {
                cells.back() += c;
            }
        }
        EXPECT_EQ(cells.size(), 6U) << line;
        EXPECT_TRUE(lines.insert({{cells[0], cells[1], cells[3]}, {cells[4], cells[5]}}).second) << line;
    }
    return lines;
}

class Observations : public testing::Test {
protected:
    void expect(const std::string& observer, const std::string& quantity, const std::string& at,
                const Estimate& estimate) {
        const auto found = lines_.find({observer, quantity, at});
        ASSERT_NE(found, lines_.end()) << observer << ' ' << quantity << ' ' << at;
        EXPECT_EQ(std::stod(found->second.first), estimate.value) << observer << ' ' << quantity;
        ASSERT_FALSE(found->second.second.empty()) << observer << ' ' << quantity << ": too few samples for an error";
        EXPECT_EQ(std::stod(found->second.second), estimate.standard_error) << observer << ' ' << quantity;
    }

    std::map<std::tuple<std::string, std::string, std::string>, std::pair<std::string, std::string>> lines_;
};

TEST_F(Observations, AreThoseOfTheLibrary) {
    const Scene scene = parse_scene(gas(125, 8, "every = 0.1\nfrom = 1\n"), "s.toml");
    std::vector<Observation> observations = scene.observations;
    World world = make_world(scene);
    World other = make_world(scene);
    Energies energies;
    ImpactStatistics impacts(other);
    Speeds speeds(5, 25);
    Profile profile(1, 1, 10, 4, 80);
    RadialDistribution radial(2, 10);
    Coordination coordination(0.5);
    SlabPacking slab(2, 3, 5, 72);
    Correlations correlations(5, 1);
    Sample sample;
    for (std::uint64_t step = 1; step <= 200; ++step) {
        world.step(scene.run.dt);
        observe(observations, world, step);
        other.step(scene.run.dt);
        if (other.time() < 1) continue;
        impacts.observe(other);
        if (step % 5 != 0) continue;
        energies.observe(other);
        sample.read(other);
        speeds.observe(sample);
        profile.observe(sample);
        radial.observe(sample);
        coordination.observe(sample);
        slab.observe(sample);
        correlations.observe(sample);
    }
    lines_ = lines_of(to_csv(observations));
    EXPECT_EQ(lines_.at({"energies", "samples", ""}).first, "31"); // of steps 50, 55 ... 200
    expect("energies", "kinetic", "", energies.kinetic());
    expect("energies", "potential", "", energies.potential());
    expect("energies", "total", "", energies.total());
    expect("energies", "momentum_y", "", energies.momentum(1));
    expect("impacts", "collision_rate", "", impacts.collision_rate());
    expect("impacts", "mean_free_path", "", mean_free_path(speeds, impacts));
    expect("impacts", "pressure", "", impacts.pressure());
    expect("impacts", "virial_rate_z", "", impacts.virial_rate(2));
    expect("impacts", "face_force", "5", impacts.face_force(5));
    expect("speeds", "speed_moment_1", "", speeds.moment(1));
    expect("speeds", "speed_moment_4", "", speeds.moment(4));
    expect("speeds", "temperature", "", speeds.temperature());
    expect("speeds", "a2", "", speeds.a2());
    expect("speeds", "speed_density", "0.1", speeds.density(0));
    expect("profile", "density", "2.125", profile.density(0));
    expect("profile", "temperature", "8.875", profile.temperature(3));
    expect("profile", "velocity_x", "4.375", profile.velocity(1, 0));
    expect("radial_distribution", "g", "1.1", radial.g(5));
    expect("coordination", "coordination", "", coordination.mean());
    expect("coordination", "coordination_without_rattlers", "", coordination.mean_without_rattlers());
    expect("coordination", "share", "0", coordination.share(0));
    expect("slab", "packing", "", slab.fraction());
    expect("correlations", "squared_displacement", "0", correlations.squared_displacement(0));
    EXPECT_GT(impacts.count(), 100U);
    EXPECT_EQ(lines_.count({"correlations", "velocity_correlation", "0"}), 1U);
}

/// Saved while impacts are not looked at yet (`from` is 1 s), and when all have seen something.
TEST_F(Observations, GoOnFromWhatWasSaved) {
    const Scene scene = parse_scene(gas(125, 8, "every = 0.1\nfrom = 1\n"), "s.toml");
    std::vector<Observation> whole = scene.observations;
    std::vector<Observation> parts = scene.observations;
    World world = make_world(scene);
    for (std::uint64_t step = 1; step <= 200; ++step) {
        world.step(scene.run.dt);
        observe(whole, world, step);
        observe(parts, world, step);
        if (step != 20 && step != 128) continue;
        const std::vector<std::byte> saved = save_observations(parts);
        parts = scene.observations;
        restore_observations(parts, saved, world);
        EXPECT_EQ(save_observations(parts), saved);
    }
    EXPECT_EQ(save_observations(parts), save_observations(whole));
    EXPECT_EQ(to_csv(parts), to_csv(whole));
}

TEST_F(Observations, AreRestoredOnlyToTheirLikes) {
    const Scene scene = parse_scene(gas(125, 8, "every = 0.1\n"), "s.toml");
    World world = make_world(scene);
    std::vector<Observation> observations = scene.observations;
    for (std::uint64_t step = 1; step <= 10; ++step) {
        world.step(scene.run.dt);
        observe(observations, world, step);
    }
    const std::vector<std::byte> saved = save_observations(observations);
    const auto is_refused = [&](std::vector<Observation> others, std::span<const std::byte> bytes) {
        try {
            restore_observations(others, bytes, world);
        } catch (const Error& error) {
            return error.code() == ErrorCode::bad_data;
        }
        return false;
    };
    EXPECT_FALSE(is_refused(scene.observations, saved));
    for (const std::string& other : {gas(125, 8.5, "every = 0.1\n"), gas(125, 8, "every = 0.2\n")}) {
        EXPECT_TRUE(is_refused(parse_scene(other, "s.toml").observations, saved));
    }
    std::vector<Observation> turned = scene.observations;
    std::swap(turned.front(), turned.back());
    EXPECT_TRUE(is_refused(turned, saved));
    for (std::size_t size = 0; size < saved.size(); size += 101) {
        EXPECT_TRUE(is_refused(scene.observations, std::span(saved).first(size))) << size;
    }
}

TEST_F(Observations, WhoHasSeenNothingSaysSo) {
    const Scene scene = parse_scene(gas(27, 8, "from = 100\n"), "s.toml");
    std::vector<Observation> observations = scene.observations;
    World world = make_world(scene);
    for (std::uint64_t step = 1; step <= 40; ++step) {
        world.step(scene.run.dt);
        observe(observations, world, step);
    }
    std::string expected = "observer,quantity,unit,at,value,standard_error\n";
    for (const Observation& observation : observations) expected += observation.name + ",samples,1,,0,\n";
    EXPECT_EQ(to_csv(observations), expected);
    EXPECT_EQ(observations.size(), 8U);
}

TEST_F(Observations, OneSampleHasNoError) {
    const Scene scene = parse_scene(gas(27, 8, ""), "s.toml");
    std::vector<Observation> observations = scene.observations;
    World world = make_world(scene);
    for (std::uint64_t step = 1; step <= 60; ++step) {
        world.step(scene.run.dt);
        observe(observations, world, step);
    }
    lines_ = lines_of(to_csv(observations));
    EXPECT_EQ(lines_.at({"energies", "kinetic", ""}).second, "");
    EXPECT_NE(lines_.at({"impacts", "pressure", ""}).second, "");
    EXPECT_EQ(lines_.count({"correlations", "squared_displacement", "0"}), 1U);
    EXPECT_EQ(lines_.count({"radial_distribution", "g", "1.1"}), 0U);
}

TEST_F(Observations, LookAsOftenAsTheSceneSays) {
    const Scene scene = parse_scene(gas(27, 8, ""), "s.toml");
    ASSERT_EQ(scene.observations.size(), 8U);
    EXPECT_EQ(scene.observations[0].every, 50U);
    EXPECT_EQ(scene.observations[4].every, 200U);
    EXPECT_EQ(scene.observations[6].name, "slab");
    EXPECT_TRUE(scene.options.record_impacts);
    EXPECT_FALSE(scene.outputs.record_impacts);
    EXPECT_EQ(parse_scene(gas(27, 8, "every = 0.051\n"), "s.toml").observations[0].every, 3U);
    EXPECT_EQ(parse_scene(gas(27, 8, "every = 0\n"), "s.toml").observations[0].every, 1U);
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

TEST_F(Observations, CostLessThanATenthOfTheSteps) {
    const Scene scene = parse_scene(gas(10'000, 36.4, ""), "s.toml");
    std::vector<Observation> observations = scene.observations;
    World world = make_world(scene);
    world.set_threads(1);
    double stepping = 0;
    double observing = 0;
    for (std::uint64_t step = 1; step <= 200; ++step) {
        auto begin = std::chrono::steady_clock::now();
        world.step(scene.run.dt);
        stepping += seconds_since(begin);
        begin = std::chrono::steady_clock::now();
        observe(observations, world, step);
        observing += seconds_since(begin);
    }
    std::printf("figure: all observers of a scene, a gas of 10 000: %.1f %% of the steps' time (at most 10 %%)\n",
                100 * observing / stepping);
    EXPECT_LT(observing, 0.1 * stepping);
}

} // namespace
} // namespace carom::scene
