// The workloads: each as it is defined, without overlap, with fixed bits.
#include "scene/workloads.hpp"

#include "bits.hpp"
#include "scene/occupancy.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <variant>

namespace carom::scene {
namespace {

/// True if no two bodies overlap by more than rounding: each finds its place free after those before it.
bool overlaps_nowhere(const BodyTable& bodies) {
    Occupancy occupancy;
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        constexpr double rounding = 1 - 1e-12;
        if (!occupancy.is_free(bodies.position[i], bodies.radius[i] * rounding)) return false;
        occupancy.add(bodies.position[i], bodies.radius[i] * rounding);
    }
    return true;
}

bool all_inside(const Scene& scene) {
    const auto* box = std::get_if<Box>(&scene.options.region);
    if (box == nullptr) return true;
    constexpr double rounding = 1e-12;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        const Vec3& p = scene.bodies.position[i];
        const double r = scene.bodies.radius[i] - rounding;
        const bool inside = p.x - r >= box->min.x && p.y - r >= box->min.y && p.z - r >= box->min.z &&
                            p.x + r <= box->max.x && p.y + r <= box->max.y && p.z + r <= box->max.z;
        if (!inside) return false;
    }
    return true;
}

double packing(const Scene& scene) {
    const Box& box = std::get<Box>(scene.options.region);
    const Vec3 size = box.max - box.min;
    double filled = 0;
    for (const double r : scene.bodies.radius) filled += 4 * std::numbers::pi / 3 * r * r * r;
    return filled / (size.x * size.y * size.z);
}

std::uint64_t bits_of(const Scene& scene) {
    BitHash hash;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        hash.add(scene.bodies.position[i]);
        hash.add(scene.bodies.velocity[i]);
        hash.add(scene.bodies.mass[i]);
        hash.add(scene.bodies.radius[i]);
        hash.add(scene.bodies.restitution[i]);
    }
    return hash.value();
}

TEST(Workloads, AllAreSoundAtManySizes) {
    for (const WorkloadInfo& info : workload_list()) {
        for (const std::uint64_t bodies : {1000U, 2345U, 20000U}) {
            const Workload made = workload(info.name, bodies);
            EXPECT_EQ(made.scene.bodies.size(), bodies) << info.name;
            EXPECT_EQ(made.scene.name, info.name);
            const bool settles = info.name == "pile";
            EXPECT_EQ(made.warm_up, settles ? 600U : 120U);
            EXPECT_EQ(made.scene.run.steps, settles ? 60U : 120U);
            EXPECT_EQ(made.scene.run.dt, info.name == "dense_gas" ? 1.0 / 240 : 1.0 / 60);
            EXPECT_TRUE(made.scene.options.record_impacts);
            EXPECT_TRUE(overlaps_nowhere(made.scene.bodies)) << info.name << bodies;
            EXPECT_TRUE(all_inside(made.scene)) << info.name << bodies;
        }
    }
}

TEST(Workloads, HaveFixedBits) {
    const std::map<std::string_view, std::uint64_t> expected{
        {"gas", 13610338298301637427U},     {"dense_gas", 9231723151860256037U},
        {"cooling", 12749702662353434235U}, {"polydisperse", 122655487250249214U},
        {"bullets", 645298910893836120U},   {"open_space", 2625640130122127999U},
        {"pile", 17076673538468032606U},
    };
    for (const WorkloadInfo& info : workload_list()) {
        EXPECT_EQ(bits_of(workload(info.name, 2000).scene), expected.at(info.name)) << info.name;
    }
}

TEST(Workloads, Gas) {
    const Scene scene = workload("gas", 1000).scene;
    EXPECT_NEAR(packing(scene), 0.1, 1e-12);
    const auto by_x = [](const Vec3& a, const Vec3& b) { return a.x < b.x; };
    const auto [low, high] = std::minmax_element(scene.bodies.velocity.begin(), scene.bodies.velocity.end(), by_x);
    EXPECT_NEAR(low->x, -5, 0.1);
    EXPECT_NEAR(high->x, 5, 0.1);
    for (const Face& face : std::get<Box>(scene.options.region).faces) {
        EXPECT_EQ(face.kind, FaceKind::reflecting);
        EXPECT_EQ(face.surface.restitution, 1);
    }
}

TEST(Workloads, DenseGas) { EXPECT_NEAR(packing(workload("dense_gas", 1000).scene), 0.45, 1e-12); }

TEST(Workloads, CoolingIsGasThatLosesEnergy) {
    Scene cooling = workload("cooling", 1000).scene;
    EXPECT_EQ(cooling.bodies.restitution, std::vector<double>(1000, 0.9));
    cooling.bodies.restitution.assign(1000, 1);
    EXPECT_EQ(bits_of(cooling), bits_of(workload("gas", 1000).scene));
}

