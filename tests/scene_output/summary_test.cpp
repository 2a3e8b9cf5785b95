#include "scene/summary.hpp"

#include <carom/executor.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <string>
#include <vector>

namespace carom::test {
namespace {

scene::Summary example() {
    scene::Summary summary;
    summary.bodies = 1234567;
    summary.steps = 60;
    summary.dt = 0.1;
    summary.precision = Precision::single_precision;
    summary.wall_seconds = 2;
    summary.ns_per_body_step = 200.5;
    summary.ns_per_body_step_min = 190;
    summary.pair_impacts = 30;
    summary.face_impacts = 12;
    summary.impacts_per_second = 21;
    summary.start.kinetic = 10;
    summary.end = {.kinetic = 7, .potential = 1, .dissipated = 3, .work = 0.5};
    summary.overlap = scene::OverlapReport{.largest = 1e-12, .mean = 1e-13, .touching = 4, .bodies_outside = 1};
    summary.peak_rss_bytes = 1 << 20;
    summary.bytes_per_body = 180.25;
    summary.hash = 0xabc;
    return summary;
}

TEST(Summary, HasEveryKeyOfTheContract) {
    const auto json = to_json(example());
    for (const char* key : {"bodies", "steps", "threads", "impacts", "contacts", "bodies_outside", "peak_rss_bytes"}) {
        ASSERT_TRUE(json.contains(key)) << key;
        EXPECT_TRUE(json[key].is_number_unsigned()) << key;
    }
    for (const char* key : {"dt", "wall_seconds", "ns_per_body_step", "ns_per_body_step_min", "impacts_per_second",
                            "energy_initial", "energy_final", "energy_balance", "energy_drift", "kinetic_initial",
                            "kinetic_final", "momentum_drift", "max_overlap", "mean_overlap", "bytes_per_body"}) {
        ASSERT_TRUE(json.contains(key)) << key;
        EXPECT_TRUE(json[key].is_number_float()) << key;
    }
    for (const char* key : {"precision", "simd", "hash"}) {
        ASSERT_TRUE(json.contains(key)) << key;
        EXPECT_TRUE(json[key].is_string()) << key;
    }
}

TEST(Summary, FiguresStandUnderTheirKeys) {
    const auto json = to_json(example());
    EXPECT_EQ(json["impacts"], 42);
    EXPECT_EQ(json["energy_initial"], 10.0);
    EXPECT_EQ(json["energy_final"], 8.0);
    EXPECT_EQ(json["energy_lost"], 2.5);
    EXPECT_EQ(json["energy_balance"], 0.05);
    EXPECT_EQ(json["energy_drift"], 0.05);
    EXPECT_EQ(json["max_overlap"], 1e-12);
    EXPECT_EQ(json["bodies_outside"], 1);
    EXPECT_EQ(json["precision"], "single");
    EXPECT_EQ(json["simd"], std::string(carom::simd_target()));
    EXPECT_EQ(json["hash"], "0000000000000abc");
    EXPECT_EQ(nlohmann::json::parse(scene::file_text(json))["dt"].get<double>(), 0.1);
}

TEST(Summary, WhatWasNotMeasuredIsNull) {
    scene::Summary summary = example();
    summary.overlap.reset();
    const auto json = to_json(summary);
    for (const char* key : {"max_overlap", "mean_overlap", "bodies_outside"}) EXPECT_TRUE(json[key].is_null()) << key;
    EXPECT_NE(to_text(summary).find("not searched for"), std::string::npos);
}

TEST(Summary, AnyNameCanBeWritten) {
    nlohmann::ordered_json json;
    json["scene"] = "caf\xe9";
    EXPECT_EQ(scene::file_text(json), "{\n  \"scene\": \"caf\xef\xbf\xbd\"\n}\n");
}

TEST(Summary, IsReadable) {
    const std::string text = to_text(example());
    EXPECT_NE(text.find("1 234 567, single precision, 1 thread\n"), std::string::npos) << text;
    EXPECT_NE(text.find("200.5 ns per body and step"), std::string::npos) << text;
    EXPECT_NE(text.find("1 bodies outside"), std::string::npos) << text;
    EXPECT_NE(text.find("0000000000000abc"), std::string::npos) << text;
}

TEST(Summary, NothingIsDividedByNothing) {
    EXPECT_EQ(scene::ratio(3, 0), 0);
    EXPECT_EQ(scene::ratio(3, 2), 1.5);
}

} // namespace
} // namespace carom::test
