#include "viewer/window/input.hpp"

#include <algorithm>
#include <cmath>

namespace carom::viewer {

std::optional<Key> key_named(std::string_view name) {
    const auto* const found = std::find(key_names.begin(), key_names.end(), name);
    if (found == key_names.end()) return std::nullopt;
    return static_cast<Key>(found - key_names.begin());
}

void Input::press(Key key) {
    if (!keys_[index(key)]) pressed_.push_back(key);
    keys_[index(key)] = true;
}

void Input::press(MouseButton button) {
    buttons_[static_cast<std::size_t>(button)] = true;
    touched_[static_cast<std::size_t>(button)] = true;
    if (button == MouseButton::left) way_ = 0;
}

void Input::release(MouseButton button) {
    constexpr double steady = 4; // pixels
    if (button == MouseButton::left && buttons_[0] && way_ < steady) clicked_ = true;
    buttons_[static_cast<std::size_t>(button)] = false;
}

void Input::move_mouse(double x, double y) {
    if (std::any_of(buttons_.begin(), buttons_.end(), [](bool down) { return down; })) {
        dragged_x_ += x - x_;
        dragged_y_ += y - y_;
        way_ += std::abs(x - x_) + std::abs(y - y_);
    }
    x_ = x;
    y_ = y;
}

void Input::next_frame() {
    touched_ = {};
    pressed_.clear();
    dragged_x_ = dragged_y_ = wheel_ = 0;
    clicked_ = false;
}

} // namespace carom::viewer
