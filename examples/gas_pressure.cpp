// The pressure of a gas of hard spheres, with its standard error, and what the equation of state says.

#include <carom/carom.hpp>

#include <cmath>
#include <cstdio>
#include <numbers>

int main() {
    constexpr int side = 10; // bodies along each axis
    constexpr double spacing = 1.5;
    carom::Box box{.min = {0, 0, 0}, .max = {side * spacing, side * spacing, side * spacing}};
    for (carom::Face& face : box.faces) face.kind = carom::FaceKind::periodic;
    carom::World world({.region = box});
    for (int i = 0; i < side * side * side; ++i) {
        const int row = i / side;
        const int layer = row / side;
        const carom::Vec3 place{spacing * (i % side), spacing * (row % side), spacing * layer};
        world.add({.position = place, .velocity = {std::sin(i * 1.3), std::cos(i * 0.7), std::sin(i * 2.1)}});
    }
    for (int step = 0; step < 200; ++step) world.step(0.5); // until the lattice has melted

    carom::ImpactStatistics impacts(world);
    for (int step = 0; step < 500; ++step) {
        world.step(0.5);
        impacts.observe(world);
    }
    const carom::Estimate pressure = impacts.pressure();
    // Carnahan & Starling, J. Chem. Phys. 51, 635 (1969)
    const double x = std::numbers::pi / 6 / (spacing * spacing * spacing);
    const double z = (1 + x + x * x - x * x * x) / ((1 - x) * (1 - x) * (1 - x));
    const double volume = std::pow(side * spacing, 3);
    const double drift = length_squared(world.momentum()) / (2.0 * side * side * side);
    const double expected = z * 2 * (world.energy().kinetic - drift) / (3 * volume);
    std::printf("packing %.3f: pressure %.6f +- %.6f Pa, %.3f collisions per body and second\n", x, pressure.value,
                pressure.standard_error, impacts.collision_rate().value);
    std::printf("The equation of state says %.6f Pa\n", expected);
    return std::abs(pressure.value / expected - 1) < 0.01 ? 0 : 1;
}
