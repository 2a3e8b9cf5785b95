// Snapshots: a loaded world goes on bit for bit, and whatever is not a whole snapshot is refused.

#include "world/checksum.hpp"
#include "world/refusals.hpp"

#include <array>
#include <cstring>
#include <random>

namespace carom {

namespace {

using test::BothPrecisions;

// ---------------------------------------------------------------------------------------------------------------------
// Worlds
// ---------------------------------------------------------------------------------------------------------------------

/// Bodies of many kinds in a cube of 10 m; what would overlap is left out.
void scatter(World& world, int count, bool with_static = true) {
    std::mt19937 random(2010); // NOLINT(cert-msc51-cpp): fixed
    const auto number = [&random](double low, double high) {
        return low + (high - low) * (static_cast<double>(random()) / 4294967296.0);
    };
    for (int k = 0; k < count; ++k) {
        Body body{.position = {number(0.7, 9.3), number(0.7, 9.3), number(0.7, 9.3)},
                  .velocity = {number(-3, 3), number(-3, 3), number(-3, 3)},
                  .mass = number(0.1, 5),
                  .radius = number(0.05, 0.5),
                  .restitution = number(0.3, 1),
                  .friction = number(0, 0.5),
                  .material = static_cast<std::uint32_t>(k % 3),
                  .user_data = random()};
        if (with_static && k % 10 == 0) {
            body.mass = infinite_mass;
            body.velocity = {};
        }
        try {
            world.add(body);
        } catch (const Error& error) {
            EXPECT_EQ(error.code(), ErrorCode::overlap);
        }
    }
}

WorldOptions with_everything(const Region& region) {
    return {.gravity = {0.25, 0, -9.81},
            .region = region,
            .origin = {3, -4, 5},
            .drag = {.linear = 0.01, .quadratic = 0.02},
            .material_rules = {{.a = 0, .b = 1, .restitution = 0.5, .friction = 0.25}},
            .interpolation = true};
}

Box box_with(FaceKind sides) {
    Box box{{0, 0, 0}, {10, 10, 10}};
    for (std::size_t face = 0; face < 4; ++face) box.faces[face].kind = sides;
    box.faces[4].surface = {.restitution = 0.25, .friction = 0.125};
    return box;
}

/// Bodies at rest on a planet whose pull comes from an attractor, with no gravity of the world's own.
World planet_with_rocks(Precision precision) {
    World world({.precision = precision});
    const BodyId planet = world.add({.mass = infinite_mass, .radius = 2, .restitution = 0});
    const BodyId moon = world.add({.position = {6, 0, 0}, .velocity = {0, 1.2, 0}, .radius = 0.2});
    for (const Vec3& place : {Vec3{0, 0, 2.25}, Vec3{0, -2.25, 0}, Vec3{-3, 1, 0}}) {
        world.add({.position = place, .radius = 0.25, .restitution = 0.1, .friction = 0.1});
    }
    world.set_attractors(std::array{Attractor{.strength = 10, .softening = 0.01, .body = planet},
                                    Attractor{.strength = 0.1, .softening = 0.1, .body = moon},
                                    Attractor{.position = {1.0 / 3, 20, 0}, .strength = 0.2}});
    return world;
}

/// Bodies that slide down a slope and around in a bowl.
World slides(Precision precision, bool in_a_shell) {
    WorldOptions options{.gravity = {0, 0, -10}, .precision = precision};
    if (in_a_shell) {
        options.region = Shell{.radius = 5};
    } else {
        options.region = std::vector<Plane>{{.normal = {1, 0, 3}}, {.point = {9, 0, 0}, .normal = {-1, 0.1, 0.2}}};
    }
    World world(options);
    for (int k = 0; k < 4; ++k) {
        const Vec3 place = in_a_shell ? Vec3{3.5 * std::cos(k), 3.5 * std::sin(k), -1} : Vec3{1, 2.0 * k, 2};
        world.add({.position = place, .restitution = 0.25, .friction = 0.1 * (k % 2)});
    }
    return world;
}

/// Sticky bodies on the way to inelastic collapse, and a step that the work cap ended.
World collapse(Precision precision) {
    World world({.precision = precision, .collapse_time = 1e-2, .work_cap = 7});
    for (int k = 0; k < 20; ++k) {
        world.add({.position = {1.001 * k, 0, 0}, .velocity = {k < 10 ? 1.0 : -1.0, 0, 0}, .restitution = 0.1});
    }
    return world;
}

struct Scenario {
    const char* name;
    World (*make)(Precision);
    double dt;
};

World scattered(WorldOptions options, Precision precision) {
    options.precision = precision;
    World world(options);
    scatter(world, 40);
    return world;
}

const std::vector<Scenario> scenarios{
    {"open", [](Precision p) { return scattered(with_everything(OpenSpace{}), p); }, 0.02},
    {"box", [](Precision p) { return scattered(with_everything(box_with(FaceKind::reflecting)), p); }, 0.02},
    {"periodic", [](Precision p) { return scattered(with_everything(box_with(FaceKind::periodic)), p); }, 0.02},
    {"open_sides", [](Precision p) { return scattered(with_everything(box_with(FaceKind::open)), p); }, 0.02},
    {"planes", [](Precision p) { return scattered(with_everything(std::vector<Plane>{{.normal = {0.1, 0, 1}}}), p); },
     0.02},
    {"shell", [](Precision p) { return scattered(with_everything(Shell{{5, 5, 5}, 9.5}), p); }, 0.02},
    {"planet", planet_with_rocks, 0.02},
    {"slope", [](Precision p) { return slides(p, false); }, 0.02},
    {"bowl", [](Precision p) { return slides(p, true); }, 0.02},
    {"collapse", collapse, 0.1},
};

class Snapshots : public ::testing::TestWithParam<std::tuple<std::size_t, Precision>> {
protected:
    [[nodiscard]] static const Scenario& scenario() { return scenarios[std::get<0>(GetParam())]; }
    [[nodiscard]] static World make() { return scenario().make(std::get<1>(GetParam())); }
};

INSTANTIATE_TEST_SUITE_P(Worlds, Snapshots,
                         ::testing::Combine(::testing::Range(std::size_t{0}, scenarios.size()),
                                            test::both_precisions()),
                         [](const auto& test) {
                             return std::string(scenarios[std::get<0>(test.param)].name) + "_" +
                                    test::name_of(std::get<1>(test.param));
                         });

bool same(const Impact& a, const Impact& b) {
    return a.time == b.time && a.offset == b.offset && a.a == b.a && a.b == b.b && a.face == b.face &&
           a.position == b.position && a.normal == b.normal && a.impulse == b.impulse &&
           a.approach_speed == b.approach_speed && a.energy_lost == b.energy_lost;
}

/// Expects that two worlds go on alike, bit for bit.
void expect_same_future(World& a, World& b, int steps, double dt) {
    for (int i = 0; i < steps; ++i) {
        const StepReport& report_a = a.step(dt);
        const StepReport& report_b = b.step(dt);
        ASSERT_EQ(report_a.advanced, report_b.advanced);
        ASSERT_EQ(report_a.tc_conversions, report_b.tc_conversions);
        ASSERT_EQ(a.impacts().size(), b.impacts().size());
        for (std::size_t k = 0; k < a.impacts().size(); ++k) ASSERT_TRUE(same(a.impacts()[k], b.impacts()[k]));
        ASSERT_EQ(a.hash(), b.hash()) << "step " << i;
    }
    EXPECT_TRUE(a.ledger() == b.ledger());
    EXPECT_EQ(a.energy().total(), b.energy().total());
    EXPECT_TRUE(a.save() == b.save());
}

// ---------------------------------------------------------------------------------------------------------------------
// Going on
// ---------------------------------------------------------------------------------------------------------------------

TEST_P(Snapshots, ALoadedWorldGoesOnBitForBit) {
    World world = make();
    for (const int steps_before : {0, 1, 15, 30}) {
        for (int i = 0; i < steps_before; ++i) world.step(scenario().dt);
        const std::vector<std::byte> bytes = world.save();
        World loaded = World::load(bytes);
        EXPECT_EQ(loaded.hash(), world.hash());
        EXPECT_EQ(loaded.time(), world.time());
        EXPECT_EQ(loaded.step_count(), world.step_count());
        EXPECT_TRUE(loaded.save() == bytes);
        expect_same_future(world, loaded, 10, scenario().dt);
    }
}

/// Guards the test above: each scenario has what it is there for.
TEST_P(Snapshots, TheScenarioIsWhatItSays) {
    World world = make();
    std::uint64_t impacts = 0;
    std::uint64_t conversions = 0;
    std::uint64_t most_held = 0;
    bool capped = false;
    for (int i = 0; i < 70; ++i) {
        const StepReport& report = world.step(scenario().dt);
        impacts += report.impacts;
        conversions += report.tc_conversions;
        most_held = std::max(most_held, report.held);
        capped = capped || report.work_cap_reached;
    }
    const std::string name = scenario().name;
    const auto is_one_of = [&name](std::initializer_list<const char*> names) {
        return std::find(names.begin(), names.end(), name) != names.end();
    };
    if (!is_one_of({"slope", "bowl", "planet"})) {
        EXPECT_GT(impacts, 10U);
    }
    if (is_one_of({"box", "planes", "planet", "slope", "bowl"})) {
        EXPECT_GT(most_held, 0U);
    }
    EXPECT_EQ(conversions > 0, name == "collapse");
    EXPECT_EQ(capped, name == "collapse");
}

TEST_P(Snapshots, IdsStayValidAndTheNextOnesAreTheSame) {
    World world = make();
    const std::vector<BodyId> before = world.ids();
    world.remove(std::array{before[2], before[1]});
    World loaded = World::load(world.save());
    EXPECT_EQ(loaded.ids(), world.ids());
    EXPECT_FALSE(loaded.contains(before[1]));
    for (const BodyId id : world.ids()) {
        ASSERT_TRUE(loaded.contains(id));
        const Body a = world.get(id);
        const Body b = loaded.get(id);
        EXPECT_EQ(a.position, b.position);
        EXPECT_EQ(a.user_data, b.user_data);
        EXPECT_EQ(a.material, b.material);
        EXPECT_EQ(loaded.held(id), world.held(id));
    }
    for (int i = 0; i < 3; ++i) {
        const Body body{.position = {4, 4, 2}};
        EXPECT_EQ(world.add(body, Overlap::accept), loaded.add(body, Overlap::accept));
    }
    expect_same_future(world, loaded, 5, scenario().dt);
    World other;
    EXPECT_FALSE(other.contains(before[0]));
}

TEST_P(Snapshots, OptionsAndSurroundingsAreKept) {
    World world = make();
    world.set_recording(true, 0.125);
    world.set_min_windows(3);
    const World loaded = World::load(world.save());
    const WorldOptions& a = world.options();
    const WorldOptions& b = loaded.options();
    EXPECT_EQ(a.gravity, b.gravity);
    EXPECT_EQ(a.region.index(), b.region.index());
    EXPECT_EQ(a.origin, b.origin);
    EXPECT_EQ(a.drag.quadratic, b.drag.quadratic);
    EXPECT_EQ(a.material_rules.size(), b.material_rules.size());
    EXPECT_EQ(a.work_cap, b.work_cap);
    EXPECT_EQ(b.min_windows, 3U);
    EXPECT_EQ(b.least_recorded_impulse, 0.125);
    EXPECT_EQ(a.interpolation, b.interpolation);
    EXPECT_EQ(world.resolution(), loaded.resolution());
    ASSERT_EQ(world.attractors().size(), loaded.attractors().size());
    for (std::size_t k = 0; k < world.attractors().size(); ++k) {
        EXPECT_EQ(world.attractors()[k].position, loaded.attractors()[k].position);
        EXPECT_EQ(world.attractors()[k].body, loaded.attractors()[k].body);
    }
}

TEST_P(Snapshots, AWorldWhoseOriginWasMovedGoesOn) {
    World world = make();
    world.step(scenario().dt);
    world.set_origin({1'000'000, -77, 12});
    World loaded = World::load(world.save());
    EXPECT_EQ(loaded.get(loaded.ids().back()).position, world.get(world.ids().back()).position);
    expect_same_future(world, loaded, 20, scenario().dt);
}

TEST_P(Snapshots, DrawingGoesOn) {
    World world = make();
    if (!world.options().interpolation) return;
    const double start = world.time();
    world.step(scenario().dt);
    const World loaded = World::load(world.save());
    const std::vector<BodyId> ids = world.ids();
    std::vector<Vec3> a(ids.size());
    std::vector<Vec3> b(ids.size());
    for (const double part : {0.0, 0.3, 1.0}) {
        const double time = start + part * (world.time() - start);
        world.positions_at(time, ids, a);
        loaded.positions_at(time, ids, b);
        EXPECT_TRUE(a == b);
    }
}

TEST_P(Snapshots, ACopyIsIndependent) {
    World world = make();
    for (int i = 0; i < 10; ++i) world.step(scenario().dt);
    const std::vector<std::byte> bytes = world.save();
    const std::uint64_t hash = world.hash();
    World copy = world;
    EXPECT_TRUE(copy.save() == bytes);
    EXPECT_EQ(copy.ids(), world.ids());
    for (int i = 0; i < 10; ++i) copy.step(scenario().dt);
    copy.remove(copy.ids().front());
    copy.set_gravity({1, 2, 3});
    EXPECT_TRUE(world.save() == bytes);
    EXPECT_EQ(world.hash(), hash);
    World assigned;
    assigned.add(Body{});
    assigned = world;
    expect_same_future(world, assigned, 20, scenario().dt);
    World& itself = assigned;
    assigned = itself;
    EXPECT_EQ(assigned.hash(), world.hash());
    const World moved = std::move(assigned);
    EXPECT_EQ(moved.hash(), world.hash());
}

TEST(SnapshotHash, SeesWhatMovesAndNothingElse) {
    const auto hash_of = [](const std::function<void(World&, BodyId)>& act) {
        World world({.gravity = {0, 0, -10}, .region = std::vector<Plane>{{}}});
        const BodyId id = world.add({.position = {0, 0, 4}, .restitution = 0});
        world.add({.position = {0, 0, 2}, .restitution = 0});
        act(world, id);
        return world.hash();
    };
    const std::uint64_t plain = hash_of([](World&, BodyId) {});
    EXPECT_EQ(plain, hash_of([](World& w, BodyId id) { w.set(std::array{id}, {.user_data = std::array{std::uint64_t{7}}}); }));
    EXPECT_EQ(plain, hash_of([](World& w, BodyId) { w.set_origin({5, 0, 0}); }));
    EXPECT_NE(plain, hash_of([](World& w, BodyId id) { w.set(std::array{id}, {.position = std::array{Vec3{0, 0, 4 + 1e-12}}}); }));
    EXPECT_NE(plain, hash_of([](World& w, BodyId id) { w.change_velocities(std::array{id}, std::array{Vec3{0, 0, 1e-15}}); }));
    EXPECT_NE(plain, hash_of([](World& w, BodyId id) { w.remove(id); }));
    EXPECT_NE(plain, hash_of([](World& w, BodyId) { w.step(1e-12); }));
}

// ---------------------------------------------------------------------------------------------------------------------
// What is no snapshot
// ---------------------------------------------------------------------------------------------------------------------

/// Where things are in the frame of a snapshot: magic, version, size and checksum of what follows.
constexpr std::size_t version_at = 8;
constexpr std::size_t size_at = 12;
constexpr std::size_t checksum_at = 20;
constexpr std::size_t payload_at = 28;

class BadSnapshots : public BothPrecisions {
protected:
    test::FurnishedWorld furnished_{GetParam()};
    std::vector<std::byte> bytes_ = furnished_.world.save();
};

INSTANTIATE_TEST_SUITE_P(Precisions, BadSnapshots, test::both_precisions(), test::precision_name);

void expect_bad_data(std::span<const std::byte> bytes, const std::string& what, const std::string& message) {
    try {
        World::load(bytes);
        ADD_FAILURE() << what << ": not refused";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::bad_data) << what << ": " << error.what();
        EXPECT_EQ(error.field(), "snapshot");
        EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << what << ": " << error.what();
    }
}

TEST_P(BadSnapshots, EveryTruncationIsRefused) {
    for (std::size_t length = 0; length < bytes_.size(); ++length) {
        expect_bad_data(std::span(bytes_).first(length), std::to_string(length) + " bytes", "ends too early");
    }
}

TEST_P(BadSnapshots, EveryAlteredByteIsRefused) {
    for (std::size_t at = 0; at < bytes_.size(); ++at) {
        for (const std::byte flip : {std::byte{0x01}, std::byte{0x80}, std::byte{0xff}}) {
            bytes_[at] ^= flip;
            const char* const message = at < version_at    ? "is no snapshot of carom"
                                        : at < size_at     ? "has format version"
                                        : at < checksum_at ? "" // longer or shorter
                                                           : "was altered";
            expect_bad_data(bytes_, "byte " + std::to_string(at), message);
            bytes_[at] ^= flip;
        }
    }
    EXPECT_EQ(World::load(bytes_).hash(), furnished_.world.hash());
}

TEST_P(BadSnapshots, AppendedBytesAreRefused) {
    for (const std::size_t more : {1U, 7U, 1000U}) {
        std::vector<std::byte> longer = bytes_;
        longer.resize(bytes_.size() + more);
        expect_bad_data(longer, "appended", "has bytes after its end");
    }
    std::vector<std::byte> twice = bytes_;
    twice.insert(twice.end(), bytes_.begin(), bytes_.end());
    expect_bad_data(twice, "twice", "has bytes after its end");
}

TEST_P(BadSnapshots, ForeignFilesAreRefused) {
    const std::string text = "[world]\ngravity = [0, 0, -9.81]  # a scene is no snapshot, however long it may be\n";
    expect_bad_data(std::as_bytes(std::span(text)), "a text", "is no snapshot of carom");
    expect_bad_data(std::vector<std::byte>(5000), "zeros", "is no snapshot of carom");
    expect_bad_data({}, "nothing", "ends too early");
}

/// Overwrites bytes of the payload and makes the checksum right again.
class Forger {
public:
    explicit Forger(std::vector<std::byte> bytes) : bytes_(std::move(bytes)) {}

