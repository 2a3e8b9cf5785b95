/// \file
/// Bodies from and to tables of comma-separated values.
#pragma once

#include "scene/scene.hpp"

#include <carom/world.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace carom::scene {

/// What a file says about its bodies; columns that it does not have hold the defaults of carom::Body.
struct CsvBodies {
    BodyTable table;
    std::vector<std::string> given; ///< the names of the file's columns that were read
};

/// Reads a file whose first line names its columns, in any order: x, y, z and, if wanted, vx, vy, vz, mass, radius,
/// restitution, friction, growth. The columns time and id of to_csv() are passed over, as are empty lines and lines
/// that begin with #. Throws SceneError with the line.
CsvBodies read_csv(const std::filesystem::path& file, std::uint64_t max_bodies);

/// The same from text; `file` is what errors call it.
CsvBodies parse_csv(std::string_view text, const std::string& file, std::uint64_t max_bodies);

/// The bodies of a world as it is now, in the order of their ids: time (s), id (slot), and all columns that are read.
/// Numbers read back exactly.
std::string to_csv(const World& world);

} // namespace carom::scene
