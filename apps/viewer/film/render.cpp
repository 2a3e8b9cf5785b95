#include "viewer/film/render.hpp"

#include "scene/atomic_file.hpp"
#include "viewer/film/film_writer.hpp"
#include "viewer/film/image_legend.hpp"
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
#include <utility>

namespace carom::viewer {

namespace {

/// A world, what is seen and heard of it, and its drawing.
class Shooting {
public:
    Shooting(scene::Subject subject, unsigned threads, bool sound)
        : subject_(std::move(subject)), begin_(subject_.world.time()), spectator_(picture().colour_by),
          stage_(subject_.world.options().obstacles) {
        subject_.world.set_threads(threads);
        stage_.set_trails(picture().trails);
        look();
        to_see_ = stage_.to_see(*moment_);
        if (!sound) return;
        const sound::SoundSettings settings = heard_from(camera(begin_), sound::settings_for(world()));
        track_.emplace(world(), settings, picture().time_scale);
    }

    [[nodiscard]] double begin() const { return begin_; } ///< s of the world
    [[nodiscard]] const scene::RunSettings& run() const { return subject_.run; }
    [[nodiscard]] const scene::PictureSettings& picture() const { return subject_.view.picture; }
    [[nodiscard]] const World& world() const { return subject_.world; }
    /// What was heard; nothing without sound.
    [[nodiscard]] const std::optional<sound::SoundTrack>& track() const { return track_; }
    /// One step towards `time` (s); false if the world is there already.
    bool step_towards(double time) {
        constexpr double rounding = 1e-9; // steps
        World& world = subject_.world;
        if (world.time() >= time - rounding * run().dt) return false;
        world.step(run().dt);
        spectator_.watch_step(world);
        if (track_) hear();
        looked_ = false;
        if (picture().trails > 0 && world.time() > time - picture().trails) {
            look();
            stage_.remember_trails(*moment_, std::min(world.time(), time));
        }
        return true;
    }
    /// The scene at `time` in the last step; a picture of a moment looks for its camera then.
    const Drawing& draw(double time, bool is_moment) {
        if (!looked_) look();
        if (is_moment) to_see_ = stage_.to_see(*moment_);
        return stage_.draw(*moment_, time, camera(time));
    }

    /// What the colours of the last drawing stand for.
    [[nodiscard]] std::optional<Legend> legend() const {
        return legend_of(picture().colour_by, moment_->lowest, moment_->highest);
    }

private:
    [[nodiscard]] Camera camera(double time) const {
        const scene::CameraSpec& spec = subject_.view.camera;
        return camera_at(spec, time, to_see_, up_of(spec, world().options().gravity));
    }
    /// What the last step sounds like at the camera.
    void hear() {
        const double seconds = world().report().advanced;
        const Camera now = camera(world().time());
        const Vec3 way = now.position - camera(world().time() - seconds).position;
        track_->listen(listener_at(now, seconds > 0 ? way / seconds : Vec3{}));
        track_->record(world());
    }
    void look() {
        moment_ = spectator_.look(world(), picture().forces, std::move(moment_));
        looked_ = true;
    }

    scene::Subject subject_;
    double begin_;
    Spectator spectator_;
    Stage stage_;
    std::shared_ptr<Moment> moment_;
    bool looked_ = false;
    Ball to_see_;
    std::optional<sound::SoundTrack> track_;
};

std::uint64_t impacts_of(const World& world) { return world.ledger().impacts + world.ledger().face_impacts; }

/// What the renderer has drawn, with all that is written on it.
Image finished(const Shooting& shooting, Renderer& renderer, const RenderOptions& options) {
    Image image = renderer.picture();
    const auto legend = options.legend ? shooting.legend() : std::nullopt;
    if (legend) add_legend(*legend, image);
    return image;
}

bool render_picture(Shooting& shooting, Renderer& renderer, const RenderOptions& options,
                    const std::function<bool(const RenderProgress&)>& go_on) {
    const double time = shooting.picture().moment.value_or(shooting.begin() + shooting.run().time);
    const World& world = shooting.world();
    const std::uint64_t before = world.step_count();
    const auto total = static_cast<std::uint64_t>(std::ceil((time - shooting.begin()) / shooting.run().dt));
    while (shooting.step_towards(time)) {
        if (!go_on({world.step_count() - before, total, world.time(), impacts_of(world)})) return false;
    }
    renderer.draw(shooting.draw(time, true), options.size);
    scene::write_file(options.file, to_png(finished(shooting, renderer, options)));
    return true;
}

bool render_film(Shooting& shooting, Renderer& renderer, const RenderOptions& options,
                 const std::function<bool(const RenderProgress&)>& go_on) {
    FilmWriter film(options.file, {options.size.width, options.size.height, options.fps});
    const double per_frame = shooting.picture().time_scale / options.fps; // s of the world
    const auto total = static_cast<std::uint64_t>(std::max(1.0, std::round(shooting.run().time / per_frame)));
    const auto time_of = [&](std::uint64_t frame) { return shooting.begin() + static_cast<double>(frame) * per_frame; };
    const auto run_to = [&](std::uint64_t frame) {
        while (shooting.step_towards(time_of(frame))) {
            if (!go_on({frame, total, shooting.world().time(), impacts_of(shooting.world())})) return false;
        }
        return true;
    };
    for (std::uint64_t frame = 0; frame < total; ++frame) {
        if (!run_to(frame)) return false;
        renderer.draw(shooting.draw(time_of(frame), false), options.size);
        film.add(finished(shooting, renderer, options));
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

bool render(scene::Subject subject, const RenderOptions& options,
            const std::function<bool(const RenderProgress&)>& go_on) {
    const std::unique_ptr<Renderer> renderer = make_offscreen_renderer();
    Shooting shooting(std::move(subject), options.threads, options.sound && is_film(options.file));
    if (is_film(options.file)) return render_film(shooting, *renderer, options, go_on);
    return render_picture(shooting, *renderer, options, go_on);
}

} // namespace carom::viewer
