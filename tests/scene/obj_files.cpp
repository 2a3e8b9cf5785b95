// Meshes from OBJ files: what is read, and each kind of mistake with the line that the message must name.
#include "refusal.hpp"
#include "scene/obj_file.hpp"
#include "scene/scene.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace carom::scene {
namespace {

struct ObjMistake {
    std::string_view text;
    std::string_view message;
};

const std::vector<ObjMistake> obj_mistakes{
    {"", "m.obj: has no faces: lines that begin with f"},
    {"v 1 2 3\n", "m.obj: has no faces: lines that begin with f"},
    {"v 1 2\n", "m.obj:1: v: must have three numbers, x y z"},
    {"v 1 2 3 4 5\n", "m.obj:1: v: must have three numbers, x y z"},
    {"\n# c\nv 1 2 x\n", "m.obj:3: v: must be in [-1e30, 1e30] m, got 'x'"},
    {"v 1 2 nan\n", "m.obj:1: v: must be in [-1e30, 1e30] m, got 'nan'"},
    {"v 0 0 0\nv 1 0 0\nf 1 2\n", "m.obj:3: f: must have three corners or more"},
    {"v 0 0 0\nf 1 1 2\n", "m.obj:2: f: must name vertices above it, 1 to 1 or -1 to -1, got '2'"},
    {"v 0 0 0\nf 1 1 0\n", "m.obj:2: f: must name vertices above it, 1 to 1 or -1 to -1, got '0'"},
    {"v 0 0 0\nf 1 1 -2\n", "m.obj:2: f: must name vertices above it, 1 to 1 or -1 to -1, got '-2'"},
    {"v 0 0 0\nf 1 1 1.5\n", "m.obj:2: f: must name vertices above it, 1 to 1 or -1 to -1, got '1.5'"},
    {"v 0 0 0\nf 1 1 /3\n", "m.obj:2: f: must name vertices above it, 1 to 1 or -1 to -1, got '/3'"},
    {"v 0 0 0\nf 1 1 99999999999999999999\n",
     "m.obj:2: f: must name vertices above it, 1 to 1 or -1 to -1, got '99999999999999999999'"},
    {"v 0 0 0\nv 1 0 0\nv 3 0 0\nv 0 1 0\nf 1 2 4\nf 1 2 3 4\n",
     "m.obj:6: f: must have corners that are not in one line, got vertices 1, 2 and 3"},
    {"v 0 0 0\nv 1 1 0\nf 1 2 1\n", "m.obj:3: f: must have corners that are not in one line, got vertices 1, 2 and 1"},
    {"curv 1\n", "m.obj:1: curv: is no line of an OBJ file that carom knows: v and f count, comments are passed over"},
};

TEST(ObjErrors, NameFileLineAndKey) {
    for (const ObjMistake& mistake : obj_mistakes) {
        EXPECT_EQ(refusal([&] { parse_obj(mistake.text, "m.obj"); }), mistake.message);
    }
}

TEST(Obj, ReadsWhatModellersWrite) {
    const Mesh mesh =
        parse_obj("# made by hand\r\nmtllib a.mtl\no plate\nv 0 0 0\r\nv 1e0 0 0 1.0\n\tv 1 1 0\nv 0 1 0\n"
                  "vt 0 0\nvn 0 0 1\ng top\nusemtl red\ns off\nf 1/1/1 2/1/1 3//1 4/1\nf -4 -2 -1",
                  "m.obj");
    EXPECT_EQ(mesh.vertices, (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
    EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}, {0, 2, 3}}));
}

TEST(Obj, IsFoundBesideTheSceneAndPlaced) {
    const TemporaryFolder folder;
    (void)folder.write("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    const auto file = folder.write("s.toml", "[[obstacle]]\nkind = \"mesh\"\nfile = \"m.obj\"\nscale = 2\n"
                                             "offset = [0, 0, 5]\nrestitution = 0.5\n");
    const Scene scene = load_scene(file);
    ASSERT_EQ(scene.options.obstacles.size(), 1U);
    const Mesh& mesh = std::get<Mesh>(scene.options.obstacles[0]);
    EXPECT_EQ(mesh.vertices[1], (Vec3{2, 0, 5}));
    EXPECT_EQ(mesh.surface.restitution, 0.5);
    EXPECT_EQ(make_world(scene).size(), 0U);
}

TEST(Obj, WhatTheWorldRefusesIsNamedWithItsLine) {
    const TemporaryFolder folder;
    (void)folder.write("m.obj", "v 0 0 0\nv 1e-11 0 0\nv 0 1 0\nf 1 2 3\n");
    const auto file = folder.write("s.toml", "[[obstacle]]\nkind = \"cone\"\nheight = 1\nradius = 1\n"
                                             "[[obstacle]]\nkind = \"mesh\"\nfile = \"m.obj\"\noffset = [1e6, 0, 0]\n");
    EXPECT_EQ(refusal([&] { make_world(load_scene(file)); }),
              file.string() + ":5: obstacle[1].triangles: must have corners that are not in one line");
}

} // namespace
} // namespace carom::scene
