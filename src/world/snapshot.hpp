/// \file
/// The frame of a snapshot: magic, version, checksum, and the options of the world.
#pragma once

#include "world/engine.hpp"

#include <span>

namespace carom::core {

/// A snapshot whose frame is sound.
struct OpenedSnapshot {
    Setting setting;
    std::uint16_t world_tag = 0;
    std::span<const std::byte> payload; ///< for Engine::load
};

/// Throws Error{bad_data}, saying what is wrong.
OpenedSnapshot open_snapshot(std::span<const std::byte> snapshot);

} // namespace carom::core
