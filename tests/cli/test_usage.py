"""Bad usage is refused with exit code 2 and a message that says what is allowed; nothing is written."""

import os
import unittest

from carom_cli import GAS, CliTest


class Usage(CliTest):
    def setUp(self):
        super().setUp()
        self.write("gas.toml", GAS)

    def refused_run(self, *options):
        message = self.refused("run", "gas.toml", "--out", "out", *options)
        self.assertEqual(self.files(), ["gas.toml"], "something was written")
        return message

    def test_help_names_commands_and_exit_codes(self):
        out, _ = self.carom("--help")
        for word in ("run", "bench", "validate", "view", "render", "info", "diff", "Exit codes", "130", "143"):
            self.assertIn(word, out)
        for command in ("run", "bench", "validate", "view", "render", "info", "diff"):
            self.assertIn("usage", self.carom(command, "--help")[0].lower())

    def test_version(self):
        self.assertRegex(self.carom("--version")[0], r"^carom \d+\.\d+\.\d+\n$")

    def test_commands(self):
        for arguments in ([], ["fly"], ["run"], ["bench"], ["render"], ["view"], ["render", "x.toml"], ["bench", "gas"], ["diff", "a"], ["info", "x"]):
            self.assertIn("--help", self.refused(*arguments), arguments)
        for arguments in ([], ["fly"]):
            self.assertIn("a command is required: run, bench, validate, view, render, info or diff", self.refused(*arguments))
        self.assertIn("or diff, not 'rn'; did you mean 'run'?", self.refused("rn", "gas.toml"))
        self.assertIn("or diff, not 'fly'\n", self.refused("fly"))

    def test_unknown_options(self):
        self.assertIn("--bodies", self.refused_run("--bodies", 3))
        self.assertIn("--fast", self.refused_run("--fast"))

    def test_numbers_of_run(self):
        for option in ("--time", "--dt", "--checkpoint-every"):
            for value in ("0", "-1", "nan", "inf", "1e999", "", "ten", "1s", "0x10", "1/0", "0/1", "1/", "/60", "1/60/2", "-1/60"):
                message = self.refused_run(option, value)
                self.assertIn(option, message)
                self.assertIn("greater than 0", message)
                self.assertIn(f"'{value}'", message)
        for value in ("0", "-1", "1.5", "nan", "", "1e3", "99999999999999999999"):
            message = self.refused_run("--steps", value)
            self.assertIn("--steps must be a whole number from 1 to", message)
        for value in ("-1", "5000", "two"):
            self.assertIn("--threads must be a whole number from 0 to 4096", self.refused_run("--threads", value))
        for value in ("half", "Single", ""):
            self.assertIn("single or double", self.refused_run("--precision", value))

    def test_quotients(self):
        self.assertEqual(self.json("run", "gas.toml", "--dt", "1/50", "--time", "1/2")["steps"], 25)
        self.assertEqual(self.json("run", "gas.toml", "--dt", "1/60", "--steps", 1)["dt"], 1 / 60)

    def test_too_many_steps(self):
        self.assertIn("2^53", self.refused_run("--time", "1e300"))
        self.assertIn("dt", self.refused_run("--dt", "1e-300"))

    def test_time_and_steps_exclude_each_other(self):
        message = self.refused_run("--time", 1, "--steps", 1)
        self.assertIn("--time", message)
        self.assertIn("--steps", message)

    def test_options_without_values(self):
        for option in ("--out", "--dt", "--resume", "--steps"):
            self.assertIn(option, self.refused_run(option))

    def test_scene_files(self):
        self.assertIn("missing.toml", self.refused("run", "missing.toml"))
        self.assertIn(".: is no", self.refused("run", "."))
        self.write("bad.toml", GAS + "\nvelocty = 3\n")
        message = self.refused("run", "bad.toml")
        self.assertIn("bad.toml:20", message)
        self.assertIn("velocty", message)
        self.write("broken.toml", "title = ")
        self.assertIn("broken.toml:1", self.refused("run", "broken.toml"))

    def test_numbers_of_bench(self):
        for value in ("0", "-3", "1.5", "many"):
            message = self.refused("bench", "gas", "--bodies", value)
            self.assertIn("--bodies must be a whole number from 1 to", message)
        for option in ("--steps", "--repeat"):
            self.assertIn(option, self.refused("bench", "gas", "--bodies", 10, option, 0))
        self.assertIn("--dt", self.refused("bench", "gas", "--bodies", 10, "--dt", "nan"))
        self.assertIn("--warmup", self.refused("bench", "gas", "--bodies", 10, "--warmup", -1))

    def test_unknown_workload_names_the_known_ones(self):
        message = self.refused("bench", "soup", "--bodies", 10)
        for name in ("soup", "gas", "dense_gas", "cooling", "polydisperse", "bullets", "open_space", "pile"):
            self.assertIn(name, message)

    def test_threads_are_honest(self):
        hashes = set()
        for threads in (0, 1, 4):
            summary = self.json("run", "gas.toml", "--steps", 60, "--threads", threads)
            self.assertEqual(summary["threads"], threads or os.cpu_count())
            hashes.add(summary["hash"])
        self.assertEqual(len(hashes), 1)

    def test_results_that_stdout_does_not_take(self):
        with open("/dev/full", "w", encoding="ascii") as full:
            _, err = self.carom("info", "--json", stdout=full, expect=1)
        self.assertIn("standard output", err)


if __name__ == "__main__":
    unittest.main()
