/// \file
/// A run of ffmpeg that reads from a pipe.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <cstdio>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace carom::viewer {

class Ffmpeg {
public:
    /// Starts it; its input is "pipe:0". `product`: what errors name. Throws carom::Error{not_available} if it is
    /// missing.
    Ffmpeg(const std::vector<std::string>& arguments, std::string product);
    /// Ends it, whatever it does.
    ~Ffmpeg();
    Ffmpeg(const Ffmpeg&) = delete;
    Ffmpeg& operator=(const Ffmpeg&) = delete;

    /// Throws carom::Error{input_output} with what ffmpeg says.
    void write(std::span<const std::byte> bytes);
    /// There is no more to read: waits until it has ended. Throws as write().
    void finish();

private:
    int wait();
    [[noreturn]] void fail(); ///< it has ended

    std::string product_;
    std::unique_ptr<std::FILE, int (*)(std::FILE*)> complaints_; ///< its standard error
    int pipe_ = -1;
    pid_t process_ = -1;
};

} // namespace carom::viewer
