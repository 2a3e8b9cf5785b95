// The classical way of older games: move everything, look for pairs that overlap, let them bounce. Only the pair
// function is carom's: overlapping bodies that already part are left alone, so they neither stick nor jitter.

#include <carom/collision.hpp>

#include <array>
#include <cstdio>

namespace {

struct Ship {
    carom::Vec3 position{};
    carom::Vec3 velocity{};
    double mass = 1;
};

} // namespace

int main() {
    constexpr double distance = 10; // m, at which two ships touch
    constexpr double dt = 1.0 / 60;
    std::array<Ship, 3> ships{{{{-50, 1, 0}, {40, 0, 0}, 1}, {{0, 0, 0}, {0, 0, 0}, 2}, {{20, -3, 0}, {-5, 0, 0}, 1}}};
    int bounces = 0;
    for (int frame = 0; frame < 240; ++frame) {
        for (Ship& ship : ships) ship.position += ship.velocity * dt;
        for (std::size_t a = 0; a < ships.size(); ++a) {
            for (std::size_t b = a + 1; b < ships.size(); ++b) {
                Ship& one = ships[a];
                Ship& other = ships[b];
                const carom::Vec3 before = one.velocity;
                if (carom::collide_point_masses(one.position, other.position, one.velocity, other.velocity, one.mass,
                                                other.mass, distance * distance, 0.8) &&
                    one.velocity != before) {
                    std::printf("frame %d: ships %zu and %zu bounce\n", frame, a, b);
                    ++bounces;
                }
            }
        }
    }
    return bounces > 0 ? 0 : 1;
}
