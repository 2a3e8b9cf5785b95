/// \file
/// Programs of the graphics card, compiled.
#pragma once

#include "viewer/render/gl/handles.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace carom::viewer::gl {

/// One or two stages of a program, as parts of their text.
using ShaderText = std::vector<std::string_view>;

/// Throws carom::Error{not_available} with the name of the program and what the driver says about its text.
ProgramHandle make_program(const std::string& name, const ShaderText& vertex, const ShaderText& fragment);

} // namespace carom::viewer::gl
