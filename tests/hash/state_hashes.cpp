// Prints, for each workload and some scenes, small ones among them, hashes of the state after some steps, of the
// impacts on the way, and of sums: builds of every preset have to print the same. Small enough for an emulated
// processor to be through in seconds.

#include "digest.hpp"
#include "scene/scene.hpp"
#include "scene/workloads.hpp"
#include "small_scenes.hpp"

#include <carom/world.hpp>

#include <array>
#include <cstdio>
#include <string>

namespace {

using carom::test::Digest;

void run(const std::string& name, const carom::scene::Scene& scene, int steps) {
    carom::World world = carom::scene::make_world(scene);
    Digest impacts;
    for (int i = 0; i < steps; ++i) {
        world.step(scene.run.dt);
        impacts.add(world.impacts());
    }
    Digest sums;
    sums.add(world.energy().total());
    sums.add(world.momentum());
    sums.add(world.angular_momentum());
    sums.add(world.ledger());
    const bool is_single = scene.options.precision == carom::Precision::single_precision;
    std::printf("%-26s %-6s  state %016llx  impacts %016llx  sums %016llx\n", name.c_str(),
                is_single ? "single" : "double", static_cast<unsigned long long>(world.hash()),
                static_cast<unsigned long long>(impacts.value()), static_cast<unsigned long long>(sums.value()));
}

struct File {
    const char* name; // seen from the root of the repository
    int steps;
};

} // namespace

int main() {
    constexpr std::uint64_t bodies = 1000;
    constexpr int steps = 60;
    constexpr int small_steps = 300;
    constexpr std::array files{
        File{"scenes/asteroids.toml", 8}, File{"scenes/bouncing_balls.toml", 120},
        File{"scenes/cooling.toml", 20},  File{"scenes/newtons_cradle.toml", 60},
        File{"scenes/rain.toml", 300},
    };
    for (const carom::Precision precision : {carom::Precision::single_precision, carom::Precision::double_precision}) {
        for (const carom::scene::WorkloadInfo& info : carom::scene::workload_list()) {
            const std::string name(info.name);
            run(name, carom::scene::workload(name, bodies, precision).scene, steps);
        }
        for (const carom::test::SmallScene& small : carom::test::small_scenes) {
            run(std::string(small.name), carom::test::small_scene(small.name, precision), small_steps);
        }
        for (const File& file : files) {
            carom::scene::Overrides overrides;
            overrides.precision = precision;
            carom::scene::Scene scene = carom::scene::load_scene(file.name, overrides);
            scene.options.record_impacts = true;
            run(file.name, scene, file.steps);
        }
    }
    return 0;
}
