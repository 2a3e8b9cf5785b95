#include "validate/cases.hpp"

#include <array>

namespace carom::validate {

namespace {

constexpr std::array all_groups{
    Group{"two_bodies", two_body_tasks},
    Group{"bouncing", bouncing_tasks},
    Group{"drag", drag_tasks},
    Group{"chains", chain_tasks},
    Group{"pi", pi_tasks},
    Group{"fluid", fluid_tasks},
    Group{"relaxation", relaxation_tasks},
    Group{"cooling", cooling_tasks},
    Group{"diffusion", diffusion_tasks},
    Group{"gravity", gravity_tasks},
    Group{"tunnelling", tunnelling_tasks},
    Group{"symmetry", symmetry_tasks},
    Group{"long_run", long_run_tasks},
    Group{"compression", compression_tasks},
    Group{"restitution", restitution_tasks},
    Group{"packing", packing_tasks},
};

constexpr std::array<std::string_view, 9> untested{
    "Heaps with friction: their angle of repose and their packing depend on friction and on how they are made, and no "
    "published figure for spheres that do not rotate is at hand.",
    "Restitution by speed at faces, obstacles and in heaps: compared with the law in the tests of the library.",
    "Collapse in one dimension (three balls below e = 7 - 4 sqrt 3), mirrored ties of three bodies, obstacles, moving "
    "faces and kinematic bodies: in the tests of the library only.",
    "Throughput: ./dev bench measures it.",
    "Coulomb friction in impacts: no published reference without rotation is at hand; the tests of the library compare "
    "it with its own law.",
    "Attractors (gravity of points): compared with closed orbits in the tests of the library only.",
    "Coincident centres in a world, where such a pair parts freely: tested with the pair functions only.",
    "A bouncing ball in single precision at the default resolution: its last bounces are as high as that, and it does "
    "not come to rest.",
    "Pressure of mixtures and of bodies of different sizes; only equal spheres were measured.",
};

} // namespace

std::span<const Group> groups() { return all_groups; }

std::span<const std::string_view> not_tested() { return untested; }

} // namespace carom::validate
