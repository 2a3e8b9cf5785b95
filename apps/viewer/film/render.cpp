#include "viewer/film/render.hpp"

#include "scene/atomic_file.hpp"
#include "viewer/film/film_writer.hpp"
#include "viewer/film/png.hpp"
#include "viewer/sound/sound_track.hpp"
#include "viewer/stage/camera_path.hpp"
#include "viewer/stage/hearing.hpp"
#include "viewer/stage/moment.hpp"
#include "viewer/stage/stage.hpp"

#include <carom/world.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

namespace carom::viewer {

namespace {

/// A scene that is run only to be seen, and heard.
scene::Scene to_be_seen(scene::Scene scene, bool sound) {
    scene.options.interpolation = true;
    scene.options.record_impacts = sound || scene.view.picture.colour_by == scene::ColourBy::impact_rate;
    return scene;
}

/// A world, what is seen and heard of it, and its drawing.
class Shooting {
public:
    Shooting(const scene::Scene& scene, unsigned threads, bool sound)
        : scene_(to_be_seen(scene, sound)), world_(scene::make_world(scene_)), spectator_(scene.view.picture.colour_by),
          stage_(scene_.options.obstacles) {
        world_.set_threads(threads);
        stage_.set_trails(scene.view.picture.trails);
        look();
        to_see_ = stage_.to_see(*moment_);
        if (!sound) return;
        const sound::SoundSettings settings = heard_from(camera(world_.time()), sound::settings_for(world_));
        track_.emplace(world_, settings, scene.view.picture.time_scale);
    }

    [[nodiscard]] const World& world() const { return world_; }
    /// What was heard; nothing without sound.
    [[nodiscard]] const std::optional<sound::SoundTrack>& track() const { return track_; }
    /// One step towards `time` (s); false if the world is there already.
    bool step_towards(double time) {
        constexpr double rounding = 1e-9; // steps
        if (world_.time() >= time - rounding * scene_.run.dt) return false;
        world_.step(scene_.run.dt);
        spectator_.watch_step(world_);
        if (track_) hear();
        looked_ = false;
        if (scene_.view.picture.trails > 0 && world_.time() > time - scene_.view.picture.trails) {
            look();
            stage_.remember_trails(*moment_, std::min(world_.time(), time));
        }
        return true;
    }
    /// The scene at `time` in the last step; a picture of a moment looks for its camera then.
    const Drawing& draw(double time, bool is_moment) {
        if (!looked_) look();
        if (is_moment) to_see_ = stage_.to_see(*moment_);
        return stage_.draw(*moment_, time, camera(time));
    }

private:
    [[nodiscard]] Camera camera(double time) const {
        return camera_at(scene_.view.camera, time, to_see_, up_of(scene_.view.camera, scene_.options.gravity));
    }
    /// What the last step sounds like at the camera.
    void hear() {
        const double seconds = world_.report().advanced;
        const Camera now = camera(world_.time());
        const Vec3 way = now.position - camera(world_.time() - seconds).position;
        track_->listen(listener_at(now, seconds > 0 ? way / seconds : Vec3{}));
        track_->record(world_);
    }
    void look() {
        moment_ = spectator_.look(world_, scene_.view.picture.forces, std::move(moment_));
        looked_ = true;
    }

    scene::Scene scene_;
    World world_;
    Spectator spectator_;
    Stage stage_;
    std::shared_ptr<Moment> moment_;
    bool looked_ = false;
    Ball to_see_;
    std::optional<sound::SoundTrack> track_;
};

std::uint64_t impacts_of(const World& world) { return world.ledger().impacts + world.ledger().face_impacts; }

bool render_picture(Shooting& shooting, Renderer& renderer, const scene::Scene& scene, const RenderOptions& options,
                    const std::function<bool(const RenderProgress&)>& go_on) {
    const double time = scene.view.picture.moment.value_or(scene.run.time);
    const World& world = shooting.world();
    const auto total = static_cast<std::uint64_t>(std::ceil(time / scene.run.dt));
    while (shooting.step_towards(time)) {
        if (!go_on({world.step_count(), total, world.time(), impacts_of(world)})) return false;
    }
    renderer.draw(shooting.draw(time, true), options.size);
    scene::write_file(options.file, to_png(renderer.picture()));
    return true;
}

bool render_film(Shooting& shooting, Renderer& renderer, const scene::Scene& scene, const RenderOptions& options,
                 const std::function<bool(const RenderProgress&)>& go_on) {
    FilmWriter film(options.file, {options.size.width, options.size.height, options.fps});
    const double per_frame = scene.view.picture.time_scale / options.fps; // s of the world
    const auto total = static_cast<std::uint64_t>(std::max(1.0, std::round(scene.run.time / per_frame)));
    const auto run_to = [&](std::uint64_t frame) {
        while (shooting.step_towards(static_cast<double>(frame) * per_frame)) {
            if (!go_on({frame, total, shooting.world().time(), impacts_of(shooting.world())})) return false;
        }
        return true;
    };
    for (std::uint64_t frame = 0; frame < total; ++frame) {
        if (!run_to(frame)) return false;
        renderer.draw(shooting.draw(static_cast<double>(frame) * per_frame, false), options.size);
        film.add(renderer.picture());
        if (!go_on({frame + 1, total, shooting.world().time(), impacts_of(shooting.world())})) return false;
    }
    if (!shooting.track()) {
        film.finish();
        return true;
    }
    if (!run_to(total)) return false; // what is heard while the last frame is seen
    film.finish(shooting.track()->excerpt(static_cast<double>(total) / options.fps), shooting.track()->rate());
    return true;
}

} // namespace

bool is_film(const std::filesystem::path& file) { return file.extension() == ".mp4"; }

bool render(const scene::Scene& scene, const RenderOptions& options,
            const std::function<bool(const RenderProgress&)>& go_on) {
    const std::unique_ptr<Renderer> renderer = make_offscreen_renderer();
    Shooting shooting(scene, options.threads, options.sound && is_film(options.file));
    if (is_film(options.file)) return render_film(shooting, *renderer, scene, options, go_on);
    return render_picture(shooting, *renderer, scene, options, go_on);
}

} // namespace carom::viewer
