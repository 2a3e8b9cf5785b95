// Two bodies, against a table in exact rational arithmetic.

#include "validate/cases.hpp"
#include "validate/two_body_cases.hpp"

#include <carom/collision.hpp>
#include <carom/world.hpp>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace carom::validate {

namespace {

using nlohmann::json;

constexpr const char* source = "exact rational arithmetic, tests/data/two_body.json";
constexpr const char* near_graze = "12_grazing_near_hit";
constexpr const char* boosted = "22_common_drift";
constexpr const char* coincident = "23_coincident_centres";

/// "3/5", "inf" or a decimal number.
double number(const std::string& text) {
    if (text == "inf") return infinite_mass;
    const auto slash = text.find('/');
    if (slash == std::string::npos) return std::stod(text);
    return std::stod(text.substr(0, slash)) / std::stod(text.substr(slash + 1));
}

/// A result has an exact form or, where it is irrational, only a decimal one.
double result(const json& value) {
    return number(value.at(value.at("exact").is_null() ? "decimal" : "exact").get<std::string>());
}

Vec3 vector(const json& texts) {
    const auto at = [&](std::size_t i) { return number(texts[i].get<std::string>()); };
    return {at(0), at(1), at(2)};
}

Vec3 result_vector(const json& values) { return {result(values[0]), result(values[1]), result(values[2])}; }

struct Case {
    std::string name;
    Body a;
    Body b;
    bool collides = false;
    double time = 0;
    Vec3 v_a{}; ///< m/s, after
    Vec3 v_b{};
};

Case read_case(const json& entry) {
    const json& input = entry.at("input");
    const json& expected = entry.at("result");
    const auto body = [&](const std::string& index) {
        return Body{.position = vector(input.at("x" + index)),
                    .velocity = vector(input.at("v" + index)),
                    .mass = number(input.at("m" + index).get<std::string>()),
                    .radius = number(input.at("r" + index).get<std::string>()),
                    .restitution = number(input.at("e").get<std::string>())};
    };
    Case c{.name = entry.at("name").get<std::string>(), .a = body("1"), .b = body("2")};
    c.collides = expected.contains("V1");
    c.v_a = c.collides ? result_vector(expected.at("V1")) : c.a.velocity;
    c.v_b = c.collides ? result_vector(expected.at("V2")) : c.b.velocity;
    if (c.collides && expected.contains("t")) c.time = result(expected.at("t"));
    return c;
}

double largest_speed(const Case& c) { return std::max({length(c.a.velocity), length(c.b.velocity), 1.0}); }

/// Errors of velocities, and of times of impact by the largest speed, relative to that.
double error_of(const Case& c, const Vec3& v_a, const Vec3& v_b, double time) {
    const double speed = largest_speed(c);
    return std::max({length(v_a - c.v_a), length(v_b - c.v_b), std::abs(time - c.time)}) / speed;
}

template <class T>
double error_of_functions(const Case& c) {
    const auto narrow = [](const Vec3& v) { return detail::narrow<T>(v); };
    Vector3<T> v_a = narrow(c.a.velocity);
    Vector3<T> v_b = narrow(c.b.velocity);
    const Vector3<T> delta = narrow(c.b.position - c.a.position);
    const T time = time_to_spheres(delta, v_b - v_a, static_cast<T>(c.a.radius + c.b.radius), T{10});
    const bool meets = time != static_cast<T>(no_impact);
    if (meets || delta == Vector3<T>{}) {
        const T flight = meets ? time : T{0};
        respond(contact_normal(delta + (v_b - v_a) * flight, v_b - v_a), static_cast<T>(c.a.mass), v_a,
                static_cast<T>(c.b.mass), v_b, static_cast<T>(c.a.restitution));
    }
    return error_of(c, detail::wide(v_a), detail::wide(v_b), meets ? static_cast<double>(time) : c.time);
}

double error_of_world(const Case& c) {
    // Fine positions; the boosted pair needs the room of the default.
    World world({.resolution = c.name == boosted ? 0 : 0x1p-50, .threads = 1});
    const BodyId a = world.add(c.a, Overlap::accept);
    const BodyId b = world.add(c.b, Overlap::accept);
    world.step(c.time + 1);
    const double time = world.impacts().empty() ? c.time : world.impacts().front().time;
    return error_of(c, world.get(a).velocity, world.get(b).velocity, time);
}

template <class Error>
Row worst_row(const std::vector<Case>& cases, const char* name, const char* how, Error error, double admitted) {
    double worst = 0;
    for (const Case& c : cases) worst = std::max(worst, error(c));
    return exact_row({name, fmt::format("{} cases, {}", cases.size(), how), source}, 0, worst, admitted);
}

Findings run() {
    std::vector<Case> all;
    const json table = json::parse(two_body_cases());
    for (const json& entry : table.at("cases")) all.push_back(read_case(entry));
    const auto is_graze = [](const Case& c) { return c.name == near_graze; };
    std::vector<Case> grazing;
    std::copy_if(all.begin(), all.end(), std::back_inserter(grazing), is_graze);
    all.erase(std::remove_if(all.begin(), all.end(), is_graze), all.end());
    const auto all_but = [&](const char* name) {
        std::vector<Case> others;
        std::copy_if(all.begin(), all.end(), std::back_inserter(others), [&](const Case& c) { return c.name != name; });
        return others;
    };
    constexpr const char* what = "two bodies: largest error of time and velocities, by the largest speed";
    Findings found;
    found.rows = {
        worst_row(all, what, "pair functions", error_of_functions<double>, 1e-12),
        worst_row(all_but(coincident), what, "in a world", error_of_world, 1e-9),
        worst_row(grazing, what, "a near-graze, 1e-12 deep, pair functions", error_of_functions<double>, 1e-9),
        worst_row(all_but(boosted), what, "pair functions, single precision", error_of_functions<float>, 1e-5)};
    return found;
}

} // namespace

std::vector<Task> two_body_tasks(Extent /*extent*/) { return {{0, run}}; }

} // namespace carom::validate
