"""The aims of BENCHMARKS for one thread in double precision, as figures and as limits."""

import string
import time
import timeit
import unittest

from carom_cli import ROOT, CliTest, figure

# s for the loop below: a third more than Debian 12's Python takes on the machine of docs/performance.md (0.0306 s).
SLOW_LOOP_SECONDS = 0.0417
# What a body of a gas of 100 000 costs there, ns a step: the middle of what docs/performance.md gives.
GAS_NANOSECONDS = 104


def slowness():
    """How many times longer than that a fixed loop takes here and now; 1 where it takes less."""
    loop = min(timeit.repeat("for k in range(1000000): s = (s * 5 + k) & 65535", "s = 1", number=1, repeat=7))
    return max(1.0, loop / SLOW_LOOP_SECONDS)


class Aims(CliTest):
    """A time is the least of some attempts, no more of them than it takes: neighbours only make it longer, and may be at
    work for a minute."""

    ATTEMPTS = 10
    PAUSE = 4  # s between two of them

    def bench(self, bodies, *options):
        return self.json("bench", "gas", "--bodies", bodies, "--threads", 1, "--precision", "double", "--skip-overlap",
                         *options)

    def least(self, name, unit, limit, measure):
        attempts = []
        while len(attempts) < self.ATTEMPTS and min(attempts, default=limit + 1) > limit:
            time.sleep(self.PAUSE if attempts else 0)
            attempts.append(measure())
        figure(f"{name}: {min(attempts):.4g} {unit} (at most {limit:g}; {len(attempts)} of {self.ATTEMPTS} attempts)")
        self.assertLessEqual(min(attempts), limit, name)

    def least_time(self, name, unit, limit, measure):
        """A machine that is far slower at other things, too, gets as much more time as it is slower than that."""
        self.least(name, unit, limit, lambda: measure() / slowness())

    def test_gas(self):
        self.least_time("gas of 100 000", "ns per body and step", 220,
                        lambda: self.bench(100000, "--repeat", 1)["ns_per_body_step"])

    def test_impacts(self):
        self.least_time("gas of 100 000 in steps of 1/15 s", "us per impact", 2.5,
                        lambda: 1e6 / self.bench(100000, "--repeat", 1, "--dt", 1 / 15)["impacts_per_second"])

    def test_asteroids(self):
        """Most of it waits for memory, which that loop does not: a machine that is slower at a gas gets more time, too."""
        folders = iter(string.ascii_lowercase)

        def measure():
            scene = self.json("run", ROOT / "scenes/asteroids.toml", "--threads", 1, "--out", next(folders))
            gas = self.bench(100000, "--repeat", 1)
            return scene["ns_per_body_step"] / max(slowness(), gas["ns_per_body_step"] / GAS_NANOSECONDS)

        self.least("scenes/asteroids.toml", "ns per body and step", 250, measure)

    def test_size_matters_little(self):
        least = {10000: float("inf"), 1000000: float("inf")}

        def measure():
            for bodies, steps in ((10000, 400), (1000000, 20)):
                result = self.bench(bodies, "--repeat", 1, "--warmup", 60, "--steps", steps)
                least[bodies] = min(least[bodies], result["ns_per_body_step"])
            return least[1000000] / least[10000]

        self.least("gas of 1 000 000", "times as dear per body as one of 10 000", 1.5, measure)

    def test_memory(self):
        self.least("gas of 100 000", "bytes per body", 256, lambda: self.bench(100000)["bytes_per_body"])


if __name__ == "__main__":
    unittest.main()