TEST(Workloads, Polydisperse) {
    const Scene scene = workload("polydisperse", 100'000).scene;
    EXPECT_NEAR(packing(scene), 0.0048, 0.0001);
    const auto [low, high] = std::minmax_element(scene.bodies.radius.begin(), scene.bodies.radius.end());
    EXPECT_NEAR(*low, 0.0005, 1e-7);
    EXPECT_NEAR(*high, 0.5, 1e-4);
    for (std::size_t i = 0; i < scene.bodies.size(); i += 1000) {
        EXPECT_NEAR(scene.bodies.mass[i], std::pow(scene.bodies.radius[i] / 0.5, 3), 1e-15);
    }
    EXPECT_EQ(scene.options.resolution, 0);
    EXPECT_EQ(workload("polydisperse", 10, Precision::single_precision).scene.options.resolution, 0x1p-30);
}

TEST(Workloads, Bullets) {
    const Scene gas = workload("gas", 30'000).scene;
    const Scene scene = workload("bullets", 30'000).scene;
    std::size_t bullets = 0;
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        if (scene.bodies.radius[i] == 0.5) continue;
        ++bullets;
        EXPECT_EQ(scene.bodies.radius[i], 0.05);
        EXPECT_EQ(scene.bodies.mass[i], 1e-9);
        EXPECT_EQ(scene.bodies.velocity[i], 1000 * gas.bodies.velocity[i]);
    }
    EXPECT_EQ(bullets, 3U);
    const std::vector<double> radii = workload("bullets", 1).scene.bodies.radius;
    EXPECT_EQ(radii, (std::vector<double>{0.05}));
}

TEST(Workloads, OpenSpace) {
    const Scene scene = workload("open_space", 8000).scene;
    EXPECT_EQ(scene.options.origin, (std::array<std::int64_t, 3>{1'000'000'000, 0, 0}));
    EXPECT_EQ(scene.options.resolution, 0x1p-30);
    EXPECT_EQ(workload("open_space", 10, Precision::single_precision).scene.options.resolution, 0x1p-20);
    EXPECT_TRUE(std::holds_alternative<OpenSpace>(scene.options.region));
    // Within a clump of 1000 the packing is 0.1, and it flies apart by 0.1/s.
    const double side = std::cbrt(1000 * std::numbers::pi / 6 / 0.1);
    const BodyTable& bodies = scene.bodies;
    Vec3 low = bodies.position[0];
    Vec3 high = low;
    for (std::size_t i = 0; i < 1000; ++i) {
        low = {std::min(low.x, bodies.position[i].x), std::min(low.y, bodies.position[i].y),
               std::min(low.z, bodies.position[i].z)};
        high = {std::max(high.x, bodies.position[i].x), std::max(high.y, bodies.position[i].y),
                std::max(high.z, bodies.position[i].z)};
    }
    EXPECT_LE(high.x - low.x, side - 1 + 1e-9);
    EXPECT_GE(high.x - low.x, side - 2);
    double along = 0;
    double square = 0;
    const Vec3 centre = 0.5 * (low + high);
    for (std::size_t i = 0; i < 1000; ++i) {
        along += dot(bodies.velocity[i], bodies.position[i] - centre);
        square += length_squared(bodies.position[i] - centre);
    }
    EXPECT_NEAR(along / square, 0.1, 5 * 5 / std::sqrt(3 * square));
    // All clumps together take 10^6 times the volume of the gas.
    const auto by_x = [](const Vec3& a, const Vec3& b) { return a.x < b.x; };
    const auto [first, last] = std::minmax_element(bodies.position.begin(), bodies.position.end(), by_x);
    EXPECT_GE(last->x - first->x, 0.5 * 100 * 2 * side);
    EXPECT_LE(last->x - first->x, 100 * 2 * side);
}

TEST(Workloads, Pile) {
    const Scene scene = workload("pile", 1000).scene;
    // 6 a side: the third root of 250 is 6.3.
    const Box& box = std::get<Box>(scene.options.region);
    EXPECT_EQ(box.min, (Vec3{0, 0, 0}));
    EXPECT_NEAR(box.max.x, 6.6, 1e-12);
    EXPECT_NEAR(box.max.y, 6.6, 1e-12);
    EXPECT_EQ(box.faces[5].kind, FaceKind::open);
    for (std::size_t face = 0; face < 5; ++face) EXPECT_EQ(box.faces[face].surface.restitution, 0);
    EXPECT_EQ(scene.options.gravity, (Vec3{0, 0, -9.81}));
    EXPECT_EQ(scene.bodies.restitution, std::vector<double>(1000, 0.3));
    for (std::size_t i = 0; i < 1000; ++i) {
        const auto at = [](std::size_t n) { return 0.55 + 1.1 * static_cast<double>(n); };
        const Vec3 off = scene.bodies.position[i] - Vec3{at(i % 6), at(i / 6 % 6), at(i / 36)};
        EXPECT_LE(std::max({std::abs(off.x), std::abs(off.y), std::abs(off.z)}), 0.02 + 1e-12);
    }
    // A cube: the third root of 1000 / 4 rounds down, that of 108 / 4 is 3.
    EXPECT_NEAR(std::get<Box>(workload("pile", 108).scene.options.region).max.x, 3.3, 1e-12);
}

TEST(Workloads, RefusalsSayWhatIsAllowed) {
    const auto refusal = [](std::string_view name, std::uint64_t bodies) -> std::string {
        try {
            (void)workload(name, bodies);
        } catch (const SceneError& error) {
            return error.what();
        }
        return "nothing was refused";
    };
    EXPECT_EQ(refusal("gaz", 1), "workload: must be one of gas, dense_gas, cooling, polydisperse, bullets, open_space, "
                                 "pile, got 'gaz'; did you mean 'gas'?");
    EXPECT_EQ(refusal("gas", 0), "bodies: must be in [1, 100000000], got 0");
    EXPECT_EQ(refusal("gas", 1'000'000'000'000'000'000), "bodies: must be in [1, 100000000], got 1000000000000000000");
    EXPECT_EQ(refusal("dense_gas", 15).substr(0, 33), "bodies: 15 bodies of radius 0.5 m");
}

} // namespace
} // namespace carom::scene
