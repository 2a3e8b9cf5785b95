// Prints a hash of the state of each workload after some steps: builds of every preset have to print the same.

#include "scene/scene.hpp"
#include "scene/workloads.hpp"

#include <carom/world.hpp>

#include <cstdio>
#include <string>

namespace {

std::uint64_t hash_after(const carom::scene::Scene& scene, int steps) {
    carom::World world = carom::scene::make_world(scene);
    for (int i = 0; i < steps; ++i) world.step(scene.run.dt);
    return world.hash();
}

void print(const std::string& name, carom::Precision precision, std::uint64_t hash) {
    const bool is_single = precision == carom::Precision::single_precision;
    std::printf("%-14s %-6s %016llx\n", name.c_str(), is_single ? "single" : "double",
                static_cast<unsigned long long>(hash));
}

} // namespace

int main() {
    constexpr std::uint64_t bodies = 1000;
    constexpr int steps = 60;
    constexpr int few_steps = 5; // of many bodies, in builds with sanitizers
    for (const carom::Precision precision : {carom::Precision::single_precision, carom::Precision::double_precision}) {
        for (const carom::scene::WorkloadInfo& info : carom::scene::workload_list()) {
            const std::string name(info.name);
            print(name, precision, hash_after(carom::scene::workload(name, bodies, precision).scene, steps));
        }
        for (const char* name : {"asteroids", "bouncing_balls", "newtons_cradle", "rain"}) {
            carom::scene::Overrides overrides;
            overrides.precision = precision;
            const auto scene = carom::scene::load_scene(std::string("scenes/") + name + ".toml", overrides);
            print(name, precision, hash_after(scene, scene.bodies.size() > 10 * bodies ? few_steps : steps));
        }
    }
    return 0;
}
