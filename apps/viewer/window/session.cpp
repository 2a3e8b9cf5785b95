#include "viewer/window/session.hpp"

#include "scene/subject.hpp"
#include "viewer/stage/camera_path.hpp"
#include "viewer/stage/hearing.hpp"

#include <carom/base.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace carom::viewer {

namespace {

constexpr std::size_t most_plot_rows = 1200;

/// A body like the others, and as fast as makes a difference.
Projectile usual_projectile(const Moment& moment, double scale) {
    std::vector<float> radii = *moment.radii;
    if (radii.empty()) return {};
    const auto middle = radii.begin() + static_cast<std::ptrdiff_t>(radii.size() / 2);
    std::nth_element(radii.begin(), middle, radii.end());
    Projectile projectile;
    projectile.radius = std::max(1.5 * static_cast<double>(*middle), 1e-3 * scale);
    projectile.speed = 2 * scale;
    return projectile;
}

/// Adds a projectile that flies from `from` along `direction`: where there is room for it first.
void add_projectile(World& world, const Projectile& projectile, const Vec3& from, const Vec3& direction, double reach) {
    constexpr int tries = 256;
    Body body;
    body.velocity = direction * projectile.speed;
    body.radius = projectile.radius;
    body.mass = projectile.mass;
    body.restitution = 0.5;
    for (int i = 0; i < tries; ++i) {
        body.position = from + direction * (reach * i / tries);
        try {
            world.add(body);
            return;
        } catch (const Error& error) {
            // A place outside the region, or one that is taken.
            if (error.code() != ErrorCode::overlap && error.code() != ErrorCode::out_of_range) throw;
        }
    }
    throw Error(ErrorCode::overlap, "projectile", "there is no room for it on its way");
}

} // namespace

Session::Session(const std::filesystem::path& file) : file_(file) {
    scene::Subject subject = scene::load_subject(file);
    const scene::PictureSettings& picture = subject.view.picture;
    title_ = subject.title;
    colour_by_ = picture.colour_by;
    time_scale = picture.time_scale;
    trails_ = picture.trails;
    gravity = subject.world.options().gravity;
    drag = subject.world.options().drag;
    if (subject.world.size() > 0) restitution = subject.world.get(subject.world.ids().front()).restitution;
    simulation_ = std::make_unique<Simulation>(std::move(subject.world), subject.run.dt, colour_by_);
    find_home(subject.view.camera);
    if (picture.forces) show_forces(true);
    projectile = usual_projectile(*moment_, ball_.radius);
    stage_.set_trails(trails_);
}

void Session::find_home(const scene::CameraSpec& spec) {
    moment_ = simulation_->moment();
    clock_ = moment_->end;
    stage_ = Stage(simulation_->obstacles());
    ball_ = stage_.to_see(*moment_);
    home_ = camera_at(spec, 0, ball_, up_of(spec, gravity));
    rig_.set_camera(home_);
}

void Session::advance(double seconds, bool wait) {
    if (wait) simulation_->wait_until_idle();
    show_now();
    const bool restarting = moment_->era != era_;
    if (!paused_ && !restarting && seconds > 0) {
        go_on(seconds, wait);
    } else {
        lag_ = 0;
    }
    show_now();
    take_plots();
}

void Session::go_on(double seconds, bool wait) {
    const double wanted = clock_ + seconds * time_scale;
    // What the next frame will show is computed while this one is drawn.
    simulation_->run_to(wait ? wanted : wanted + seconds * time_scale);
    if (wait) simulation_->wait_until_idle();
    // The world is computed up to the moment's end; one that is not there yet is not waited for.
    const double before = clock_;
    clock_ = std::min(wanted, std::max(clock_, simulation_->moment()->end));
    lag_ += wanted - clock_;
    constexpr double newest = 0.05; // of the mean
    reached_ += ((clock_ - before) / seconds - reached_) * newest;
}

/// While paused the picture is that of the last step or change.
void Session::show_now() {
    const bool is_new_era = moment_->era != simulation_->moment()->era;
    moment_ = simulation_->moment();
    if (is_new_era) {
        rows_.clear();
        stage_.restart();
    }
    if (paused_ || is_new_era || clock_ > moment_->end) clock_ = moment_->end;
}

void Session::take_plots() {
    for (const PlotRow& row : simulation_->take_rows()) {
        while (!rows_.empty() && rows_.back().time >= row.time) rows_.pop_back();
        rows_.push_back(row);
    }
    while (!rows_.empty() && rows_.back().time > moment_->end + simulation_->dt()) rows_.pop_back();
    while (rows_.size() > most_plot_rows) rows_.pop_front();
}

void Session::step() {
    paused_ = true;
    simulation_->step();
}

void Session::step_back() {
    paused_ = true;
    simulation_->step_back();
}

void Session::restart() {
    simulation_->restart();
    ++era_;
}

const Drawing& Session::draw() {
    if (picked_) {
        const auto found = std::lower_bound(moment_->ids->begin(), moment_->ids->end(), *picked_);
        if (found != moment_->ids->end() && *found == *picked_) {
            rig_.follow(moment_->position_at(static_cast<std::size_t>(found - moment_->ids->begin()), clock_));
        }
    }
    return stage_.draw(*moment_, clock_, rig_.camera());
}

void Session::hear(bool wanted) {
    if (std::exchange(hears_, wanted) != wanted) simulation_->hear(wanted);
}

sound::SoundSettings Session::sound_settings() const { return heard_from(home_, simulation_->sound_settings()); }

sound::Listener Session::listener() const {
    const Status status = simulation_->status();
    const bool follows = rig_.mode() == CameraMode::follow && status.picked;
    return listener_at(rig_.camera(), follows ? status.picked->body.velocity : Vec3{});
}

void Session::pick_at(const Place& place) { pick(body_at(*moment_, clock_, rig_.camera(), place)); }

void Session::pick(std::optional<BodyId> id) {
    picked_ = id;
    stage_.set_highlight(id);
    simulation_->pick(id);
}

void Session::colour_by(scene::ColourBy by) {
    colour_by_ = by;
    simulation_->colour_by(by);
}

void Session::show_forces(bool forces) {
    forces_ = forces;
    simulation_->show_forces(forces);
}

void Session::set_trails(double seconds) {
    trails_ = seconds;
    stage_.set_trails(seconds);
}

void Session::set_gravity(const Vec3& value) {
    gravity = value;
    simulation_->change([value](World& world) { world.set_gravity(value); });
}

void Session::set_drag(const Drag& value) {
    drag = value;
    simulation_->change([value](World& world) { world.set_drag(value); });
}

void Session::set_restitution(double value) {
    restitution = value;
    simulation_->change([value](World& world) {
        const std::vector<BodyId> ids = world.ids();
        const std::vector<double> values(ids.size(), value);
        world.set(ids, {.restitution = values});
    });
}

void Session::shoot(const Place& place) {
    const Vec3 direction = direction_through(rig_.camera(), place);
    const Vec3 from = rig_.camera().position;
    const double reach = length(ball_.centre - from) + 2 * ball_.radius;
    simulation_->change([shot = projectile, from, direction, reach](World& world) {
        add_projectile(world, shot, from, direction, reach);
    });
}

} // namespace carom::viewer
