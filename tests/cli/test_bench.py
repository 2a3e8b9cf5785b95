"""What `carom bench` and `carom info` print."""

import os
import unittest

from carom_cli import CliTest

CONTRACT = {"bodies", "steps", "dt", "threads", "precision", "simd", "wall_seconds", "ns_per_body_step",
            "ns_per_body_step_min", "impacts", "impacts_per_second", "contacts", "energy_initial", "energy_final",
            "energy_drift", "kinetic_initial", "kinetic_final", "momentum_drift", "max_overlap", "mean_overlap",
            "bodies_outside", "peak_rss_bytes", "bytes_per_body", "hash"}
WORKLOADS = ("gas", "dense_gas", "cooling", "polydisperse", "bullets", "open_space", "pile")


class Bench(CliTest):
    def bench(self, workload, bodies, *options):
        return self.json("bench", workload, "--bodies", bodies, *options)

    def test_every_workload(self):
        for workload in WORKLOADS:
            with self.subTest(workload):
                result = self.bench(workload, 500, "--warmup", 10, "--steps", 20, "--repeat", 2)
                self.assertLessEqual(CONTRACT, set(result))
                self.assertEqual((result["workload"], result["bodies"], result["steps"]), (workload, 500, 20))
                self.assertEqual((result["warmup"], result["repeat"]), (10, 2))
                self.assertEqual(result["threads"], os.cpu_count())
                self.assertIn(result["simd"], self.json("info")["simd_targets"])
                self.assertLess(abs(result["energy_drift"]), 1e-10)
                self.assertLess(result["momentum_drift"], 1e-10)
                # Contacts in a pile give way to their loads.
                self.assertLess(result["max_overlap"], 0.01 if workload == "pile" else 1e-8)
                self.assertEqual(result["bodies_outside"], 0)
                self.assertGreater(result["peak_rss_bytes"], 1 << 20)
                self.assertGreater(result["bytes_per_body"], 0)
                self.assertLessEqual(result["ns_per_body_step_min"], result["ns_per_body_step"])
                self.assertAlmostEqual(result["ns_per_body_step"], result["wall_seconds"] * 1e9 / 20 / 500, delta=1e-6)
                self.assertAlmostEqual(result["impacts_per_second"], result["impacts"] / result["wall_seconds"],
                                       delta=1e-6 * result["impacts_per_second"])

    def test_defaults_are_those_of_the_workload(self):
        result = self.bench("gas", 50)
        self.assertEqual((result["dt"], result["warmup"], result["steps"], result["repeat"]), (1 / 60, 120, 120, 3))
        self.assertEqual(result["precision"], "double")
        self.assertEqual(self.bench("dense_gas", 50)["dt"], 1 / 240)
        pile = self.bench("pile", 20, "--repeat", 1)
        self.assertEqual((pile["dt"], pile["warmup"], pile["steps"]), (1 / 60, 600, 60))
        self.assertGreaterEqual(pile["contacts"], 20)

    def test_options(self):
        result = self.bench("gas", 50, "--dt", 0.01, "--steps", 3, "--warmup", 0, "--repeat", 1, "--precision",
                            "single", "--threads", 1)
        self.assertEqual((result["dt"], result["steps"], result["warmup"], result["repeat"], result["precision"]),
                         (0.01, 3, 0, 1, "single"))

    def test_impacts_are_those_of_the_timed_steps(self):
        whole = self.bench("gas", 300, "--warmup", 0, "--steps", 40, "--repeat", 1)
        early = self.bench("gas", 300, "--warmup", 0, "--steps", 10, "--repeat", 1)
        late = self.bench("gas", 300, "--warmup", 10, "--steps", 30, "--repeat", 1)
        self.assertEqual(early["impacts"] + late["impacts"], whole["impacts"])
        self.assertEqual(late["hash"], whole["hash"])
        self.assertEqual(late["energy_initial"], whole["energy_initial"])

    def test_same_bits_each_time(self):
        first = self.bench("polydisperse", 300, "--steps", 20, "--repeat", 1)
        second = self.bench("polydisperse", 300, "--steps", 20, "--repeat", 2)
        self.assertEqual(first["hash"], second["hash"])
        self.assertNotEqual(first["hash"], self.bench("gas", 300, "--steps", 20, "--repeat", 1)["hash"])

    def test_without_search_for_overlaps(self):
        result = self.bench("gas", 50, "--steps", 3, "--repeat", 1, "--skip-overlap")
        self.assertEqual([result[key] for key in ("max_overlap", "mean_overlap", "bodies_outside")], [None] * 3)

    def test_text_for_people(self):
        out, err = self.carom("bench", "gas", "--bodies", 100, "--steps", 5, "--warmup", 1)
        self.assertEqual(err, "")
        for part in ("gas: 1 steps to warm up, 5 timed, 3 repeats", "ns per body and step", "bytes per body", "hash"):
            self.assertIn(part, out)

    def test_help_lists_the_workloads(self):
        out, _ = self.carom("bench", "--help")
        for workload in WORKLOADS:
            self.assertIn(workload, out)


class Info(CliTest):
    def test_json(self):
        facts = self.json("info")
        self.assertEqual(set(facts), {"version", "compiler", "build", "precision", "resolution", "simd", "simd_targets",
                                      "threads", "cores"})
        self.assertEqual(facts["resolution"], {"single": 2.0**-20, "double": 2.0**-40})
        self.assertEqual((facts["precision"], facts["simd"]), ("double", facts["simd_targets"][0]))
        self.assertEqual(facts["simd_targets"][-1], "scalar")
        self.assertEqual(facts["threads"], os.cpu_count())
        self.assertGreaterEqual(facts["cores"], 1)

    def test_text(self):
        out, _ = self.carom("info")
        for fact in ("carom", "compiler", "build", "precision", "resolution", "simd", "threads"):
            self.assertIn(fact, out)


if __name__ == "__main__":
    unittest.main()
