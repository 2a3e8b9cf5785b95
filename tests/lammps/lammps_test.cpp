// The same bouncing ball and the same small gas in LAMMPS (Debian's package), whose granular spheres are stiff springs:
// its contacts last t_c instead of no time, so it must come to carom's results as t_c goes to nothing, in proportion.
// Skipped where there is no `lmp`.

#include "scene/random.hpp"
#include "scene/temporary_folder.hpp"

#include <carom/carom.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

namespace carom {
namespace {

using std::numbers::pi;

constexpr double gravity = 9.81;

/// Springs between spheres of 1 kg: F = stiffness * overlap - damping * m_eff * approach speed.
struct Contact {
    double stiffness = 0; ///< N/m
    double damping = 0;   ///< 1/s

    /// s that a contact with reduced mass `mass` (kg) lasts.
    [[nodiscard]] double duration(double mass) const {
        return pi / std::sqrt(stiffness / mass - damping * damping / 4);
    }
};

bool succeeds(const std::string& command) {
    return std::system(command.c_str()) == 0; // NOLINT(bugprone-command-processor): commands of this file alone
}

bool has_lammps() { return succeeds("command -v lmp > /dev/null 2>&1"); }

std::string data_file(const std::vector<Body>& bodies, const Box& box) {
    std::ostringstream text;
    text.precision(17);
    text << "spheres\n\n" << bodies.size() << " atoms\n1 atom types\n\n";
    text << box.min.x << ' ' << box.max.x << " xlo xhi\n" << box.min.y << ' ' << box.max.y << " ylo yhi\n";
    text << box.min.z << ' ' << box.max.z << " zlo zhi\n\nAtoms # sphere\n\n";
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const Body& b = bodies[i];
        const double density = b.mass / (4 * pi / 3 * std::pow(b.radius, 3));
        text << i + 1 << " 1 " << 2 * b.radius << ' ' << density << ' ' << b.position.x << ' ' << b.position.y << ' '
             << b.position.z << '\n';
    }
    text << "\nVelocities\n\n";
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        const Vec3& v = bodies[i].velocity;
        text << i + 1 << ' ' << v.x << ' ' << v.y << ' ' << v.z << " 0 0 0\n";
    }
    return text.str();
}

/// Positions and velocities at the end. `extra`: commands that the case adds.
std::vector<Body> run_lammps(const std::vector<Body>& bodies, const Box& box, const Contact& contact, double time,
                             const std::string& boundary, const std::string& extra) {
    const scene::TemporaryFolder folder;
    // 50 steps a contact, and a whole number of them.
    const double steps = std::ceil(time / (contact.duration(0.5) / 50));
    std::ostringstream input;
    input.precision(17);
    input << "units si\natom_style sphere\nboundary " << boundary << "\nnewton off\ncomm_modify vel yes\n"
          << "read_data spheres.data\nneighbor 0.1 bin\nneigh_modify delay 0 every 1 check yes\n"
          << "pair_style gran/hooke " << contact.stiffness << " NULL " << contact.damping << " NULL 0 0\n"
          << "pair_coeff * *\ntimestep " << time / steps << "\nfix move all nve/sphere\n"
          << extra << "thermo 1000000\nrun " << static_cast<long>(steps) << '\n'
          << "write_dump all custom end.dump id x y z vx vy vz modify sort id format float %.17g\n";
    (void)folder.write("spheres.data", data_file(bodies, box));
    (void)folder.write("in.lammps", input.str());
    const std::string command =
        "cd '" + folder.path().string() + "' && OMP_NUM_THREADS=1 lmp -in in.lammps -log none > out.txt 2>&1";
    EXPECT_TRUE(succeeds(command)) << input.str();
    std::ifstream dump(folder.path() / "end.dump");
    std::string line;
    while (std::getline(dump, line) && !line.starts_with("ITEM: ATOMS")) {
    }
    std::vector<Body> end;
    std::size_t id = 0;
    Body b;
    while (dump >> id >> b.position.x >> b.position.y >> b.position.z >> b.velocity.x >> b.velocity.y >> b.velocity.z) {
        end.push_back(b);
    }
    EXPECT_EQ(end.size(), bodies.size());
    return end;
}

/// m above the floor that the ball would rise to.
double energy_height(const Body& ball) {
    return ball.position.z - ball.radius + ball.velocity.z * ball.velocity.z / (2 * gravity);
}

