#include "viewer/film/film_writer.hpp"

#include "scene/atomic_file.hpp"

#include <carom/base.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <system_error>
#include <utility>

namespace carom::viewer {

namespace {

/// Starts ffmpeg with `input` and `complaints` as its standard input and error, in a process group of its own, so that
/// Ctrl-C is for this program alone. Returns 0 or an error number.
int spawn(const std::vector<std::string>& arguments, int input, int complaints, pid_t& process) {
    std::vector<char*> pointers;
    pointers.reserve(arguments.size() + 1);
    for (const std::string& argument : arguments)
        pointers.push_back(
            const_cast<char*>(argument.c_str())); // NOLINT(cppcoreguidelines-pro-type-const-cast): POSIX takes these
    pointers.push_back(nullptr);
    posix_spawn_file_actions_t actions{};
    posix_spawnattr_t attributes{};
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, complaints, STDERR_FILENO);
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    const int error = ::posix_spawnp(&process, pointers.front(), &actions, &attributes, pointers.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    return error;
}

std::string text_of(std::FILE* file) {
    std::array<char, 2000> text{};
    if (std::fseek(file, 0, SEEK_SET) != 0) return "";
    const std::size_t size = std::fread(text.data(), 1, text.size(), file);
    return {text.data(), size};
}

} // namespace

std::vector<std::string> ffmpeg_arguments(const FilmFormat& format, const std::filesystem::path& file) {
    std::vector<std::string> arguments{"ffmpeg", "-hide_banner", "-nostdin", "-loglevel", "error", "-y"};
    const auto add = [&](std::initializer_list<std::string> more) { arguments.insert(arguments.end(), more); };
    add({"-f", "rawvideo", "-pixel_format", "rgb24", "-video_size", fmt::format("{}x{}", format.width, format.height),
         "-framerate", fmt::format("{}", format.fps), "-i", "pipe:0"});
    if (!format.sound.empty()) add({"-i", format.sound, "-c:a", "aac", "-b:a", "192k"});
    add({"-c:v", "libx264", "-preset", "medium", "-crf", "20", "-pix_fmt", "yuv420p", "-movflags", "+faststart", "-f",
         "mp4", file.string()});
    return arguments;
}

FilmWriter::FilmWriter(std::filesystem::path file, const FilmFormat& format)
    : file_(std::move(file)), part_(file_.string() + ".part"), complaints_(std::tmpfile(), std::fclose) {
    std::array<int, 2> ends{};
    if (complaints_ == nullptr || ::pipe2(ends.data(), O_CLOEXEC) != 0) {
        throw Error(ErrorCode::input_output, file_.string(),
                    "no pipe to ffmpeg: " + std::generic_category().message(errno));
    }
    // What ffmpeg no longer reads is an error of write(), and no reason to be killed.
    std::signal(SIGPIPE, SIG_IGN);
    const int error = spawn(ffmpeg_arguments(format, part_), ends[0], ::fileno(complaints_.get()), ffmpeg_);
    ::close(ends[0]);
    pipe_ = ends[1];
    if (error != 0) {
        ::close(pipe_);
        throw Error(ErrorCode::not_available, "ffmpeg",
                    error == ENOENT ? "is missing, and films need it: install the package ffmpeg"
                                    : "cannot be started: " + std::generic_category().message(error));
    }
}

FilmWriter::~FilmWriter() {
    if (ffmpeg_ < 0) return;
    ::kill(ffmpeg_, SIGKILL);
    wait_for_ffmpeg();
    std::error_code ignored; // a destructor has nobody to tell
    std::filesystem::remove(part_, ignored);
}

int FilmWriter::wait_for_ffmpeg() {
    if (pipe_ >= 0) ::close(std::exchange(pipe_, -1));
    int status = 0;
    while (::waitpid(ffmpeg_, &status, 0) < 0 && errno == EINTR) {
    }
    ffmpeg_ = -1;
    return status;
}

void FilmWriter::fail() {
    std::error_code ignored; // the film's own error is the one to tell
    std::filesystem::remove(part_, ignored);
    throw Error(ErrorCode::input_output, file_.string(), "ffmpeg has failed: " + text_of(complaints_.get()));
}

void FilmWriter::add(const Image& frame) {
    std::size_t done = 0;
    while (done < frame.pixels.size()) {
        const ssize_t written = ::write(pipe_, frame.pixels.data() + done, frame.pixels.size() - done);
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) {
            wait_for_ffmpeg();
            fail();
        }
        done += static_cast<std::size_t>(written);
    }
}

void FilmWriter::finish() {
    if (wait_for_ffmpeg() != 0) fail();
    scene::publish(part_, file_);
}

} // namespace carom::viewer
