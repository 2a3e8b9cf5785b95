// Every case of tests/data/two_body.json: times, positions, velocities, impulses and energies of two bodies, computed
// with exact rational arithmetic by a program that shares nothing with this one.

#include <carom/collision.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
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
void expect_near(const Vector3<T>& measured, const json& expected, double tolerance, const char* what) {
    const std::array components{measured.x, measured.y, measured.z};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_NEAR(static_cast<double>(components[i]), value(expected[i]), tolerance) << what << " " << i;
    }
}

template <class T>
class TwoBodyCase {
public:
    TwoBodyCase(const json& test_case, double relative)
        : input_(test_case.at("input")), result_(test_case.at("result")), a_(input_, "1"), b_(input_, "2"),
          e_(Body<T>::scalar(input_.at("e"))),
          speed_(static_cast<double>(std::max({length(a_.v), length(b_.v), T{1}}))), tolerance_(relative * speed_) {}

    void check() {
        const T horizon = 10;
        const T time = time_to_spheres(b_.x - a_.x, b_.v - a_.v, a_.r + b_.r, horizon);
        if (result_.at("collides") == true) {
            ASSERT_NE(time, static_cast<T>(no_impact));
            EXPECT_NEAR(static_cast<double>(time), value(result_.at("t")), tolerance_ / speed_);
            a_.move(time);
            b_.move(time);
            check_impact();
        } else {
            EXPECT_EQ(time, static_cast<T>(no_impact));
            check_without_impact();
        }
    }

private:
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
        EXPECT_NEAR(static_cast<double>(response.energy_lost()), lost, tolerance_ / speed_ * energy);
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
    for (const json& test_case : cases) {
        const auto name = test_case.at("name").get<std::string>();
        SCOPED_TRACE(name);
        if (!left_out.contains(name)) {
            TwoBodyCase<T>(test_case, name == "12_grazing_near_hit" ? near_graze : relative).check();
        }
    }
}

TEST(TwoBody, AllCasesInDouble) { check_all<double>(1e-12, 1e-9, {}); }

// The near-graze and the boost by 10^6 lie below the resolution of a float.
TEST(TwoBody, CasesInSingle) { check_all<float>(1e-5, 0, {"12_grazing_near_hit", "22_common_drift"}); }

} // namespace
} // namespace carom
