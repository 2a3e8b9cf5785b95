/// \file
/// `carom render`: a picture or a film, without a window.
#pragma once

#include "scene/subject.hpp"
#include "viewer/render/renderer.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>

namespace carom::viewer {

struct RenderOptions {
    std::filesystem::path file;     ///< a film if it ends in .mp4, a PNG picture if in .png
    PictureSize size{1280, 720, 2}; ///< of a film even
    double fps = 30;                ///< frames a second
    bool sound = true;              ///< a film is heard as well
    bool legend = false;            ///< tells what colours stand for, where they are a scale
    unsigned threads = 0;           ///< of the engine; 0: one for each core
};

/// How far the rendering has come.
struct RenderProgress {
    std::uint64_t done = 0; ///< frames of a film, steps up to a picture
    std::uint64_t total = 0;
    double time = 0; ///< s of the world
    std::uint64_t impacts = 0;
};

/// True if the file's name says that it is to be a film.
bool is_film(const std::filesystem::path& file);

/// Runs the world and draws it: a film of all the run, or a picture at PictureSettings::moment (the run's end if it is
/// not set; the world must not be later). `go_on` is asked after each step or frame. Returns false, with no file
/// written, if it has said no. Throws carom::Error{not_available} where graphics, ffmpeg or sound are missing,
/// {input_output} where the file cannot be written.
bool render(scene::Subject subject, const RenderOptions& options,
            const std::function<bool(const RenderProgress&)>& go_on);

} // namespace carom::viewer
