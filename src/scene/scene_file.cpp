#include "scene/bodies_reader.hpp"
#include "scene/observation_reader.hpp"
#include "scene/obstacle_reader.hpp"
#include "scene/reader.hpp"
#include "scene/region_reader.hpp"
#include "scene/restitution_reader.hpp"
#include "scene/scene.hpp"
#include "scene/text_file.hpp"
#include "scene/view_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <new>

namespace carom::scene {

namespace {

/// 2^53: steps beyond it could not be told apart as numbers.
constexpr double most_steps = 0x1p53;

/// A power of two: a number, or a text like "2^-20".
double read_resolution(const ValueReader& value) {
    constexpr const char* allowed = "must be a power of two > 0 in m: a number, or a text like \"2^-20\"";
    constexpr int largest_exponent = 100;
    if (!value.is_text()) {
        const double number = value.number(length_range);
        int exponent = 0;
        if (std::frexp(number, &exponent) != 0.5) value.fail(fmt::format("{}, got {}", allowed, number));
        return number;
    }
    const std::string text = value.text();
    int exponent = 0;
    const char* end = text.data() + text.size();
    const char* start = text.starts_with("2^") ? text.data() + 2 : end;
    const auto [rest, error] = std::from_chars(start, end, exponent);
    if (error != std::errc{} || rest != end || std::abs(exponent) > largest_exponent) {
        value.fail(fmt::format("{}, got '{}'", allowed, text.substr(0, 40)));
    }
    return std::ldexp(1.0, exponent);
}

/// s: a number, or a text like "1/60".
double read_dt(const ValueReader& value) {
    if (!value.is_text()) return value.number(positive);
    const std::string text = value.text();
    const double dt = quotient_of_text(text).value_or(0);
    if (!positive.contains(dt)) {
        value.fail(fmt::format("must be > 0 s: a number, or a text like \"1/60\", got '{}'", text.substr(0, 40)));
    }
    return dt;
}

/// A number is linear drag.
Drag read_drag(const ValueReader& value) {
    Drag drag;
    if (value.is_table()) {
        TableReader table = value.table();
        table.read("linear", drag.linear, not_negative);
        table.read("quadratic", drag.quadratic, not_negative);
        table.finish();
    } else {
        drag.linear = value.number(not_negative);
    }
    return drag;
}

void read_world(TableReader table, Scene& scene) {
    WorldOptions& options = scene.options;
    table.read("gravity", options.gravity);
    if (const auto value = table.find("drag")) options.drag = read_drag(*value);
    if (const auto value = table.find("resolution")) options.resolution = read_resolution(*value);
    if (const auto value = table.find("origin")) {
        const std::vector<ValueReader> parts = value->elements(3, "three integers [x, y, z]");
        for (std::size_t axis = 0; axis < parts.size(); ++axis) options.origin[axis] = parts[axis].integer();
    }
    table.read("rest_time", options.rest_time, positive);
    table.read("collapse_time", options.collapse_time, positive);
    if (const auto value = table.find("work_cap")) {
        options.work_cap = value->count(0, std::numeric_limits<std::int64_t>::max());
    }
    table.read("interpolation", options.interpolation);
    table.read("sleeping", options.sleeping);
    if (const auto value = table.find("overlap")) {
        constexpr std::array<std::string_view, 2> names{"refuse", "accept"};
        scene.overlap = value->choice(names) == 0 ? Overlap::refuse : Overlap::accept;
    }
    table.finish();
    for (const auto& [key, line] : table.lines()) scene.lines["world." + key] = line;
}

void read_obstacles(TableReader& top, Scene& scene) {
    const std::filesystem::path folder = std::filesystem::path(scene.file).parent_path();
    for (TableReader& table : top.tables("obstacle")) {
        scene.lines["obstacles[" + std::to_string(scene.options.obstacles.size()) + "]"] = table.line();
        scene.options.obstacles.push_back(read_obstacle(table, folder));
    }
}

std::vector<Material> read_materials(TableReader& top) {
    std::vector<Material> materials;
    for (TableReader& table : top.tables("material")) {
        Material material;
        const ValueReader name = table.need("name");
        material.name = name.text();
        for (const Material& other : materials) {
            if (other.name == material.name) name.fail("is the name of an earlier material");
        }
        if (const auto value = table.find("restitution")) {
            material.law = read_law(*value);
            if (!material.law) material.restitution = value->number(zero_to_one);
        }
        table.read("friction", material.friction, not_negative);
        table.finish();
        materials.push_back(std::move(material));
    }
    return materials;
}

void add_laws(const std::vector<Material>& materials, Scene& scene) {
    for (std::size_t i = 0; i < materials.size(); ++i) {
        if (materials[i].law) scene.options.materials.push_back({static_cast<std::uint32_t>(i + 1), *materials[i].law});
    }
}

void read_material_rules(TableReader& top, const std::vector<Material>& materials, Scene& scene) {
    std::vector<std::string_view> names;
    names.reserve(materials.size());
    for (const Material& material : materials) names.push_back(material.name);
    for (TableReader& table : top.tables("material_rule")) {
        const std::vector<ValueReader> pair = table.need("between").elements(2, "the names of two materials");
        if (names.empty()) pair[0].fail("must be the name of a [[material]], and there is none");
        MaterialRule rule;
        rule.a = static_cast<std::uint32_t>(pair[0].choice(names) + 1);
        rule.b = static_cast<std::uint32_t>(pair[1].choice(names) + 1);
        for (const MaterialRule& other : scene.options.material_rules) {
            if (std::minmax(other.a, other.b) == std::minmax(rule.a, rule.b))
                pair[0].fail(fmt::format("has a rule with {} already", names[rule.b - 1]));
        }
        const ValueReader restitution = table.need("restitution");
        rule.law = read_law(restitution);
        if (!rule.law) rule.restitution = restitution.number(zero_to_one);
        table.read("friction", rule.friction, not_negative);
        table.finish();
        scene.options.material_rules.push_back(rule);
    }
}

Precision read_precision(const ValueReader& value) {
    constexpr std::array<std::string_view, 2> names{"single", "double"};
    return value.choice(names) == 0 ? Precision::single_precision : Precision::double_precision;
}

void read_run(TableReader table, Scene& scene) {
    RunSettings& run = scene.run;
    table.read("time", run.time, positive);
    if (const auto dt = table.find("dt")) run.dt = read_dt(*dt);
    if (const auto steps = table.find("steps")) {
        if (table.has("time")) steps->fail("must not stand beside time: give one of them");
        run.steps = steps->count(1, static_cast<std::uint64_t>(most_steps));
    }
    if (const auto precision = table.find("precision")) scene.options.precision = read_precision(*precision);
    if (const auto threads = table.find("threads"))
        run.threads = static_cast<unsigned>(threads->count(0, most_threads));
    table.finish();
    scene.lines["run"] = table.line();
}

void read_output(TableReader table, Scene& scene) {
    OutputSettings& outputs = scene.outputs;
    table.read("timeline_every", outputs.timeline_every, not_negative);
    table.read("checkpoint_every", outputs.checkpoint_every, not_negative);
    table.read("bodies_every", outputs.bodies_every, positive);
    table.read("energy_plot", outputs.energy_plot);
    table.read("record_impacts", outputs.record_impacts);
    table.read("least_recorded_impulse", scene.options.least_recorded_impulse, not_negative);
    table.read("check_overlap", outputs.check_overlap);
    table.finish();
}

double checked(double value, const NumberRange& range, const char* option) {
    if (range.contains(value)) return value;
    throw SceneError("", 0, option, fmt::format("{}, got {}", range.allowed, value));
}

void apply(const Overrides& overrides, Scene& scene) {
    RunSettings& run = scene.run;
    if (overrides.dt) run.dt = checked(*overrides.dt, positive, "--dt");
    if (overrides.time) {
        run.time = checked(*overrides.time, positive, "--time");
        run.steps.reset();
    }
    if (overrides.steps) {
        if (overrides.time) throw SceneError("", 0, "--steps", "must not stand beside --time: give one of them");
        if (*overrides.steps == 0) throw SceneError("", 0, "--steps", "must be at least 1");
        run.steps = overrides.steps;
    }
    if (overrides.threads) run.threads = *overrides.threads;
    if (overrides.precision) scene.options.precision = *overrides.precision;
    if (overrides.checkpoint_every) {
        scene.outputs.checkpoint_every = checked(*overrides.checkpoint_every, not_negative, "--checkpoint-every");
    }
}

/// Steps and dt set the time; a time and dt must not ask for more steps than can be counted.
void complete_run(Scene& scene) {
    RunSettings& run = scene.run;
    const double steps = run.steps ? static_cast<double>(*run.steps) : run.time / run.dt;
    if (run.steps) run.time = steps * run.dt;
    if (steps <= most_steps && std::isfinite(run.time)) return;
    const auto line = scene.lines.find("run");
    throw SceneError(
        scene.file, line == scene.lines.end() ? 0 : line->second, "run",
        fmt::format("must take at most 2^53 steps and a finite time, got time = {} and dt = {}", run.time, run.dt));
}

Scene read_scene(TableReader& top, const std::filesystem::path& file, const Overrides& overrides) {
    Scene scene;
    scene.file = file.string();
    scene.name = file.stem().string();
    scene.title = scene.name;
    top.read("title", scene.title);
    if (const auto seed = top.find("seed")) scene.seed = seed->count(0, std::numeric_limits<std::int64_t>::max());
    if (const auto table = top.find("run")) read_run(table->table(), scene);
    apply(overrides, scene);
    complete_run(scene);
    if (const auto table = top.find("world")) read_world(table->table(), scene);
    if (const auto table = top.find("region")) {
        scene.lines["region"] = table->line();
        scene.options.region = read_region(table->table());
    }
    read_obstacles(top, scene);
    if (const auto table = top.find("output")) read_output(table->table(), scene);
    scene.view = read_view(top);
    scene.options.record_impacts = scene.outputs.record_impacts;
    const std::vector<Material> materials = read_materials(top);
    add_laws(materials, scene);
    read_material_rules(top, materials, scene);
    read_bodies(top, materials, overrides.max_bodies, scene);
    read_observations(top, scene);
    top.finish();
    return scene;
}

} // namespace

Scene parse_scene(std::string_view text, const std::filesystem::path& file, const Overrides& overrides) {
    const std::string name = file.string();
    const TomlValue root = parse_toml(text, name);
    TableReader top(root, "", name);
    try {
        return read_scene(top, file, overrides);
    } catch (const std::bad_alloc&) {
        throw SceneError(name, 0, "bodies", "there is not enough memory for so many");
    }
}

Scene load_scene(const std::filesystem::path& file, const Overrides& overrides) {
    return parse_scene(read_text_file(file), file, overrides);
}

} // namespace carom::scene
