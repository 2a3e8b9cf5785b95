#include "space/checks.hpp"
#include "space/floating_point.hpp"
#include "world/engine.hpp"
#include "world/snapshot.hpp"

#include <atomic>
#include <cmath>
#include <variant>

namespace carom {

using core::DefaultFloatingPoint;
using core::Engine;

namespace {

std::uint16_t next_world_tag() {
    static std::atomic<std::uint16_t> tags{0};
    return ++tags;
}

ConstBodyColumns one_row(const Body& body) {
    return {.position = {&body.position, 1},
            .velocity = {&body.velocity, 1},
            .mass = {&body.mass, 1},
            .radius = {&body.radius, 1},
            .restitution = {&body.restitution, 1},
            .friction = {&body.friction, 1},
            .material = {&body.material, 1},
            .user_data = {&body.user_data, 1},
            .growth = {&body.growth, 1}};
}

BodyColumns one_row(Body& body) {
    return {.position = {&body.position, 1},
            .velocity = {&body.velocity, 1},
            .mass = {&body.mass, 1},
            .radius = {&body.radius, 1},
            .restitution = {&body.restitution, 1},
            .friction = {&body.friction, 1},
            .material = {&body.material, 1},
            .user_data = {&body.user_data, 1},
            .growth = {&body.growth, 1}};
}

} // namespace

/// One of the two precisions; everything is passed on to it, in the floating-point environment of the results.
struct World::Impl {
    using Engines = std::variant<Engine<float>, Engine<double>>;
    Engines engine;

    Impl(core::Setting setting, std::uint16_t tag) : engine(std::in_place_type<Engine<double>>, setting, tag) {
        if (setting.options.precision == Precision::single_precision) engine.emplace<Engine<float>>(setting, tag);
    }
    Impl(const Impl&) = default;

