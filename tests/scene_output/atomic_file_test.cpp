#include "scene/atomic_file.hpp"
#include "scene/temporary_folder.hpp"

#include <carom/base.hpp>

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <iterator>
#include <string>

namespace carom::test {
namespace {

using scene::TemporaryFolder;

std::string content(const std::filesystem::path& file) {
    std::string text;
    for (const std::byte byte : scene::read_file(file)) text.push_back(static_cast<char>(byte));
    return text;
}

std::size_t files_in(const std::filesystem::path& folder) {
    const std::filesystem::directory_iterator files(folder);
    return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

/// Files of this process may not grow beyond so many bytes, as if the disk were full.
class FileSizeLimit {
public:
    explicit FileSizeLimit(rlim_t bytes) : old_handler_(std::signal(SIGXFSZ, SIG_IGN)) {
        ::getrlimit(RLIMIT_FSIZE, &old_);
        rlimit limit = old_;
        limit.rlim_cur = bytes;
        ::setrlimit(RLIMIT_FSIZE, &limit);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &old_);
        std::signal(SIGXFSZ, old_handler_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

private:
    void (*old_handler_)(int);
    rlimit old_{};
};

void expect_refused(const std::filesystem::path& file, std::string_view text) {
    try {
        scene::write_file(file, text);
        ADD_FAILURE() << file << " was written";
    } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::input_output);
        EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos) << error.what();
    }
}

TEST(AtomicFile, HoldsWhatWasWritten) {
    const TemporaryFolder folder;
    const std::string text("a\0b\n", 4);
    scene::write_file(folder.path() / "file", text);
    EXPECT_EQ(content(folder.path() / "file"), text);
    scene::write_file(folder.path() / "file", std::string_view());
    EXPECT_EQ(content(folder.path() / "file"), "");
    const std::string large(5'000'000, 'x');
    scene::write_file(folder.path() / "file", large);
    EXPECT_EQ(content(folder.path() / "file"), large);
    EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(AtomicFile, OldContentSurvivesAFullDisk) {
    const TemporaryFolder folder;
    scene::write_file(folder.path() / "file", std::string_view("old"));
    {
        const FileSizeLimit limit(1000);
        expect_refused(folder.path() / "file", std::string(100'000, 'x'));
    }
    EXPECT_EQ(content(folder.path() / "file"), "old");
    EXPECT_EQ(files_in(folder.path()), 1U) << "a part was left behind";
}

TEST(AtomicFile, LeftoverPartOfADeadWriterIsNoObstacle) {
    const TemporaryFolder folder;
    scene::write_file(folder.path() / "file.part", std::string(1000, 'x'));
    scene::write_file(folder.path() / "file", std::string_view("new"));
    EXPECT_EQ(content(folder.path() / "file"), "new");
    EXPECT_EQ(files_in(folder.path()), 1U);
}

TEST(AtomicFile, RefusesWhatIsNoPlaceForAFile) {
    const TemporaryFolder folder;
    expect_refused(folder.path() / "missing/file", "text");
    scene::write_file(folder.path() / "file", std::string_view("old"));
    expect_refused(folder.path() / "file/below", "text");
    std::filesystem::create_directory(folder.path() / "taken");
    expect_refused(folder.path() / "taken", "text");
    EXPECT_EQ(files_in(folder.path()), 2U);
}

TEST(AtomicFile, ReadingNamesTheFile) {
    const TemporaryFolder folder;
    EXPECT_THROW(scene::read_file(folder.path() / "missing"), Error);
    EXPECT_THROW(scene::read_file(folder.path()), Error);
}

} // namespace
} // namespace carom::test
