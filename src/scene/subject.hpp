/// \file
/// What is watched or listened to: a scene from its start, or a state that was saved.
#pragma once

#include "scene/scene.hpp"

#include <filesystem>
#include <string>

namespace carom::scene {

/// A world that records its impacts, and how it is to be run and seen.
struct Subject {
    std::string title; ///< one line for people
    World world{};
    RunSettings run;
    ViewSettings view;
};

/// Opens a scene (.toml), a checkpoint, or a snapshot (the bytes of World::save). The world of a scene interpolates.
/// Saved states know of no camera; their picture is that of the state as it is. Of `overrides`, `time` and `threads`
/// hold for all, the others for scenes alone. Throws SceneError, also for a file that cannot be read or is no state.
Subject load_subject(const std::filesystem::path& file, const Overrides& overrides = {});

} // namespace carom::scene
