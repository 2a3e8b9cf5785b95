// Scene files that are refused.
#include "body_mistakes.hpp"
#include "generator_mistakes.hpp"
#include "other_mistakes.hpp"
#include "refusal.hpp"
#include "scene/scene.hpp"
#include "scene/text_file.hpp"
#include "temporary_folder.hpp"
#include "world_mistakes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace carom::scene {
namespace {

TEST(SceneErrors, NameFileLineKeyAndWhatIsAllowed) {
    for (const auto* table : {&world_mistakes, &body_mistakes, &generator_mistakes, &other_mistakes}) {
        for (const Mistake& mistake : *table) {
            const std::string message = refusal([&] { parse_scene(mistake.text, "s.toml"); });
            EXPECT_EQ(message.substr(0, mistake.message.size()), mistake.message) << mistake.text << message;
            EXPECT_NE(message.find(mistake.also), std::string::npos) << mistake.text << message;
        }
    }
}

TEST(SceneErrors, TellThePartsOfTheMessage) {
    try {
        parse_scene("\n[world]\nrest_time = 0\n", "a/b.toml");
        FAIL() << "nothing was refused";
    } catch (const SceneError& error) {
        EXPECT_EQ(error.file(), "a/b.toml");
        EXPECT_EQ(error.line(), 3);
        EXPECT_EQ(error.key(), "world.rest_time");
        EXPECT_EQ(error.reason(), "must be > 0 and finite, got 0");
    }
}

TEST(SceneErrors, LongTextsAreCutShort) {
    const std::string message =
        refusal([] { parse_scene("[run]\nprecision = \"" + std::string(100'000, 'x') + "\"", "s.toml"); });
    EXPECT_LT(message.size(), 300U);
}

TEST(SceneErrors, FilesThatCannotBeRead) {
    const TemporaryFolder folder;
    EXPECT_NE(refusal([&] { load_scene(folder.path() / "none.toml"); }).find("none.toml: cannot be opened"),
              std::string::npos);
    EXPECT_NE(refusal([&] { load_scene(folder.path()); }).find("is no regular file"), std::string::npos);
    EXPECT_NE(refusal([] { load_scene("/dev/zero"); }).find("is no regular file"), std::string::npos);
}

TEST(SceneErrors, ValuesOfTheCommandLine) {
    const auto with = [](const Overrides& overrides) { return refusal([&] { parse_scene("", "s.toml", overrides); }); };
    Overrides overrides;
    overrides.dt = 0;
    EXPECT_EQ(with(overrides), "--dt: must be > 0 and finite, got 0");
    overrides = {};
    overrides.time = -1;
    EXPECT_EQ(with(overrides), "--time: must be > 0 and finite, got -1");
    overrides.time = 1;
    overrides.steps = 1;
    EXPECT_EQ(with(overrides), "--steps: must not stand beside --time: give one of them");
    overrides = {};
    overrides.steps = 0;
    EXPECT_EQ(with(overrides), "--steps: must be at least 1");
    overrides = {};
    overrides.checkpoint_every = -1;
    EXPECT_EQ(with(overrides), "--checkpoint-every: must be >= 0 and finite, got -1");
}

/// The keys that a scene with an unknown key "q" is told to be allowed there.
std::vector<std::string> keys_allowed_in(std::string_view text) {
    std::string message = refusal([&] { parse_scene(text, "s.toml"); });
    constexpr std::string_view before = "allowed here: ";
    const std::size_t start = message.find(before);
    if (start == std::string::npos) return {};
    message.erase(0, start + before.size());
    std::vector<std::string> keys;
    while (!message.empty()) {
        const std::size_t end = std::min(message.find(", "), message.size());
        keys.push_back(message.substr(0, end));
        message.erase(0, end + 2);
    }
    return keys;
}

TEST(SceneErrors, EveryKeyIsDocumented) {
    const std::string documentation = read_text_file("docs/scenes.md");
    const std::string box = "min = [0, 0, 0]\nmax = [9, 9, 9]\n";
    const std::string body = "[[bodies]]\nposition = [0, 0, 0]\n";
    const std::string around = "[[attractor]]\nposition = [9, 9, 9]\nstrength = 1\n";
    const std::string round = "count = 1\ncentre = [0, 0, 0]\ninner = 1\nouter = 2\n";
    const std::vector<std::string> texts{
        "q = 1",
        "[world]\nq = 1",
        "[world]\ndrag = { q = 1 }",
        "[run]\nq = 1",
        "[output]\nq = 1",
        "[region]\nkind = \"box\"\n" + box + "q = 1",
        "[region]\nkind = \"box\"\n" + box + "faces = { q = 1 }",
        "[region]\nkind = \"box\"\n" + box + "faces = { x = { q = 1 } }",
        "[region]\nkind = \"box\"\n" + box + "faces = { x = { motion = { q = 1 } } }",
        "[region]\nkind = \"planes\"\nplane = [{ q = 1 }]",
        "[region]\nkind = \"shell\"\nradius = 1\nq = 1",
        "[[material]]\nname = \"a\"\nq = 1",
        "[[material]]\nname = \"a\"\n[[material_rule]]\nbetween = [\"a\", \"a\"]\nrestitution = 1\nq = 1",
        around + "q = 1",
        body + "q = 1",
        body + "velocity = { distribution = \"uniform\", min = 0, max = 1, q = 1 }",
        body + "velocity = { distribution = \"maxwell\", kT = 1, q = 1 }",
        around + body + "velocity = { distribution = \"radial\", speed = 1, q = 1 }",
        around + body + "velocity = { distribution = \"orbit\", q = 1 }",
        around + body + "velocity = { distribution = \"orbit\" }\nq = 1",
        "[[bodies]]\ngenerator = \"lattice\"\ncount = 1\n" + box + "q = 1",
        "[[bodies]]\ngenerator = \"fcc\"\ncount = 1\n" + box + "q = 1",
        "[[bodies]]\ngenerator = \"random\"\ncount = 1\n" + box +
            "radius = { q = 1, distribution = \"uniform\", min = 0, max = 1 }",
        "[[bodies]]\ngenerator = \"shell\"\n" + round + "q = 1",
        "[[bodies]]\ngenerator = \"disc\"\n" + round + "q = 1",
    };
    for (const std::string& text : texts) {
        const std::vector<std::string> keys = keys_allowed_in(text);
        EXPECT_FALSE(keys.empty()) << text;
        for (const std::string& key : keys) {
            if (key == "x_max" || key == "y_max" || key == "z_min" || key == "plane") continue; // written in other ways
            const bool known = documentation.find("`" + key + "`") != std::string::npos ||
                               documentation.find("[" + key + "]") != std::string::npos;
            EXPECT_TRUE(known) << key;
        }
    }
}

} // namespace
} // namespace carom::scene
