#include "output_folder.hpp"

#include "scene/atomic_file.hpp"

#include <carom/base.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

namespace carom::cli {

namespace {

[[noreturn]] void fail(const std::filesystem::path& folder, const std::string& reason) {
    throw Error(ErrorCode::input_output, folder.string(), reason);
}

void make(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error) fail(folder, "cannot be made: " + error.message());
    if (!std::filesystem::is_directory(folder, error)) fail(folder, "is not a folder");
}

/// Better now than after hours of computing.
void try_to_write(const std::filesystem::path& folder) {
    const std::filesystem::path probe = folder / ".carom-probe";
    try {
        scene::write_file(probe, std::string_view("probe\n"));
    } catch (const Error& error) {
        fail(folder, std::string("cannot be written into: ") + error.what());
    }
    std::error_code ignored;
    std::filesystem::remove(probe, ignored);
}

/// The opened folder, locked; -1 where folders cannot be opened.
int lock(const std::filesystem::path& folder) {
    const int handle = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (handle >= 0 && ::flock(handle, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
        ::close(handle);
        fail(folder, "another run is writing into this folder");
    }
    return handle;
}

} // namespace

OutputFolder::OutputFolder(std::filesystem::path path) : path_(std::move(path)) {
    make(path_);
    const int handle = lock(path_);
    try {
        try_to_write(path_);
    } catch (...) {
        ::close(handle);
        throw;
    }
    handle_ = handle;
}

OutputFolder::~OutputFolder() {
    if (handle_ >= 0) ::close(handle_);
}

} // namespace carom::cli
