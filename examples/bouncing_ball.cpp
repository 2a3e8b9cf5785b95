// A ball falls onto a floor, bounces and comes to rest. Its impacts are exact although the steps are long.

#include <carom/carom.hpp>

#include <cstdio>
#include <vector>

int main() {
    const std::vector<carom::Plane> floor{{.point = {0, 0, 0}, .normal = {0, 0, 1}}};
    carom::World world({.gravity = {0, 0, -9.81}, .region = floor});
    const carom::BodyId ball = world.add({.position = {0, 0, 1.1}, .radius = 0.1, .restitution = 0.7});
    while (!world.held(ball)) {
        world.step(0.25);
        for (const carom::Impact& impact : world.impacts()) {
            std::printf("%.6f s: hits the floor at %.4f m/s\n", impact.time, impact.approach_speed);
        }
    }
    std::printf("It rests before %.2f s; theory says at 2.558634 s\n", world.time());
    return world.time() <= 2.75 ? 0 : 1;
}
