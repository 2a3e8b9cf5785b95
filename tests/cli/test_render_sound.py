"""What `carom render` writes of sound, and what it refuses."""

import array
import signal
import unittest
import wave

from carom_cli import GAS, ROOT, CliTest

CRADLE = ROOT / "scenes/newtons_cradle.toml"


class RenderSound(CliTest):
    def render(self, *arguments, **options):
        """Renders; skips the test where this carom has no sound."""
        process = self.start("render", *arguments, **options)
        out, err = process.communicate(timeout=120)
        if process.returncode == 1 and "this build of carom has none" in err:
            self.assertEqual(self.files(), ["gas.toml"])
            self.skipTest("built without sound")
        self.assertEqual(process.returncode, 0, err)
        return out

    def setUp(self):
        super().setUp()
        self.write("gas.toml", GAS)

    def samples(self, name):
        with wave.open(str(self.folder / name)) as file:
            self.assertEqual((file.getnchannels(), file.getsampwidth(), file.getframerate()), (2, 2, 48000))
            return array.array("h", file.readframes(file.getnframes()))

    def test_a_scene_is_heard(self):
        self.render(CRADLE, "-o", "cradle.wav", "--time", 3)
        samples = self.samples("cradle.wav")
        self.assertEqual(len(samples), 2 * 3 * 48000)
        # The first impacts are at 2 s.
        self.assertEqual(max(map(abs, samples[:2 * 2 * 48000])), 0)
        self.assertGreater(max(map(abs, samples[2 * 2 * 48000:])), 3000)
        self.assertEqual(self.files(), ["cradle.wav", "gas.toml"])

    def test_the_same_each_time_and_for_any_threads(self):
        for name, threads in (("a.wav", 1), ("b.wav", 4)):
            self.render("gas.toml", "--output", name, "--threads", threads)
        self.assertEqual(self.read("a.wav"), self.read("b.wav"))
        self.assertGreater(max(self.samples("a.wav")), 3000)

    def test_a_checkpoint_is_heard_from_where_it_is(self):
        self.carom("run", CRADLE, "--out", "out", "--time", 1.5)
        self.render("out/checkpoint.carom", "-o", "late.wav", "--time", 1)
        samples = self.samples("late.wav")
        self.assertEqual(len(samples), 2 * 48000)
        self.assertEqual(max(map(abs, samples[:48000])), 0)  # the first impacts are at 2 s
        self.assertGreater(max(map(abs, samples[48000:])), 3000)

    def test_refusals(self):
        self.assertIn("'gas.flac'", self.refused("render", "gas.toml", "-o", "gas.flac"))
        self.assertIn("missing.toml", self.refused("render", "missing.toml", "-o", "a.wav"))
        self.assertIn("--output", self.refused("render", "gas.toml"))
        self.assertEqual(self.files(), ["gas.toml"])

    def test_a_file_that_cannot_be_written(self):
        self.render("gas.toml", "-o", "gas.wav", "--time", 0.1)
        err = self.refused("render", "gas.toml", "-o", "missing/gas.wav", "--time", 0.1, expect=1)
        self.assertIn("missing/gas.wav: cannot be created", err)

    def test_an_interrupt_leaves_no_file(self):
        self.render("gas.toml", "-o", "gas.wav", "--time", 0.1)
        process = self.start("render", "gas.toml", "-o", "long.wav", "--time", 100000)
        self.wait_until_it_notes_interrupts(process)
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, err)
        self.assertIn("nothing was written", err)
        self.assertEqual(self.files(), ["gas.toml", "gas.wav"])


if __name__ == "__main__":
    unittest.main()
