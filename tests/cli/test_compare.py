"""bench/compare, which fails if one carom program is slower than another, with programs that print times."""

import subprocess
import unittest

from carom_cli import ROOT, CliTest

WORKLOADS = 5
PAIRS = 5


class Compare(CliTest):
    def program(self, name, time, first_time=None, bits="0"):
        """A program that tells its time per step; `first_time` for the first PAIRS calls, the first workload."""
        path = self.folder / name
        path.write_text(f"""#!/bin/sh
            echo >> '{path}.calls'
            [ $(wc -l < '{path}.calls') -le {PAIRS} ] && time={first_time or time} || time={time}
            echo "{{\\"ns_per_body_step\\": $time, \\"hash\\": \\"{bits}\\"}}"
            """)
        path.chmod(0o755)
        return path

    def compare(self, base, head, expect):
        done = subprocess.run([ROOT / "bench/compare", base, head, "--pairs", str(PAIRS)], capture_output=True,
                              text=True, check=False)
        self.assertEqual(done.returncode, expect, done.stdout + done.stderr)
        return done

    def test_a_program_and_itself(self):
        program = self.program("carom", 100)
        done = self.compare(program, program, expect=0)
        self.assertEqual(done.stdout.count("+0.0% time\n"), WORKLOADS)
        self.assertEqual(done.stderr, "")

    def test_slower(self):
        done = self.compare(self.program("base", 100), self.program("head", 111), expect=1)
        self.assertEqual(done.stdout.count("+11.0% time"), 2 * WORKLOADS)
        self.assertIn("more than 10 % slower: gas", done.stderr)

    def test_a_little_slower_or_faster(self):
        base = self.program("base", 100)
        self.compare(base, self.program("head", 109), expect=0)
        self.assertIn("-50.0% time", self.compare(base, self.program("faster", 50), expect=0).stdout)

    def test_needs_confirmation(self):
        done = self.compare(self.program("base", 100), self.program("head", 100, first_time=200), expect=0)
        self.assertIn("+100.0% time\n    measured once more", done.stdout)
        self.assertEqual(done.stdout.count("once more"), 1)

    def test_other_results_are_noted(self):
        done = self.compare(self.program("base", 100), self.program("head", 100, bits="1"), expect=0)
        self.assertEqual(done.stdout.count("other bits"), WORKLOADS)

    def test_failures_end_it(self):
        broken = self.folder / "broken"
        broken.write_text("#!/bin/sh\nexit 2\n")
        broken.chmod(0o755)
        self.compare(self.program("base", 100), broken, expect=2)


if __name__ == "__main__":
    unittest.main()