    void overwrite(std::size_t at, std::uint64_t value, std::size_t length) {
        for (std::size_t k = 0; k < length; ++k) bytes_[at + k] = static_cast<std::byte>(value >> (8 * k));
    }
    std::span<const std::byte> signed_bytes() {
        core::Checksum sum;
        sum.add(std::span(bytes_).subspan(payload_at));
        overwrite(checksum_at, sum.value(), 8);
        return bytes_;
    }
    [[nodiscard]] std::size_t size() const { return bytes_.size(); }
    [[nodiscard]] std::byte at(std::size_t at) const { return bytes_[at]; }

private:
    std::vector<std::byte> bytes_;
};

/// Loads, and if that works uses the world: errors are fine, crashes and hangs are not.
bool is_refused(std::span<const std::byte> bytes) {
    try {
        World world = World::load(bytes);
        static_cast<void>(world.hash());
        static_cast<void>(world.energy());
        if (world.options().min_windows < 100) {
            world.set_work_cap(100);
            world.step(1e-3);
        }
        for (const BodyId id : world.ids()) static_cast<void>(world.get(id));
        world.remove(world.ids());
        EXPECT_EQ(world.size(), 0U);
        return false;
    } catch (const Error& error) {
        return error.code() == ErrorCode::bad_data;
    }
}

TEST_P(BadSnapshots, ForgedOnesDoNoHarm) {
    Forger forger(bytes_);
    std::size_t refused = 0;
    for (std::size_t at = payload_at; at < forger.size(); ++at) {
        const auto original = static_cast<std::uint64_t>(forger.at(at));
        for (const std::uint64_t value : {original ^ 1U, original ^ 0x80U, original ^ 0xffU, std::uint64_t{0x7f}}) {
            forger.overwrite(at, value, 1);
            if (is_refused(forger.signed_bytes())) ++refused;
        }
        forger.overwrite(at, original, 1);
    }
    EXPECT_GT(refused, forger.size() / 2);
    EXPECT_FALSE(is_refused(forger.signed_bytes()));
}

/// Whatever stands where a length may stand: nothing is allocated for what is not there.
TEST_P(BadSnapshots, HugeClaimsAreRefused) {
    for (const std::uint64_t size : {std::uint64_t{1} << 40U, ~std::uint64_t{0}}) {
        Forger forger(bytes_);
        forger.overwrite(size_at, size, 8);
        expect_bad_data(forger.signed_bytes(), "size", "ends too early");
    }
    for (std::size_t at = payload_at; at + 8 <= bytes_.size(); ++at) {
        for (const std::uint64_t value : {std::uint64_t{1} << 60U, ~std::uint64_t{0}}) {
            Forger forger(bytes_);
            forger.overwrite(at, value, 8);
            is_refused(forger.signed_bytes());
        }
    }
}

} // namespace

} // namespace carom
