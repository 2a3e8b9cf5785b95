// Prints, for each workload and some scenes, hashes of the state after some steps, of the impacts on the way, and of
// sums: builds of every preset have to print the same. Small enough for an emulated processor to be through in seconds.

#include "scene/scene.hpp"
#include "scene/workloads.hpp"

#include <carom/world.hpp>

#include <array>
#include <bit>
#include <cstdio>
#include <string>

namespace {

/// FNV-1a over whole numbers instead of bytes.
class Hash {
public:
    void add(std::uint64_t number) { value_ = (value_ ^ number) * 0x100000001b3U; }
    void add(double number) { add(std::bit_cast<std::uint64_t>(number)); }
    void add(const carom::Vec3& vector) {
        add(vector.x);
        add(vector.y);
        add(vector.z);
    }
    void add(carom::BodyId id) {
        add(std::uint64_t{id.slot});
        add(std::uint64_t{id.generation});
    }
    void add(const carom::Impact& impact) {
        add(impact.time);
        add(impact.offset);
        add(impact.a);
        add(impact.b);
        add(static_cast<std::uint64_t>(impact.face));
        add(impact.position);
        add(impact.normal);
        add(impact.impulse);
        add(impact.approach_speed);
        add(impact.energy_lost);
    }
    void add(const carom::Ledger& ledger) {
        add(ledger.impacts);
        add(ledger.face_impacts);
        add(ledger.lost_to_restitution);
        add(ledger.lost_to_friction);
        add(ledger.lost_to_drag);
        add(ledger.outer_impulse);
    }
    [[nodiscard]] unsigned long long value() const { return value_; }

private:
    std::uint64_t value_ = 0xcbf29ce484222325U;
};

void run(const std::string& name, const carom::scene::Scene& scene, int steps) {
    carom::World world = carom::scene::make_world(scene);
    Hash impacts;
    for (int i = 0; i < steps; ++i) {
        world.step(scene.run.dt);
        for (const carom::Impact& impact : world.impacts()) impacts.add(impact);
    }
    Hash sums;
    sums.add(world.energy().total());
    sums.add(world.momentum());
    sums.add(world.angular_momentum());
    sums.add(world.ledger());
    const bool is_single = scene.options.precision == carom::Precision::single_precision;
    std::printf("%-26s %-6s  state %016llx  impacts %016llx  sums %016llx\n", name.c_str(),
                is_single ? "single" : "double", static_cast<unsigned long long>(world.hash()), impacts.value(),
                sums.value());
}

struct File {
    const char* name; // seen from the root of the repository
    int steps;
};

} // namespace

int main() {
    constexpr std::uint64_t bodies = 1000;
    constexpr int steps = 60;
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
