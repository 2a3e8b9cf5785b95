// Snapshots: a loaded world goes on as the saved one, anything else is refused; and what the hash is over.

#include "world/checksum.hpp"
#include "world/refusals.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <random>

namespace carom {

namespace {

using Bytes = std::vector<std::byte>;

class Snapshots : public test::BothPrecisions {};

INSTANTIATE_TEST_SUITE_P(Precisions, Snapshots, test::both_precisions(), test::precision_name);

bool same(const Impact& x, const Impact& y) {
    return x.time == y.time && x.offset == y.offset && x.a == y.a && x.b == y.b && x.face == y.face &&
           x.position == y.position && x.normal == y.normal && x.impulse == y.impulse &&
           x.approach_speed == y.approach_speed && x.energy_lost == y.energy_lost;
}

/// All that there is to see of a world's state.
void expect_same(const World& world, const World& expected) {
    EXPECT_EQ(world.hash(), expected.hash());
    EXPECT_EQ(world.ids(), expected.ids());
    EXPECT_EQ(world.time(), expected.time());
    EXPECT_EQ(world.step_count(), expected.step_count());
    EXPECT_EQ(world.ledger(), expected.ledger());
    EXPECT_EQ(world.energy().total(), expected.energy().total());
    EXPECT_EQ(world.resolution(), expected.resolution());
    EXPECT_EQ(world.attractors().size(), expected.attractors().size());
}

/// Loads a snapshot and expects that the world goes on with the same bits; how many impacts that compared.
std::size_t expect_same_future(World& world, int steps, double dt) {
    World loaded = World::load(world.save());
    expect_same(loaded, world);
    // Only until the next step: the order of bodies in memory, in which they are saved, is no part of the state.
    EXPECT_TRUE(loaded.save() == world.save());
    std::size_t compared = 0;
    for (int i = 0; i < steps; ++i) {
        const StepReport& expected = world.step(dt);
        const StepReport& report = loaded.step(dt);
        EXPECT_EQ(report.tc_conversions, expected.tc_conversions);
        EXPECT_EQ(report.held, expected.held);
        EXPECT_EQ(report.advanced, expected.advanced);
        EXPECT_EQ(loaded.hash(), world.hash()) << "step " << i;
        const auto impacts = loaded.impacts();
        EXPECT_TRUE(std::equal(impacts.begin(), impacts.end(), world.impacts().begin(), world.impacts().end(), same));
        compared += impacts.size();
    }
    expect_same(loaded, world);
    return compared;
}

TEST_P(Snapshots, AFurnishedWorldGoesOn) {
    test::FurnishedWorld furnished(GetParam());
    World& world = furnished.world;
    world.set_origin({3, -2, 1});
    EXPECT_TRUE(world.held(furnished.movers[0]) && world.held(furnished.movers[1]));
    World loaded = World::load(world.save());
    for (const BodyId id : world.ids()) EXPECT_EQ(loaded.held(id), world.held(id));
    std::vector<Vec3> positions(world.size());
    std::vector<Vec3> expected(world.size());
    world.positions_at(0.995, world.ids(), expected);
    loaded.positions_at(0.995, world.ids(), positions);
    EXPECT_EQ(positions, expected);
    EXPECT_GT(expect_same_future(world, 200, 0.01), 2U);
    // The attractor still goes with its body, and ends with it.
    EXPECT_EQ(loaded.attractors()[1].body, furnished.movers[2]);
    loaded.remove(furnished.movers[2]);
    EXPECT_EQ(loaded.attractors().size(), 1U);
}

TEST_P(Snapshots, OptionsAreKept) {
    WorldOptions options{
        .gravity = {1, 2, 3},
        .region = Box{{-1, -2, -3}, {1, 2, 3}},
        .precision = GetParam(),
        .resolution = std::ldexp(1.0, -30),
        .origin = {4, 5, 6},
        .drag = {.linear = 0.1, .quadratic = 0.2},
        .materials = {{.key = 5, .restitution = PowerLaw{0.5, 0.25, 0.125}}},
        .material_rules = {{.a = 3, .b = 4, .restitution = 0.25, .friction = 2}, {.law = Viscoelastic{1e-5, 1e9}}},
        .rest_time = 0.03,
        .collapse_time = 0.004,
        .work_cap = 1234,
        .min_windows = 5,
        .record_impacts = false,
        .least_recorded_impulse = 0.5,
        .interpolation = true};
    std::get<Box>(options.region).faces[2].kind = FaceKind::open;
    std::get<Box>(options.region).faces[5].surface = {.restitution = 0.5, .friction = 0.75};
    const World loaded = World::load(World(options).save());
    const WorldOptions& kept = loaded.options();
    EXPECT_EQ(kept.gravity, options.gravity);
    EXPECT_EQ(kept.precision, options.precision);
    EXPECT_EQ(loaded.resolution(), options.resolution);
    EXPECT_EQ(kept.origin, options.origin);
    EXPECT_EQ(kept.drag.linear, options.drag.linear);
    EXPECT_EQ(kept.drag.quadratic, options.drag.quadratic);
    ASSERT_EQ(kept.materials.size(), 1U);
    EXPECT_EQ(kept.materials[0].key, 5U);
    EXPECT_EQ(kept.materials[0].restitution, options.materials[0].restitution);
    ASSERT_EQ(kept.material_rules.size(), 2U);
    EXPECT_EQ(kept.material_rules[0].law, std::nullopt);
    EXPECT_EQ(kept.material_rules[1].law, options.material_rules[1].law);
    EXPECT_EQ(kept.material_rules[0].b, 4U);
    EXPECT_EQ(kept.material_rules[0].friction, 2);
    EXPECT_EQ(kept.rest_time, options.rest_time);
    EXPECT_EQ(kept.collapse_time, options.collapse_time);
    EXPECT_EQ(kept.work_cap, options.work_cap);
    EXPECT_EQ(kept.min_windows, options.min_windows);
    EXPECT_EQ(kept.record_impacts, options.record_impacts);
    EXPECT_EQ(kept.least_recorded_impulse, options.least_recorded_impulse);
    EXPECT_EQ(kept.interpolation, options.interpolation);
    const Box& box = std::get<Box>(kept.region);
    EXPECT_EQ(box.min, (Vec3{-1, -2, -3}));
    EXPECT_EQ(box.faces[2].kind, FaceKind::open);
    EXPECT_EQ(box.faces[5].surface.friction, 0.75);
    EXPECT_EQ(box.faces[4].surface.friction, std::nullopt);
}

/// A dense gas whose impacts nearly all count as quick ones, so that the TC rule is at work all the time.
World hasty_gas(Precision precision, const Region& region) {
    World world({.gravity = {0, 0, -5}, .region = region, .precision = precision, .collapse_time = 0.5});
    std::mt19937 random(3); // NOLINT(cert-msc51-cpp): fixed
    for (int k = 0; k < 64; ++k) {
        const auto speed = [&random] { return static_cast<double>(random() % 1024) / 64 - 8; };
        const int layer = k / 16;
        world.add({.position = {1.25 * (k % 4) - 1.875, 1.25 * ((k / 4) % 4) - 1.875, 1.25 * layer - 1.875},
                   .velocity = {speed(), speed(), speed()},
                   .mass = 1.0 + k % 3,
                   .restitution = 0.75,
                   .friction = 0.125,
                   .material = static_cast<std::uint32_t>(k % 5)});
    }
    return world;
}

TEST_P(Snapshots, CountersOfQuickImpactsGoOn) {
    Box periodic{{-3, -3, -3}, {3, 3, 3}};
    for (const std::size_t face : {0U, 1U, 2U, 3U}) periodic.faces[face].kind = FaceKind::periodic;
    const std::array<Region, 4> regions{
        Box{{-3, -3, -3}, {3, 3, 3}}, periodic, Shell{.radius = 5},
        std::vector<Plane>{{.point = {0, 0, -3}}, {.point = {0, 0, 3}, .normal = {0.25, 0, -1}}}};
    for (const Region& region : regions) {
        World world = hasty_gas(GetParam(), region);
        std::uint64_t conversions = 0;
        for (int i = 0; i < 20; ++i) conversions += world.step(0.05).tc_conversions;
        EXPECT_GT(conversions, 0U) << region.index();
        EXPECT_GT(expect_same_future(world, 20, 0.01), 5U);
    }
}

TEST_P(Snapshots, IdsStayAndSlotsAreReusedTheSameWay) {
    World world({.precision = GetParam()});
    std::vector<BodyId> ids;
    for (const double x : {0.0, 2.0, 4.0, 6.0, 8.0, 10.0}) ids.push_back(world.add({.position = {x, 0, 0}}));
    for (const std::size_t k : {4U, 1U, 3U}) world.remove(ids[k]);
    World loaded = World::load(world.save());
    for (const BodyId id : ids) EXPECT_EQ(loaded.contains(id), world.contains(id));
    test::expect_refused(loaded, {ErrorCode::unknown_body, "id", 0}, "a removed body",
                         [&](World& w) { static_cast<void>(w.get(ids[1])); });
    for (const double x : {20.0, 22.0, 24.0, 26.0}) {
        const BodyId id = world.add({.position = {x, 0, 0}});
        EXPECT_EQ(loaded.add({.position = {x, 0, 0}}), id);
    }
    expect_same(loaded, world);
    // A world's ids are its own and its snapshots': another one refuses them.
    EXPECT_FALSE(World({.precision = GetParam()}).contains(ids[0]));
}

TEST_P(Snapshots, AnEmptyWorldIsOne) {
    World world({.precision = GetParam()});
    EXPECT_EQ(expect_same_future(world, 3, 0.1), 0U);
}

// ---------------------------------------------------------------------------------------------------------------------
// Bytes that are no snapshot
// ---------------------------------------------------------------------------------------------------------------------

void expect_bad(const Bytes& bytes, const std::string& reason, const std::string& what) {
    try {
        World::load(bytes);
        ADD_FAILURE() << what << ": not refused";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::bad_data) << what << ": " << error.what();
        EXPECT_EQ(error.field(), "snapshot") << what;
        EXPECT_NE(std::string(error.what()).find(reason), std::string::npos) << what << ": " << error.what();
    }
}

Bytes bytes_of(const std::string& text) {
    Bytes bytes(text.size());
    std::memcpy(bytes.data(), text.data(), text.size());
    return bytes;
}

/// Two bodies, one of them held, and something of most other things.
World small_world(Precision precision) {
    World world({.gravity = {0, 0, -10},
                 .region = Box{{0, 0, 0}, {8, 8, 8}},
                 .precision = precision,
                 .materials = {{.key = 3, .restitution = Viscoelastic{1e-3, 1e6}}},
                 .material_rules = {{.a = 1, .b = 2, .restitution = 0.5}},
                 .interpolation = true});
    const BodyId lying = world.add({.position = {2, 2, 0.5}, .restitution = 0, .friction = 0.5});
    world.add({.position = {5, 5, 5}, .velocity = {1, 2, 3}, .restitution = 0.5});
    world.remove(world.add({.position = {7, 7, 7}}));
    world.set_attractors(std::array{Attractor{.strength = 1, .softening = 1, .body = lying},
                                    Attractor{.strength = 0.5, .softening = 1}});
    for (int i = 0; i < 3; ++i) world.step(0.01);
    EXPECT_TRUE(world.held(lying));
    return world;
}

TEST_P(Snapshots, EveryTruncationIsRefused) {
    const Bytes whole = small_world(GetParam()).save();
    for (std::size_t size = 0; size < whole.size(); ++size) {
        const Bytes part(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(size));
        expect_bad(part, "ends too early", std::to_string(size) + " of " + std::to_string(whole.size()) + " bytes");
    }
    Bytes more = whole;
    more.push_back(std::byte{0});
    expect_bad(more, "has bytes after its end", "one byte more");
    std::printf("figure: snapshot in %s: refused at all %zu shorter lengths\n", test::name_of(GetParam()),
                whole.size());
}

TEST_P(Snapshots, EveryFlippedBitIsRefused) {
    Bytes bytes = small_world(GetParam()).save();
    for (std::size_t k = 0; k < bytes.size(); ++k) {
        for (unsigned bit = 0; bit < 8; ++bit) {
            bytes[k] ^= std::byte{1} << bit;
            expect_bad(bytes, "", "byte " + std::to_string(k) + ", bit " + std::to_string(bit));
            bytes[k] ^= std::byte{1} << bit;
        }
    }
    EXPECT_NO_THROW(World::load(bytes));
    std::printf("figure: snapshot in %s: refused with any of its %zu bits flipped\n", test::name_of(GetParam()),
                8 * bytes.size());
}

TEST_P(Snapshots, ForeignFilesAreRefused) {
    const Bytes good = small_world(GetParam()).save();
    expect_bad({}, "ends too early", "empty");
    expect_bad(Bytes(1000), "is no snapshot of carom", "zeros");
    expect_bad(bytes_of("[world]\ngravity = [0, 0, -9.81]\n"), "is no snapshot of carom", "text");
    Bytes other = good;
    std::memcpy(other.data(), "\x89PNG\r\n\x1a\n", 8);
    expect_bad(other, "is no snapshot of carom", "another magic");
    constexpr std::size_t version_at = 8;
    Bytes future = good;
    future[version_at] = std::byte{77};
    expect_bad(future, "has format version 77, this carom reads version", "a future version");
    constexpr std::size_t payload_at = 28;
    Bytes altered = good;
    altered[payload_at + 40] ^= std::byte{1};
    expect_bad(altered, "was altered", "a wrong checksum");
}

TEST_P(Snapshots, ARefusedSnapshotLeavesNothingBehind) {
    World world = small_world(GetParam());
    const std::uint64_t hash = world.hash();
    Bytes bytes = world.save();
    bytes.back() ^= std::byte{1};
    EXPECT_THROW(world = World::load(bytes), Error);
    EXPECT_EQ(world.hash(), hash);
    EXPECT_EQ(expect_same_future(world, 5, 0.01), 0U);
}

/// Puts the checksum right after an alteration: it finds accidents, not malice.
void seal(Bytes& bytes) {
    constexpr std::size_t checksum_at = 20;
    constexpr std::size_t payload_at = 28;
    core::Checksum sum;
    sum.add(std::span(bytes).subspan(payload_at));
    const std::uint64_t value = sum.value();
    std::memcpy(bytes.data() + checksum_at, &value, sizeof(value));
}

/// Loads bytes with a right checksum. A world that comes out is a sound one: it steps or refuses, and saves.
bool loads_soundly(const Bytes& bytes) {
    try {
        World world = World::load(bytes);
        // What is slow is none of this test's business.
        world.set_min_windows(1);
        world.set_work_cap(100);
        EXPECT_TRUE(World::load(world.save()).hash() == world.hash());
        try {
            world.step(0.01);
        } catch (const Error& error) {
            // A face may be about to run over the opposite one, or a radius to become negative.
            const bool is_driven = error.code() != ErrorCode::out_of_world;
            if (is_driven) {
                EXPECT_TRUE(error.field() == "motion" || error.field() == "growth");
            }
        }
        static_cast<void>(world.energy());
        static_cast<void>(world.save());
        return true;
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::bad_data) << error.what();
        return false;
    }
}

