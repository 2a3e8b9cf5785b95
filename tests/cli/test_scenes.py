"""Every scene of the repository runs to its end, and what its first lines tell the reader to watch is there to see."""

import csv
import math
import time
import unittest

from carom_cli import ROOT, CliTest, figure


class Scenes(CliTest):
    def whole(self, name, max_overlap=1e-9):
        """Runs a scene as it is. Returns its figures and the rows of its timeline."""
        began = time.monotonic()
        summary = self.json("run", ROOT / f"scenes/{name}.toml", "--out", "out")
        figure(f"scenes/{name}.toml: {summary['impacts']} impacts, energy balance {summary['energy_balance']:.2g}, "
               f"largest overlap {summary['max_overlap']:.2g}, {time.monotonic() - began:.1f} s")
        self.assertTrue(summary["complete"])
        self.assertEqual(summary["bodies_outside"], 0)
        self.assertLessEqual(summary["max_overlap"], max_overlap)
        if summary["kinetic_final"] == 0 or summary["kinetic_final"] > 1e-6:
            # In units of the momenta of all bodies, which mean nothing where these only just do not stand still.
            self.assertLess(summary["momentum_drift"], 1e-10)
        with open(self.folder / "out/timeline.csv", newline="", encoding="ascii") as file:
            rows = [{key: float(value) for key, value in row.items()} for row in csv.DictReader(file)]
        return summary, rows

    def row_at(self, rows, moment):
        return min(rows, key=lambda row: abs(row["time"] - moment))

    def test_two_bodies(self):
        summary, _ = self.whole("two_bodies")
        self.assertEqual(summary["impacts"], 1)
        self.assertLess(abs(summary["energy_drift"]), 1e-15)

    def test_newtons_cradle(self):
        summary, rows = self.whole("newtons_cradle")
        self.assertEqual(summary["pair_impacts"], 4 * (summary["face_impacts"] + 1))
        for row in rows:
            self.assertAlmostEqual(row["kinetic"], 0.5, delta=1e-14)

    def test_bouncing_balls(self):
        summary, rows = self.whole("bouncing_balls")
        self.assertEqual(summary["contacts"], 10)
        self.assertLess(abs(summary["energy_drift"]), 1e-9)
        # The balls with e <= 0.5 rest at 1.35 s, the one with 0.9 at 8.58 s, the one with 1 never.
        for moment, resting in ((1.34, 5), (1.36, 6), (8.55, 9), (8.6, 10)):
            self.assertEqual(self.row_at(rows, moment)["contacts"], resting, f"at {moment} s")

    def test_pi(self):
        summary, _ = self.whole("pi")
        self.assertEqual(summary["impacts"], 3141592)
        self.assertLess(abs(summary["energy_drift"]), 1e-9)

    def test_gas(self):
        summary, _ = self.whole("gas")
        self.assertGreater(summary["impacts"], 200000)
        self.assertLess(abs(summary["energy_drift"]), 1e-12)

    def test_cooling(self):
        summary, rows = self.whole("cooling")
        self.assertLess(abs(summary["energy_drift"]), 1e-12)
        # Haff's law T0 / (1 + t / tau)^2: collisions per body until tau are 31.6654 at e = 0.9, and their rate at the
        # start is 4 sqrt(pi) n chi sqrt(kT / m) sigma^2, with chi = 0.227485 / (4 * 0.05) at this packing of 0.05.
        rate = 4 * math.sqrt(math.pi) * 10000 / 47.14**3 * 0.227485 / 0.2 * math.sqrt(4)
        row = self.row_at(rows, 6)
        tau = row["time"] / (math.sqrt(rows[0]["kinetic"] / row["kinetic"]) - 1)
        figure(f"cooling: tau {tau:.2f} s, by Haff's law {31.6654 / rate:.2f} s")
        self.assertAlmostEqual(tau * rate / 31.6654, 1, delta=0.03)

    def test_rain(self):
        summary, _ = self.whole("rain")
        self.assertEqual((summary["contacts"], summary["kinetic_final"]), (400, 0))
        self.assertLess(abs(summary["energy_drift"]), 1e-8)

    def test_shaker(self):
        # The floor, of 0.9 m/s at most, stops a bed that comes at as much within some t_rest. Then grains that meet at
        # less than 1.8 m/s are pushed and not struck: they go 1.8 / 480 m, 0.019 diameters, into each other in each of
        # the five pieces in which a pass a piece brings word of the floor up through five layers.
        summary, rows = self.whole("shaker", max_overlap=0.1)
        self.assertLess(abs(summary["energy_drift"]), 1e-9)
        # The bed is thrown up and caught in each period: its momentum turns round as often.
        late = [row["momentum_z"] for row in rows if row["time"] > 1]
        turns = sum(before < 0 <= after for before, after in zip(late, late[1:]))
        self.assertAlmostEqual(turns, 3 * 33 / (2 * math.pi), delta=2)
        self.assertGreater(max(row["contacts"] for row in rows), 300)
        self.assertLess(min(row["contacts"] for row in rows if row["time"] > 1), 30)

    def test_drum(self):
        # What slides down the slope drives others into each other for a moment.
        summary, rows = self.whole("drum", max_overlap=0.1)
        self.assertLess(abs(summary["energy_drift"]), 1e-9)
        # 500 balls of m = 2.26 kg lie at the bottom first; the drum takes them up by more than a quarter of its radius on average,
        # and keeps them going.
        deepest = min(row["potential"] for row in rows)
        mass = 500 * 2500 * math.pi / 6 * 0.12**3
        for row in rows:
            if row["time"] > 2.5:
                self.assertGreater(row["potential"] - deepest, mass * 9.81 * 0.25 * 1.2, row["time"])
                self.assertGreater(row["kinetic"], 0.5 * 0.5 * mass * (0.8 * 1.2)**2, row["time"])

    def test_heap(self):
        # What falls from five metres drives others into each other for a moment.
        summary, rows = self.whole("heap", max_overlap=0.05)
        self.assertLess(abs(summary["energy_balance"]), 1e-9)
        self.assertGreater(rows[-1]["contacts"], 2 * 1200)
        self.assertEqual(rows[-1]["impacts"], rows[-30]["impacts"])
        self.assertEqual(summary["bodies"], 1200)
        mass = 1200 * 2500 * math.pi / 6 * 0.25**3
        self.assertLess(summary["kinetic_final"], 1e-6 * mass)

    def test_tower(self):
        summary, rows = self.whole("tower", max_overlap=0.01)
        self.assertEqual(self.row_at(rows, 0.5)["contacts"], 10)
        self.assertEqual(self.row_at(rows, 0.5)["impacts"], 0)
        self.assertGreater(summary["impacts"], 10)
        self.assertLess(abs(summary["energy_drift"]), 1e-9)

    def test_hopper(self):
        summary, rows = self.whole("hopper", max_overlap=0.1)
        mass = 600 * 1000 * math.pi / 6 * 0.16**3
        # They lie on the floor: a heap less than three diameters high on average.
        self.assertLess(summary["energy_final"], mass * 9.81 * 3 * 0.16)
        self.assertLess(summary["kinetic_final"], 1e-6 * mass)
        self.assertLess(abs(summary["energy_balance"]), 1e-9)

    def test_avalanche(self):
        summary, rows = self.whole("avalanche", max_overlap=0.1)
        boulder = 2500 * math.pi / 6 * 1.6**3
        stones = 240 * 2500 * math.pi / 6 * 0.3**3
        # Before the boulder arrives the stones lie still: what moves is the boulder alone, in free fall.
        row = self.row_at(rows, 3.5)
        fall = 0.5 * boulder * (0.5**2 + (9.81 * row["time"])**2)
        self.assertLess(abs(row["kinetic"] - fall), 1e-3 * stones)
        self.assertGreater(summary["impacts"], self.row_at(rows, 3.5)["impacts"])
        self.assertLess(summary["kinetic_final"], 1e-6 * stones)

    def test_asteroids(self):
        summary, rows = self.whole("asteroids")
        self.assertEqual(summary["bodies"], 20301)
        self.assertGreater(summary["impacts"], 10000)
        self.assertGreater(summary["contacts"], 0)
        # Kicks at the ends of steps: of second order in dt.
        self.assertLess(abs(summary["energy_drift"]), 1e-3)
        self.assertTrue(all(a["lost"] <= b["lost"] for a, b in zip(rows, rows[1:])))
        picture = ROOT / "docs/images/asteroids.svg"
        self.assertEqual(self.read("out", "energy.svg"), picture.read_bytes(),
                         f"{picture} is not what carom draws now: run ./dev run, then copy out/asteroids/energy.svg")

    def test_all_are_here(self):
        tested = {name.removeprefix("test_") for name in dir(self) if name.startswith("test_")} - {"all_are_here"}
        self.assertEqual(tested, {path.stem for path in (ROOT / "scenes").glob("*.toml")})


if __name__ == "__main__":
    unittest.main()
