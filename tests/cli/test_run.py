"""What `carom run` computes, prints and writes."""

import csv
import json
import os
import pty
import resource
import time
import unittest
import xml.dom.minidom

from carom_cli import GAS, RAIN, CliTest

WHOLE_NUMBERS = ("bodies", "steps", "threads", "impacts", "contacts", "bodies_outside", "peak_rss_bytes",
                 "pair_impacts", "face_impacts", "resumed_from_step")
NUMBERS = ("dt", "wall_seconds", "ns_per_body_step", "ns_per_body_step_min", "impacts_per_second", "energy_initial",
           "energy_final", "energy_lost", "energy_balance", "energy_drift", "kinetic_initial", "kinetic_final", "momentum_drift",
           "max_overlap", "mean_overlap", "bytes_per_body", "time")
TEXTS = ("scene", "precision", "simd", "hash")
COLUMNS = ["time", "step", "kinetic", "potential", "total", "lost", "momentum_x", "momentum_y", "momentum_z",
           "impacts", "face_impacts", "contacts"]


class Run(CliTest):
    def setUp(self):
        super().setUp()
        self.write("gas.toml", GAS)
        self.write("rain.toml", RAIN)

    def timeline(self, *folder):
        with open(self.folder.joinpath(*folder, "timeline.csv"), newline="", encoding="ascii") as file:
            rows = list(csv.reader(file))
        return rows[0], [dict(zip(rows[0], map(float, row))) for row in rows[1:]]

    def table(self, *file):
        with open(self.folder.joinpath(*file), newline="", encoding="ascii") as table:
            return list(csv.DictReader(table))

    def test_json_keys_and_types(self):
        summary = self.json("run", "rain.toml", "--out", "out")
        for key in WHOLE_NUMBERS:
            self.assertIs(type(summary[key]), int, key)
        for key in NUMBERS:
            self.assertIs(type(summary[key]), float, key)
        for key in TEXTS:
            self.assertIs(type(summary[key]), str, key)
        self.assertIs(summary["complete"], True)
        self.assertEqual(set(summary), {*WHOLE_NUMBERS, *NUMBERS, *TEXTS, "complete"})
        self.assertRegex(summary["hash"], "^[0-9a-f]{16}$")
        self.assertEqual(json.loads(self.read("out", "summary.json")), summary)

    def test_figures(self):
        gas = self.json("run", "gas.toml")
        self.assertEqual((gas["bodies"], gas["steps"], gas["precision"]), (60, 60, "double"))
        self.assertEqual(gas["dt"], 1 / 60)
        self.assertAlmostEqual(gas["time"], 1, delta=1e-12)
        self.assertGreater(gas["pair_impacts"], 50)
        self.assertEqual(gas["impacts"], gas["pair_impacts"] + gas["face_impacts"])
        self.assertAlmostEqual(gas["ns_per_body_step"], gas["wall_seconds"] * 1e9 / 60 / 60, delta=1e-6)
        self.assertLess(abs(gas["energy_drift"]), 1e-12)
        self.assertLess(gas["momentum_drift"], 1e-12)
        self.assertLess(gas["max_overlap"], 1e-9)
        self.assertEqual(gas["bodies_outside"], 0)
        rain = self.json("run", "rain.toml", "--time", 10)
        self.assertGreater(rain["contacts"], 0)
        self.assertGreater(rain["energy_lost"], 0)
        self.assertAlmostEqual(rain["energy_final"] + rain["energy_lost"], rain["energy_initial"],
                               delta=1e-3 * rain["energy_initial"])

    def test_files(self):
        self.carom("run", "gas.toml", "--out", "a/b/out")
        self.assertEqual(self.files("a/b/out"), ["checkpoint.carom", "energy.svg", "summary.json", "timeline.csv"])
        self.carom("run", "gas.toml")
        self.assertEqual(self.files("out/gas"), self.files("a/b/out"))

    def test_observers(self):
        self.write("observed.toml", GAS + """
[[observe]]
kind = "impacts"
[[observe]]
name = "speeds"
kind = "speeds"
most = 20
bins = 10
every = 0.1
""")
        self.carom("run", "observed.toml", "--out", "out", "--time", 4)
        self.assertEqual(self.files("out"), ["checkpoint.carom", "energy.svg", "observations.csv", "summary.json",
                                             "timeline.csv"])
        with open(self.folder / "out" / "observations.csv", newline="", encoding="ascii") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(list(rows[0]), ["observer", "quantity", "unit", "at", "value", "standard_error"])
        values = {(row["observer"], row["quantity"], row["at"]): row for row in rows}
        summary = json.loads(self.read("out", "summary.json"))
        rate = float(values["impacts", "collision_rate", ""]["value"])
        self.assertAlmostEqual(rate, 2 * summary["pair_impacts"] / 60 / 4, delta=1e-9 * rate)
        mean_square = float(values["speeds", "speed_moment_2", ""]["value"])
        self.assertAlmostEqual(mean_square, 2 * summary["kinetic_initial"] / 60, delta=1e-9 * mean_square)
        self.assertEqual(len([row for row in rows if row["quantity"] == "speed_density"]), 10)
        self.assertIn("pressure", {row["quantity"] for row in rows})

        self.carom("run", "observed.toml", "--out", "parts", "--time", 1.5)
        self.carom("run", "observed.toml", "--out", "parts", "--time", 4, "--resume", "parts/checkpoint.carom")
        for name in ("observations.csv", "checkpoint.carom"):
            self.assertEqual(self.read("parts", name), self.read("out", name), name)
        self.write("observed.toml", (self.folder / "observed.toml").read_text().replace("bins = 10", "bins = 11"))
        message = self.refused("run", "observed.toml", "--out", "out", "--time", 8, "--resume", "out/checkpoint.carom")
        self.assertIn("this checkpoint is of another run: its run wrote other outputs", message)
        self.carom("run", "gas.toml", "--out", "out")
        self.assertNotIn("observations.csv", self.files("out"))

    def test_a_floor_weighs_what_lies_on_it(self):
        heap = RAIN.replace("max = [9, 9, 9]", "max = [3, 3, 9]").replace("radius = 0.2", "radius = 0.4")
        self.write("heap.toml", heap + '[[observe]]\nkind = "impacts"\nfrom = 5\n')
        self.carom("run", "heap.toml", "--out", "out", "--time", 8)
        self.carom("run", "heap.toml", "--out", "parts", "--time", 6)
        self.carom("run", "heap.toml", "--out", "parts", "--time", 8, "--resume", "parts/checkpoint.carom")
        self.assertEqual(self.read("parts", "observations.csv"), self.read("out", "observations.csv"))
        forces = [float(row["value"]) for row in self.table("out", "observations.csv")
                  if row["quantity"] == "face_force"]
        self.assertAlmostEqual(forces[4], 40 * 2 * 9.81, delta=1e-3 * 40 * 2 * 9.81)

    def test_summary_for_people(self):
        out, err = self.carom("run", "gas.toml", "--out", "out")
        self.assertEqual(err, "")
        for part in ("Small gas: 1 s simulated\n", "60, double precision, ", "energy", "impacts", "overlap",
                     json.loads(self.read("out", "summary.json"))["hash"], "results   out\n"):
            self.assertIn(part, out)

    def test_timeline(self):
        summary = self.json("run", "rain.toml", "--out", "out")
        names, rows = self.timeline("out")
        self.assertEqual(names, COLUMNS)
        self.assertEqual([row["step"] for row in rows], list(range(201)))
        for row in rows:
            self.assertAlmostEqual(row["time"], row["step"] * 0.01, delta=1e-12)
            self.assertEqual(row["total"], row["kinetic"] + row["potential"])
        self.assertEqual(rows[0]["total"], summary["energy_initial"])
        self.assertEqual(rows[-1]["total"], summary["energy_final"])
        self.assertEqual(rows[-1]["lost"], summary["energy_lost"])
        self.assertEqual(rows[-1]["face_impacts"], summary["face_impacts"])
        self.assertEqual(rows[-1]["contacts"], summary["contacts"])

    def test_timeline_at_intervals(self):
        self.write("some.toml", RAIN + "[output]\ntimeline_every = 0.25\n")
        self.carom("run", "some.toml", "--out", "out", "--time", "1.1")
        _, rows = self.timeline("out")
        self.assertEqual([row["step"] for row in rows], [0, 25, 50, 75, 100, 110])

    def test_energy_plot(self):
        self.carom("run", "rain.toml", "--out", "out")
        document = xml.dom.minidom.parseString(self.read("out", "energy.svg"))
        text = " ".join(node.data for element in document.getElementsByTagName("text") for node in element.childNodes)
        for word in ("Small rain", "kinetic", "potential", "total", "energy, ", "time, s", "impacts per"):
            self.assertIn(word, text)
        self.write("plain.toml", RAIN + "[output]\nenergy_plot = false\n")
        self.carom("run", "plain.toml", "--out", "plain")
        self.assertNotIn("energy.svg", self.files("plain"))
        self.carom("run", "plain.toml", "--out", "out")
        self.assertNotIn("energy.svg", self.files("out"), "the picture of an earlier run was left there")

    def test_impacts_where_the_scene_asks_for_them(self):
        self.write("log.toml", GAS + "[output]\nrecord_impacts = true\n")
        summary = self.json("run", "log.toml", "--out", "out")
        with open(self.folder / "out/impacts.csv", newline="", encoding="ascii") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), summary["impacts"])
        self.assertEqual(sum(1 for row in rows if row["face"]), summary["face_impacts"])
        self.assertEqual([float(row["time"]) for row in rows], sorted(float(row["time"]) for row in rows))
        for row in rows:
            self.assertEqual(bool(row["b"]), not row["face"])
            self.assertGreater(float(row["approach_speed"]), 0)

    def test_bodies_where_the_scene_asks_for_them(self):
        self.write("tables.toml", RAIN + "[output]\nbodies_every = 0.25\n")
        self.carom("run", "tables.toml", "--out", "out", "--time", 1.1)
        self.assertEqual(self.files("out", "bodies"), [f"{number:06}.csv" for number in range(5)])
        for number in range(5):
            rows = self.table("out", "bodies", f"{number:06}.csv")
            self.assertEqual(list(rows[0]), ["time", "id", "x", "y", "z", "vx", "vy", "vz", "mass", "radius",
                                             "restitution", "friction", "growth"])
            self.assertEqual([int(row["id"]) for row in rows], list(range(40)))
            for row in rows:
                self.assertAlmostEqual(float(row["time"]), 0.25 * number, delta=1e-12)
                self.assertEqual((row["mass"], row["radius"], row["restitution"]), ("2", "0.2", "0.5"))
        # The same numbers as the run had: the kinetic energy of the timeline.
        _, timeline = self.timeline("out")
        kinetic = sum(float(row["mass"]) * sum(float(row[v]) ** 2 for v in ("vx", "vy", "vz")) / 2 for row in rows)
        self.assertAlmostEqual(kinetic, timeline[100]["kinetic"], delta=1e-12 * kinetic)

        self.carom("run", "tables.toml", "--out", "out", "--time", 0.3)
        self.assertEqual(self.files("out", "bodies"), ["000000.csv", "000001.csv"], "those of a longer run were left")
        self.carom("run", "rain.toml", "--out", "out", "--time", 0.1)
        self.assertNotIn("bodies", self.files("out"))

    def test_a_table_of_bodies_is_a_start(self):
        self.write("tables.toml", RAIN + "[output]\nbodies_every = 0.25\n")
        self.carom("run", "tables.toml", "--out", "out", "--time", 0.25)
        generator = RAIN.partition("generator")[2]
        self.write("again.toml", RAIN.replace("generator" + generator, 'generator = "csv"\n'
                                              'file = "out/bodies/000001.csv"\n[output]\nbodies_every = 0.25\n'))
        self.carom("run", "again.toml", "--out", "again", "--time", 0.25)
        then, now = self.table("out", "bodies", "000001.csv"), self.table("again", "bodies", "000000.csv")
        for row in [*then, *now]:
            del row["time"]
        self.assertEqual(then, now)

    def test_tables_of_bodies_of_a_resumed_run(self):
        self.write("tables.toml", RAIN + "[output]\nbodies_every = 0.05\n")
        self.carom("run", "tables.toml", "--out", "whole", "--time", 1)
        self.carom("run", "tables.toml", "--out", "parts", "--steps", 33)
        resume = ("--resume", "parts/checkpoint.carom")
        message = self.refused("run", "tables.toml", "--out", "elsewhere", "--time", 1, *resume)
        self.assertIn("elsewhere/bodies/000000.csv, which is missing", message)
        self.carom("run", "tables.toml", "--out", "parts", "--time", 1, *resume)
        self.assertEqual(self.files("whole", "bodies"), [f"{number:06}.csv" for number in range(21)])
        self.assertEqual(self.files("parts", "bodies"), self.files("whole", "bodies"))
        for name in self.files("whole", "bodies"):
            self.assertEqual(self.read("parts", "bodies", name), self.read("whole", "bodies", name), name)
        self.write("tables.toml", RAIN + "[output]\nbodies_every = 0.1\n")
        self.assertIn("its run wrote other outputs",
                      self.refused("run", "tables.toml", "--out", "parts", "--time", 2, *resume))

    def test_overlap_search_can_be_left_out(self):
        self.write("quick.toml", GAS + "[output]\ncheck_overlap = false\n")
        summary = self.json("run", "quick.toml")
        self.assertIsNone(summary["max_overlap"])
        self.assertIsNone(summary["mean_overlap"])
        self.assertIsNone(summary["bodies_outside"])

    def test_options_stand_over_the_scene(self):
        self.assertEqual(self.json("run", "gas.toml", "--steps", 7)["steps"], 7)
        self.assertEqual(self.json("run", "gas.toml", "--time", 0.5)["steps"], 30)
        self.assertEqual(self.json("run", "gas.toml", "--dt", 0.1)["steps"], 10)
        self.assertEqual(self.json("run", "gas.toml", "--precision", "single")["precision"], "single")
        long = self.json("run", "gas.toml", "--dt", 0.3)
        self.assertEqual(long["steps"], 4)
        self.assertAlmostEqual(long["time"], 1, delta=1e-12)
        self.assertAlmostEqual(self.json("run", "gas.toml", "--dt", 5)["time"], 1, delta=1e-12)

    def test_same_bits_each_time(self):
        first = self.json("run", "gas.toml", "--out", "a")
        second = self.json("run", "gas.toml", "--out", "b")
        self.assertEqual(first["hash"], second["hash"])
        for name in ("timeline.csv", "energy.svg", "checkpoint.carom"):
            self.assertEqual(self.read("a", name), self.read("b", name), name)
        self.assertNotEqual(first["hash"], self.json("run", "gas.toml", "--steps", 59)["hash"])

    def test_work_cap(self):
        # Elastic bodies on each other never come to rest: impacts beyond number.
        self.write("heap.toml", "[world]\ngravity = [0, 0, -9.81]\nwork_cap = 20\n[region]\nkind = \"box\"\n"
                                "min = [0, 0, 0]\nmax = [2, 2, 20]\n[[bodies]]\nrestitution = 1\nradius = 0.5\n"
                                "position = [[1, 1, 0.5], [1, 1, 1.5], [1, 1, 2.5], [1, 1, 3.5]]\n")
        out, err = self.carom("run", "heap.toml", "--out", "out", "--steps", 200, "--dt", 0.02, "--json")
        summary = json.loads(out)
        self.assertEqual(summary["steps"], 200)
        self.assertTrue(summary["complete"])
        self.assertLess(summary["time"], 4)
        self.assertRegex(err, r"^carom: \d+ steps ended early at the work cap of 20: the world is at [\d.]+ s, "
                              r"[\d.]+ s behind\n$")
        self.carom("run", "heap.toml", "--out", "parts", "--steps", 150, "--dt", 0.02)
        self.carom("run", "heap.toml", "--out", "parts", "--steps", 200, "--dt", 0.02, "--resume",
                   "parts/checkpoint.carom")
        self.carom("diff", "out", "parts")

    def test_step_that_fails_keeps_what_was_computed(self):
        self.write("edge.toml", "[run]\ntime = 1e9\ndt = 1e5\n[[bodies]]\nposition = [0, 0, 0]\n"
                                "velocity = [10, 0, 0]\n")
        out, err = self.carom("run", "edge.toml", "--out", "out", "--json", expect=1)
        summary = json.loads(out)
        self.assertFalse(summary["complete"])
        self.assertIn("failed", err)
        self.assertIn("resolution", err)
        self.assertGreater(summary["steps"], 0)
        self.assertEqual(json.loads(self.read("out", "summary.json")), summary)

    def test_folders_that_cannot_be_written(self):
        self.write("file", "")
        for folder in ("file", "file/below", "/proc/carom", "/dev/null"):
            out, err = self.carom("run", "gas.toml", "--out", folder, expect=1)
            self.assertEqual(out, "")
            self.assertIn(folder, err)

    def test_full_disk_leaves_no_half_file(self):
        self.carom("run", "gas.toml", "--out", "out", "--steps", 1)
        before = {name: self.read("out", name) for name in self.files("out")}

        def limit_file_size():
            resource.setrlimit(resource.RLIMIT_FSIZE, (3000, 3000))

        out, err = self.carom("run", "gas.toml", "--out", "out", "--steps", 50, expect=1,
                              preexec_fn=limit_file_size)
        self.assertEqual(out, "")
        self.assertRegex(err, "checkpoint.carom: cannot be written: File too large")
        self.assertEqual({name: self.read("out", name) for name in self.files("out")}, before)

    def test_two_runs_do_not_share_a_folder(self):
        self.write("long.toml", GAS.replace("time = 1", "time = 1e6"))
        first = self.start("run", "long.toml", "--out", "out", "--checkpoint-every", 0.1)
        try:
            while not (self.folder / "out/checkpoint.carom").exists():
                self.assertIsNone(first.poll())
                time.sleep(0.005)
            _, err = self.carom("run", "gas.toml", "--out", "out", expect=1)
            self.assertIn("another run", err)
        finally:
            first.kill()
            first.communicate()
        self.carom("run", "gas.toml", "--out", "out")

    def test_progress_elsewhere(self):
        self.write("long.toml", GAS.replace("time = 1", "time = 1e6"))
        process = self.start("run", "long.toml")
        line = process.stderr.readline()  # the first one comes after ten seconds
        process.kill()
        process.communicate()
        self.assertRegex(line, r"^ *\d+ %  step \d+ of 60000000  t = .* s  .* steps/s  .* impacts  (\d+:)+\d\d left\n$")

    def test_progress_on_a_terminal(self):
        controller, terminal = pty.openpty()
        self.write("long.toml", GAS.replace("time = 1", "time = 1e6"))
        process = self.start("run", "long.toml", stderr=terminal, env={**os.environ, "TERM": "xterm"})
        os.close(terminal)
        text = b""
        while text.count(b"\r") < 4:
            text += os.read(controller, 1000)
        process.kill()
        process.communicate()
        os.close(controller)
        self.assertRegex(text.decode(),
                         r"\r\[[#.]+\] +\d+ %  t = .* s  .* steps/s  .* impacts  (\d+:)?\d+:\d\d left\x1b\[K")


if __name__ == "__main__":
    unittest.main()
