// What is made of a world to be drawn: places between steps, colours, regions, trails, forces, cameras.
#include "scene/scene.hpp"
#include "viewer/drawings.hpp"
#include "viewer/film/image_legend.hpp"
#include "viewer/stage/camera_path.hpp"
#include "viewer/stage/legend.hpp"
#include "viewer/stage/obstacle_shapes.hpp"
#include "viewer/stage/palette.hpp"
#include "viewer/stage/stage.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <initializer_list>
#include <span>
#include <utility>
#include <vector>

namespace carom::viewer {
namespace {

World world_of(WorldOptions options, const std::vector<Body>& bodies) {
    options.interpolation = true;
    World world(options);
    for (const Body& body : bodies) world.add(body);
    return world;
}

float scale_place(std::uint32_t look) { return static_cast<float>(look & 0xffffU) / 65535; }

TEST(Moment, PlacesBetweenStepsAreThoseOfTheWorld) {
    Box box{{0, 0, 0}, {10, 10, 10}};
    for (Face& face : box.faces) face.kind = FaceKind::periodic;
    World world = world_of({.region = box}, {{.position = {9.5, 5, 5}, .velocity = {2, 1, 0}},
                                             {.position = {1, 1, 1}, .velocity = {-4, 0, 3}}});
    world.step(0.5);
    world.step(0.5);
    Spectator spectator(scene::ColourBy::material);
    const auto moment = spectator.look(world, false);
    for (const double time : {0.5, 0.6, 0.75, 1.0}) {
        std::vector<Vec3> expected(2);
        world.positions_at(time, world.ids(), expected);
        std::vector<PackedBody> packed;
        pack(*moment, time, {5, 5, 5}, std::nullopt, packed);
        for (std::size_t i = 0; i < 2; ++i) {
            // Beside the box where the world has it on the other side.
            const Vec3 off = shortest(moment->position_at(i, time) - expected[i], {10, 10, 10});
            EXPECT_LT(length(off), 1e-6);
            const Vec3f drawn{packed[i].x, packed[i].y, packed[i].z};
            EXPECT_LT(length(drawn - narrow(moment->position_at(i, time) - Vec3{5, 5, 5})), 1e-5F);
        }
    }
}

TEST(Moment, BodiesThatComeAndGoAreNoticed) {
    World world = world_of({}, {{}, {.position = {5, 0, 0}, .radius = 0.25}});
    Spectator spectator(scene::ColourBy::material);
    world.step(0.1);
    const auto before = spectator.look(world, false);
    EXPECT_EQ(before->radii->at(1), 0.25F);
    const BodyId third = world.add({.position = {0, 9, 0}, .radius = 2});
    world.step(0.1);
    const auto after = spectator.look(world, false);
    ASSERT_EQ(after->position.size(), 3U);
    EXPECT_EQ(after->radii->at(2), 2.0F);
    EXPECT_NE(after->version, before->version);
    EXPECT_NE(Spectator(scene::ColourBy::material).look(world, false)->version, after->version);
    EXPECT_EQ(after->ids->back(), third);
}

TEST(Colours, ScaleWithSpeedAndMass) {
    std::vector<Body> bodies;
    bodies.reserve(21);
    for (int i = 0; i < 21; ++i) {
        bodies.push_back(
            {.position = {3.0 * i, 0, 0}, .velocity = {0, static_cast<double>(i), 0}, .mass = std::pow(10, i)});
    }
    World world = world_of({}, bodies);
    world.step(0.1);
    const auto by_speed = Spectator(scene::ColourBy::speed).look(world, false);
    EXPECT_EQ(by_speed->lowest, 0);
    EXPECT_EQ(by_speed->highest, 19); // one in twenty is faster
    for (std::size_t i = 0; i < 21; ++i) {
        EXPECT_NEAR(scale_place(by_speed->looks[i]), std::min(1.0, static_cast<double>(i) / 19), 1e-4);
    }
    const auto by_mass = Spectator(scene::ColourBy::mass).look(world, false);
    for (std::size_t i = 0; i < 21; ++i) EXPECT_NEAR(scale_place(by_mass->looks[i]), static_cast<double>(i) / 20, 1e-4);
}

TEST(Colours, TemperatureIsThatOfTheNeighbourhood) {
    // Two clouds far from each other that fly: one cold, one with speeds of 1 m/s about the common motion.
    std::vector<Vec3> position;
    std::vector<Vec3> velocity;
    for (int i = 0; i < 1000; ++i) {
        position.push_back(site(i, 10) * 0.1 + Vec3{i < 500 ? 0.0 : 1000.0, 0, 0});
        velocity.push_back(Vec3{100, 0, 0} + (i < 500 ? Vec3{} : Vec3{0, i % 2 == 0 ? 1.0 : -1.0, 0}));
    }
    const std::vector<BodyId> ids(1000);
    const std::vector<double> mass(1000, 6);
    const std::vector<std::uint32_t> material(1000);
    std::vector<float> temperatures(1000);
    find_temperatures({ids, position, velocity, mass, material}, temperatures);
    for (std::size_t i = 0; i < 1000; ++i) EXPECT_NEAR(temperatures[i], i < 500 ? 0 : 2, 1e-6); // m v^2 / 3
}

TEST(Colours, ImpactRatesAreCountedAndForgotten) {
    // A ball between two walls, one metre of room, 10 m/s: ten impacts a second.
    World world = world_of({.region = Box{{-1, -1, -1}, {1, 1, 1}}}, {{.velocity = {10, 0, 0}, .radius = 0.5}});
    Spectator spectator(scene::ColourBy::impact_rate);
    for (int i = 0; i < 1000; ++i) {
        world.step(0.01);
        spectator.watch_step(world);
    }
    EXPECT_NEAR(spectator.look(world, false)->highest, 10, 1);
}

TEST(Colours, TellStaticBodiesFromKinematicOnes) {
    World world =
        world_of({}, {{.mass = infinite_mass}, {.position = {5, 0, 0}, .velocity = {0, 0, 1}, .mass = infinite_mass}});
    world.step(0.1);
    const auto moment = Spectator(scene::ColourBy::speed).look(world, false);
    EXPECT_EQ(moment->looks[0], look_of(PaletteRow::still, 0));
    EXPECT_EQ(moment->looks[1], look_of(PaletteRow::still, 1));
}

TEST(Colours, ShadesOfAMaterialStayInItsHue) {
    for (std::uint32_t material = 0; material < 8; ++material) {
        for (std::uint32_t seed = 0; seed < 100; ++seed) {
            const float column = place_of_material(material, seed) * 255;
            EXPECT_GT(column, static_cast<float>(32 * material) + 0.5F);
            EXPECT_LT(column, static_cast<float>(32 * material) + 30.5F);
        }
    }
}

TEST(Legends, NameQuantityUnitAndRange) {
    using scene::ColourBy;
    EXPECT_FALSE(legend_of(ColourBy::material, 0, 0));
    const auto speed = legend_of(ColourBy::speed, 0, 12.345);
    ASSERT_TRUE(speed);
    EXPECT_EQ(speed->title, "speed in m/s");
    EXPECT_EQ(speed->low, "0");
    EXPECT_EQ(speed->high, "12.3 and more"); // one body in twenty is faster
    const auto mass = legend_of(ColourBy::mass, -1, 3);
    EXPECT_EQ(mass->low, "0.1");
    EXPECT_EQ(mass->high, "1e+03"); // and no body has more
    EXPECT_EQ(legend_of(ColourBy::mass, 0, 0)->high, "");
    EXPECT_EQ(legend_of(ColourBy::impact_rate, 0, 1)->title, "impacts per second");
    EXPECT_EQ(legend_of(ColourBy::temperature, 0, 1)->title, "temperature in J");
}

TEST(Legends, AreWrittenIntoTheCornerOfAPicture) {
    const Legend legend{"speed in m/s", "0", "5 and more"};
    const auto image_with = [](const Legend& shown, int width, int height) {
        const auto bytes = 3 * static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
        Image image{width, height, std::vector<std::uint8_t>(bytes, 200)};
        add_legend(shown, image);
        return image;
    };
    const Image image = image_with(legend, 400, 300);
    // The bar is 220 pixels wide, 18 from the left, and its middle 44 above the lower edge. It has 44 parts: half of
    // one is a step of 7 of 255 where the scale is steepest.
    const auto like = [](const std::uint8_t* pixel, const Colour& colour) {
        return std::abs(pixel[0] - 255 * colour.red) < 8 && std::abs(pixel[1] - 255 * colour.green) < 8 &&
               std::abs(pixel[2] - 255 * colour.blue) < 8;
    };
    for (const float place : {0.01F, 0.3F, 0.5F, 0.99F}) {
        EXPECT_TRUE(like(image.at(18 + static_cast<int>(220 * place), 300 - 44), scale_colour(place))) << place;
    }
    EXPECT_EQ(*image.at(399, 0), 200);
    EXPECT_EQ(*image.at(5, 256), 200);
    EXPECT_NE(image_with({"mass in kg", "0", "5 and more"}, 400, 300).pixels, image.pixels);
    EXPECT_NE(image_with({"speed in m/s", "0", "6 and more"}, 400, 300).pixels, image.pixels);
    // Twice as large in a picture that is twice as high as usual; cut off in one that is smaller.
    EXPECT_TRUE(like(image_with(legend, 2560, 1440).at(36 + 220, 1440 - 88), scale_colour(0.5F)));
    EXPECT_EQ(image_with(legend, 3, 2).pixels.size(), 18U);
}

TEST(Cameras, PathsGoThroughTheirKeysSmoothly) {
    scene::CameraSpec spec;
    spec.path = {{1, {10, 0, 0}, {0, 0, 0}, 30}, {2, {0, 10, 0}, {0, 0, 1}, 50}, {4, {-10, 0, 5}, {0, 0, 0}, 40}};
    const auto at = [&](double time) { return camera_at(spec, time, {}, {0, 0, 1}); };
    for (const scene::CameraKey& key : spec.path) {
        EXPECT_LT(length(at(key.time).position - key.position), 1e-12);
        EXPECT_LT(length(at(key.time).target - key.target), 1e-12);
        EXPECT_NEAR(at(key.time).field_of_view, key.field_of_view, 1e-12);
    }
    EXPECT_EQ(at(0).position, spec.path.front().position);
    EXPECT_EQ(at(9).position, spec.path.back().position);
    const double h = 1e-4;
    const Vec3 before = (at(2).position - at(2 - h).position) / h;
    const Vec3 after = (at(2 + h).position - at(2).position) / h;
    EXPECT_LT(length(after - before), 1e-2); // of curvature times h
}

TEST(Cameras, ShowEverythingWhereTheSceneLeavesItOpen) {
    const Ball ball{{100, 0, 0}, 10};
    const Camera camera = camera_at({}, 0, ball, {0, 0, 1});
    EXPECT_EQ(camera.target, ball.centre);
    // The ball fills the height of the picture.
    EXPECT_NEAR(std::asin(ball.radius / length(camera.position - camera.target)) * 360 / 3.14159265,
                camera.field_of_view, 1e-6);
    EXPECT_EQ(up_of({}, {0, -9.81, 0}), (Vec3{0, 1, 0}));
    EXPECT_EQ(up_of({}, {}), (Vec3{0, 0, 1}));
}

TEST(Cameras, ShowTheFacesThatHoldTheBodies) {
    const Ball bodies{{5, 5, 1}, 1};
    const auto open = [](Box box, std::initializer_list<std::size_t> faces) {
        for (const std::size_t face : faces) box.faces.at(face).kind = FaceKind::open;
        return box;
    };
    const Box box{{0, 0, 0}, {10, 20, 40}};
    const auto expect_ball = [&](const Region& region, const Vec3& centre, double radius) {
        const Ball ball = ball_to_see(region, bodies, std::nullopt);
        EXPECT_LT(length(ball.centre - centre), 1e-12);
        EXPECT_NEAR(ball.radius, radius, 1e-12);
    };
    expect_ball(box, {5, 10, 20}, std::sqrt(2100) / 2);
    expect_ball(open(box, {5}), {5, 10, 20}, std::sqrt(2100) / 2);           // the walls reach as high as the box
    expect_ball(open(box, {0, 1, 2, 3, 5}), {5, 10, 0}, std::sqrt(500) / 2); // a floor
    expect_ball(open(box, {0, 1, 2, 3, 4}), joined(bodies, {{5, 10, 40}, std::sqrt(500) / 2}).centre,
                joined(bodies, {{5, 10, 40}, std::sqrt(500) / 2}).radius); // a ceiling, and the bodies far below
    expect_ball(open(box, {0, 1, 2, 3, 4, 5}), bodies.centre, bodies.radius);
}

TEST(Stages, ShowRegionsForcesTrailsAndAttractors) {
    World world =
        world_of({.gravity = {0, 0, -9.81}, .region = Box{{0, 0, 0}, {10, 10, 10}}},
                 {{.position = {5, 5, 0.5}, .restitution = 0}, {.position = {8, 5, 5}, .velocity = {-1, 0, 0}}});
    const Attractor attractor{.position = {5, 5, 5}, .strength = 1e-6};
    world.set_attractors({&attractor, 1});
    Spectator spectator(scene::ColourBy::material);
    Stage stage;
    stage.set_trails(0.25);
    const Camera camera{{5, -20, 9}, {5, 5, 5}};
    std::size_t trail_lines = 0;
    for (int i = 1; i <= 10; ++i) {
        world.step(0.1);
        const auto moment = spectator.look(world, true);
        const Drawing& drawing = stage.draw(*moment, world.time(), camera);
        EXPECT_EQ(drawing.panels.size(), 6U);
        EXPECT_EQ(drawing.lines_on_top.size(), 3U + 1); // the attractor's cross and the weight of the lying ball
        trail_lines = drawing.lines.size() - 24;        // without the edges of the faces
    }
    EXPECT_EQ(trail_lines, 2 * 2U); // two whole steps of 0.1 s in 0.25 s, of two bodies
    const Line force = stage.settings().lines_on_top.back();
    EXPECT_NEAR(force.from.z - force.to.z, 0.5, 1e-5);
    stage.restart();
    EXPECT_EQ(stage.draw(*spectator.look(world, false), world.time(), camera).lines.size(), 24U);
}

TEST(Stages, DrawMovingFacesWhereTheyAre) {
    Box piston{{0, 0, 0}, {10, 10, 10}};
    piston.faces[4].motion = {.velocity = 2};
    World world = world_of({.region = piston}, {{.position = {5, 5, 8}}});
    Spectator spectator(scene::ColourBy::material);
    Stage stage;
    const Camera camera{{5, -20, 9}, {5, 5, 5}};
    EXPECT_EQ(stage.draw(*spectator.look(world, false), 0, camera).panels.at(4).corner.z, -5); // from the target
    for (int i = 1; i <= 3; ++i) {
        world.step(0.5);
        spectator.watch_step(world);
        const auto moment = spectator.look(world, false);
        for (const double time : {world.time() - 0.5, world.time() - 0.2, world.time()}) {
            EXPECT_NEAR(stage.draw(*moment, time, camera).panels.at(4).corner.z, 2 * time - 5, 1e-5);
        }
    }
}

TEST(Stages, DrawGrowingBodiesAsLargeAsTheyAre) {
    World world = world_of({}, {{.radius = 0.5, .growth = 0.1}, {.position = {9, 0, 0}}});
    Spectator spectator(scene::ColourBy::material);
    const auto before = spectator.look(world, false);
    world.step(1);
    spectator.watch_step(world);
    const auto after = spectator.look(world, false);
    EXPECT_FLOAT_EQ(after->radii->at(0), 0.6F);
    EXPECT_FLOAT_EQ(after->radii->at(1), 0.5F);
    EXPECT_NE(after->version, before->version);
}

TEST(Stages, TheOneThatIsPickedGlows) {
    World world = world_of({}, {{}, {.position = {5, 0, 0}}});
    world.step(0.1);
    const auto moment = Spectator(scene::ColourBy::material).look(world, false);
    std::vector<PackedBody> packed;
    pack(*moment, 0.1, {}, moment->ids->at(1), packed);
    EXPECT_EQ(packed[0].look >> 24U, 0U);
    EXPECT_EQ(packed[1].look >> 24U, 255U);
}

/// The middles of triangles and their normals, from the corners' places and from what the corners say.
struct Triangle {
    Vec3f middle;
    Vec3f normal;
    Vec3f told;
};

std::vector<Triangle> triangles_of(std::span<const Corner> corners) {
    std::vector<Triangle> triangles;
    for (std::size_t i = 0; i < corners.size(); i += 3) {
        const auto& [a, b, c] = std::array{corners[i], corners[i + 1], corners[i + 2]};
        triangles.push_back({(a.place + b.place + c.place) / 3.0F, unit(cross(b.place - a.place, c.place - a.place)),
                             unit(a.normal + b.normal + c.normal)});
    }
    return triangles;
}

TEST(ObstacleShapes, OfAFunnelAreGlassThatTurnsOutwards) {
    const Obstacle funnel = Frustum{{1, 2, 3}, {0, 3, 4}, 5, 1, 2};
    const ObstacleShapes shapes({&funnel, 1});
    const Shapes drawn = shapes.shapes({1, 2, 3}); // from the middle of the base
    EXPECT_TRUE(drawn.plain.empty());
    ASSERT_FALSE(drawn.glass.empty());
    const Vec3f axis{0, 0.6F, 0.8F};
    for (const Corner& corner : drawn.glass) {
        const Vec3f place = corner.place + drawn.anchor;
        const float height = dot(place, axis);
        EXPECT_NEAR(length(place - axis * height), 1 + height / 5, 1e-5F);
        const Vec3f outwards = unit(place - axis * height);
        EXPECT_NEAR(dot(corner.normal, outwards), 5 / std::sqrt(26.0F), 1e-5F);
        EXPECT_NEAR(dot(corner.normal, axis), -1 / std::sqrt(26.0F), 1e-5F);
    }
    // A triangle of a cone lies flat: its normal differs from those of its corners by half a segment, 1.9 degrees.
    for (const Triangle& triangle : triangles_of(drawn.glass)) EXPECT_GT(dot(triangle.normal, triangle.told), 0.999);
    const Ball& ball = *shapes.ball();
    EXPECT_LT(ball.radius, 6);
    for (const Corner& corner : drawn.glass) EXPECT_LT(length(corner.place), ball.radius + 1e-5);
    EXPECT_EQ(shapes.edges().size(), 2 * 96U);
    EXPECT_EQ(shapes.meridians(0).size(), 8U);
    EXPECT_EQ(shapes.meridians(1), shapes.meridians(0)); // it stands still
}

/// The angle in rad by which `line` has turned round z.
double turned(const Line& before, const Line& line) {
    return std::atan2(before.from.x * line.from.y - before.from.y * line.from.x,
                      before.from.x * line.from.x + before.from.y * line.from.y);
}

TEST(Stages, TurnTheMeridiansOfWhatTurns) {
    // A drum, a turntable the other way, and a disc that stands still, which has no meridians.
    const std::vector<Obstacle> obstacles{
        Frustum{.base = {0, 0, 0}, .axis = {0, 0, 2}, .angular_velocity = 0.5},
        Frustum{.base = {0, 0, 3}, .axis = {0, 0, -1}, .height = 0, .base_radius = 2, .angular_velocity = 0.25},
        Frustum{.base = {0, 0, 5}, .height = 0, .base_radius = 2}};
    World world = world_of({.obstacles = obstacles}, {{.position = {9, 0, 0}}});
    Spectator spectator(scene::ColourBy::material);
    Stage stage(obstacles);
    const Camera camera{{0, -20, 9}, {0, 0, 0}};
    constexpr std::size_t rims = std::size_t{3} * 2 * 96;
    const auto lines_at = [&](double time) { return stage.draw(*spectator.look(world, false), time, camera).lines; };
    const std::vector<Line> before = lines_at(0);
    ASSERT_EQ(before.size(), rims + 16);
    for (int i = 0; i < 3; ++i) {
        world.step(0.5);
        spectator.watch_step(world);
        for (const double time : {world.time() - 0.5, world.time() - 0.2, world.time()}) {
            const std::vector<Line> lines = lines_at(time);
            for (std::size_t k = 0; k < rims; ++k) ASSERT_EQ(lines[k].from, before[k].from);
            for (std::size_t k = 0; k < 8; ++k) {
                EXPECT_NEAR(turned(before[rims + k], lines[rims + k]), 0.5 * time, 1e-6);
                EXPECT_NEAR(turned(before[rims + 8 + k], lines[rims + 8 + k]), -0.25 * time, 1e-6);
                EXPECT_EQ(lines[rims + k].to.z - lines[rims + k].from.z, 1);
            }
        }
    }
}

TEST(ObstacleShapes, OfClosedMeshesAreGlassWhicheverWayTheyRunRound) {
    const Mesh tetrahedron{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                           {{{0, 2, 1}}, {{0, 1, 3}}, {{1, 2, 3}}, {{0, 3, 2}}}};
    Mesh inside_out = tetrahedron;
    for (auto& triangle : inside_out.triangles) std::swap(triangle[0], triangle[1]);
    for (const Obstacle& obstacle : {Obstacle{tetrahedron}, Obstacle{inside_out}}) {
        const ObstacleShapes shapes({&obstacle, 1});
        const Shapes drawn = shapes.shapes({0.25, 0.25, 0.25});
        ASSERT_EQ(drawn.glass.size(), 12U);
        EXPECT_TRUE(drawn.plain.empty());
        for (const Triangle& triangle : triangles_of(drawn.glass)) {
            EXPECT_GT(dot(triangle.normal, triangle.middle + drawn.anchor), 0);
            EXPECT_GT(dot(triangle.normal, triangle.told), 0.999);
        }
        EXPECT_EQ(shapes.edges().size(), 6U);
    }
}

TEST(ObstacleShapes, OfOpenMeshesHideAndHaveBordersAndCreases) {
    // A roof of two flat sides, each of two triangles, of which one runs round the other way.
    const Obstacle roof = Mesh{{{0, -1, 0}, {0, 0, 1}, {0, 1, 0}, {4, -1, 0}, {4, 0, 1}, {4, 1, 0}},
                               {{{0, 3, 4}}, {{0, 1, 4}}, {{1, 4, 5}}, {{1, 5, 2}}}};
    const ObstacleShapes shapes({&roof, 1});
    const Shapes drawn = shapes.shapes({});
    EXPECT_EQ(drawn.plain.size(), 12U);
    EXPECT_TRUE(drawn.glass.empty());
    EXPECT_EQ(shapes.edges().size(), 6U + 1); // and the ridge, but no diagonal
    EXPECT_FALSE(ObstacleShapes().ball());
}

TEST(Balls, AroundBodiesAndObstacles) {
    const Ball both = joined(Ball{{0, 0, 0}, 1}, Ball{{10, 0, 0}, 2});
    EXPECT_EQ(both.centre, (Vec3{5.5, 0, 0}));
    EXPECT_EQ(both.radius, 6.5);
    EXPECT_EQ(joined(Ball{{0, 0, 0}, 9}, Ball{{5, 0, 0}, 2}).radius, 9);
    EXPECT_EQ(joined(Ball{{5, 0, 0}, 2}, Ball{{0, 0, 0}, 9}).radius, 9);
    const Ball obstacle{{20, 0, 0}, 1};
    EXPECT_GT(ball_to_see(OpenSpace{}, Ball{}, obstacle).radius, 10);
    EXPECT_EQ(ball_to_see(Shell{{0, 0, 0}, 3}, Ball{}, obstacle).radius, 3);
}

TEST(Balls, LeaveOutTheFew) {
    std::vector<Vec3> positions;
    positions.reserve(1000);
    for (int i = 0; i < 999; ++i) positions.push_back(site(i, 10));
    positions.push_back({1e6, 0, 0});
    const std::vector<float> radii(1000, 0.5F);
    EXPECT_LT(ball_around(positions, radii).radius, 10);
    EXPECT_EQ(ball_around({}, {}).radius, 1);
    EXPECT_EQ(ball_around(std::vector<Vec3>{{1, 2, 3}}, std::vector<float>{0}).radius, 1);
}

} // namespace
} // namespace carom::viewer
