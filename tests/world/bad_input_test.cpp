// Whatever is wrong with a call, it is refused with an error that names it, and nothing has changed.

#include "world/refusals.hpp"

#include <array>
#include <span>

namespace carom {

namespace {

using test::denormal;
using test::expect_error;
using test::expect_refused;
using test::FurnishedWorld;
using test::infinity;
using test::not_a_number;
using test::Refusal;

/// A body with one bad value, and what is wrong with it.
struct BadBody {
    std::string what;
    Refusal refusal;
    Body body;
};

/// Puts bad values into one number of a body.
class BadBodies {
public:
    void add(const char* field, double& number, double value, ErrorCode code) {
        const double good = number;
        number = value;
        bodies_.push_back({std::string(field) + " = " + std::to_string(value), {code, field, 0}, body_});
        number = good;
    }
    void add_not_finite(const char* field, double& number) {
        for (const double value : {not_a_number, infinity, -infinity}) {
            add(field, number, value, ErrorCode::not_finite);
        }
    }
    void add_out_of_range(const char* field, double& number, std::initializer_list<double> values) {
        for (const double value : values) add(field, number, value, ErrorCode::out_of_range);
    }

    Body& body() { return body_; }
    std::vector<BadBody> take() { return std::move(bodies_); }

private:
    Body body_{.position = {15, 15, 15}};
    std::vector<BadBody> bodies_;
};

std::vector<BadBody> bad_bodies(bool is_single) {
    BadBodies bad;
    Body& b = bad.body();
    for (double* x : {&b.position.x, &b.position.y, &b.position.z}) {
        bad.add_not_finite("position", *x);
        for (const double far : {1e13, -1e13, 1e300, -1e300}) bad.add("position", *x, far, ErrorCode::out_of_world);
        bad.add("position", *x, 19.6, ErrorCode::overlap);
        bad.add("position", *x, -0.5, ErrorCode::overlap);
    }
    for (double* v : {&b.velocity.x, &b.velocity.y, &b.velocity.z}) {
        bad.add_not_finite("velocity", *v);
        if (is_single) bad.add_out_of_range("velocity", *v, {1e39, -1e300});
    }
    bad.add("mass", b.mass, not_a_number, ErrorCode::not_finite);
    bad.add_out_of_range("mass", b.mass, {0, -0.0, -1, -denormal, -1e300, -infinity});
    if (is_single) bad.add_out_of_range("mass", b.mass, {1e39, 1e-46, denormal});
    bad.add_not_finite("radius", b.radius);
    bad.add_out_of_range("radius", b.radius, {-1, -denormal, -1e300, 1e13, 1e300});
    if (is_single) bad.add_out_of_range("radius", b.radius, {1e39, 1e-46, denormal});
    bad.add_not_finite("growth", b.growth);
    bad.add_not_finite("restitution", b.restitution);
    bad.add_out_of_range("restitution", b.restitution, {-denormal, -1, std::nextafter(1.0, 2.0), 1e300});
    bad.add_not_finite("friction", b.friction);
    bad.add_out_of_range("friction", b.friction, {-denormal, -1, -1e300});
    if (is_single) bad.add_out_of_range("friction", b.friction, {1e39, 1e-46, denormal});
    return bad.take();
}

/// The same values as columns.
struct Table {
    std::vector<Vec3> position, velocity;
    std::vector<double> mass, radius, growth, restitution, friction;
    std::vector<std::uint32_t> material;
    std::vector<std::uint64_t> user_data;

