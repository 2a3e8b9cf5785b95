#include "scene/subject.hpp"

#include "scene/atomic_file.hpp"
#include "scene/checkpoint.hpp"

#include <carom/base.hpp>

#include <cstddef>
#include <utility>
#include <vector>

namespace carom::scene {

namespace {

Subject subject_of_scene(const std::filesystem::path& file, const Overrides& overrides) {
    Scene scene = load_scene(file, overrides);
    scene.options.interpolation = true;
    scene.options.record_impacts = true;
    return {scene.title, make_world(scene), scene.run, scene.view};
}

World load_state(const std::filesystem::path& file, RunSettings& run) {
    try {
        const std::vector<std::byte> bytes = read_file(file);
        if (!looks_like_checkpoint(bytes)) return World::load(bytes);
        Checkpoint checkpoint = load_checkpoint(bytes);
        run.dt = checkpoint.identity.dt;
        return std::move(checkpoint.world);
    } catch (const Error& error) {
        throw SceneError(file.string(), 0, "", reason_of(error));
    }
}

} // namespace

Subject load_subject(const std::filesystem::path& file, const Overrides& overrides) {
    if (file.extension() == ".toml") return subject_of_scene(file, overrides);
    Subject subject;
    subject.title = file.filename().string();
    subject.world = load_state(file, subject.run);
    subject.world.set_recording(true);
    subject.run.time = overrides.time.value_or(subject.run.time);
    subject.run.threads = overrides.threads.value_or(subject.run.threads);
    subject.view.picture.moment = subject.world.time();
    return subject;
}

} // namespace carom::scene
