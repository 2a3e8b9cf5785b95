// Every case of tests/data/two_body.json: times, positions, velocities, impulses and energies of two bodies, computed
// with exact rational arithmetic by a program that shares nothing with this one.

#include <carom/collision.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <set>
#include <string>

namespace carom {
namespace {

using nlohmann::json;

/// "3/5", "inf" or a decimal number.
double number(const std::string& text) {
    if (text == "inf") {
        return std::numeric_limits<double>::infinity();
    }
    const auto slash = text.find('/');
    return slash == std::string::npos ? std::stod(text)
                                      : std::stod(text.substr(0, slash)) / std::stod(text.substr(slash + 1));
}

/// A result has an exact form or, where it is irrational, only a decimal one.
double value(const json& result) {
    return number(result.at(result.at("exact").is_null() ? "decimal" : "exact").get<std::string>());
}

template <class T>
struct Body {
    Vector3<T> x, v;
    T m, r;

    Body(const json& input, const std::string& index)
        : x(vector(input.at("x" + index))), v(vector(input.at("v" + index))), m(scalar(input.at("m" + index))),
          r(scalar(input.at("r" + index))) {}

    static T scalar(const json& text) { return static_cast<T>(number(text.get<std::string>())); }
    static Vector3<T> vector(const json& texts) { return {scalar(texts[0]), scalar(texts[1]), scalar(texts[2])}; }
    void move(T t) { x += v * t; }
};

template <class T>
class TwoBodyCase {
public:
    TwoBodyCase(const json& test_case, double relative)
        : relative_(relative), input_(test_case.at("input")), result_(test_case.at("result")), a_(input_, "1"),
          b_(input_, "2"), e_(Body<T>::scalar(input_.at("e"))),
          speed_(static_cast<double>(std::max({length(a_.v), length(b_.v), T{1}}))), tolerance_(relative * speed_) {}

    /// Returns the largest error, in units of the largest speed.
    double check() {
        const T horizon = 10;
        const T time = time_to_spheres(b_.x - a_.x, b_.v - a_.v, a_.r + b_.r, horizon);
        if (result_.at("collides") == true) {
            EXPECT_NE(time, static_cast<T>(no_impact));
            expect_near(time, result_.at("t"), tolerance_ / speed_, "time");
            a_.move(time);
            b_.move(time);
            check_impact();
        } else {
            EXPECT_EQ(time, static_cast<T>(no_impact));
            check_without_impact();
        }
        return worst_;
    }

private:
    void expect_near(T measured, double expected, double tolerance, const char* what) {
        EXPECT_NEAR(static_cast<double>(measured), expected, tolerance) << what;
        worst_ = std::max(worst_, relative_ * std::abs(static_cast<double>(measured) - expected) / tolerance);
    }
    void expect_near(T measured, const json& expected, double tolerance, const char* what) {
        expect_near(measured, value(expected), tolerance, what);
    }
    void expect_near(const Vector3<T>& measured, const json& expected, double tolerance, const char* what) {
        expect_near(measured.x, expected[0], tolerance, what);
        expect_near(measured.y, expected[1], tolerance, what);
        expect_near(measured.z, expected[2], tolerance, what);
    }

    Response<T> respond() {
        return carom::respond(contact_normal(b_.x - a_.x, b_.v - a_.v), a_.m, a_.v, b_.m, b_.v, e_);
    }

    void check_impact() {
        expect_near(a_.x, result_.at("X1"), tolerance_, "position of a");
        expect_near(b_.x, result_.at("X2"), tolerance_, "position of b");
        const Vector3<T> normal = contact_normal(b_.x - a_.x, b_.v - a_.v);
        const Response<T> response = respond();
        expect_near(a_.v, result_.at("V1"), tolerance_, "velocity of a");
        expect_near(b_.v, result_.at("V2"), tolerance_, "velocity of b");
        expect_near(normal * -response.impulse, result_.at("impulse_on_1"), tolerance_ * double(std::min(a_.m, b_.m)),
                    "impulse on a");
        const double energy = value(result_.at("E0"));
        const double lost = energy - value(result_.at("E1"));
        expect_near(response.energy_lost(), lost, tolerance_ / speed_ * energy, "energy lost");
    }

    /// Grazing, parting, resting and coincident pairs: whatever acts on them, it is not from an impact in time.
    void check_without_impact() {
        if (result_.at("collides") == "grazing") {
            const auto time = static_cast<T>(value(result_.at("t")));
            a_.move(time);
            b_.move(time);
        }
        const Body<T> a = a_;
        const Body<T> b = b_;
        const Response<T> response = respond();
        if (result_.at("collides") == "convention") {
            expect_near(a_.v, result_.at("V1"), tolerance_, "velocity of a");
            expect_near(b_.v, result_.at("V2"), tolerance_, "velocity of b");
        } else if (result_.contains("why") && a.r + b.r > 0) {
            EXPECT_EQ(response.impulse, T{0});
            EXPECT_EQ(a_.v, a.v);
            EXPECT_EQ(b_.v, b.v);
        }
    }

    double relative_;
    double worst_ = 0;
    json input_, result_;
    Body<T> a_, b_;
    T e_;
    double speed_, tolerance_;
};

template <class T>
void check_all(double relative, double near_graze, const std::set<std::string>& left_out) {
    std::ifstream file("tests/data/two_body.json");
    ASSERT_TRUE(file) << "run this from the repository's root";
    const json cases = json::parse(file).at("cases");
    EXPECT_EQ(cases.size(), 18U);
    double worst = 0;
    for (const json& test_case : cases) {
        const auto name = test_case.at("name").get<std::string>();
        SCOPED_TRACE(name);
        if (left_out.contains(name)) continue;
        const bool grazes = name == "12_grazing_near_hit";
        const double error = TwoBodyCase<T>(test_case, grazes ? near_graze : relative).check();
        if (grazes)
            std::printf("figure: two_body.json, near-graze: %.2g of the largest speed (at most %g)\n", error,
                        near_graze);
        else
            worst = std::max(worst, error);
    }
    std::printf("figure: two_body.json, %zu cases in %s: %.2g of the largest speed (at most %g)\n",
                cases.size() - left_out.size() - (near_graze > 0 ? 1 : 0), sizeof(T) == 4 ? "single" : "double", worst,
                relative);
}

TEST(TwoBody, AllCasesInDouble) { check_all<double>(1e-12, 1e-9, {}); }

// The near-graze and the boost by 10^6 lie below the resolution of a float.
TEST(TwoBody, CasesInSingle) { check_all<float>(1e-5, 0, {"12_grazing_near_hit", "22_common_drift"}); }

} // namespace
} // namespace carom