    void append(const Body& body) {
        position.push_back(body.position);
        velocity.push_back(body.velocity);
        mass.push_back(body.mass);
        radius.push_back(body.radius);
        growth.push_back(body.growth);
        restitution.push_back(body.restitution);
        friction.push_back(body.friction);
        material.push_back(body.material);
        user_data.push_back(body.user_data);
    }
    [[nodiscard]] ConstBodyColumns columns() const {
        return {position, velocity, mass, radius, restitution, friction, material, user_data, growth};
    }
    [[nodiscard]] BodyColumns columns() {
        return {position, velocity, mass, radius, restitution, friction, material, user_data, growth};
    }
};

/// Two good bodies, and the given one last.
Table table_ending_with(const Body& last) {
    Table table;
    table.append({.position = {5, 15, 15}});
    table.append({.position = {10, 15, 15}});
    table.append(last);
    return table;
}

class BadInput : public test::BothPrecisions {
protected:
    FurnishedWorld furnished_{GetParam()};
    World& world_ = furnished_.world;
    const std::vector<BodyId>& movers_ = furnished_.movers;
};

INSTANTIATE_TEST_SUITE_P(Precisions, BadInput, test::both_precisions(), test::precision_name);

TEST_P(BadInput, OneBodyIsNotAdded) {
    for (const BadBody& bad : bad_bodies(is_single())) {
        expect_refused(world_, bad.refusal, bad.what, [&](World& world) { world.add(bad.body); });
    }
}

TEST_P(BadInput, OneBodyIsNotSet) {
    for (const BadBody& bad : bad_bodies(is_single())) {
        expect_refused(world_, bad.refusal, bad.what, [&](World& world) { world.set(movers_[0], bad.body); });
    }
}

TEST_P(BadInput, TheLastOfManyBodiesSpoilsTheCall) {
    const std::array<BodyId, 3> ids{movers_[1], movers_[3], movers_[0]};
    for (const BadBody& bad : bad_bodies(is_single())) {
        const Table table = table_ending_with(bad.body);
        const Refusal refusal{bad.refusal.code, bad.refusal.field, 2};
        expect_refused(world_, refusal, bad.what, [&](World& world) { world.add(table.columns()); });
        expect_refused(world_, refusal, bad.what, [&](World& world) { world.set(ids, table.columns()); });
    }
}

/// Only values: where a body may be is another matter.
TEST_P(BadInput, AcceptedOverlapExcusesNothingElse) {
    for (const BadBody& bad : bad_bodies(is_single())) {
        if (bad.refusal.code == ErrorCode::overlap) continue;
        expect_refused(world_, bad.refusal, bad.what, [&](World& world) { world.add(bad.body, Overlap::accept); });
        expect_refused(world_, bad.refusal, bad.what,
                       [&](World& world) { world.set(movers_[0], bad.body, Overlap::accept); });
    }
}

TEST_P(BadInput, AColumnOnItsOwnIsChecked) {
    const std::array<BodyId, 2> ids{movers_[0], movers_[1]};
    const std::array<double, 2> numbers{1, -1};
    const std::array<Vec3, 2> vectors{Vec3{5, 5, 15}, Vec3{15, not_a_number, 15}};
    const auto refuse = [&](ErrorCode code, const char* field, const ConstBodyColumns& columns) {
        expect_refused(world_, {code, field, 1}, field, [&](World& world) { world.set(ids, columns); });
    };
    refuse(ErrorCode::not_finite, "position", {.position = vectors});
    refuse(ErrorCode::not_finite, "velocity", {.velocity = vectors});
    refuse(ErrorCode::out_of_range, "mass", {.mass = numbers});
    refuse(ErrorCode::out_of_range, "radius", {.radius = numbers});
    refuse(ErrorCode::out_of_range, "restitution", {.restitution = numbers});
    refuse(ErrorCode::out_of_range, "friction", {.friction = numbers});
}

TEST_P(BadInput, ColumnsOfDifferentLengths) {
    const auto shorten = [](Table& table, std::size_t column) {
        std::size_t k = 0;
        const auto pop = [&](auto& values) {
            if (k++ == column) values.pop_back();
        };
        pop(table.velocity), pop(table.mass), pop(table.radius), pop(table.restitution), pop(table.friction);
        pop(table.material), pop(table.user_data), pop(table.position);
    };
    const std::array<const char*, 8> fields{"velocity", "mass",     "radius",    "restitution",
                                            "friction", "material", "user_data", "position"};
    const std::array<BodyId, 3> ids{movers_[0], movers_[1], movers_[2]};
    for (std::size_t column = 0; column < fields.size(); ++column) {
        Table table = table_ending_with({.position = {15, 15, 15}});
        shorten(table, column);
        const ConstBodyColumns input = std::as_const(table).columns();
        const Refusal refusal{ErrorCode::size_mismatch, fields[column]};
        expect_refused(world_, refusal, "set", [&](World& world) { world.set(ids, input); });
        expect_refused(world_, refusal, "get", [&](World& world) { world.get(ids, table.columns()); });
        // How many are added is what the positions say: without the last of them the others are too long.
        const Refusal at_adding{ErrorCode::size_mismatch, column == 7 ? "velocity" : fields[column]};
        expect_refused(world_, at_adding, "add", [&](World& world) { world.add(input); });
    }
    Table table = table_ending_with({});
    table.position.clear();
    expect_refused(world_, {ErrorCode::size_mismatch, "velocity"}, "no positions",
                   [&](World& world) { world.add(std::as_const(table).columns()); });
}

TEST_P(BadInput, IdsThatNameNothingHere) {
    const World copy = world_;
    World other;
    const std::vector<std::pair<const char*, BodyId>> bad_ids{
        {"default", BodyId{}},
        {"stale", furnished_.removed},
        {"of another world", other.add(Body{})},
        {"never given out", BodyId{1000, 0, movers_[0].world}},
        {"of a later generation", BodyId{movers_[0].slot, 1, movers_[0].world}},
    };
    const std::array<Vec3, 3> vectors{};
    std::array<Vec3, 3> out{};
    const double now = world_.time();
    for (const auto& [what, bad] : bad_ids) {
        const std::array<BodyId, 3> ids{movers_[0], movers_[1], bad};
        const std::array<Attractor, 3> attractors{Attractor{}, Attractor{}, Attractor{.body = bad}};
        EXPECT_FALSE(world_.contains(bad)) << what;
        const Refusal last{ErrorCode::unknown_body, "id", 2};
        const Refusal only{ErrorCode::unknown_body, "id", 0};
        const auto refuse = [&, name = what](const Refusal& refusal, const std::function<void(World&)>& call) {
            expect_refused(world_, refusal, name, call);
        };
        refuse(last, [&](World& world) { world.get(ids, {.position = out}); });
        refuse(last, [&](World& world) { world.set(ids, {.velocity = vectors}); });
        refuse(last, [&](World& world) { world.remove(ids); });
        refuse(last, [&](World& world) { world.apply_impulses(ids, vectors); });
        refuse(last, [&](World& world) { world.change_velocities(ids, vectors); });
        refuse(last, [&](World& world) { world.positions_at(now, ids, out); });
        refuse(only, [id = bad](World& world) { static_cast<void>(world.get(id)); });
        refuse(only, [id = bad](World& world) { world.set(id, Body{}); });
        refuse(only, [id = bad](World& world) { world.remove(id); });
        refuse({ErrorCode::unknown_body, "id"}, [id = bad](World& world) { static_cast<void>(world.held(id)); });
        if (!bad.is_set()) continue; // an attractor that no body carries
        refuse({ErrorCode::unknown_body, "attractor.body", 2}, [&](World& world) { world.set_attractors(attractors); });
    }
}

TEST_P(BadInput, ABodyIsRemovedOnce) {
    const std::array<BodyId, 3> twice{movers_[0], movers_[1], movers_[0]};
    expect_refused(world_, {ErrorCode::unknown_body, "id", 2}, "removed twice",
                   [&](World& world) { world.remove(twice); });
}

TEST_P(BadInput, ImpulsesAndVelocityChanges) {
    const std::array<BodyId, 2> ids{movers_[0], movers_[1]};
    const std::array<BodyId, 2> with_static{movers_[0], furnished_.fixed};
    const std::array<Vec3, 2> good{};
    const std::array<Vec3, 1> few{};
    const double too_much = is_single() ? 3e38 : 1.7e308;
    const std::array<BodyId, 3> thrice{movers_[0], movers_[0], movers_[0]};
    const std::array<Vec3, 3> sum_too_large{Vec3{too_much, 0, 0}, Vec3{too_much, 0, 0}, Vec3{}};
    using Change = void (World::*)(std::span<const BodyId>, std::span<const Vec3>);
    for (const auto& [field, change] : {std::pair<const char*, Change>{"impulses", &World::apply_impulses},
                                        std::pair<const char*, Change>{"changes", &World::change_velocities}}) {
        const auto refuse = [&, call = change](const Refusal& refusal, std::span<const BodyId> of,
                                               std::span<const Vec3> by) {
            expect_refused(world_, refusal, refusal.field, [&](World& world) { (world.*call)(of, by); });
        };
        for (const double value : {not_a_number, infinity, -infinity}) {
            const std::array<Vec3, 2> bad{Vec3{}, Vec3{0, value, 0}};
            refuse({ErrorCode::not_finite, field, 1}, ids, bad);
        }
        refuse({ErrorCode::size_mismatch, field}, ids, few);
        refuse({ErrorCode::out_of_range, "id", 1}, with_static, good);
        refuse({ErrorCode::out_of_range, field, 1}, thrice, sum_too_large);
    }
}

TEST_P(BadInput, Time) {
    const double now = world_.time();
    const auto refuse = [&](ErrorCode code, const char* field, const std::function<void(World&)>& call) {
        expect_refused(world_, {code, field}, field, call);
    };
    for (const double dt : {not_a_number, infinity, -infinity}) {
        refuse(ErrorCode::not_finite, "dt", [dt](World& world) { world.step(dt); });
        refuse(ErrorCode::not_finite, "time", [dt](World& world) { world.step_until(dt); });
    }
    for (const double dt : {0.0, -0.0, -1.0, -denormal, 1e300}) {
        refuse(ErrorCode::out_of_range, "dt", [dt](World& world) { world.step(dt); });
    }
    for (const double time : {now, std::nextafter(now, 0.0), 0.0, -1.0, -1e300}) {
        refuse(ErrorCode::out_of_range, "time", [time](World& world) { world.step_until(time); });
    }
    refuse(ErrorCode::not_finite, "max_dt", [&](World& world) { world.step_until(now + 1, not_a_number); });
    for (const double max_dt : {0.0, -1.0, -infinity}) {
        refuse(ErrorCode::out_of_range, "max_dt", [&](World& world) { world.step_until(now + 1, max_dt); });
    }
}

TEST_P(BadInput, InterpolatedPositions) {
    const double now = world_.time();
    std::array<Vec3, 2> out{};
    const std::span<const BodyId> two(movers_.data(), 2);
    const auto refuse = [&](const Refusal& refusal, double time, std::span<const BodyId> ids) {
        expect_refused(world_, refusal, "positions_at " + std::to_string(time),
                       [&](World& world) { world.positions_at(time, ids, out); });
    };
    refuse({ErrorCode::not_finite, "time"}, not_a_number, two);
    refuse({ErrorCode::not_finite, "time"}, infinity, two);
    for (const double time : {now + 1e-9, now - 0.0100001, -1.0, 0.0, 1e300}) {
        refuse({ErrorCode::out_of_range, "time"}, time, two);
    }
    refuse({ErrorCode::size_mismatch, "positions"}, now, std::span(movers_.data(), 1));
    World without{{.precision = GetParam()}};
    expect_refused(without, {ErrorCode::not_available, "interpolation"}, "not asked for",
                   [](World& world) { world.positions_at(0, {}, {}); });
}

TEST_P(BadInput, ChangesOfContactsThatAreNotRecorded) {
    expect_refused(world_, {ErrorCode::not_available, "record_contacts"}, "not asked for",
                   [](World& world) { (void)world.contact_changes(); });
    const World recording({.precision = GetParam(), .record_contacts = true});
    EXPECT_TRUE(recording.contact_changes().empty());
}

TEST_P(BadInput, Surroundings) {
    const auto refuse = [&](const Refusal& refusal, const std::function<void(World&)>& call) {
        expect_refused(world_, refusal, refusal.field, call);
    };
    for (const double value : {not_a_number, infinity, -infinity}) {
        refuse({ErrorCode::not_finite, "gravity"}, [=](World& world) { world.set_gravity({0, value, 0}); });
        refuse({ErrorCode::not_finite, "drag.linear"}, [=](World& world) { world.set_drag({.linear = value}); });
        refuse({ErrorCode::not_finite, "drag.quadratic"}, [=](World& world) { world.set_drag({.quadratic = value}); });
        refuse({ErrorCode::not_finite, "least_recorded_impulse"},
               [=](World& world) { world.set_recording(false, value); });
        refuse({ErrorCode::not_finite, "about"},
               [=](World& world) { static_cast<void>(world.angular_momentum({0, 0, value})); });
        const auto refuse_attractor = [&](const char* field, const Attractor& attractor) {
            const std::array<Attractor, 2> list{Attractor{}, attractor};
            refuse({ErrorCode::not_finite, field, 1}, [&](World& world) { world.set_attractors(list); });
        };
        refuse_attractor("attractor.position", {.position = {value, 0, 0}});
        refuse_attractor("attractor.strength", {.strength = value});
        refuse_attractor("attractor.softening", {.softening = value});
    }
    refuse({ErrorCode::out_of_range, "drag.linear"}, [](World& world) { world.set_drag({.linear = -1}); });
    refuse({ErrorCode::out_of_range, "drag.quadratic"}, [](World& world) { world.set_drag({.quadratic = -denormal}); });
    refuse({ErrorCode::out_of_range, "least_recorded_impulse"}, [](World& world) { world.set_recording(true, -1); });
    for (const std::uint32_t windows : {0U, 1'000'001U, 0xffffffffU}) {
        refuse({ErrorCode::out_of_range, "min_windows"}, [=](World& world) { world.set_min_windows(windows); });
    }
    const std::array<Attractor, 1> negative{Attractor{.softening = -1}};
    refuse({ErrorCode::out_of_range, "attractor.softening", 0}, [&](World& world) { world.set_attractors(negative); });
    const std::array<Attractor, 1> far{Attractor{.position = {0, 0, -1e13}}};
    refuse({ErrorCode::out_of_world, "attractor.position", 0}, [&](World& world) { world.set_attractors(far); });
    constexpr std::int64_t farthest = std::numeric_limits<std::int64_t>::max();
    for (const std::int64_t origin : {farthest, -farthest, std::int64_t{10'000'000'000'000}}) {
        refuse({ErrorCode::out_of_world, "origin", 1}, [=](World& world) { world.set_origin({0, origin, 0}); });
    }
}

// ---------------------------------------------------------------------------------------------------------------------
// Options
// ---------------------------------------------------------------------------------------------------------------------

void expect_no_world(const Refusal& refusal, const WorldOptions& options, double value) {
    for (const Precision precision : {Precision::single_precision, Precision::double_precision}) {
        WorldOptions tried = options;
        if (refusal.field != "precision") tried.precision = precision;
        const std::string what = refusal.field + " = " + std::to_string(value) + ", " + test::name_of(precision);
        expect_error(refusal, what, [&] { const World world(tried); });
    }
}

/// Tries bad values of one number of the options.
struct BadOption {
    const char* field;
    WorldOptions (*with)(double value);
    std::vector<double> out_of_range;
    bool may_be_infinite = false;
    std::size_t index = Error::no_index;
};

TEST(BadOptions, Numbers) {
    const double beyond = std::nextafter(1.0, 2.0);
    const std::vector<BadOption> table{
        {"gravity", [](double v) { return WorldOptions{.gravity = {v, 0, 0}}; }, {}},
        {"gravity", [](double v) { return WorldOptions{.gravity = {0, 0, v}}; }, {}},
        {"resolution",
         [](double v) { return WorldOptions{.resolution = v}; },
         {-1, 3, 0.1, 0x1p-101, 0x1p41, denormal, 1e300}},
        {"drag.linear", [](double v) { return WorldOptions{.drag = {.linear = v}}; }, {-1, -denormal}},
        {"drag.quadratic", [](double v) { return WorldOptions{.drag = {.quadratic = v}}; }, {-1, -denormal}},
        {"rest_time", [](double v) { return WorldOptions{.rest_time = v}; }, {0, -1}},
        {"collapse_time", [](double v) { return WorldOptions{.collapse_time = v}; }, {0, -1}},
        {"least_recorded_impulse", [](double v) { return WorldOptions{.least_recorded_impulse = v}; }, {-1}},
        {"material_rules.restitution",
         [](double v) { return WorldOptions{.material_rules = {{}, {.restitution = v}}}; },
         {-denormal, beyond},
         false,
         1},
        {"materials.restitution.restitution",
         [](double v) { return WorldOptions{.materials = {{.restitution = carom::PowerLaw{v, 1, 1}}}}; },
         {0, -denormal, beyond},
         false,
         0},
        {"materials.restitution.speed",
         [](double v) { return WorldOptions{.materials = {{.restitution = carom::PowerLaw{1, v, 1}}}}; },
         {0, -1},
         false,
         0},
        {"materials.restitution.exponent",
         [](double v) { return WorldOptions{.materials = {{}, {.key = 1, .restitution = carom::PowerLaw{1, 1, v}}}}; },
         {-denormal},
         false,
         1},
        {"materials.restitution.dissipation",
         [](double v) { return WorldOptions{.materials = {{.restitution = carom::Viscoelastic{v, 1}}}}; },
         {-1},
         false,
         0},
        {"materials.restitution.modulus",
         [](double v) { return WorldOptions{.materials = {{.restitution = carom::Viscoelastic{1, v}}}}; },
         {-1},
         false,
         0},
        {"material_rules.law.modulus",
         [](double v) { return WorldOptions{.material_rules = {{.law = carom::Viscoelastic{1, v}}}}; },
         {-1},
         false,
         0},
        {"material_rules.friction",
         [](double v) { return WorldOptions{.material_rules = {{.friction = v}}}; },
         {-1},
         false,
         0},
    };
    for (const BadOption& option : table) {
        for (const double value : {not_a_number, infinity, -infinity}) {
            expect_no_world({ErrorCode::not_finite, option.field, option.index}, option.with(value), value);
        }
        for (const double value : option.out_of_range) {
            expect_no_world({ErrorCode::out_of_range, option.field, option.index}, option.with(value), value);
        }
    }
}

TEST(BadOptions, Regions) {
    const Box unit{{0, 0, 0}, {1, 1, 1}};
    for (const double value : {not_a_number, infinity, -infinity}) {
        const auto refuse = [value](const char* field, const Region& region, std::size_t index = Error::no_index) {
            expect_no_world({ErrorCode::not_finite, field, index}, {.region = region}, value);
        };
        refuse("region.min", Box{{0, value, 0}, {1, 1, 1}});
        refuse("region.max", Box{{0, 0, 0}, {1, 1, value}});
        refuse("region.centre", Shell{.centre = {value, 0, 0}});
        refuse("region.radius", Shell{.radius = value});
        refuse("region.point", std::vector<Plane>{{}, {.point = {0, value, 0}}}, 1);
        refuse("region.normal", std::vector<Plane>{{}, {.normal = {0, value, 0}}}, 1);
        refuse("region.surface.restitution", Shell{.surface = {.restitution = value}});
        refuse("region.surface.friction", std::vector<Plane>{{.surface = {.friction = value}}}, 0);
        Box box = unit;
        box.faces[4].surface.friction = value;
        refuse("region.faces.friction", box, 4);
    }
    const auto refuse = [](const char* field, const Region& region, std::size_t index = Error::no_index) {
        expect_no_world({ErrorCode::out_of_range, field, index}, {.region = region}, 0);
    };
    for (const Vec3& max : {Vec3{0, 1, 1}, Vec3{1, -1, 1}, Vec3{1, 1, 0}}) {
        refuse("region.max", Box{{0, 0, 0}, max});
    }
    for (const double radius : {0.0, -1.0, 1e13}) refuse("region.radius", Shell{.radius = radius});
    refuse("region.normal", std::vector<Plane>{{}, {}, {.normal = {0, 0, 0}}}, 2);
    refuse("region.planes", std::vector<Plane>(65));
    refuse("region.surface.restitution", Shell{.surface = {.restitution = -1}});
    refuse("region.surface.friction", Shell{.surface = {.friction = -1}});
    for (std::size_t face = 0; face < 6; ++face) {
        Box box = unit;
        box.faces[face].surface.restitution = 1.5;
        refuse("region.faces.restitution", box, face);
        box = unit;
        box.faces[face].kind = FaceKind::periodic;
        refuse("region.faces", box, face % 2 == 0 ? face + 1 : face - 1);
        box = unit;
        box.faces[face].kind = static_cast<FaceKind>(7);
        refuse("region.faces", box, face);
    }
}

TEST(BadOptions, OutsideTheWorld) {
    const auto refuse = [](const char* field, const WorldOptions& options, std::size_t index = Error::no_index) {
        expect_no_world({ErrorCode::out_of_world, field, index}, options, 0);
    };
    refuse("region.min", {.region = Box{{-1e13, 0, 0}, {1, 1, 1}}});
    refuse("region.max", {.region = Box{{0, 0, 0}, {1, 1e300, 1}}});
    refuse("region.centre", {.region = Shell{.centre = {0, -1e13, 0}}});
    refuse("region.point", {.region = std::vector<Plane>{{.point = {0, 0, 1e13}}}}, 0);
    refuse("origin", {.origin = {0, 0, 10'000'000'000'000}}, 2);
    refuse("origin", {.origin = {std::numeric_limits<std::int64_t>::min(), 0, 0}}, 0);
}

TEST(BadOptions, TheRest) {
    expect_no_world({ErrorCode::out_of_range, "materials.key", 1}, {.materials = {{.key = 7}, {.key = 7}}}, 7);
    expect_no_world({ErrorCode::out_of_range, "precision"}, {.precision = static_cast<Precision>(2)}, 2);
    expect_no_world({ErrorCode::out_of_range, "material_rules", 2},
                    {.material_rules = {{.a = 1, .b = 2}, {.a = 2, .b = 2}, {.a = 2, .b = 1}}}, 1);
    expect_no_world({ErrorCode::out_of_range, "threads"}, {.threads = 4097}, 4097);
    for (const std::uint32_t windows : {0U, 1'000'001U}) {
        expect_no_world({ErrorCode::out_of_range, "min_windows"}, {.min_windows = windows}, windows);
    }
    expect_no_world({ErrorCode::out_of_range, "origin", 1}, {.resolution = 4, .origin = {8, 6, 0}}, 6);
    expect_no_world({ErrorCode::out_of_range, "origin", 0}, {.resolution = 0x1p40, .origin = {1, 0, 0}}, 1);
}

TEST(BadOptions, TheOddestOnesThatAreFine) {
    for (const double resolution : {0x1p-100, 0x1p-40, 1.0, 4.0, 0x1p40}) {
        World world({.resolution = resolution});
        EXPECT_EQ(world.resolution(), resolution);
        world.add({.radius = 0});
        world.step(1e-3);
    }
    World world({.resolution = 4, .origin = {8, -4, 0}});
    EXPECT_EQ(world.get(world.add({.position = {4, 0, 0}})).position, (Vec3{4, 0, 0}));
    for (const double length : {denormal, 1e-300, 1e300, 1.7e308}) {
        World tilted({.region = std::vector<Plane>{{.normal = {length, 0, length}}}});
        expect_error({ErrorCode::overlap, "position", 0}, "behind the plane",
                     [&] { tilted.add({.position = {-1, 0, 0}, .radius = 0}); });
        tilted.add({.position = {1, 0, 0}, .radius = 0});
    }
}

TEST_P(BadInput, ABodyTooLargeForAPeriodicSide) {
    Box box{{0, 0, 0}, {10, 4, 10}};
    box.faces[2].kind = box.faces[3].kind = FaceKind::periodic;
    World world({.region = box, .precision = GetParam()});
    const BodyId id = world.add({.position = {5, 2, 5}, .radius = 0.999});
    const Refusal refusal{ErrorCode::out_of_range, "radius", 0};
    expect_refused(world, refusal, "added", [](World& w) { w.add({.position = {2, 2, 2}, .radius = 1}); });
    const std::array<double, 1> radius{1};
    expect_refused(world, refusal, "set", [&](World& w) { w.set({&id, 1}, {.radius = radius}); });
    Box tight{{0, 0, 0}, {10, 2, 10}};
    tight.faces = box.faces;
    World narrow({.region = tight, .precision = GetParam()});
    const std::array<Vec3, 1> position{Vec3{5, 1, 5}};
    expect_refused(narrow, refusal, "by default", [&](World& w) { w.add({.position = position}); });
}

// ---------------------------------------------------------------------------------------------------------------------
// The edge of the world
// ---------------------------------------------------------------------------------------------------------------------

/// The resolution that an error tells to set.
double advised_resolution(const Error& error) {
    const std::string message = error.what();
    const std::string lead = "set the resolution to ";
    const std::size_t at = message.find(lead);
    EXPECT_NE(at, std::string::npos) << message;
    return at == std::string::npos ? 0 : std::stod(message.substr(at + lead.size()));
}

/// Does something that leaves the world, sets the resolution that the error advises, and does it again.
void expect_advice_to_help(WorldOptions options, const std::function<void(World&)>& act) {
    try {
        World world(options);
        act(world);
        ADD_FAILURE() << "not refused";
    } catch (const Error& error) {
        ASSERT_EQ(error.code(), ErrorCode::out_of_world) << error.what();
        options.resolution = advised_resolution(error);
    }
    World world(options);
    EXPECT_NO_THROW(act(world));
}

TEST_P(BadInput, TheResolutionAdvisedWorks) {
    const WorldOptions options{.precision = GetParam()};
    for (const double far : {8e6, 7864320.0, -7.9e6, 9e12, -1e15, 3e17, 1e30}) {
        if (is_single() && std::abs(far) < 1e10) continue;
        expect_advice_to_help(options, [far](World& world) { world.add({.position = {0, far, 0}}); });
        expect_advice_to_help(
            options, [far](World& world) { world.set_attractors(std::array{Attractor{.position = {far, 0, 0}}}); });
    }
    expect_advice_to_help(options, [](World& world) {
        world.add({.velocity = {0, 0, 1e14}});
        world.step(1);
    });
    expect_advice_to_help({.gravity = {0, 0, -1e14}, .precision = GetParam()}, [](World& world) {
        world.add(Body{});
        world.step(1);
    });
    WorldOptions shifted = options;
    shifted.origin = {is_single() ? 8'000'000'000'000 : 7'000'000, 0, 0};
    expect_advice_to_help(shifted, [&](World& world) { world.add({.position = {is_single() ? 8e12 : 7e6, 0, 0}}); });
}

TEST_P(BadInput, LeavingTheWorldIsRefusedBeforehand) {
    World world({.precision = GetParam()});
    world.add({.position = {1, 0, 0}, .velocity = {1, 0, 0}});
    world.add({.position = {5, 0, 0}, .velocity = {1, 0, 0}});
    const BodyId fast = world.add({.position = {9, 0, 0}, .velocity = {1e13, 0, 0}});
    expect_refused(world, {ErrorCode::out_of_world, "position", fast.slot}, "leaves", [](World& w) { w.step(1); });
    EXPECT_EQ(world.step_count(), 0U);
    world.remove(fast);
    EXPECT_EQ(world.step(1).advanced, 1);
}

/// A light body that a heavy one strikes leaves twice as fast: the impact happens, and the step ends with it.
TEST_P(BadInput, AnImpactThatThrowsABodyOutEndsTheStep) {
    const double size = is_single() ? 7e12 : 7e6;
    for (const std::uint32_t windows : {1U, 16U}) {
        World world({.precision = GetParam(), .min_windows = windows});
        const BodyId heavy = world.add({.velocity = {0.7 * size, 0, 0}, .mass = 1e6});
        const BodyId light = world.add({.position = {0.07 * size, 0, 0}, .mass = 1e-6});
        const StepReport& report = world.step(1);
        EXPECT_TRUE(report.edge_reached);
        EXPECT_NEAR(report.advanced, 0.1, 1e-3);
        EXPECT_EQ(report.advanced + report.behind, 1);
        EXPECT_EQ(report.impacts, 1U);
        EXPECT_NEAR(world.get(light).velocity.x, 1.4 * size, 1e-5 * size);
        EXPECT_NEAR(world.get(heavy).position.x, 0.07 * size, 1e-3 * size);
        expect_refused(world, {ErrorCode::out_of_world, "position", light.slot}, "leaves", [](World& w) { w.step(1); });
    }
}

TEST_P(BadInput, SpeedsWhoseSquaresOverflowAreAnswered) {
    World world({.precision = GetParam()});
    world.add({.velocity = {is_single() ? 3e38 : 1e200, 0, 0}});
    EXPECT_FALSE(std::isnan(world.energy().kinetic));
    expect_refused(world, {ErrorCode::out_of_world, "position", 0}, "fast", [](World& w) { w.step(1); });
}

} // namespace

} // namespace carom