    template <class F>
    decltype(auto) pass(F&& f) {
        const DefaultFloatingPoint environment;
        return std::visit(std::forward<F>(f), engine);
    }
    template <class F>
    decltype(auto) pass(F&& f) const {
        const DefaultFloatingPoint environment;
        return std::visit(std::forward<F>(f), engine);
    }
};

World::World(WorldOptions options) {
    const DefaultFloatingPoint environment;
    impl_ = std::make_unique<Impl>(core::checked_setting(std::move(options)), next_world_tag());
}

World::World(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;
World::World(const World& other) : impl_(std::make_unique<Impl>(*other.impl_)) {}
World& World::operator=(const World& other) {
    if (this != &other) impl_ = std::make_unique<Impl>(*other.impl_);
    return *this;
}

std::vector<BodyId> World::add(const ConstBodyColumns& columns, Overlap overlap) {
    return impl_->pass([&](auto& engine) { return engine.add(columns, overlap); });
}

BodyId World::add(const Body& body, Overlap overlap) { return add(one_row(body), overlap).front(); }

void World::get(std::span<const BodyId> ids, const BodyColumns& columns) const {
    impl_->pass([&](const auto& engine) { engine.get(ids, columns); });
}

Body World::get(BodyId id) const {
    Body body;
    get({&id, 1}, one_row(body));
    return body;
}

void World::set(std::span<const BodyId> ids, const ConstBodyColumns& columns, Overlap overlap) {
    impl_->pass([&](auto& engine) { engine.set(ids, columns, overlap); });
}

void World::set(BodyId id, const Body& body, Overlap overlap) { set({&id, 1}, one_row(body), overlap); }

void World::remove(std::span<const BodyId> ids) {
    impl_->pass([&](auto& engine) { engine.remove(ids); });
}

void World::remove(BodyId id) { remove({&id, 1}); }

void World::apply_impulses(std::span<const BodyId> ids, std::span<const Vec3> impulses) {
    impl_->pass([&](auto& engine) { engine.change_velocities(ids, impulses, true); });
}

void World::change_velocities(std::span<const BodyId> ids, std::span<const Vec3> changes) {
    impl_->pass([&](auto& engine) { engine.change_velocities(ids, changes, false); });
}

bool World::contains(BodyId id) const noexcept {
    return std::visit([id](const auto& engine) { return engine.contains(id); }, impl_->engine);
}

bool World::held(BodyId id) const {
    return impl_->pass([id](const auto& engine) { return engine.held(id); });
}

std::size_t World::size() const noexcept {
    return std::visit([](const auto& engine) { return engine.size(); }, impl_->engine);
}

std::vector<BodyId> World::ids() const {
    return impl_->pass([](const auto& engine) { return engine.ids(); });
}

const StepReport& World::step(double dt) {
    return impl_->pass([dt](auto& engine) -> const StepReport& { return engine.step(dt); });
}

const StepReport& World::step_until(double time, double max_dt) {
    const DefaultFloatingPoint environment;
    core::check_finite(time, "time");
    if (std::isnan(max_dt)) throw Error(ErrorCode::not_finite, "max_dt", "must be a number, got nan");
    if (!(max_dt > 0)) {
        throw Error(ErrorCode::out_of_range, "max_dt", "must be > 0, got " + core::shown(max_dt));
    }
    if (!(time > this->time())) {
        throw Error(ErrorCode::out_of_range, "time",
                    "must be later than the world's time of " + core::shown(this->time()) + " s, got " +
                        core::shown(time));
    }
    // Less than the clock can tell apart is no time left.
    const double slack = 2 * std::numeric_limits<double>::epsilon() * time;
    while (time - this->time() > slack) {
        const StepReport& done = step(std::min(max_dt, time - this->time()));
        if (done.behind > 0) break;
    }
    return report();
}

double World::time() const noexcept {
    return impl_->pass([](const auto& engine) { return engine.clock().seconds(); });
}

std::uint64_t World::step_count() const noexcept {
    return std::visit([](const auto& engine) { return engine.clock().steps(); }, impl_->engine);
}

const StepReport& World::report() const noexcept {
    return std::visit([](const auto& engine) -> const StepReport& { return engine.report(); }, impl_->engine);
}

std::span<const ContactChange> World::contact_changes() const {
    return impl_->pass([](const auto& engine) { return engine.contact_changes(); });
}

std::vector<Contact> World::contacts() const {
    return impl_->pass([](const auto& engine) { return engine.contacts(); });
}

std::vector<double> World::face_forces() const {
    return impl_->pass([](const auto& engine) { return engine.face_forces(); });
}

std::span<const Impact> World::impacts() const noexcept {
    return std::visit([](const auto& engine) { return engine.impacts(); }, impl_->engine);
}

void World::positions_at(double time, std::span<const BodyId> ids, std::span<Vec3> positions) const {
    impl_->pass([&](const auto& engine) { engine.positions_at(time, ids, positions); });
}

const WorldOptions& World::options() const noexcept {
    return std::visit([](const auto& engine) -> const WorldOptions& { return engine.setting().options; },
                      impl_->engine);
}

double World::resolution() const noexcept {
    return std::visit([](const auto& engine) { return engine.setting().resolution.metres; }, impl_->engine);
}

void World::set_gravity(const Vec3& gravity) {
    impl_->pass([&](auto& engine) { engine.set_gravity(gravity); });
}

void World::set_drag(const Drag& drag) {
    impl_->pass([&](auto& engine) { engine.set_drag(drag); });
}

void World::set_attractors(std::span<const Attractor> attractors) {
    impl_->pass([&](auto& engine) { engine.set_attractors(attractors); });
}

std::span<const Attractor> World::attractors() const noexcept {
    return std::visit([](const auto& engine) { return engine.attractors(); }, impl_->engine);
}

void World::set_face_motion(std::int32_t face, const FaceMotion& motion) {
    impl_->pass([&](auto& engine) { engine.set_face_motion(face, motion); });
}

Region World::region() const {
    return impl_->pass([](const auto& engine) { return engine.region(); });
}

void World::set_origin(const std::array<std::int64_t, 3>& origin) {
    impl_->pass([&](auto& engine) { engine.set_origin(origin); });
}

void World::set_recording(bool record_impacts, double least_recorded_impulse) {
    impl_->pass([&](auto& engine) { engine.set_recording(record_impacts, least_recorded_impulse); });
}

void World::set_work_cap(std::uint64_t work_cap) {
    impl_->pass([work_cap](auto& engine) { engine.set_work_cap(work_cap); });
}

void World::set_serial_reference(bool serial_reference) {
    impl_->pass([serial_reference](auto& engine) { engine.set_serial_reference(serial_reference); });
}

void World::set_threads(unsigned threads) {
    impl_->pass([threads](auto& engine) { engine.set_threads(threads); });
}

void World::set_executor(std::shared_ptr<Executor> executor) {
    impl_->pass([&](auto& engine) { engine.set_executor(std::move(executor)); });
}

void World::set_min_windows(std::uint32_t min_windows) {
    impl_->pass([min_windows](auto& engine) { engine.set_min_windows(min_windows); });
}

Energy World::energy() const {
    return impl_->pass([](const auto& engine) { return engine.energy(); });
}

Vec3 World::momentum() const {
    return impl_->pass([](const auto& engine) { return engine.momentum(); });
}

Vec3 World::angular_momentum(const Vec3& about) const {
    return impl_->pass([&](const auto& engine) { return engine.angular_momentum(about); });
}

Vec3 World::centre_of_mass() const {
    return impl_->pass([](const auto& engine) { return engine.centre_of_mass(); });
}

const Ledger& World::ledger() const noexcept {
    return std::visit([](const auto& engine) -> const Ledger& { return engine.ledger(); }, impl_->engine);
}

std::vector<std::byte> World::save() const {
    return impl_->pass([](const auto& engine) { return engine.save(); });
}

World World::load(std::span<const std::byte> snapshot) {
    const DefaultFloatingPoint environment;
    try {
        const core::OpenedSnapshot opened = core::open_snapshot(snapshot);
        auto impl = std::make_unique<Impl>(opened.setting, opened.world_tag);
        std::visit([&](auto& engine) { engine.load(opened.payload); }, impl->engine);
        return World(std::move(impl));
    } catch (const Error& error) {
        if (error.code() == ErrorCode::bad_data) throw;
        throw Error(ErrorCode::bad_data, "snapshot", std::string("has a value that no world has: ") + error.what());
    }
}

std::uint64_t World::hash() const {
    return impl_->pass([](const auto& engine) { return engine.hash(); });
}

} // namespace carom
