"""`carom diff` names the first body, field and impact in which two results differ."""

import unittest

from carom_cli import GAS, CliTest


class Diff(CliTest):
    def setUp(self):
        super().setUp()
        self.write("gas.toml", GAS + "[output]\nrecord_impacts = true\n")
        self.carom("run", "gas.toml", "--out", "a")

    def diff(self, a, b, expect):
        out, err = self.carom("diff", a, b, expect=expect)
        self.assertEqual(err, "")
        return out

    def cannot(self, a, b):
        return self.refused("diff", a, b)

    def test_equal_runs(self):
        self.carom("run", "gas.toml", "--out", "b")
        out = self.diff("a", "b", 0)
        for line in ("state: the same, 60 bodies at 1 s", "timeline: the same, 61 rows", "impacts: the same, "):
            self.assertIn(line, out)

    def test_one_changed_velocity(self):
        first, second = "velocity = [[1, 0, 0], [0, 0, 0]]", "velocity = [[1, 0, 0], [0, 0.25, 0]]"
        bodies = "[run]\ntime = 1\ndt = 0.25\n[[bodies]]\nposition = [[0, 0, 0], [9, 0, 0]]\n"
        self.write("pair.toml", bodies + first)
        self.carom("run", "pair.toml", "--out", "c")
        self.write("pair.toml", bodies + second)
        self.carom("run", "pair.toml", "--out", "d")
        out = self.diff("c", "d", 1)
        self.assertIn("state: body 1: position.y is 0 and 0.25; 1 of 2 bodies differ, in their places by at most 0.25 m",
                      out)
        self.assertIn("timeline: row 1 (time 0): kinetic is 0.5 and 0.53125", out)

    def test_other_step_names_impact_and_row(self):
        self.carom("run", "gas.toml", "--out", "b", "--dt", 0.05)
        out = self.diff("a", "b", 1)
        self.assertRegex(out, r"state: body \d+: position\.[xyz] is \S+ and \S+; \d+ of 60 bodies differ")
        self.assertRegex(out, r"timeline: row 2 \(time 0\.01\d*\): time is 0\.01\d* and 0\.05")
        self.assertRegex(out, r"impacts: impact \d+ \(time \S+, a \d+, (b|face) \d+\): \w+ is \S+ and \S+")

    def test_shorter_runs(self):
        self.carom("run", "gas.toml", "--out", "b", "--steps", 30)
        out = self.diff("a", "b", 1)
        self.assertIn("timeline: there are 61 and 31 rows; the first 31 are equal", out)
        self.assertRegex(out, r"impacts: there are \d+ and \d+ rows; the first \d+ are equal")

    def test_other_precision_and_other_bodies(self):
        self.carom("run", "gas.toml", "--out", "b", "--precision", "single")
        self.assertIn("state: precision is double and single", self.diff("a", "b", 1))
        self.write("gas.toml", GAS.replace("count = 60", "count = 59"))
        self.carom("run", "gas.toml", "--out", "b")
        out = self.diff("a", "b", 1)
        self.assertIn("state: the number of bodies is 60 and 59", out)
        self.assertIn("impacts: only a has any", out)

    def test_single_files(self):
        self.carom("run", "gas.toml", "--out", "b")
        for name in ("checkpoint.carom", "timeline.csv", "impacts.csv"):
            self.assertIn("the same", self.diff(f"a/{name}", f"b/{name}", 0))
        self.assertIn("timeline: the same", self.diff("a", "b/timeline.csv", 0))
        self.assertIn("nothing of the same kind", self.cannot("a/checkpoint.carom", "b/timeline.csv"))

    def test_what_cannot_be_compared(self):
        self.assertIn("missing", self.cannot("a", "missing"))
        self.assertIn("gas.toml", self.cannot("gas.toml", "a"))
        self.assertIn("allowed are snapshots", self.cannot("gas.toml", "a"))
        (self.folder / "empty").mkdir()
        self.assertIn("empty holds no", self.cannot("empty", "a"))
        damaged = bytearray(self.read("a", "checkpoint.carom"))
        damaged[100] ^= 4
        (self.folder / "damaged").write_bytes(damaged)
        self.assertIn("checksum", self.cannot("damaged", "a"))


if __name__ == "__main__":
    unittest.main()
