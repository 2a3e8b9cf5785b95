/// \file
/// A property of bodies that is the same for all of most worlds.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace carom::core {

/// One value per body: a single one as long as all are equal, an array from then on.
template <class T>
class Column {
public:
    Column() = default;
    explicit Column(const T& shared) : shared_(shared) {}

    [[nodiscard]] T operator[](std::size_t i) const { return own_.empty() ? shared_ : own_[i]; }

    /// The value of one more body than the `size` so far.
    void append(const T& value, std::size_t size) {
        if (size == 0) {
            own_.clear();
            shared_ = value;
        }
        if (own_.empty() && !(value == shared_)) own_.assign(size, shared_);
        if (!own_.empty()) own_.push_back(value);
    }
    /// Changes the value of one of `size` bodies.
    void set(std::size_t i, const T& value, std::size_t size) {
        if (own_.empty() && value == shared_) return;
        if (own_.empty()) own_.assign(size, shared_);
        own_[i] = value;
    }
    /// Forgets what the values of `size` bodies do not tell: those of others, and that they were once different.
    void normalise(std::size_t size) {
        if (size == 0) *this = {};
        const auto is_shared = [this](const T& value) { return value == own_.front(); };
        if (!own_.empty() && std::all_of(own_.begin(), own_.end(), is_shared)) *this = Column(own_.front());
    }

    /// The array; empty while one value does.
    [[nodiscard]] std::vector<T>& array() { return own_; }
    [[nodiscard]] bool is_sound(std::size_t size) const { return own_.empty() || own_.size() == size; }

    template <class Archive>
    void transfer(Archive& archive) {
        archive(shared_, own_);
    }

private:
    T shared_{};
    std::vector<T> own_;
};

} // namespace carom::core