TEST_P(Snapshots, AlteredOnesWithARightChecksumAreRefusedOrSound) {
    const Bytes good = small_world(GetParam()).save();
    constexpr std::size_t payload_at = 28;
    std::size_t refused = 0;
    for (std::size_t k = payload_at; k < good.size(); ++k) {
        for (unsigned bit = 0; bit < 8; ++bit) {
            Bytes bytes = good;
            bytes[k] ^= std::byte{1} << bit;
            seal(bytes);
            if (!loads_soundly(bytes)) ++refused;
        }
    }
    EXPECT_GT(refused, 1000U);
    std::mt19937 random(11); // NOLINT(cert-msc51-cpp): fixed
    for (int i = 0; i < 2000; ++i) {
        Bytes bytes = good;
        for (int change = 0; change < 3; ++change) {
            bytes[payload_at + random() % (bytes.size() - payload_at)] = static_cast<std::byte>(random() & 0xffU);
        }
        seal(bytes);
        loads_soundly(bytes);
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// The hash
// ---------------------------------------------------------------------------------------------------------------------

TEST_P(Snapshots, EachFieldOfABodyCounts) {
    World world({.precision = GetParam()});
    const BodyId id = world.add({.position = {5, 5, 5}, .velocity = {1, 2, 3}, .restitution = 0.5, .friction = 0.5});
    const Body body = world.get(id);
    const auto next = [](double value) {
        return is_single() ? static_cast<double>(
                                 std::nextafter(static_cast<float>(value), std::numeric_limits<float>::infinity()))
                           : std::nextafter(value, test::infinity);
    };
    // What is done to one field, and whether it is part of the hash, which is over the state alone.
    struct Change {
        const char* field;
        bool hashed;
        std::function<void(Body&)> make;
    };
    const double unit = world.resolution();
    const std::array<Change, 12> changes{{
        {"position.x", true, [&](Body& b) { b.position.x += unit; }},
        {"position.y", true, [&](Body& b) { b.position.y -= unit; }},
        {"position.z", true, [&](Body& b) { b.position.z += unit; }},
        {"velocity.x", true, [&](Body& b) { b.velocity.x = next(b.velocity.x); }},
        {"velocity.y", true, [&](Body& b) { b.velocity.y = next(b.velocity.y); }},
        {"velocity.z", true, [&](Body& b) { b.velocity.z = next(b.velocity.z); }},
        {"mass", false, [&](Body& b) { b.mass = next(b.mass); }},
        {"radius", false, [&](Body& b) { b.radius = next(b.radius); }},
        {"restitution", false, [&](Body& b) { b.restitution = next(b.restitution); }},
        {"friction", false, [&](Body& b) { b.friction = next(b.friction); }},
        {"material", false, [&](Body& b) { b.material += 1; }},
        {"user_data", false, [&](Body& b) { b.user_data += 1; }},
    }};
    World same_again = world;
    same_again.set(id, body);
    EXPECT_EQ(same_again.hash(), world.hash());
    EXPECT_TRUE(same_again.save() == world.save());
    for (const Change& change : changes) {
        World other = world;
        Body changed = body;
        change.make(changed);
        other.set(id, changed);
        EXPECT_EQ(other.hash() != world.hash(), change.hashed) << change.field;
        EXPECT_FALSE(other.save() == world.save()) << change.field;
    }
}

TEST_P(Snapshots, TimeRestAndSlotsCount) {
    World world({.precision = GetParam()});
    world.add({.mass = infinite_mass});
    World later = world;
    EXPECT_EQ(later.hash(), world.hash());
    later.step(1e-9);
    EXPECT_NE(later.hash(), world.hash());

    World lying({.gravity = {0, 0, -10}, .region = std::vector<Plane>{{}}, .precision = GetParam()});
    const BodyId id = lying.add({.position = {0, 0, 0.5}, .restitution = 0});
    lying.step(0.01);
    World released = lying;
    released.change_velocities(std::array{id}, std::array{Vec3{}});
    EXPECT_FALSE(released.held(id));
    EXPECT_EQ(released.get(id).position, lying.get(id).position);
    EXPECT_EQ(released.get(id).velocity, lying.get(id).velocity);
    EXPECT_NE(released.hash(), lying.hash());

    World in_slot_0({.precision = GetParam()});
    World in_slot_1({.precision = GetParam()});
    const BodyId first = in_slot_1.add({.position = {5, 0, 0}});
    in_slot_0.add(Body{});
    in_slot_1.add(Body{});
    in_slot_1.remove(first);
    EXPECT_NE(in_slot_0.hash(), in_slot_1.hash());
}

/// The counters of quick impacts are all that tells the two worlds apart: one body has just had an impact.
TEST_P(Snapshots, CollapseCountersCount) {
    World world({.region = std::vector<Plane>{{}}, .precision = GetParam(), .collapse_time = 1});
    const BodyId id = world.add({.position = {0, 0, 1.5}, .velocity = {0, 0, -4}});
    // It comes back to where it was.
    world.step(0.5);
    EXPECT_EQ(world.get(id).position, (Vec3{0, 0, 1.5}));
    EXPECT_EQ(world.get(id).velocity, (Vec3{0, 0, 4}));
    World calm({.region = std::vector<Plane>{{}}, .precision = GetParam(), .collapse_time = 1});
    const BodyId calm_id = calm.add({.position = {0, 0, 1}, .velocity = {0, 0, 1}});
    calm.step(0.5);
    EXPECT_EQ(calm.get(calm_id).position, world.get(id).position);
    calm.set(calm_id, world.get(id));
    EXPECT_NE(calm.hash(), world.hash());
}

TEST_P(Snapshots, TheOrderInMemoryDoesNotCount) {
    std::vector<Vec3> places;
    for (const double x : {0.0, 4.0, 8.0, 12.0}) places.insert(places.end(), {{x, 0, 0}, {x + 2, 0.5, 0}});
    const auto thrown = [&](std::size_t k) {
        return Body{.position = places[k], .velocity = {k % 2 == 0 ? 1.0 : -1.0, 0, 0}, .restitution = 0.5};
    };
    World straight({.precision = GetParam()});
    World shuffled({.precision = GetParam()});
    for (std::size_t k = 0; k < places.size(); ++k) {
        straight.add(thrown(k));
        shuffled.add(thrown(k));
    }
    // Removing a body brings the last one into its place; added again it gets its slot back, but the last place.
    for (const std::size_t k : {1U, 4U, 0U}) {
        shuffled.remove(shuffled.ids()[k]);
        shuffled.add(thrown(k));
    }
    EXPECT_EQ(shuffled.hash(), straight.hash());
    for (int i = 0; i < 40; ++i) {
        straight.step(0.05);
        shuffled.step(0.05);
        EXPECT_EQ(shuffled.hash(), straight.hash()) << i;
    }
    EXPECT_EQ(straight.ledger().impacts, 4U);
    EXPECT_EQ(shuffled.ledger(), straight.ledger());
}

} // namespace

} // namespace carom
