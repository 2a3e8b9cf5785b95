/// \file
/// Drawings for tests, from lists of spheres.
#pragma once

#include "viewer/render/drawing.hpp"
#include "viewer/stage/palette.hpp"
#include "viewer/stage/stage.hpp"

#include <algorithm>
#include <vector>

namespace carom::viewer {

/// m: site number `i` of a cubic lattice with `side` sites to a side, a metre from each other.
inline Vec3 site(int i, int side) {
    const int column = i / side;
    const int layer = column / side;
    return {static_cast<double>(i % side), static_cast<double>(column % side), static_cast<double>(layer)};
}

struct Sphere {
    Vec3 centre{};     ///< m
    double radius = 1; ///< m
    PaletteRow row = PaletteRow::materials;
    float place = 0.2F;
};

/// Without shadows and occlusion, unless a test wants them.
struct TestDrawing {
    TestDrawing(std::vector<Sphere> all, const Camera& camera) : spheres(std::move(all)) {
        static std::uint64_t version = 1'000'000; // no Spectator comes so far in a test
        picture.radii_version = ++version;
        picture.camera = camera;
        picture.origin = camera.target;
        picture.palette = palette();
        picture.palette_version = 1;
        picture.sky = sky_colour;
        picture.ground = ground_colour;
        picture.extent = 10;
        picture.shadows = false;
        picture.occlusion = false;
    }

    const Drawing& finished() {
        bodies.clear();
        radii.clear();
        for (const Sphere& sphere : spheres) {
            const Vec3f place = narrow(sphere.centre - picture.origin);
            bodies.push_back({place.x, place.y, place.z, look_of(sphere.row, sphere.place)});
            radii.push_back(static_cast<float>(sphere.radius));
        }
        picture.bodies = bodies;
        picture.radii = radii;
        return picture;
    }

    std::vector<Sphere> spheres;
    std::vector<PackedBody> bodies;
    std::vector<float> radii;
    Drawing picture;
};

} // namespace carom::viewer
