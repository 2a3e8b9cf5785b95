// Two equal bodies meet head-on; with e = 1 they exchange their velocities.
#include <carom/carom.hpp>

int main() {
    carom::World world;
    const carom::BodyId left = world.add({.position = {-1, 0, 0}, .velocity = {1, 0, 0}, .radius = 0.5});
    const carom::BodyId right = world.add({.position = {1, 0, 0}, .velocity = {-1, 0, 0}, .radius = 0.5});
    world.step(1);
    const bool exchanged = world.get(left).velocity.x == -1 && world.get(right).velocity.x == 1;
    return exchanged && world.impacts().size() == 1 ? 0 : 1;
}
