#include "viewer/sound/render_sound.hpp"

namespace carom::sound {

bool is_sound(const std::filesystem::path& file) { return file.extension() == ".wav"; }

bool render_sound(const scene::Scene& scene, const std::filesystem::path& file,
                  const std::function<bool(const World&)>& go_on) {
    if (const auto folder = file.parent_path(); !folder.empty() && !std::filesystem::is_directory(folder)) {
        throw Error(ErrorCode::input_output, file.string(), "cannot be created: there is no folder " + folder.string());
    }
    World world = scene::make_world(scene);
    world.set_recording(true, scene.options.least_recorded_impulse);
    world.set_threads(scene.run.threads);
    SoundTrack track(world, settings_for(world));
    track.listen(overview(world));
    constexpr double rounding = 1e-9; // steps
    const double dt = scene.run.dt;
    while (world.time() < scene.run.time - rounding * dt) {
        const double left = scene.run.time - world.time();
        world.step(left < (1 - rounding) * dt ? left : dt);
        track.record(world);
        if (!go_on(world)) return false;
    }
    track.write_wav(file);
    return true;
}

} // namespace carom::sound
