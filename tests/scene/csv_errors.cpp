// CSV files of bodies: what is read, and each kind of mistake with the line and the column that the message must name.
#include "refusal.hpp"
#include "scene/csv.hpp"
#include "scene/scene.hpp"
#include "temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace carom::scene {
namespace {

struct CsvMistake {
    std::string_view text;
    std::string_view message;
};

const std::vector<CsvMistake> csv_mistakes{
    {"", "b.csv: the first line must name the columns, for example x,y,z,vx,vy,vz"},
    {"x,y,z\n", "b.csv:1: there are no bodies below the names of the columns"},
    {"x,y\n1,2\n", "b.csv:1: column 'z': is missing"},
    {"x,y,z,x\n", "b.csv:1: column 'x': is there twice"},
    {"x,y,z,speed\n", "b.csv:1: column 'speed': must be one of x, y, z, vx, vy, vz, mass, radius, restitution, "
                      "friction, growth, got 'speed'"},
    {"x,y,z,frictoin\n", "b.csv:1: column 'frictoin': must be one of x, y, z, vx, vy, vz, mass, radius, restitution, "
                         "friction, growth, got 'frictoin'; did you mean 'friction'?"},
    {"# c\n\nx,y,z\n1,2,3\n1,2\n", "b.csv:5: must have 3 values, got 2"},
    {"x,y,z\n1,2,3,4\n", "b.csv:2: must have 3 values, got 4"},
    {"x,y,z\n1,2,\n", "b.csv:2: column 'z': must be a number, got ''"},
    {"x,y,z\n1,2,3m\n", "b.csv:2: column 'z': must be a number, got '3m'"},
    {"x,y,z\n1,nan,3\n", "b.csv:2: column 'y': must be in [-1e30, 1e30] m, got nan"},
    {"x,y,z,mass\n1,2,3,1\n\n1,2,3,0\n", "b.csv:4: column 'mass': must be > 0; inf makes a body static, got 0"},
    {"x,y,z,restitution\n1,2,3,2\n", "b.csv:2: column 'restitution': must be in [0, 1], got 2"},
    {"x;y;z\n1;2;3\n", "b.csv:1: column 'x;y;z': must be one of x, y, z, vx, vy, vz, mass, radius, restitution, "
                       "friction, growth, got 'x;y;z'"},
    {"x,y,z\n1,2,3\n1,2,3\n1,2,3\n", "b.csv:4: has 3 bodies; at most 2 more are allowed"},
};

TEST(CsvErrors, NameFileLineAndColumn) {
    for (const CsvMistake& mistake : csv_mistakes) {
        EXPECT_EQ(refusal([&] { parse_csv(mistake.text, "b.csv", 2); }), mistake.message);
    }
}

TEST(Csv, ReadsWhatSpreadsheetsWrite) {
    const CsvBodies bodies = parse_csv("\xEF\xBB\xBFx, y ,z,radius\r\n1,2,3,4\r\n# c\r\n 5e0,-6,7.5,0", "b.csv", 9);
    ASSERT_EQ(bodies.table.size(), 2U);
    EXPECT_EQ(bodies.table.position[1], (Vec3{5, -6, 7.5}));
    EXPECT_EQ(bodies.table.radius, (std::vector<double>{4, 0}));
    EXPECT_EQ(bodies.given, (std::vector<std::string>{"x", "y", "z", "radius"}));
}

/// Bodies of a world as a table, and a world of them again: the table tells of the same bits.
TEST(Csv, ReadsBackTheBodiesOfAWorld) {
    World world({.gravity = {0, 0, -9.81}});
    world.add({.position = {0.1, -2, 1e5}, .velocity = {1.0 / 3, 0, -1e-7}, .mass = 0.3, .growth = 0.01});
    world.add({.position = {5, 5, 5}, .mass = infinite_mass, .radius = 0, .restitution = 0.7, .friction = 0.2});
    world.step(0.1);
    const std::string text = to_csv(world);
    const CsvBodies bodies = parse_csv(text, "b.csv", 2);
    EXPECT_EQ(bodies.given.size(), 11U);
    World again;
    again.add(bodies.table.columns());
    again.step(0.1); // only for the time that the table tells
    again.set(again.ids(), bodies.table.columns());
    EXPECT_EQ(to_csv(again), text);
    EXPECT_EQ(text.substr(0, text.find('\n')), "time,id,x,y,z,vx,vy,vz,mass,radius,restitution,friction,growth");
    EXPECT_EQ(refusal([&] { parse_csv("x,y,z,id,id\n1,2,3,4,5\n", "b.csv", 2); }),
              "b.csv:1: column 'id': is there twice");
}

TEST(CsvErrors, WhatIsGivenTwice) {
    const TemporaryFolder folder;
    (void)folder.write("b.csv", "x,y,z,mass,vy\n1,2,3,4,5\n");
    const std::string entry = "[[bodies]]\ngenerator = \"csv\"\nfile = \"b.csv\"\n";
    const auto with = [&](const std::string& line) {
        const std::string message = refusal([&] { load_scene(folder.write("s.toml", entry + line)); });
        return message.substr(std::min(message.size(), folder.path().string().size() + 1));
    };
    EXPECT_EQ(with("mass = 1"), "s.toml:4: bodies[0].mass: is given twice: here and as column 'mass'");
    EXPECT_EQ(with("density = 1"), "s.toml:4: bodies[0].density: is given twice: here and as column 'mass'");
    EXPECT_EQ(with("velocity = [0, 0, 0]"), "s.toml:4: bodies[0].velocity: is given twice: here and as column 'vy'");
}

} // namespace
} // namespace carom::scene
