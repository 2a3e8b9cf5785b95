"""The table, the CSV file and the plot that bench/run makes of what `carom bench` and its peers measure."""

import csv
import importlib.util
import json
import subprocess
import unittest
import xml.etree.ElementTree

from carom_cli import PROGRAM, ROOT, CliTest

BANDWIDTH = {"copy_gb_per_s_1_thread": 12.5, "copy_gb_per_s_2_threads": 20}
PEER = {"engine": "Bullet", "workload": "gas", "bodies": 50, "precision": "single", "threads": 1, "steps": 120,
        "ns_per_body_step": 1e6, "ns_per_body_step_min": 9e5, "energy_drift": 0.5, "max_overlap": 0.25}


class Table(CliTest):
    def setUp(self):
        super().setUp()
        (self.folder / "bin").mkdir()
        (self.folder / "bin/carom").symlink_to(PROGRAM)
        self.program("bench_copy_bandwidth", BANDWIDTH)

    def program(self, name, prints):
        """A program that prints what it is told to, and keeps its arguments."""
        path = self.folder / "bin" / name
        path.write_text(f"#!/bin/sh\necho \"$@\" >> '{path}.calls'\necho '{json.dumps(prints)}'\n")
        path.chmod(0o755)

    def stand_ins(self):
        """Programs in the place of a peer and of carom."""
        self.program("peer_bullet", PEER)
        (self.folder / "bin/carom").unlink()
        self.program("carom", {**PEER, "engine": "carom", "hash": "0", "impacts": 1, "version": "", "compiler": ""})

    def table(self, *options):
        """Runs bench/run; returns its output and the rows of its one CSV file."""
        arguments = ["--programs", self.folder / "bin", "--results", self.folder / "results", *options]
        done = subprocess.run([ROOT / "bench/run", *arguments], capture_output=True, text=True, check=True)
        [file] = (self.folder / "results").glob("*.csv")
        with open(file, newline="", encoding="utf-8") as text:
            return done.stdout, list(csv.DictReader(text))

    def test_carom_beside_a_peer(self):
        self.program("peer_bullet", PEER)
        out, rows = self.table("--workloads", "gas,cooling", "--bodies", "50", "--quick")
        single = [row for row in rows if row["threads"] == "1"]
        self.assertEqual([(row["engine"], row["workload"], row["precision"]) for row in single],
                         [("carom", "gas", "single"), ("carom", "gas", "double"), ("Bullet", "gas", "single"),
                          ("carom", "cooling", "single"), ("carom", "cooling", "double")])
        for row in single:
            self.assertEqual((row["bodies"], row["copy_gb_per_s_1_thread"]), ("50", "12.5"))
            self.assertLessEqual(float(row["ns_per_body_step_min"]), float(row["ns_per_body_step"]))
        for row in single[:2]:
            self.assertAlmostEqual(float(row["times_bullet"]) * float(row["ns_per_body_step"]), 1e6, delta=1)
            self.assertIn(f"{float(row['times_bullet']):.1f}x Bullet", out)
        self.assertEqual(single[3]["times_bullet"], "")
        self.assertIn("ode is left out", out)

    @unittest.skipUnless(importlib.util.find_spec("matplotlib"), "python3-matplotlib is not installed")
    def test_plot(self):
        self.program("peer_bullet", PEER)
        self.table("--workloads", "gas,open_space", "--bodies", "50,100", "--quick")
        [file] = (self.folder / "results").glob("*.svg")
        words = [element.text for element in xml.etree.ElementTree.parse(file).iter("{http://www.w3.org/2000/svg}text")]
        for name in ("Bullet, single", "carom, double", "open_space",
                     "copying 100 bytes with one thread, 12.5 GB/s"):
            self.assertIn(name, words)

    def test_both_sides_do_the_same(self):
        self.stand_ins()
        self.table("--workloads", "gas", "--bodies", "50")
        peer = (self.folder / "bin/peer_bullet.calls").read_text().splitlines()
        carom = [call for call in (self.folder / "bin/carom.calls").read_text().splitlines() if "single" in call]
        self.assertEqual(len(peer), 3)
        self.assertEqual([call.partition("--warmup")[2] for call in carom],
                         [call.partition("--warmup")[2] for call in peer])
        self.assertEqual([call.endswith("--skip-overlap") for call in peer], [False, True, True])

    def test_sizes_of_the_quick_table(self):
        self.stand_ins()
        self.table("--quick")
        calls = (self.folder / "bin/carom.calls").read_text()
        self.assertIn("bench gas --json --bodies 100000 ", calls)
        self.assertIn("bench cooling --json --bodies 10000 ", calls)
        self.assertNotIn("bench cooling --json --bodies 100000 ", calls)
        self.assertNotIn("--bodies 1000000 ", calls)
        peer = (self.folder / "bin/peer_bullet.calls").read_text()
        self.assertNotIn("--bodies 100000 ", peer)
        self.assertEqual({call.partition(" --")[0] for call in peer.splitlines()}, {"gas", "pile"})

    def test_failures_end_it(self):
        arguments = ["--programs", self.folder / "bin", "--results", self.folder / "results", "--workloads", "none",
                     "--bodies", "50"]
        done = subprocess.run([ROOT / "bench/run", *arguments], capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn("none", done.stderr)
        self.assertFalse((self.folder / "results").exists())


if __name__ == "__main__":
    unittest.main()
