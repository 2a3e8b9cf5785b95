#include "viewer/film/film_writer.hpp"

#include "scene/atomic_file.hpp"

#include <carom/base.hpp>

#include <fmt/format.h>

#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace carom::viewer {

namespace {

std::vector<std::string> encoding(const FilmFormat& format, const std::filesystem::path& file) {
    return {"-f",
            "rawvideo",
            "-pixel_format",
            "rgb24",
            "-video_size",
            fmt::format("{}x{}", format.width, format.height),
            "-framerate",
            fmt::format("{}", format.fps),
            "-i",
            "pipe:0",
            "-c:v",
            "libx264",
            "-preset",
            "medium",
            "-crf",
            "20",
            "-pix_fmt",
            "yuv420p",
            "-movflags",
            "+faststart",
            "-f",
            "mp4",
            file.string()};
}

std::vector<std::string> adding_sound(const std::filesystem::path& pictures, int rate,
                                      const std::filesystem::path& file) {
    return {"-i",         pictures.string(),
            "-f",         "s16le",
            "-ar",        fmt::format("{}", rate),
            "-ac",        "2",
            "-i",         "pipe:0",
            "-c:v",       "copy",
            "-c:a",       "aac",
            "-b:a",       "192k",
            "-movflags",  "+faststart",
            "-f",         "mp4",
            file.string()};
}

} // namespace

FilmWriter::FilmWriter(std::filesystem::path file, const FilmFormat& format)
    : file_(std::move(file)), pictures_(file_.string() + ".part"), whole_(file_.string() + ".sound.part"),
      ffmpeg_(std::make_unique<Ffmpeg>(encoding(format, pictures_), file_.string())) {}

FilmWriter::~FilmWriter() {
    ffmpeg_.reset();         // before its file is removed
    std::error_code ignored; // a destructor has nobody to tell
    std::filesystem::remove(pictures_, ignored);
    std::filesystem::remove(whole_, ignored);
}

void FilmWriter::add(const Image& frame) { ffmpeg_->write(std::as_bytes(std::span(frame.pixels))); }

void FilmWriter::finish() {
    ffmpeg_->finish();
    scene::publish(pictures_, file_);
}

void FilmWriter::finish(std::span<const std::int16_t> samples, int rate) {
    ffmpeg_->finish();
    ffmpeg_ = std::make_unique<Ffmpeg>(adding_sound(pictures_, rate, whole_), file_.string());
    ffmpeg_->write(std::as_bytes(samples));
    ffmpeg_->finish();
    scene::publish(whole_, file_);
}

} // namespace carom::viewer
