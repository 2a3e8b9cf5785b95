#include "scene/atomic_file.hpp"

#include <carom/base.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <string>
#include <system_error>
#include <utility>

namespace carom::scene {

namespace {

/// Throws for what `errno` says. Its value is an argument, because the caller may have to clean up first.
[[noreturn]] void fail(const std::filesystem::path& file, const std::string& what, int error) {
    throw Error(ErrorCode::input_output, file.string(), what + ": " + std::generic_category().message(error));
}

/// An open file that is closed at the end of its scope.
class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;

    [[nodiscard]] int get() const { return number_; }
    [[nodiscard]] bool is_open() const { return number_ >= 0; }
    /// Closes now; some file systems report only here that a write has failed.
    [[nodiscard]] bool close() { return ::close(std::exchange(number_, -1)) == 0; }

private:
    int number_;
};

int open_retrying(const std::filesystem::path& file, int flags) {
    for (;;) {
        const int number = ::open(file.c_str(), flags | O_CLOEXEC, 0666);
        if (number >= 0 || errno != EINTR) return number;
    }
}

bool write_all(int number, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(number, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return true;
}

/// Brings the new name itself to the disk, as far as the folder may be read and its file system can (else EINVAL).
bool sync_folder_of(const std::filesystem::path& file) {
    const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
    const Descriptor handle(open_retrying(folder, O_RDONLY | O_DIRECTORY));
    return !handle.is_open() || ::fsync(handle.get()) == 0 || errno == EINVAL;
}

} // namespace

void write_file(const std::filesystem::path& file, std::span<const std::byte> bytes) {
    std::filesystem::path part = file;
    part += ".part";
    Descriptor handle(open_retrying(part, O_WRONLY | O_CREAT | O_TRUNC));
    if (!handle.is_open()) fail(file, "cannot be created", errno);
    if (!write_all(handle.get(), bytes) || ::fsync(handle.get()) != 0 || !handle.close() ||
        std::rename(part.c_str(), file.c_str()) != 0) {
        const int error = errno;
        ::unlink(part.c_str());
        fail(file, "cannot be written", error);
    }
    if (!sync_folder_of(file)) fail(file, "is written, but may not survive a power failure", errno);
}

void write_file(const std::filesystem::path& file, std::string_view text) {
    write_file(file, std::as_bytes(std::span(text)));
}

void publish(const std::filesystem::path& part, const std::filesystem::path& file) {
    const Descriptor handle(open_retrying(part, O_RDONLY));
    if (!handle.is_open() || ::fsync(handle.get()) != 0 || std::rename(part.c_str(), file.c_str()) != 0) {
        const int error = errno;
        ::unlink(part.c_str());
        fail(file, "cannot be written", error);
    }
    if (!sync_folder_of(file)) fail(file, "is written, but may not survive a power failure", errno);
}

std::vector<std::byte> read_file(const std::filesystem::path& file) {
    const Descriptor handle(open_retrying(file, O_RDONLY));
    if (!handle.is_open()) fail(file, "cannot be opened", errno);
    constexpr std::size_t chunk = std::size_t{1} << 20U;
    std::vector<std::byte> bytes;
    for (;;) {
        const std::size_t filled = bytes.size();
        bytes.resize(filled + chunk);
        const ssize_t got = ::read(handle.get(), bytes.data() + filled, chunk);
        if (got < 0 && errno != EINTR) fail(file, "cannot be read", errno);
        bytes.resize(filled + static_cast<std::size_t>(got > 0 ? got : 0));
        if (got == 0) return bytes;
    }
}

} // namespace carom::scene
