#include "scene/checkpoint.hpp"
#include "scene/random.hpp"

#include <carom/base.hpp>
#include <carom/world.hpp>

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace carom::test {
namespace {

using scene::RunIdentity;
using scene::RunProgress;

World small_world() {
    World world({.gravity = {0, 0, -9.81}, .region = Box{{0, 0, 0}, {10, 10, 10}}});
    world.add({.position = {3, 5, 5}, .velocity = {1, 0, 0}, .restitution = 0.9});
    world.add({.position = {7, 5, 5}, .velocity = {-1, 0, 0.5}, .restitution = 0.9});
    return world;
}

std::vector<scene::Observation> observations() { return {{.name = "energies", .observer = Energies()}}; }

RunIdentity identity(const World& world) {
    RunIdentity identity = scene::identity_of(world, "small", observations());
    identity.dt = 0.01;
    identity.record_impacts = true;
    return identity;
}

RunProgress progress(const World& world) {
    RunProgress progress;
    progress.steps = 3;
    progress.start = scene::read_books(world);
    progress.largest_overlap = 0.25;
    progress.contacts = 1;
    for (std::uint64_t step = 0; step < 4; ++step) progress.rows.push_back(scene::timeline_row(world, step));
    progress.impact_log = "1,2,3\n";
    progress.frames = 7;
    return progress;
}

std::vector<std::byte> bytes_of_small_run() {
    const World world = small_world();
    return scene::save_checkpoint(identity(world), progress(world), observations(), world);
}

std::string message_of(std::span<const std::byte> bytes) {
    try {
        scene::load_checkpoint(bytes);
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::bad_data);
        return error.what();
    }
    return "";
}

TEST(Checkpoint, ComesBackAsItWas) {
    World world = small_world();
    const RunIdentity wanted = identity(world);
    for (int i = 0; i < 200; ++i) world.step(0.01);
    const RunProgress before = progress(world);
    scene::Checkpoint loaded = scene::load_checkpoint(scene::save_checkpoint(wanted, before, observations(), world));
    EXPECT_EQ(loaded.identity, wanted);
    EXPECT_EQ(loaded.progress.steps, 3U);
    EXPECT_EQ(loaded.progress.last_step_short, before.last_step_short);
    EXPECT_EQ(loaded.progress.largest_overlap, 0.25);
    EXPECT_EQ(loaded.progress.contacts, 1U);
    EXPECT_EQ(loaded.progress.rows, before.rows);
    EXPECT_EQ(loaded.progress.impact_log, before.impact_log);
    EXPECT_EQ(loaded.progress.frames, 7U);
    EXPECT_EQ(loaded.progress.start.momentum_scale, before.start.momentum_scale);
    EXPECT_EQ(loaded.world.hash(), world.hash());
    for (int i = 0; i < 200; ++i) {
        world.step(0.01);
        loaded.world.step(0.01);
    }
    EXPECT_EQ(loaded.world.hash(), world.hash());
}

TEST(Checkpoint, IsTheSameBytesAgain) {
    const World world = small_world();
    const World copy(world); // NOLINT(performance-unnecessary-copy-initialization): the copy is what is tested
    EXPECT_TRUE(scene::save_checkpoint(identity(world), progress(world), observations(), world) ==
                scene::save_checkpoint(identity(copy), progress(copy), observations(), copy));
}

TEST(Checkpoint, TruncatedIsRefusedAtEveryLength) {
    const std::vector<std::byte> bytes = bytes_of_small_run();
    for (std::size_t size = 0; size < bytes.size(); ++size) {
        EXPECT_NE(message_of(std::span(bytes).first(size)), "") << "first " << size << " bytes";
    }
    std::vector<std::byte> longer = bytes;
    longer.push_back(std::byte{0});
    EXPECT_NE(message_of(longer).find("too long"), std::string::npos);
}

TEST(Checkpoint, AnyFlippedBitIsRefused) {
    std::vector<std::byte> bytes = bytes_of_small_run();
    for (std::size_t i = 0; i < bytes.size(); ++i) {
        const std::byte flip{static_cast<unsigned char>(1U << (i % 8))};
        bytes[i] ^= flip;
        EXPECT_NE(message_of(bytes), "") << "byte " << i;
        bytes[i] ^= flip;
    }
    EXPECT_EQ(message_of(bytes), "");
}

TEST(Checkpoint, ForeignFilesAndVersionsAreNamed) {
    const std::string text = "# a scene, not a checkpoint, and longer than the head of one is\n";
    EXPECT_NE(message_of(std::as_bytes(std::span(text))).find("no checkpoint"), std::string::npos);
    std::vector<std::byte> newer = bytes_of_small_run();
    newer[8] = std::byte{4};
    EXPECT_NE(message_of(newer).find("version 4"), std::string::npos);
}

TEST(RunIdentity, NamesWhatDiffers) {
    const World world = small_world();
    const RunIdentity saved = identity(world);
    EXPECT_EQ(scene::difference(saved, saved), std::nullopt);
    const auto reason = [&](auto change) {
        RunIdentity wanted = saved;
        change(wanted);
        return scene::difference(saved, wanted).value_or("");
    };
    EXPECT_EQ(reason([](RunIdentity& i) { i.scene = "gas"; }), "it is of scene small, not gas");
    EXPECT_EQ(reason([](RunIdentity& i) { i.dt = 0.02; }), "its dt is 0.01 s, not 0.02 s");
    EXPECT_EQ(reason([](RunIdentity& i) { i.bodies = 3; }), "its scene has 2 bodies, not 3");
    EXPECT_EQ(reason([](RunIdentity& i) { i.precision = Precision::single_precision; }),
              "its precision is double, not single");
    EXPECT_EQ(reason([](RunIdentity& i) { i.record_impacts = false; }), "its run wrote other outputs");
    EXPECT_EQ(reason([](RunIdentity& i) { i.observers ^= 1U; }), "its run wrote other outputs");
    EXPECT_EQ(reason([](RunIdentity& i) { i.world ^= 1U; }), "the scene has changed since");
}

TEST(RunIdentity, SeesAnyChangeOfTheScene) {
    const World world = small_world();
    World copy = world;
    EXPECT_EQ(identity(copy), identity(world));
    Body body = copy.get(copy.ids().front());
    body.restitution = 0.8;
    copy.set(copy.ids().front(), body);
    EXPECT_NE(identity(copy), identity(world));
    copy = world;
    copy.set_gravity({0, 0, -9.8});
    EXPECT_NE(identity(copy), identity(world));
}

} // namespace
} // namespace carom::test
