#include "viewer/film/render.hpp"

#include "scene/atomic_file.hpp"
#include "viewer/film/film_writer.hpp"
#include "viewer/film/png.hpp"
#include "viewer/stage/camera_path.hpp"
#include "viewer/stage/moment.hpp"
#include "viewer/stage/stage.hpp"

#include <carom/world.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

namespace carom::viewer {

namespace {

/// A scene that is run only to be seen.
scene::Scene to_be_seen(scene::Scene scene) {
    scene.options.interpolation = true;
    scene.options.record_impacts = scene.view.picture.colour_by == scene::ColourBy::impact_rate;
    return scene;
}

/// A world, what is seen of it, and its drawing.
class Shooting {
public:
    Shooting(const scene::Scene& scene, unsigned threads)
        : scene_(to_be_seen(scene)), world_(scene::make_world(scene_)), spectator_(scene.view.picture.colour_by),
          stage_(scene_.options.obstacles) {
        world_.set_threads(threads);
        stage_.set_trails(scene.view.picture.trails);
        look();
        to_see_ = stage_.to_see(*moment_);
    }

    [[nodiscard]] const World& world() const { return world_; }
    /// One step towards `time` (s); false if the world is there already.
    bool step_towards(double time) {
        constexpr double rounding = 1e-9; // steps
        if (world_.time() >= time - rounding * scene_.run.dt) return false;
        world_.step(scene_.run.dt);
        spectator_.watch_step(world_);
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
        const Vec3 up = up_of(scene_.view.camera, scene_.options.gravity);
        return stage_.draw(*moment_, time, camera_at(scene_.view.camera, time, to_see_, up));
    }

private:
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
    FilmWriter film(options.file, {options.size.width, options.size.height, options.fps, {}});
    const double per_frame = scene.view.picture.time_scale / options.fps; // s of the world
    const auto total = static_cast<std::uint64_t>(std::max(1.0, std::round(scene.run.time / per_frame)));
    for (std::uint64_t frame = 0; frame < total; ++frame) {
        const double time = static_cast<double>(frame) * per_frame;
        const auto progress = [&](std::uint64_t done) {
            return RenderProgress{done, total, shooting.world().time(), impacts_of(shooting.world())};
        };
        while (shooting.step_towards(time)) {
            if (!go_on(progress(frame))) return false;
        }
        renderer.draw(shooting.draw(time, false), options.size);
        film.add(renderer.picture());
        if (!go_on(progress(frame + 1))) return false;
    }
    film.finish();
    return true;
}

} // namespace

bool is_film(const std::filesystem::path& file) { return file.extension() == ".mp4"; }

bool render(const scene::Scene& scene, const RenderOptions& options,
            const std::function<bool(const RenderProgress&)>& go_on) {
    const std::unique_ptr<Renderer> renderer = make_offscreen_renderer();
    Shooting shooting(scene, options.threads);
    if (is_film(options.file)) return render_film(shooting, *renderer, scene, options, go_on);
    return render_picture(shooting, *renderer, scene, options, go_on);
}

} // namespace carom::viewer
