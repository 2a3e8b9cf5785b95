/// \file
/// Films: frames go through a pipe to ffmpeg, which writes the file.
#pragma once

#include "viewer/render/image.hpp"

#include <sys/types.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace carom::viewer {

struct FilmFormat {
    int width = 0;          ///< pixels, even
    int height = 0;         ///< pixels, even
    double fps = 30;        ///< frames a second
    std::string sound = {}; ///< what ffmpeg takes as second input, for example a WAV file or a pipe; none if empty
};

/// What ffmpeg is called with to write `file`.
std::vector<std::string> ffmpeg_arguments(const FilmFormat& format, const std::filesystem::path& file);

/// The film appears whole or not at all: until finish() it is `file` + ".part".
class FilmWriter {
public:
    /// Starts ffmpeg. Throws carom::Error{not_available} if it is missing.
    FilmWriter(std::filesystem::path file, const FilmFormat& format);
    ~FilmWriter();
    FilmWriter(const FilmWriter&) = delete;
    FilmWriter& operator=(const FilmWriter&) = delete;

    /// Throws carom::Error{input_output} with what ffmpeg says.
    void add(const Image& frame);
    /// The film is complete. Throws as add().
    void finish();

private:
    int wait_for_ffmpeg();
    [[noreturn]] void fail(); ///< ffmpeg has ended

    std::filesystem::path file_;
    std::filesystem::path part_;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> complaints_; ///< ffmpeg's standard error
    int pipe_ = -1;
    pid_t ffmpeg_ = -1;
};

} // namespace carom::viewer