TEST(Lammps, BouncingBall) {
    if (!has_lammps()) GTEST_SKIP() << "LAMMPS is not installed (Debian package lammps)";
    constexpr double e = 0.8;
    constexpr double time = 2; // after the third bounce, before the fourth
    const Body ball{.position = {2, 2, 1.5}, .restitution = e};
    WorldOptions options;
    options.gravity = {0, 0, -gravity};
    options.region = std::vector<Plane>{{}};
    World world(options);
    const BodyId id = world.add(ball);
    for (int i = 0; i < 120; ++i) world.step(time / 120);
    const double expected = energy_height(world.get(id));
    EXPECT_EQ(world.ledger().face_impacts, 3U);
    EXPECT_NEAR(expected, std::pow(e, 6), 1e-9);
    std::vector<double> errors;
    for (const double stiffness : {1e6, 1.6e7}) {
        // e = exp(-damping t_c / 2)
        const double damping = 2 * std::log(1 / e) * std::sqrt(stiffness) / std::hypot(pi, std::log(e));
        const Contact contact{stiffness, damping};
        std::ostringstream extra;
        extra.precision(17);
        extra << "fix g all gravity " << gravity << " vector 0 0 -1\n"
              << "fix floor all wall/gran hooke " << stiffness << " NULL " << damping << " NULL 0 0 zplane 0 NULL\n";
        const Box box{.min = {0, 0, 0}, .max = {4, 4, 4}};
        const std::vector<Body> end = run_lammps({ball}, box, contact, time, "p p f", extra.str());
        ASSERT_EQ(end.size(), 1U);
        errors.push_back(std::abs(energy_height(end[0]) - expected));
        // Each contact is under gravity for t_c: v changes by up to g t_c, of a speed above 2.2 m/s.
        EXPECT_LE(errors.back(), 3 * 2 * gravity * contact.duration(1) / 2.2 * expected) << stiffness;
        std::printf("figure: LAMMPS, ball after three bounces, contacts of %.2g s: height differs by %.2g m\n",
                    contact.duration(1), errors.back());
    }
    EXPECT_LT(errors[1], 0.5 * errors[0]);
}

/// 27 spheres of diameter 1 m in a periodic cube of 4.5 m.
std::vector<Body> small_gas() {
    scene::Random random(5);
    std::vector<Body> bodies;
    for (int i = 0; i < 27; ++i) {
        const int row = i / 3;
        const int layer = row / 3;
        const Vec3 place{0.75 + 1.5 * (i % 3), 0.75 + 1.5 * (row % 3), 0.75 + 1.5 * layer};
        bodies.push_back({.position = place, .velocity = random.normal_vector()});
    }
    return bodies;
}

TEST(Lammps, ElasticGas) {
    if (!has_lammps()) GTEST_SKIP() << "LAMMPS is not installed (Debian package lammps)";
    constexpr double time = 1.2;
    Box box{.min = {0, 0, 0}, .max = {4.5, 4.5, 4.5}};
    for (Face& face : box.faces) face.kind = FaceKind::periodic;
    const std::vector<Body> bodies = small_gas();
    World world({.region = box});
    for (const Body& body : bodies) world.add(body);
    world.step(time);
    Sample sample;
    sample.read(world);
    std::vector<double> errors;
    for (const double stiffness : {1e7, 1.6e8}) {
        const Contact contact{stiffness, 0};
        const std::vector<Body> end = run_lammps(bodies, box, contact, time, "p p p", "");
        ASSERT_EQ(end.size(), bodies.size());
        double largest = 0;
        for (std::size_t i = 0; i < end.size(); ++i)
            largest = std::max(largest, length(end[i].velocity - sample.velocity[i]));
        errors.push_back(largest);
        std::printf(
            "figure: LAMMPS, gas of 27 after %.1f collisions per body, contacts of %.2g s: velocities differ by up "
            "to %.2g m/s\n",
            2.0 * static_cast<double>(world.ledger().impacts) / 27, contact.duration(0.5), largest);
    }
    EXPECT_GT(world.ledger().impacts, 20U);
    EXPECT_LT(errors[1], 0.05);
    // Contacts four times as short: errors four times as small.
    EXPECT_NEAR(errors[0] / errors[1], 4, 1.5);
}

} // namespace
} // namespace carom
