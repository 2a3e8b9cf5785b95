/// \file
/// What bounds a world.
#pragma once

#include <carom/base.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

namespace carom {

/// e and mu of a surface; what is not given is taken from the body that meets it.
struct Surface {
    std::optional<double> restitution{}; ///< in [0, 1]
    std::optional<double> friction{};    ///< Coulomb's mu >= 0
};

/// How a face of a Box, or a Plane, moves from where the region has it: along its normal, towards the bodies, by
/// `velocity t + amplitude (sin(angular_frequency t + phase) - sin(phase))`.
struct FaceMotion {
    double velocity = 0;          ///< m/s, of a piston; positive towards the bodies
    double amplitude = 0;         ///< m, >= 0, of a shaker
    double angular_frequency = 0; ///< rad/s, >= 0: 2 pi times the oscillations a second
    double phase = 0;             ///< rad, when the motion begins
    Vec3 surface_velocity{};      ///< m/s along the face, of a conveyor belt: the face itself stays where it is

    friend bool operator==(const FaceMotion&, const FaceMotion&) = default;
};

/// No bounds at all.
struct OpenSpace {};

/// What a face of a Box does with the bodies that reach it.
enum class FaceKind : std::uint8_t {
    reflecting, ///< bodies bounce off it
    open,       ///< it is not there; the faces beside it go on for ever
    periodic,   ///< what leaves here enters at the opposite face, which must be periodic too
};

/// One face of a Box.
struct Face {
    FaceKind kind = FaceKind::reflecting;
    Surface surface{};
    FaceMotion motion{}; ///< of a reflecting face
};

/// Axis-aligned box with the bodies inside. Faces are numbered -x, +x, -y, +y, -z, +z (0 to 5), also in Impact::face.
/// A periodic side must be longer than four times the largest radius in the world.
struct Box {
    Vec3 min{}; ///< m
    Vec3 max{}; ///< m, greater than min in every component
    std::array<Face, 6> faces{};
};

/// A wall: bodies are on the side the normal points to. Impact::face is its index in the list of planes.
struct Plane {
    Vec3 point{};         ///< m, any point of the plane
    Vec3 normal{0, 0, 1}; ///< any length but zero; only the direction counts
    Surface surface{};
    FaceMotion motion{};
};

/// The inside of a spherical shell. Impact::face is 0.
struct Shell {
    Vec3 centre{};     ///< m
    double radius = 1; ///< m, > 0
    Surface surface{};
};

/// What bounds a world: nothing, a box, up to 64 planes, or a shell.
using Region = std::variant<OpenSpace, Box, std::vector<Plane>, Shell>;

/// What a segment sweeps as it turns round an axis: the wall of a cylinder, of a cone or a funnel, or a disc. It has no
/// thickness, and bodies touch it from both sides, its rims too.
struct Frustum {
    Vec3 base{};            ///< m, centre of the circle at the base
    Vec3 axis{0, 0, 1};     ///< from there to the top; any length but zero, only the direction counts
    double height = 1;      ///< m, >= 0; 0: a disc or a ring
    double base_radius = 1; ///< m, >= 0
    double top_radius = 1;  ///< m, >= 0: the base's for a cylinder, 0 for a cone. The two circles are not one.
    Surface surface{};
    /// rad/s, at which it turns round its axis, as a right-handed screw that goes along it: a drum, a turntable. Its
    /// friction takes bodies along; without any it makes no difference.
    double angular_velocity = 0;
};

/// Triangles without thickness, which bodies touch from both sides, closed or not. Triangles that have corners at the
/// same place are joined there: a body passes over their common edge as over what they make together.
struct Mesh {
    std::vector<Vec3> vertices{};                          ///< m
    std::vector<std::array<std::uint32_t, 3>> triangles{}; ///< each three indices of vertices, not in one line
    Surface surface{};
};

/// What stands in a world and stays where it is.
using Obstacle = std::variant<Frustum, Mesh>;

} // namespace carom
