#include "viewer/sound/render_sound.hpp"

namespace carom::sound {

bool is_sound(const std::filesystem::path& file) { return file.extension() == ".wav"; }

bool render_sound(scene::Subject subject, const std::filesystem::path& file,
                  const std::function<bool(const World&)>& go_on) {
    if (const auto folder = file.parent_path(); !folder.empty() && !std::filesystem::is_directory(folder)) {
        throw Error(ErrorCode::input_output, file.string(), "cannot be created: there is no folder " + folder.string());
    }
    World& world = subject.world;
    world.set_threads(subject.run.threads);
    SoundTrack track(world, settings_for(world));
    track.listen(overview(world));
    constexpr double rounding = 1e-9; // steps
    const double dt = subject.run.dt;
    const double end = world.time() + subject.run.time;
    while (world.time() < end - rounding * dt) {
        const double left = end - world.time();
        world.step(left < (1 - rounding) * dt ? left : dt);
        track.record(world);
        if (!go_on(world)) return false;
    }
    track.write_wav(file);
    return true;
}

} // namespace carom::sound
