#include "scene/view_reader.hpp"

#include <fmt/format.h>

namespace carom::scene {

namespace {

constexpr NumberRange angle_range{1, 170, false, false, "must be in [1, 170] degrees"};
/// Beyond it the seconds of a film would not be numbers.
constexpr NumberRange time_scale_range{1e-12, 1e12, false, false, "must be in [1e-12, 1e12]"};

/// A camera sees nothing of what it is in.
void check_apart(const TableReader& table, const Vec3& position, const Vec3& target) {
    if (position == target) table.fail("target", "must differ from position");
}

CameraKey read_key(TableReader table, double field_of_view) {
    CameraKey key;
    key.time = table.need("time").number(not_negative);
    key.position = table.need("position").vec3(coordinate_range);
    key.target = table.need("target").vec3(coordinate_range);
    key.field_of_view = field_of_view;
    table.read("field_of_view", key.field_of_view, angle_range);
    check_apart(table, key.position, key.target);
    table.finish();
    return key;
}

CameraSpec read_camera(TableReader table) {
    CameraSpec camera;
    if (const auto value = table.find("position")) camera.position = value->vec3(coordinate_range);
    if (const auto value = table.find("target")) camera.target = value->vec3(coordinate_range);
    if (const auto value = table.find("up")) camera.up = value->direction();
    table.read("field_of_view", camera.field_of_view, angle_range);
    if (camera.position && camera.target) check_apart(table, *camera.position, *camera.target);
    for (const TableReader& entry : table.tables("path")) {
        const CameraKey key = read_key(entry, camera.field_of_view);
        if (!camera.path.empty() && !(key.time > camera.path.back().time)) {
            entry.fail("time", fmt::format("must be later than that of the key before, {} s, got {}",
                                           camera.path.back().time, key.time));
        }
        camera.path.push_back(key);
    }
    table.finish();
    return camera;
}

PictureSettings read_picture(TableReader table) {
    PictureSettings picture;
    if (const auto value = table.find("colour_by")) {
        picture.colour_by = static_cast<ColourBy>(value->choice(colour_names));
    }
    table.read("time_scale", picture.time_scale, time_scale_range);
    if (const auto value = table.find("moment")) picture.moment = value->number(not_negative);
    table.read("trails", picture.trails, not_negative);
    table.read("forces", picture.forces);
    table.finish();
    return picture;
}

} // namespace

ViewSettings read_view(TableReader& top) {
    ViewSettings view;
    if (const auto table = top.find("camera")) view.camera = read_camera(table->table());
    if (const auto table = top.find("picture")) view.picture = read_picture(table->table());
    return view;
}

} // namespace carom::scene
