// A world is saved and loaded: what is loaded goes on as the first would have, to the last bit.

#include <carom/carom.hpp>

#include <cstddef>
#include <cstdio>
#include <vector>

int main() {
    carom::World world({.gravity = {0, 0, -9.81}, .region = carom::Box{{0, 0, 0}, {4, 4, 4}}});
    for (int i = 0; i < 8; ++i) {
        const carom::Vec3 corner{1.0 + 2 * (i % 2), 1.0 + 2 * (i / 2 % 2), 1.0 + (i < 4 ? 0 : 2)};
        world.add({.position = corner, .velocity = {1.0 + i, -2, 0.5}, .restitution = 0.9});
    }
    for (int frame = 0; frame < 60; ++frame) world.step(1.0 / 60);

    const std::vector<std::byte> snapshot = world.save();
    carom::World copy = carom::World::load(snapshot);
    for (int frame = 0; frame < 60; ++frame) {
        world.step(1.0 / 60);
        copy.step(1.0 / 60);
    }
    std::printf("%zu bytes saved; hashes a second later: %016llx and %016llx\n", snapshot.size(),
                static_cast<unsigned long long>(world.hash()), static_cast<unsigned long long>(copy.hash()));
    return world.hash() == copy.hash() ? 0 : 1;
}
