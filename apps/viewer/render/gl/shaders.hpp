/// \file
/// The programs of the graphics card, in GLSL 4.50.
#pragma once

#include <string_view>

namespace carom::viewer::gl::shaders {

/// Stands before each of the others: version and what a frame is drawn with.
extern const std::string_view frame;
extern const std::string_view sphere_vertex;   ///< with SHADOW defined: for the map of shadows; else of those bodies
                                               ///< that are planets (PLANET is 1) or are none (0): few are, and what
                                               ///< they look like takes longer than all the rest of a body
extern const std::string_view sphere_fragment; ///< likewise
extern const std::string_view panel_vertex;
extern const std::string_view panel_fragment;
extern const std::string_view screen_vertex; ///< one triangle over the whole picture
extern const std::string_view hollow_fragment;
extern const std::string_view shape_vertex; ///< with SHADOW defined: for the map of shadows
extern const std::string_view shape_fragment;
extern const std::string_view depth_fragment; ///< leaves the depth as it is
extern const std::string_view glass_fragment;
extern const std::string_view occlusion_fragment;
extern const std::string_view blur_fragment;
extern const std::string_view light_fragment;
extern const std::string_view line_vertex;
extern const std::string_view line_fragment;
extern const std::string_view resolve_fragment;

} // namespace carom::viewer::gl::shaders
