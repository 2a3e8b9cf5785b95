#include "viewer/window/settings.hpp"

#include "scene/atomic_file.hpp"

#include <carom/base.hpp>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <system_error>

namespace carom::viewer {

namespace {

constexpr int least_side = 200;
constexpr int most_side = 16384;

nlohmann::json to_json(const Vec3& v) { return {v.x, v.y, v.z}; }

Vec3 vector_of(const nlohmann::json& json) {
    const Vec3 v{json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>()};
    if (!std::isfinite(length(v))) throw Error(ErrorCode::not_finite, "settings", "must be finite");
    return v;
}

Camera camera_of(const nlohmann::json& json) {
    Camera camera;
    camera.position = vector_of(json.at("position"));
    camera.target = vector_of(json.at("target"));
    camera.up = vector_of(json.at("up"));
    camera.field_of_view = json.at("field_of_view").get<double>();
    const bool sensible = camera.position != camera.target && length(camera.up) > 0 && camera.field_of_view >= 1 &&
                          camera.field_of_view <= 170;
    if (!sensible) throw Error(ErrorCode::out_of_range, "settings", "is no camera");
    return camera;
}

int side_of(const nlohmann::json& json, const char* key, int otherwise) {
    const int side = json.value(key, otherwise);
    return side >= least_side && side <= most_side ? side : otherwise;
}

std::optional<std::filesystem::path> folder_in(const char* variable) {
    const char* value = std::getenv(variable);
    if (value == nullptr || std::string_view(value).empty()) return std::nullopt;
    return std::filesystem::path(value);
}

} // namespace

std::optional<std::filesystem::path> settings_file() {
    if (const auto folder = folder_in("XDG_CONFIG_HOME")) return *folder / "carom/view.json";
    if (const auto home = folder_in("HOME")) return *home / ".config/carom/view.json";
    return std::nullopt;
}

Settings load_settings(const std::filesystem::path& file) {
    Settings settings;
    try {
        const std::vector<std::byte> bytes = scene::read_file(file);
        const auto* text = reinterpret_cast<const char*>(bytes.data());
        const nlohmann::json json = nlohmann::json::parse(text, text + bytes.size());
        settings.width = side_of(json, "width", settings.width);
        settings.height = side_of(json, "height", settings.height);
        settings.volume = std::clamp(json.value("volume", settings.volume), 0.0, 1.0);
        settings.muted = json.value("muted", settings.muted);
        for (const auto& [scene, camera] : json.at("cameras").items()) settings.cameras[scene] = camera_of(camera);
    } catch (const Error&) { // there is no file yet, or none that makes sense
        return settings;
    } catch (const nlohmann::json::exception&) {
        return settings;
    }
    return settings;
}

void save_settings(const Settings& settings, const std::filesystem::path& file) {
    nlohmann::json json;
    json["width"] = settings.width;
    json["height"] = settings.height;
    json["volume"] = settings.volume;
    json["muted"] = settings.muted;
    json["cameras"] = nlohmann::json::object();
    for (const auto& [scene, camera] : settings.cameras) {
        json["cameras"][scene] = {{"position", to_json(camera.position)},
                                  {"target", to_json(camera.target)},
                                  {"up", to_json(camera.up)},
                                  {"field_of_view", camera.field_of_view}};
    }
    std::error_code error;
    std::filesystem::create_directories(file.parent_path(), error);
    if (error) throw Error(ErrorCode::input_output, file.string(), "cannot be created: " + error.message());
    scene::write_file(file, json.dump(2) + "\n");
}

} // namespace carom::viewer
