#include "scene/checkpoint.hpp"

#include "scene/archive.hpp"

#include <carom/base.hpp>

#include <fmt/format.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <string_view>
#include <utility>

namespace carom::scene {

namespace {

// Layout: signature (8 bytes), version (8), length of what follows the checksum (8), XXH64 of that (8), identity,
// progress, what observers have seen, snapshot of the world.
constexpr std::string_view signature = "caromCKP";
constexpr std::uint64_t format_version = 3;
constexpr std::size_t head_size = 32;

[[noreturn]] void refuse(const std::string& reason) { throw Error(ErrorCode::bad_data, "checkpoint", reason); }

std::uint64_t checksum(std::span<const std::byte> bytes) { return XXH64(bytes.data(), bytes.size(), 0); }

/// The checked bytes behind the head.
std::span<const std::byte> body_of(std::span<const std::byte> bytes) {
    if (!looks_like_checkpoint(bytes)) refuse("is no checkpoint of carom");
    if (bytes.size() < head_size) refuse(fmt::format("is cut off: it ends after {} bytes", bytes.size()));
    Reader head(bytes.subspan(signature.size()));
    std::uint64_t version = 0;
    std::uint64_t size = 0;
    std::uint64_t sum = 0;
    head(version, size, sum);
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

RunIdentity identity_of(const World& world, std::string scene, std::span<const Observation> observations) {
    const std::vector<std::byte> snapshot = world.save();
    return {.scene = std::move(scene),
            .bodies = world.size(),
            .world = checksum(snapshot),
            .observers = checksum(save_observations(observations)),
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
    if (saved.timeline_every != wanted.timeline_every || saved.bodies_every != wanted.bodies_every ||
        saved.check_overlap != wanted.check_overlap || saved.record_impacts != wanted.record_impacts ||
        saved.observers != wanted.observers) {
        return "its run wrote other outputs";
    }
    if (saved.world != wanted.world) return "the scene has changed since";
    return std::nullopt;
}

std::vector<std::byte> save_checkpoint(const RunIdentity& identity, const RunProgress& progress,
                                       std::span<const Observation> observations, const World& world) {
    Writer body;
    body(identity, progress, save_observations(observations));
    body.raw(world.save());
    const std::vector<std::byte> content = body.take();

    Writer file;
    file.raw(std::as_bytes(std::span(signature)));
    file(format_version, std::uint64_t{content.size()}, checksum(content));
    file.raw(content);
    return file.take();
}

bool looks_like_checkpoint(std::span<const std::byte> bytes) { return as_text(bytes).starts_with(signature); }

Checkpoint load_checkpoint(std::span<const std::byte> bytes) {
    Reader body(body_of(bytes));
    RunIdentity identity;
    RunProgress progress;
    std::vector<std::byte> observations;
    body(identity, progress, observations);
    return {std::move(identity), std::move(progress), std::move(observations), World::load(body.rest())};
}

} // namespace carom::scene
