#include "viewer/film/ffmpeg.hpp"

#include <carom/base.hpp>

#include <fcntl.h>
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
int spawn(std::vector<std::string> arguments, int input, int complaints, pid_t& process) {
    std::vector<char*> pointers;
    pointers.reserve(arguments.size() + 1);
    for (std::string& argument : arguments) pointers.push_back(argument.data());
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

/// Its beginning, without the end of the last line.
std::string text_of(std::FILE* file) {
    std::array<char, 2000> buffer{};
    if (std::fseek(file, 0, SEEK_SET) != 0) return "";
    std::string text(buffer.data(), std::fread(buffer.data(), 1, buffer.size(), file));
    while (text.ends_with('\n')) text.pop_back();
    return text;
}

} // namespace

Ffmpeg::Ffmpeg(const std::vector<std::string>& arguments, std::string product)
    : product_(std::move(product)), complaints_(std::tmpfile(), std::fclose) {
    std::array<int, 2> ends{};
    if (complaints_ == nullptr || ::pipe2(ends.data(), O_CLOEXEC) != 0) {
        throw Error(ErrorCode::input_output, product_,
                    "there is no pipe to ffmpeg: " + std::generic_category().message(errno));
    }
    // What ffmpeg no longer reads is an error of write(), and no reason to be killed.
    std::signal(SIGPIPE, SIG_IGN);
    std::vector<std::string> command{"ffmpeg", "-hide_banner", "-nostdin", "-loglevel", "error", "-xerror", "-y"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const int error = spawn(std::move(command), ends[0], ::fileno(complaints_.get()), process_);
    ::close(ends[0]);
    pipe_ = ends[1];
    if (error != 0) {
        ::close(pipe_);
        throw Error(ErrorCode::not_available, "ffmpeg",
                    error == ENOENT ? "is missing, and films need it: install the package ffmpeg"
                                    : "cannot be started: " + std::generic_category().message(error));
    }
}

Ffmpeg::~Ffmpeg() {
    if (process_ < 0) return;
    ::kill(process_, SIGKILL);
    wait();
}

int Ffmpeg::wait() {
    if (pipe_ >= 0) ::close(std::exchange(pipe_, -1));
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    process_ = -1;
    return status;
}

void Ffmpeg::fail() {
    throw Error(ErrorCode::input_output, product_, "ffmpeg has failed: " + text_of(complaints_.get()));
}

void Ffmpeg::write(std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(pipe_, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) {
            wait();
            fail();
        }
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
}

void Ffmpeg::finish() {
    if (wait() != 0) fail();
}

} // namespace carom::viewer
