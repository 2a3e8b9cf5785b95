"""The commands of README.md and docs/command_line.md do what they say, the scenes of docs/scenes.md run, and the
tables of the command line name what there is."""

import csv
import json
import re
import shlex
import unittest

from carom_cli import GAS, ROOT, CliTest

README = (ROOT / "README.md").read_text(encoding="utf-8")
PAGE = (ROOT / "docs/command_line.md").read_text(encoding="utf-8")
SCENES = (ROOT / "docs/scenes.md").read_text(encoding="utf-8")


def blocks(page, language):
    """The code blocks of a page."""
    return re.findall(rf"```{language}\n(.*?)```", page, re.DOTALL)


def commands(page):
    """The lines of code blocks that begin with `carom`, and the exit codes that stand behind them. Windows are for
    test_view.py."""
    for block in blocks(page, "sh"):
        for line in block.splitlines():
            if line.startswith("carom ") and not line.startswith("carom view "):
                code = re.search(r"exit code (\d)", line)
                yield shlex.split(line.partition("#")[0])[1:], int(code.group(1)) if code else 0


def keys_of_table(heading):
    """What stands in the first column of the table below a heading."""
    section = PAGE.partition(f"## {heading}\n")[2].partition("\n## ")[0]
    return [key for row in re.findall(r"^\| (`.*?) \|", section, re.MULTILINE) for key in re.findall(r"`(.*?)`", row)]


class Documentation(CliTest):
    def test_commands(self):
        (self.folder / "scenes").symlink_to(ROOT / "scenes")
        for page, least in ((README, 5), (PAGE, 9)):
            shown = list(commands(page))
            self.assertGreaterEqual(len(shown), least)
            for arguments, code in shown:
                self.carom(*arguments, expect=code)

    def test_scenes(self):
        scene, faces, shaken, obstacle, ice, observers = blocks(SCENES, "toml")
        self.write("ball.toml", scene)
        self.assertEqual(self.json("run", "ball.toml", "--time", 1)["face_impacts"], 0)
        self.write("faces.toml", scene.replace("max = [10, 10, 10]\n", "max = [10, 10, 10]\n" + faces))
        self.assertEqual(self.json("run", "faces.toml")["contacts"], 1)
        self.write("shaken.toml", scene.replace("max = [10, 10, 10]\n", "max = [10, 10, 10]\n" + shaken))
        self.assertEqual(self.json("run", "shaken.toml", "--time", 20)["contacts"], 0) # at 4 g it never rests
        under = scene.replace("position = [5, 5, 9]", "position = [0.5, 0.5, 5]").replace("min = [0, 0, 0]", "min = [-9, -9, 0]")
        self.write("obstacle.toml", under + obstacle)
        self.assertGreater(self.json("run", "obstacle.toml", "--time", 2)["face_impacts"], 0)
        self.write("ice.toml", scene.replace("restitution = 0.9", 'material = "ice"') + ice)
        self.assertGreater(self.json("run", "ice.toml", "--time", 20)["energy_lost"], 80)
        self.write("observed.toml", scene + observers)
        self.carom("run", "observed.toml", "--time", 3)
        rows = list(csv.DictReader(self.read("out", "observed", "observations.csv").decode().splitlines()))
        self.assertEqual({row["observer"] for row in rows}, {"impacts", "layers"})
        self.assertEqual(len([row for row in rows if row["quantity"] == "density"]), 8)

    def test_observations_are_described(self):
        keys = {"energies": "", "impacts": "", "speeds": "most = 9", "profile": 'axis = "z"', "coordination": "",
                "radial_distribution": "most = 2", "slab_packing": 'axis = "z"', "correlations": ""}
        self.write("all.toml", GAS + "".join(f'[[observe]]\nkind = "{kind}"\nevery = 0.1\n{key}\n'
                                             for kind, key in keys.items()))
        self.carom("run", "all.toml")
        rows = csv.DictReader(self.read("out", "all", "observations.csv").decode().splitlines())
        self.assertEqual({row["quantity"] for row in rows}, set(keys_of_table("Observations")))

    def test_every_option_is_described(self):
        for command in ("run", "bench", "validate", "view", "render", "info", "diff"):
            for option in set(re.findall(r"--[a-z-]+", self.carom(command, "--help")[0])) - {"--help"}:
                self.assertTrue(f"`{option}" in PAGE, f"{command} {option}")

    def test_json_keys(self):
        run = self.json("run", ROOT / "scenes/two_bodies.toml", "--out", "out")
        bench = self.json("bench", "gas", "--bodies", 10, "--steps", 1, "--warmup", 0)
        self.assertEqual(set(keys_of_table("Figures")), set(run) | set(bench))
        self.assertEqual(set(keys_of_table("Facts")), set(self.json("info")))
        self.assertEqual(set(keys_of_table("Rows")), set(self.json("validate", "--only", "drag")["rows"][0]))
        self.assertEqual(json.loads(self.read("out", "summary.json")), run)

    def test_columns(self):
        self.write("log.toml", (ROOT / "scenes/two_bodies.toml").read_text() + "\n[output]\nrecord_impacts = true\nbodies_every = 1\n")
        self.carom("run", "log.toml", "--out", "out")
        for name, heading in (("timeline.csv", "Timeline"), ("impacts.csv", "Impacts"),
                              ("bodies/000000.csv", "Bodies")):
            with open(self.folder / "out" / name, newline="", encoding="ascii") as file:
                self.assertEqual(keys_of_table(heading), next(csv.reader(file)))


if __name__ == "__main__":
    unittest.main()
