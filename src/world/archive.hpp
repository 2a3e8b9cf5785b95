/// \file
/// Bytes in and out. One function, `transfer`, describes a layout for both directions. Little-endian.
#pragma once

#include "space/bodies.hpp"
#include "space/sum.hpp"

#include <carom/base.hpp>
#include <carom/world.hpp>

#include <bit>
#include <concepts>
#include <cstring>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

namespace carom::core {

static_assert(std::endian::native == std::endian::little, "snapshots are written as they lie in memory");

template <class T>
concept Plain = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// Appends values to a list of bytes.
class Writer {
public:
    static constexpr bool reading = false;

    template <class... T>
    void operator()(T&... values) {
        (put(values), ...);
    }
    [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

private:
    template <Plain T>
    void put(const T& value) {
        const auto* data = reinterpret_cast<const std::byte*>(&value);
        bytes_.insert(bytes_.end(), data, data + sizeof(T));
    }
    template <class T>
        requires(!Plain<T>)
    void put(T& value) {
        transfer(*this, value);
    }

    std::vector<std::byte> bytes_;
};

/// Takes values from bytes. Throws Error{bad_data} where they end too early.
class Reader {
public:
    static constexpr bool reading = true;

    explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    template <class... T>
    void operator()(T&... values) {
        (take(values), ...);
    }
    [[nodiscard]] std::size_t left() const { return bytes_.size(); }
    [[nodiscard]] std::span<const std::byte> rest() const { return bytes_; }

private:
    template <Plain T>
    void take(T& value) {
        if (bytes_.size() < sizeof(T)) throw Error(ErrorCode::bad_data, "snapshot", "ends too early");
        if constexpr (std::is_same_v<T, bool>) {
            if (bytes_.front() > std::byte{1}) throw Error(ErrorCode::bad_data, "snapshot", "contradicts itself");
        }
        std::memcpy(&value, bytes_.data(), sizeof(T));
        bytes_ = bytes_.subspan(sizeof(T));
    }
    template <class T>
        requires(!Plain<T>)
    void take(T& value) {
        transfer(*this, value);
    }

    std::span<const std::byte> bytes_;
};

template <class Archive, class T>
void transfer(Archive& archive, Vector3<T>& v) {
    archive(v.x, v.y, v.z);
}

template <class Archive>
void transfer(Archive& archive, Int3& v) {
    archive(v.x, v.y, v.z);
}

template <class Archive>
void transfer(Archive& archive, Sum& sum) {
    archive(sum.main, sum.carry);
}

template <class Archive>
void transfer(Archive& archive, VectorSum& sum) {
    archive(sum.x, sum.y, sum.z);
}

template <class Archive, class T, std::size_t N>
void transfer(Archive& archive, std::array<T, N>& values) {
    for (T& value : values) archive(value);
}

template <class Archive, class T>
void transfer(Archive& archive, std::optional<T>& value) {
    bool given = value.has_value();
    archive(given);
    if constexpr (Archive::reading) value = given ? std::optional<T>{T{}} : std::nullopt;
    if (given) archive(*value);
}

/// A list: its length, which cannot exceed the bytes that are left, and its elements.
template <class Archive, class T, class Allocator>
void transfer(Archive& archive, std::vector<T, Allocator>& values) {
    std::uint64_t count = values.size();
    archive(count);
    if constexpr (Archive::reading) {
        if (count > archive.left()) throw Error(ErrorCode::bad_data, "snapshot", "ends too early");
        values.clear();
        values.reserve(static_cast<std::size_t>(count));
        for (std::uint64_t k = 0; k < count; ++k) archive(values.emplace_back());
    } else {
        for (T& value : values) archive(value);
    }
}

} // namespace carom::core
