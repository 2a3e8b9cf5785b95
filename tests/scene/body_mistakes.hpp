/// \file
/// Scenes with a mistake in materials and bodies.
#pragma once

#include "mistake.hpp"

#include <vector>

namespace carom::scene {

// clang-format off: one mistake after the other, its text as it stands in the file
inline const std::vector<Mistake> body_mistakes{
    {R"([[material]]
restitution = 1
)",
     "s.toml:1: material[0].name: is missing", ""},
    {R"([[material]]
name = "a"
[[material]]
name = "a"
)",
     "s.toml:4: material[1].name: is the name of an earlier material", ""},
    {R"([[material]]
name = "ice"
[[material_rule]]
between = ["ice", "ise"]
restitution = 1
)",
     "s.toml:4: material_rule[0].between[1]: must be one of ice, got 'ise'; did you mean 'ice'?", ""},
    {R"([[material]]
name = "ice"
[[material]]
name = "iron"
[[material_rule]]
between = ["ice", "iron"]
restitution = 0.5
[[material_rule]]
between = ["iron", "ice"]
restitution = 0.6
)",
     "s.toml:9: material_rule[1].between[0]: has a rule with ice already", ""},
    {R"([[material_rule]]
between = ["ice", "ice"]
restitution = 1
)",
     "s.toml:2: material_rule[0].between[0]: must be the name of a [[material]], and there is none", ""},
    {R"([[material]]
name = "ice"
[[material_rule]]
between = ["ice"]
)",
     "s.toml:4: material_rule[0].between: must be the names of two materials, got an array of 1", ""},
    {R"([[material]]
name = "ice"
[[material_rule]]
between = ["ice", "ice"]
)",
     "s.toml:3: material_rule[0].restitution: is missing", ""},
    {R"([[material]]
name = "ice"
restitution = { law = "powr" }
)",
     "s.toml:3: material[0].restitution.law: must be one of power, viscoelastic, got 'powr'; did you mean 'power'?", ""},
    {R"([[material]]
name = "ice"
restitution = { law = "power", restitution = 0, speed = 1, exponent = 1 }
)",
     "s.toml:3: material[0].restitution.restitution: must be in (0, 1], got 0", ""},
    {R"([[material]]
name = "ice"
restitution = { law = "power", restitution = 1, speed = 0, exponent = 1 }
)",
     "s.toml:3: material[0].restitution.speed: must be > 0 and finite, got 0", ""},
    {R"([[material]]
name = "ice"
restitution = { law = "power", restitution = 1, speed = 1, exponent = -1 }
)",
     "s.toml:3: material[0].restitution.exponent: must be >= 0 and finite, got -1", ""},
    {R"([[material]]
name = "steel"
restitution = { law = "viscoelastic", dissipation = -1, modulus = 1 }
)",
     "s.toml:3: material[0].restitution.dissipation: must be >= 0 and finite, got -1", ""},
    {R"([[material]]
name = "steel"
restitution = { law = "viscoelastic", dissipation = 1 }
)",
     "s.toml:3: material[0].restitution.modulus: is missing", ""},
    {R"([[material]]
name = "steel"
restitution = { law = "viscoelastic", dissipation = 1, modulus = 1, speed = 1 }
)",
     "s.toml:3: material[0].restitution.speed: unknown key", "dissipation, law, modulus"},
    {R"([[material]]
name = "ice"
[[material_rule]]
between = ["ice", "ice"]
restitution = { law = "viscoelastic", dissipation = 1, modulus = -1 }
)",
     "s.toml:5: material_rule[0].restitution.modulus: must be >= 0", "got -1"},
    {R"([[material]]
name = "ice"
restitution = { law = "power", restitution = 1, speed = 1, exponent = 1 }
[[bodies]]
position = [0, 0, 0]
material = "ice"
restitution = 0.5
)",
     "s.toml:6: bodies[0].material: has a law of restitution: its bodies must have no restitution of their own", ""},
    {R"([bodies]
position = [0, 0, 0]
)",
     "s.toml:1: bodies: must be an array of tables; write [[bodies]]", ""},
    {R"([[bodies]]
)",
     "s.toml:1: bodies[0].position: is missing", ""},
    {R"([[bodies]]
position = [0, 0, 0]
radius = -1
)",
     "s.toml:3: bodies[0].radius: must be >= 0", "got -1"},
    {R"([[bodies]]
position = [0, 0, 0]
radius = "big"
)",
     "s.toml:3: bodies[0].radius: must be a number, or an array with one number per body", ""},
    {R"([[bodies]]
position = [0, 0, 0]
mass = 0
)",
     "s.toml:3: bodies[0].mass: must be > 0; inf makes a body static, got 0", ""},
    {R"([[bodies]]
position = [0, 0, 0]
[[bodies]]
position = [9, 0, 0]
mass = -inf
)",
     "s.toml:5: bodies[1].mass: must be > 0", "got -inf"},
    {R"([[bodies]]
position = [0, 0, 0]
restitution = 1.01
)",
     "s.toml:3: bodies[0].restitution: must be in [0, 1], got 1.01", ""},
    {R"([[bodies]]
position = [0, 0, 0]
friction = nan
)",
     "s.toml:3: bodies[0].friction: must be >= 0 and finite, got nan", ""},
    {R"([[bodies]]
position = [0, 0, 1e40]
)",
     "s.toml:2: bodies[0].position[2]: must be in [-1e30, 1e30] m, got 1e+40", ""},
    {R"([[bodies]]
position = [[0, 0, 0], [1, 1]]
)",
     "s.toml:2: bodies[0].position[1]: must be three numbers [x, y, z], got an array of 2", ""},
    {R"([[bodies]]
position = []
)",
     "s.toml:2: bodies[0].position: must be three numbers", ""},
    {R"([[bodies]]
position = [[0, 0, 0], [9, 1, 1]]
radius = [1, 2, 3]
)",
     "s.toml:3: bodies[0].radius: must be one number or 2, one per body, got 3", ""},
    {R"([[bodies]]
position = [0, 0, 0]
mass = 1
density = 1
)",
     "s.toml:4: bodies[0].density: must not stand beside mass", ""},
    {R"([[bodies]]
position = [0, 0, 0]
radius = 0
density = 1
)",
     "s.toml:4: bodies[0].density: gives body 0 of the entry, radius 0 m, a mass of 0 kg", ""},
    {R"([[bodies]]
position = [0, 0, 0]
materiel = "x"
)",
     "s.toml:3: bodies[0].materiel: unknown key; did you mean 'material'?", ""},
    {R"([[bodies]]
position = [0, 0, 0]
material = "x"
)",
     "s.toml:3: bodies[0].material: must be the name of a [[material]], but the scene has none", ""},
    {R"([[bodies]]
position = [0, 0, 0]
mass = inf
velocity = [1, 0, 0]
)",
     "s.toml:4: bodies[0].velocity: must be 0 for a static body", ""},
    {R"([[bodies]]
position = [0, 0, 0]
velocity = 3
)",
     "s.toml:3: bodies[0].velocity: must be [vx, vy, vz]", ""},
    {R"([[bodies]]
position = [0, 0, 0]
velocity = [[1, 0, 0], [1, 0, 0]]
)",
     "s.toml:3: bodies[0].velocity: must be one velocity or 1, one per body, got 2", ""},
    {R"([[bodies]]
name = "a"
position = [0, 0, 0]
[[bodies]]
name = "a"
position = [9, 0, 0]
)",
     "s.toml:5: bodies[1].name: is the name of an earlier entry", ""},
};
// clang-format on

} // namespace carom::scene
