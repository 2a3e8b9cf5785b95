/// \file
/// The bytes of checkpoints. One function, `transfer`, describes the layout of a class for both directions. Whole
/// numbers have 8 bytes, lowest first; doubles are their bits; texts and lists begin with their length.
#pragma once

#include <carom/base.hpp>
#include <carom/world.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace carom::scene {

/// What says itself of what it consists.
template <class T, class Archive>
concept Transferable = requires(T& value, Archive& archive) { T::transfer(archive, value); };

inline std::string_view as_text(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Appends values to a list of bytes.
class Writer {
public:
    template <class... T>
    void operator()(const T&... values) {
        (put(values), ...);
    }
    /// Of a list whose length is known to whoever reads it: only its elements.
    template <class T>
    void elements(const T& values) {
        for (const auto& value : values) put(value);
    }
    /// What whoever reads it knows already.
    template <class... T>
    void settings(const T&... values) {
        (put(values), ...);
    }
    void raw(std::span<const std::byte> bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }
    [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

private:
    void put(std::uint64_t value) {
        for (unsigned shift = 0; shift < 64; shift += 8) {
            bytes_.push_back(static_cast<std::byte>((value >> shift) & 0xffU));
        }
    }
    void put(bool value) { put(static_cast<std::uint64_t>(value)); }
    void put(Precision value) { put(static_cast<std::uint64_t>(value)); }
    void put(double value) { put(std::bit_cast<std::uint64_t>(value)); }
    void put(const Vec3& value) {
        for (const double component : {value.x, value.y, value.z}) put(component);
    }
    void put(const std::string& value) {
        put(std::uint64_t{value.size()});
        raw(std::as_bytes(std::span(value)));
    }
    void put(const std::vector<std::byte>& bytes) {
        put(std::uint64_t{bytes.size()});
        raw(bytes);
    }
    template <class T>
    void put(const std::vector<T>& values) {
        put(std::uint64_t{values.size()});
        elements(values);
    }
    template <class T, std::size_t N>
    void put(const std::array<T, N>& values) {
        elements(values);
    }
    template <class T>
    void put(const std::optional<T>& value) {
        put(value.has_value());
        if (value) put(*value);
    }
    template <Transferable<Writer> T>
    void put(const T& value) {
        T::transfer(*this, value);
    }

    std::vector<std::byte> bytes_;
};

/// The counterpart of Writer. Lengths that lead beyond the end are refused: Error{bad_data}.
class Reader {
public:
    explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    template <class... T>
    void operator()(T&... values) {
        (take(values), ...);
    }
    template <class T>
    void elements(T& values) {
        for (auto& value : values) take(value);
    }
    template <class... T>
    void settings(const T&... values) {
        (check(values), ...);
    }
    std::span<const std::byte> rest() { return take_bytes(bytes_.size()); }

private:
    [[noreturn]] static void refuse(const char* reason) { throw Error(ErrorCode::bad_data, "checkpoint", reason); }

    template <class T>
    void check(const T& known) {
        T value{};
        take(value);
        if (value != known) refuse("contradicts itself");
    }
    void take(std::uint64_t& value) {
        const std::span<const std::byte> raw = take_bytes(8);
        value = 0;
        for (std::size_t i = 8; i-- > 0;) value = (value << 8U) | std::to_integer<std::uint64_t>(raw[i]);
    }
    void take(bool& value) { value = small_number(1) != 0; }
    void take(Precision& value) { value = static_cast<Precision>(small_number(1)); }
    void take(double& value) {
        std::uint64_t bits = 0;
        take(bits);
        value = std::bit_cast<double>(bits);
    }
    void take(Vec3& value) {
        for (double* component : {&value.x, &value.y, &value.z}) take(*component);
    }
    void take(std::string& value) { value = as_text(take_bytes(small_number(bytes_.size()))); }
    void take(std::vector<std::byte>& bytes) {
        const std::span<const std::byte> taken = take_bytes(small_number(bytes_.size()));
        bytes.assign(taken.begin(), taken.end());
    }
    /// Every element has a number of 8 bytes at least.
    template <class T>
    void take(std::vector<T>& values) {
        values.assign(small_number(bytes_.size() / 8), T{});
        elements(values);
    }
    template <class T, std::size_t N>
    void take(std::array<T, N>& values) {
        elements(values);
    }
    template <class T>
    void take(std::optional<T>& value) {
        bool given = false;
        take(given);
        value = given ? std::optional<T>{T{}} : std::nullopt;
        if (given) take(*value);
    }
    template <Transferable<Reader> T>
    void take(T& value) {
        T::transfer(*this, value);
    }

    std::size_t small_number(std::size_t largest) {
        std::uint64_t value = 0;
        take(value);
        if (value > largest) refuse("a value in it is out of range");
        return value;
    }
    std::span<const std::byte> take_bytes(std::size_t size) {
        if (size > bytes_.size()) refuse("ends too early");
        const std::span<const std::byte> taken = bytes_.first(size);
        bytes_ = bytes_.subspan(size);
        return taken;
    }

    std::span<const std::byte> bytes_;
};

} // namespace carom::scene
