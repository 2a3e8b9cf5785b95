/// \file
/// How finely the window's picture is drawn.
#pragma once

namespace carom::viewer {

/// Where sixty pictures a second are too many for what draws them, they are drawn smaller than the window.
class Detail {
public:
    static constexpr int coarsest = 3;

    /// The window is so many times as wide and high as the picture, 1 to `coarsest`.
    [[nodiscard]] int divisor() const { return divisor_; }
    /// A frame with that divisor took `seconds` of the wall clock.
    void took(double seconds) {
        constexpr int frames = 8; // before it decides
        sum_ += seconds;
        if (++count_ < frames) return;
        const double mean = sum_ / frames;
        count_ = 0;
        sum_ = 0;
        constexpr double aim = 1.0 / 60;
        constexpr double late = 1.25 * aim;
        constexpr double early = 0.75 * aim; // far enough from the other that it does not swing
        const double finer = static_cast<double>(divisor_) / (divisor_ - (divisor_ > 1 ? 1 : 0));
        if (mean > late && divisor_ < coarsest) {
            ++divisor_;
        } else if (divisor_ > 1 && mean * finer * finer < early) {
            --divisor_;
        }
    }

private:
    int divisor_ = 1;
    int count_ = 0;
    double sum_ = 0; ///< s
};

} // namespace carom::viewer
