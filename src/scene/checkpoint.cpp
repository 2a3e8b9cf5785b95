#include "scene/checkpoint.hpp"

#include <carom/base.hpp>

#include <fmt/format.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <bit>
#include <string_view>
#include <utility>

namespace carom::scene {

namespace {

// Layout: signature (8 bytes), version (8), length of what follows the checksum (8), XXH64 of that (8), identity,
// progress, snapshot of the world. Whole numbers have 8 bytes, lowest first; doubles are their bits; texts and lists
// begin with their length.
constexpr std::string_view signature = "caromCKP";
constexpr std::uint64_t format_version = 1;
constexpr std::size_t head_size = 32;

[[noreturn]] void refuse(const std::string& reason) { throw Error(ErrorCode::bad_data, "checkpoint", reason); }

std::uint64_t checksum(std::span<const std::byte> bytes) { return XXH64(bytes.data(), bytes.size(), 0); }

std::string_view as_text(std::span<const std::byte> bytes) {
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

class Writer {
public:
    void number(std::uint64_t value) {
        for (unsigned shift = 0; shift < 64; shift += 8) {
            bytes_.push_back(static_cast<std::byte>((value >> shift) & 0xffU));
        }
    }
    void number(bool value) { number(static_cast<std::uint64_t>(value)); }
    void number(Precision value) { number(static_cast<std::uint64_t>(value)); }
    void number(double value) { number(std::bit_cast<std::uint64_t>(value)); }
    void number(const Vec3& value) {
        for (const double component : {value.x, value.y, value.z}) number(component);
    }
    void raw(std::span<const std::byte> bytes) { bytes_.insert(bytes_.end(), bytes.begin(), bytes.end()); }
    void text(std::string_view value) {
        number(std::uint64_t{value.size()});
        raw(std::as_bytes(std::span(value)));
    }
    [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

private:
    std::vector<std::byte> bytes_;
};

/// The counterpart of Writer. The checksum was right, so a length that leads beyond the end is a mistake of whoever
/// wrote the file; it is refused all the same.
class Reader {
public:
    explicit Reader(std::span<const std::byte> bytes) : bytes_(bytes) {}

    void number(std::uint64_t& value) {
        const std::span<const std::byte> raw = take(8);
        value = 0;
        for (std::size_t i = 8; i-- > 0;) value = (value << 8U) | std::to_integer<std::uint64_t>(raw[i]);
    }
    void number(bool& value) { value = small_number(1) != 0; }
    void number(Precision& value) { value = static_cast<Precision>(small_number(1)); }
    void number(double& value) {
        std::uint64_t bits = 0;
        number(bits);
        value = std::bit_cast<double>(bits);
    }
    void number(Vec3& value) {
        for (double* component : {&value.x, &value.y, &value.z}) number(*component);
    }
    void text(std::string& value) { value = as_text(take(small_number(bytes_.size()))); }
    /// The number of elements of `size` bytes that follow.
    std::size_t count(std::size_t size) { return small_number(bytes_.size() / size); }
    std::span<const std::byte> rest() { return take(bytes_.size()); }

private:
    std::size_t small_number(std::size_t largest) {
        std::uint64_t value = 0;
        number(value);
        if (value > largest) refuse("a value in it is out of range");
        return value;
    }
    std::span<const std::byte> take(std::size_t size) {
        if (size > bytes_.size()) refuse("ends too early");
        const std::span<const std::byte> taken = bytes_.first(size);
        bytes_ = bytes_.subspan(size);
        return taken;
    }

    std::span<const std::byte> bytes_;
};

// Each record is described once, for writing and for reading.

template <class Archive, class Identity>
void identity_fields(Archive& archive, Identity& identity) {
    archive.text(identity.scene);
    archive.number(identity.bodies);
    archive.number(identity.world);
    archive.number(identity.precision);
    archive.number(identity.dt);
    archive.number(identity.timeline_every);
    archive.number(identity.check_overlap);
    archive.number(identity.record_impacts);
}

template <class Archive, class BooksType>
void books_fields(Archive& archive, BooksType& books) {
    archive.number(books.kinetic);
    archive.number(books.potential);
    archive.number(books.lost);
    archive.number(books.momentum);
    archive.number(books.outer_impulse);
    archive.number(books.momentum_scale);
}

constexpr std::size_t row_size = 96; // 12 numbers

template <class Archive, class Row>
void row_fields(Archive& archive, Row& row) {
    archive.number(row.time);
    archive.number(row.step);
    archive.number(row.kinetic);
    archive.number(row.potential);
    archive.number(row.total);
    archive.number(row.lost);
    archive.number(row.momentum);
    archive.number(row.impacts);
    archive.number(row.face_impacts);
    archive.number(row.contacts);
}

template <class Archive, class Progress>
void progress_fields(Archive& archive, Progress& progress) {
    archive.number(progress.steps);
    archive.number(progress.last_step_short);
    books_fields(archive, progress.start);
    archive.number(progress.largest_overlap);
    archive.number(progress.contacts);
    archive.text(progress.impact_log);
}

/// The checked bytes behind the head.
std::span<const std::byte> body_of(std::span<const std::byte> bytes) {
    if (!looks_like_checkpoint(bytes)) refuse("is no checkpoint of carom");
    if (bytes.size() < head_size) refuse(fmt::format("is cut off: it ends after {} bytes", bytes.size()));
    Reader head(bytes.subspan(signature.size()));
    std::uint64_t version = 0;
    std::uint64_t size = 0;
    std::uint64_t sum = 0;
    head.number(version);
    head.number(size);
    head.number(sum);
    if (version != format_version) {
        refuse(fmt::format("has format version {}; this program reads version {}", version, format_version));
    }
    const std::span<const std::byte> body = bytes.subspan(head_size);
    if (body.size() < size) refuse(fmt::format("is cut off: {} of {} bytes are there", body.size(), size));
    if (body.size() > size) refuse(fmt::format("is too long by {} bytes", body.size() - size));
    if (checksum(body) != sum) refuse("is damaged: its checksum is wrong");
    return body;
}

} // namespace

RunIdentity identity_of(const World& world, std::string scene) {
    const std::vector<std::byte> snapshot = world.save();
    return {.scene = std::move(scene),
            .bodies = world.size(),
            .world = checksum(snapshot),
            .precision = world.options().precision};
}

std::optional<std::string> difference(const RunIdentity& saved, const RunIdentity& wanted) {
    const auto name = [](Precision p) { return p == Precision::single_precision ? "single" : "double"; };
    if (saved.scene != wanted.scene) return fmt::format("it is of scene {}, not {}", saved.scene, wanted.scene);
    if (saved.precision != wanted.precision) {
        return fmt::format("its precision is {}, not {}", name(saved.precision), name(wanted.precision));
    }
    if (saved.dt != wanted.dt) return fmt::format("its dt is {} s, not {} s", saved.dt, wanted.dt);
    if (saved.bodies != wanted.bodies) {
        return fmt::format("its scene has {} bodies, not {}", saved.bodies, wanted.bodies);
    }
    if (saved.timeline_every != wanted.timeline_every || saved.check_overlap != wanted.check_overlap ||
        saved.record_impacts != wanted.record_impacts) {
        return "its run wrote other outputs";
    }
    if (saved.world != wanted.world) return "the scene has changed since";
    return std::nullopt;
}

std::vector<std::byte> save_checkpoint(const RunIdentity& identity, const RunProgress& progress, const World& world) {
    Writer body;
    identity_fields(body, identity);
    progress_fields(body, progress);
    body.number(std::uint64_t{progress.rows.size()});
    for (const TimelineRow& row : progress.rows) row_fields(body, row);
    body.raw(world.save());
    const std::vector<std::byte> content = body.take();

    Writer file;
    file.raw(std::as_bytes(std::span(signature)));
    file.number(format_version);
    file.number(std::uint64_t{content.size()});
    file.number(checksum(content));
    file.raw(content);
    return file.take();
}

bool looks_like_checkpoint(std::span<const std::byte> bytes) { return as_text(bytes).starts_with(signature); }

Checkpoint load_checkpoint(std::span<const std::byte> bytes) {
    Reader body(body_of(bytes));
    RunIdentity identity;
    RunProgress progress;
    identity_fields(body, identity);
    progress_fields(body, progress);
    progress.rows.resize(body.count(row_size));
    for (TimelineRow& row : progress.rows) row_fields(body, row);
    return {std::move(identity), std::move(progress), World::load(body.rest())};
}

} // namespace carom::scene
