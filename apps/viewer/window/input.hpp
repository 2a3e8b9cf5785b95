/// \file
/// Mouse and keys between two frames, whoever presses them: a user or a script.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace carom::viewer {

enum class MouseButton : std::uint8_t { left, right, middle };
inline constexpr std::size_t mouse_buttons = 3;

/// The keys that mean something here.
enum class Key : std::uint8_t {
    space,
    left,
    right,
    escape,
    f1,
    w,
    a,
    s,
    d,
    q,
    e,
    f,
    c,
    r,
    b,
    h,
    t,
    one,
    two,
    three,
    p,
    m,
    shift
};
/// Their names in scripts, in the order of the enumeration.
inline constexpr std::array<std::string_view, 23> key_names{"space", "left", "right", "escape", "f1", "w", "a",    "s",
                                                            "d",     "q",    "e",     "f",      "c",  "r", "b",    "h",
                                                            "t",     "1",    "2",     "3",      "p",  "m", "shift"};
std::optional<Key> key_named(std::string_view name);

class Input {
public:
    /// \name What happens
    /// @{
    void press(Key key);
    void release(Key key) { keys_[index(key)] = false; }
    void press(MouseButton button);
    void release(MouseButton button);
    void move_mouse(double x, double y);
    void turn_wheel(double notches) { wheel_ += notches; }
    /// @}

    /// \name What has happened since the last next_frame()
    /// @{
    [[nodiscard]] bool is_down(Key key) const { return keys_[index(key)]; }
    /// Down now, or for a moment since the last frame.
    [[nodiscard]] bool is_down(MouseButton button) const {
        return buttons_[static_cast<std::size_t>(button)] || touched_[static_cast<std::size_t>(button)];
    }
    [[nodiscard]] const std::vector<Key>& pressed() const { return pressed_; }
    [[nodiscard]] double mouse_x() const { return x_; }
    [[nodiscard]] double mouse_y() const { return y_; }
    [[nodiscard]] double dragged_x() const { return dragged_x_; } ///< pixels, with a button down
    [[nodiscard]] double dragged_y() const { return dragged_y_; }
    [[nodiscard]] double wheel() const { return wheel_; }
    /// The left button went down and up again in one place.
    [[nodiscard]] bool clicked() const { return clicked_; }
    /// @}

    void next_frame();

private:
    static std::size_t index(Key key) { return static_cast<std::size_t>(key); }

    std::array<bool, key_names.size()> keys_{};
    std::array<bool, mouse_buttons> buttons_{};
    std::array<bool, mouse_buttons> touched_{};
    std::vector<Key> pressed_;
    double x_ = -1;
    double y_ = -1;
    double dragged_x_ = 0;
    double dragged_y_ = 0;
    double way_ = 0; ///< pixels, since the left button went down
    double wheel_ = 0;
    bool clicked_ = false;
};

} // namespace carom::viewer
