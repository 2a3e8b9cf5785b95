"""Checkpoints: interrupted runs go on to the same bits, and no finished checkpoint is ever lost."""

import json
import os
import random
import re
import resource
import signal
import time
import unittest

from carom_cli import GAS, RAIN, CliTest, dense_gas, figure

# Long enough that no test waits for its end.
ENDLESS = GAS.replace("time = 1", "time = 1e6") + "[output]\nrecord_impacts = true\ntimeline_every = 0.1\n"


class Checkpoint(CliTest):
    def setUp(self):
        super().setUp()
        self.write("gas.toml", GAS)
        self.write("rain.toml", RAIN + "[output]\nrecord_impacts = true\ntimeline_every = 0.07\n")
        self.write("endless.toml", ENDLESS)

    def wait_for_checkpoint(self, process, folder):
        deadline = time.monotonic() + 60
        while not (self.folder / folder / "checkpoint.carom").exists():
            self.assertIsNone(process.poll(), process.communicate() if process.poll() is not None else "")
            self.assertLess(time.monotonic(), deadline)
            time.sleep(0.005)

    def assert_same_results(self, a, b):
        self.assertEqual(json.loads(self.read(a, "summary.json"))["hash"],
                         json.loads(self.read(b, "summary.json"))["hash"])
        for name in ("timeline.csv", "impacts.csv", "checkpoint.carom"):
            if name in self.files(a):
                self.assertEqual(self.read(a, name), self.read(b, name), name)
        self.carom("diff", a, b)

    def test_resumed_run_is_the_uninterrupted_run(self):
        for scene, steps in (("gas.toml", (20, 60)), ("rain.toml", (1, 200)), ("rain.toml", (150, 200))):
            with self.subTest(scene=scene, steps=steps):
                self.carom("run", scene, "--out", "whole")
                self.carom("run", scene, "--out", "first", "--steps", steps[0])
                summary = self.json("run", scene, "--out", "second", "--resume", "first/checkpoint.carom")
                self.assertEqual((summary["resumed_from_step"], summary["steps"]), steps)
                self.assert_same_results("whole", "second")
                whole = json.loads(self.read("whole", "summary.json"))
                for key in ("impacts", "energy_drift", "max_overlap", "contacts", "energy_initial", "time"):
                    self.assertEqual(summary[key], whole[key], key)

    def test_resuming_in_place_and_in_single_precision(self):
        single = ("--precision", "single")
        self.carom("run", "rain.toml", "--out", "whole", *single)
        self.carom("run", "rain.toml", "--out", "parts", "--steps", 77, *single)
        self.carom("run", "rain.toml", "--out", "parts", "--resume", "parts/checkpoint.carom", *single)
        self.assert_same_results("whole", "parts")

    def test_resuming_a_finished_run_does_nothing(self):
        self.carom("run", "gas.toml", "--out", "out")
        before = {name: self.read("out", name) for name in ("timeline.csv", "checkpoint.carom", "energy.svg")}
        summary = self.json("run", "gas.toml", "--out", "out", "--resume", "out/checkpoint.carom")
        self.assertEqual(summary["resumed_from_step"], 60)
        self.assertEqual(summary["ns_per_body_step"], 0)
        for name, content in before.items():
            self.assertEqual(self.read("out", name), content)

    def test_periodic_checkpoints(self):
        process = self.start("run", "endless.toml", "--out", "out", "--checkpoint-every", "0.05")
        self.wait_for_checkpoint(process, "out")
        process.kill()
        process.communicate()
        summary = self.json("run", "endless.toml", "--out", "out", "--steps", 3000, "--resume", "out/checkpoint.carom")
        self.assertGreater(summary["resumed_from_step"], 0)
        self.assertEqual(summary["resumed_from_step"] % 3, 0)

    def interrupt(self, number, expected_code):
        out = f"out{number}"
        process = self.start("run", "endless.toml", "--out", out, "--checkpoint-every", "0.05", "--json")
        self.wait_for_checkpoint(process, out)
        process.send_signal(number)
        stdout, stderr = process.communicate(timeout=60)
        self.assertEqual(process.returncode, expected_code, stderr)
        summary = json.loads(stdout)
        self.assertFalse(summary["complete"])
        self.assertIn("interrupted", stderr)
        self.assertIn(f"--resume {out}/checkpoint.carom", stderr)
        self.assertEqual(self.files(out),
                         ["checkpoint.carom", "energy.svg", "impacts.csv", "summary.json", "timeline.csv"])
        steps = summary["steps"] + 50
        self.carom("run", "endless.toml", "--out", out, "--steps", steps, "--resume", f"{out}/checkpoint.carom")
        self.carom("run", "endless.toml", "--out", "whole", "--steps", steps)
        self.assert_same_results("whole", out)

    def test_ctrl_c(self):
        self.interrupt(signal.SIGINT, 130)

    def test_termination(self):
        self.interrupt(signal.SIGTERM, 143)

    def test_ctrl_c_in_a_long_step_waits_for_its_end(self):
        self.write("slow.toml", dense_gas(100))
        process = self.start("run", "slow.toml", "--out", "out", "--json")
        self.wait_until_it_notes_interrupts(process)
        time.sleep(0.3)
        self.assertEqual([name for name in self.files("out") if not name.startswith(".")], [])
        process.send_signal(signal.SIGINT)
        stdout, stderr = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 130, stderr)
        self.assertEqual(json.loads(stdout)["steps"], 1)
        self.assertEqual(self.files("out"), ["checkpoint.carom", "energy.svg", "summary.json", "timeline.csv"])

    def test_a_second_ctrl_c_ends_it_at_once(self):
        self.write("slow.toml", dense_gas(1e4))  # a step of minutes
        for number in (signal.SIGINT, signal.SIGTERM):
            process = self.start("run", "slow.toml", "--out", "out")
            self.wait_until_it_notes_interrupts(process)
            process.send_signal(signal.SIGINT)
            time.sleep(1)
            self.assertIsNone(process.poll())
            process.send_signal(number)
            process.communicate(timeout=60)
            self.assertEqual(process.returncode, -number)
            self.assertEqual([name for name in self.files("out") if not name.startswith(".")], [])

    def time_of(self, checkpoint):
        """The world's time in a checkpoint; fails where it is not sound."""
        out, _ = self.carom("diff", checkpoint, checkpoint)
        return float(re.search(r"state: the same, 60 bodies at (\S+) s", out)[1])

    def test_kill_at_random_moments_never_costs_a_checkpoint(self):
        arguments = ("run", "endless.toml", "--out", "out", "--checkpoint-every", "0.01")
        began = time.monotonic()
        process = self.start(*arguments)
        self.wait_for_checkpoint(process, "out")
        process.kill()
        process.communicate()
        # From before the program has begun to well after it has gone on.
        latest = 2 * (time.monotonic() - began) + 0.02
        moments = random.Random(20101127)
        resume = ("--resume", "out/checkpoint.carom")
        reached, gone_on, while_writing = 0, 0, 0
        for _ in range(50):
            process = self.start(*arguments, *resume)
            time.sleep(moments.uniform(0, latest))
            process.kill()
            process.communicate()
            now = self.time_of("out/checkpoint.carom")  # it is there, and sound
            self.assertGreaterEqual(now, reached, "a finished checkpoint was lost")
            gone_on += now > reached
            while_writing += any(name.endswith(".part") for name in self.files("out"))
            reached = now
        figure(f"50 kills: {gone_on} runs had gone on, {while_writing} were writing; no checkpoint damaged or lost")
        self.assertGreater(gone_on, 10)
        summary = self.json("run", "endless.toml", "--out", "out", "--steps", 20000, *resume)
        self.assertGreater(summary["resumed_from_step"], 50)
        self.carom("run", "endless.toml", "--out", "whole", "--steps", 20000)
        self.assert_same_results("whole", "out")

    def test_damaged_and_foreign_checkpoints_are_refused(self):
        self.carom("run", "gas.toml", "--out", "out", "--steps", 5)
        good = self.read("out", "checkpoint.carom")
        for name, content, reason in (("cut", good[:-1], "cut off"), ("head", good[:20], "cut off"),
                                      ("empty", b"", "no checkpoint"), ("scene", GAS.encode(), "no checkpoint"),
                                      ("long", good + b"x", "too long"),
                                      ("flip", good[:500] + bytes([good[500] ^ 1]) + good[501:], "damaged")):
            (self.folder / name).write_bytes(content)
            message = self.refused("run", "gas.toml", "--out", "other", "--resume", name)
            self.assertIn(f"--resume {name}", message)
            self.assertIn(reason, message)
        self.assertIn("missing", self.refused("run", "gas.toml", "--resume", "missing"))

    def test_checkpoints_of_other_runs_are_refused(self):
        self.carom("run", "gas.toml", "--out", "out", "--steps", 5)
        resume = ("--resume", "out/checkpoint.carom")
        self.assertIn("of scene gas, not rain", self.refused("run", "rain.toml", *resume))
        self.assertIn("dt", self.refused("run", "gas.toml", "--dt", 0.01, *resume))
        self.assertIn("precision", self.refused("run", "gas.toml", "--precision", "single", *resume))
        self.assertIn("5 steps already", self.refused("run", "gas.toml", "--steps", 4, *resume))
        for change in (("count = 60", "count = 59"), ("seed = 5", "seed = 6"), ("max = [6,", "max = [7,")):
            self.write("gas.toml", GAS.replace(*change))
            self.assertIn("another run", self.refused("run", "gas.toml", *resume))
        self.write("gas.toml", "# a remark changes nothing\n" + GAS)
        self.carom("run", "gas.toml", *resume)

    def test_a_shortened_last_step_is_no_place_to_go_on_from(self):
        self.carom("run", "gas.toml", "--out", "out", "--time", 0.155)
        message = self.refused("run", "gas.toml", "--resume", "out/checkpoint.carom")
        self.assertIn("shortened", message)
        self.carom("run", "gas.toml", "--time", 0.155, "--resume", "out/checkpoint.carom")

    def test_checkpoint_that_cannot_be_written_ends_the_run(self):
        def limit_file_size():
            resource.setrlimit(resource.RLIMIT_FSIZE, (3000, 3000))

        _, err = self.carom("run", "endless.toml", "--out", "out", "--checkpoint-every", 0.1, expect=1,
                            preexec_fn=limit_file_size)
        self.assertIn("checkpoint.carom", err)
        self.assertEqual(os.listdir(self.folder / "out"), [])


if __name__ == "__main__":
    unittest.main()
