/// \file
/// Films: frames go through a pipe to ffmpeg, which writes the file; sound is added at the end.
#pragma once

#include "viewer/film/ffmpeg.hpp"
#include "viewer/render/image.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>

namespace carom::viewer {

struct FilmFormat {
    int width = 0;   ///< pixels, even
    int height = 0;  ///< pixels, even
    double fps = 30; ///< frames a second
};

/// The film appears whole or not at all: until the end there is only `file` + ".part", and another such file while
/// sound is added. Its functions throw carom::Error{input_output} with what ffmpeg says.
class FilmWriter {
public:
    /// Starts ffmpeg. Throws carom::Error{not_available} if it is missing.
    FilmWriter(std::filesystem::path file, const FilmFormat& format);
    ~FilmWriter();
    FilmWriter(const FilmWriter&) = delete;
    FilmWriter& operator=(const FilmWriter&) = delete;

    void add(const Image& frame);
    /// The film is complete, and silent.
    void finish();
    /// The film is complete, with samples that stand left and right in turn, `rate` a second.
    void finish(std::span<const std::int16_t> samples, int rate);

private:
    std::filesystem::path file_;
    std::filesystem::path pictures_; ///< the film without sound
    std::filesystem::path whole_;    ///< with sound
    std::unique_ptr<Ffmpeg> ffmpeg_;
};

} // namespace carom::viewer
