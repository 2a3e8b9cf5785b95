"""carom render: pictures and films are whole, repeatable and of the size asked for, and what is missing is named."""

import array
import os
import re
import resource
import signal
import struct
import subprocess
import time
import unittest

from carom_cli import GAS, ROOT, CliTest, dense_gas, figure

HAS_SOUND = os.environ.get("CAROM_HAS_SOUND", "ON") == "ON"
SILENT = () if HAS_SOUND else ("--no-sound",)

SPIN = """
[run]
time = 1
[[bodies]]
position = [0, 0, 0]
[camera]
field_of_view = 30
[[camera.path]]
time = 0
position = [0, -9, 0]
target = [0, 0, 0]
[[camera.path]]
time = 1
position = [9, 0, 3]
target = [1, 0, 0]
[picture]
time_scale = 0.5
"""


class Render(CliTest):
    def setUp(self):
        super().setUp()
        self.write("gas.toml", GAS)
        self.write("spin.toml", SPIN)

    def render(self, *arguments, **options):
        return self.carom("render", *arguments, *SILENT, **options)

    def refused_render(self, *arguments, expect=2, **options):
        """Checks that it fails with a message and leaves no file; returns the message."""
        before = self.files()
        _, err = self.render(*arguments, expect=expect, **options)
        self.assertTrue(err.startswith("carom: "), err)
        self.assertEqual(self.files(), before)
        return err

    def size_of_png(self, name):
        data = self.read(name)
        self.assertEqual(data[:8], b"\x89PNG\r\n\x1a\n")
        return struct.unpack(">II", data[16:24])

    def probe(self, name):
        """Width, height, frames a second and number of frames of a film."""
        command = ["ffprobe", "-v", "error", "-select_streams", "v", "-count_frames", "-show_entries",
                   "stream=width,height,r_frame_rate,nb_read_frames", "-of", "csv=p=0", name]
        return subprocess.run(command, cwd=self.folder, text=True, capture_output=True, check=True).stdout.strip()

    def frames(self, name):
        """A checksum of each frame of a film."""
        command = ["ffmpeg", "-v", "error", "-i", name, "-map", "0:v", "-f", "framemd5", "-"]
        text = subprocess.run(command, cwd=self.folder, text=True, capture_output=True, check=True).stdout
        return re.findall(r"[0-9a-f]{32}", text)

    def test_a_picture(self):
        self.render("gas.toml", "-o", "a.png", "--size", "70x51", "--time", 0.31)
        self.assertEqual(self.size_of_png("a.png"), (70, 51))
        self.render("gas.toml", "-o", "b.png", "--size", "70x51", "--time", 0.31, "--threads", 1)
        self.assertEqual(self.read("a.png"), self.read("b.png"))
        for name, options in (("later.png", ("--time", 0.32)), ("rough.png", ("--time", 0.31, "--supersample", 1)),
                              ("speed.png", ("--time", 0.31, "--colour-by", "speed"))):
            self.render("gas.toml", "-o", name, "--size", "70x51", *options)
            self.assertEqual(self.size_of_png(name), (70, 51))
            self.assertNotEqual(self.read("a.png"), self.read(name), name)
        self.render("gas.toml", "-o", "legend.png", "--size", "70x51", "--time", 0.31, "--colour-by", "speed", "--legend")
        self.assertNotEqual(self.read("legend.png"), self.read("speed.png"))
        self.assertEqual(len([name for name in self.files() if name.endswith(".png")]), 6)

    def test_checkpoints_are_drawn_like_the_scene_that_they_are_of(self):
        self.carom("run", "gas.toml", "--out", "out", "--time", 0.5)
        checkpoint = "out/checkpoint.carom"
        small = ("--size", "70x51")
        self.render("gas.toml", "-o", "scene.png", *small, "--time", 0.5)
        self.render(checkpoint, "-o", "state.png", *small)
        self.assertEqual(self.read("state.png"), self.read("scene.png"))
        self.render("gas.toml", "-o", "scene.png", *small, "--time", 0.7)
        self.render(checkpoint, "-o", "state.png", *small, "--time", 0.7)
        self.assertEqual(self.read("state.png"), self.read("scene.png"))
        self.assertIn("--time must be at least 0.5, where out/checkpoint.carom begins, not 0.4",
                      self.refused_render(checkpoint, "-o", "a.png", "--time", 0.4))
        # A film begins at the checkpoint.
        self.render(checkpoint, "-o", "state.mp4", *("--size", "64x48", "--fps", 10), "--time", 0.3)
        self.assertEqual(self.probe("state.mp4"), "64,48,10/1,3")
        self.render("gas.toml", "-o", "scene.mp4", *("--size", "64x48", "--fps", 10), "--time", 0.8)
        self.assertNotEqual(self.frames("state.mp4")[0], self.frames("scene.mp4")[0])
        self.write("cut.carom", "")
        (self.folder / "cut.carom").write_bytes(self.read(checkpoint)[:100])
        self.assertIn("cut.carom: ", self.refused_render("cut.carom", "-o", "a.png"))

    def test_the_smallest_picture_and_a_scene_without_bodies(self):
        self.write("empty.toml", "")
        self.render("empty.toml", "-o", "e.png", "--size", "1x1", "--time", 0.1)
        self.assertEqual(self.size_of_png("e.png"), (1, 1))

    def test_a_film(self):
        film = ("--size", "64x48", "--fps", 10)
        self.render("spin.toml", "-o", "a.mp4", *film)
        self.assertEqual(self.probe("a.mp4"), "64,48,10/1,20")
        self.render("spin.toml", "-o", "b.mp4", *film)
        frames = self.frames("a.mp4")
        self.assertEqual(frames, self.frames("b.mp4"))
        self.assertEqual(len(set(frames)), 20, "the camera moves in each frame")
        self.render("spin.toml", "-o", "c.mp4", *film, "--time", 0.5, "--time-scale", 1)
        self.assertEqual(self.probe("c.mp4"), "64,48,10/1,5")
        self.assertEqual(self.files(), ["a.mp4", "b.mp4", "c.mp4", "gas.toml", "spin.toml"])

    def seconds_of_sound(self, name):
        """How long each stream of sound of a film is."""
        command = ["ffprobe", "-v", "error", "-select_streams", "a", "-show_entries", "stream=duration", "-of", "csv=p=0",
                   name]
        text = subprocess.run(command, cwd=self.folder, text=True, capture_output=True, check=True).stdout
        return [float(line) for line in text.split()]

    def onsets(self, name):
        """s: where a millisecond of a film's sound is three times as loud as any of the 20 ms before, and no whisper."""
        command = ["ffmpeg", "-v", "error", "-i", name, "-f", "s16le", "-ac", "1", "-ar", "48000", "-"]
        data = subprocess.run(command, cwd=self.folder, capture_output=True, check=True).stdout
        samples = array.array("h", data)
        levels = [max(map(abs, samples[i:i + 48])) for i in range(0, len(samples) - 47, 48)]
        rising = [i for i in range(20, len(levels)) if levels[i] > 100 and levels[i] > 3 * max(levels[i - 20:i])]
        return [i / 1000 for k, i in enumerate(rising) if k == 0 or i > rising[k - 1] + 5]

    @unittest.skipUnless(HAS_SOUND, "built without OpenAL Soft")
    def test_films_are_heard(self):
        # A second of the film is two of the world.
        self.render(ROOT / "scenes/newtons_cradle.toml", "-o", "a.mp4", "--size", "32x18", "--fps", 20, "--supersample", 1,
                    "--time", 22, "--time-scale", 2)
        self.assertEqual(self.probe("a.mp4"), "32,18,20/1,220")
        (seconds,) = self.seconds_of_sound("a.mp4")
        self.assertAlmostEqual(seconds, 11, delta=0.001)
        # At 1 m/s: 2 m to the others, 4.5 m to the wall and back, 2.5 m to the other wall and back, and so on.
        clicks = [2, 6.5, 11, 13.5, 16, 20.5]
        heard = self.onsets("a.mp4")
        self.assertEqual(len(heard), len(clicks), f"{heard} {clicks}")
        worst = max(abs(2 * at - click) for at, click in zip(heard, clicks)) / 2
        self.assertLess(worst, 0.005)
        figure(f"Newton's cradle in a film, clicks heard at most {1000 * worst:.1f} ms from their impacts")
        self.render(ROOT / "scenes/newtons_cradle.toml", "-o", "b.mp4", "--size", "32x18", "--time", 1, "--no-sound")
        self.assertEqual(self.seconds_of_sound("b.mp4"), [])

    @unittest.skipIf(HAS_SOUND, "built with OpenAL Soft")
    def test_films_of_a_build_without_sound(self):
        _, err = self.carom("render", "spin.toml", "-o", "a.mp4", "--size", "64x48", expect=1)
        self.assertIn("sound: this build of carom has none", err)
        self.render("spin.toml", "-o", "a.mp4", "--size", "64x48", "--fps", 2)

    def test_bad_usage(self):
        self.assertIn(".png", self.refused_render("gas.toml", "-o", "a.gif"))
        self.assertIn("--output is required", self.refused_render("gas.toml"))
        for size in ("70", "70x", "x5", "0x5", "5x0", "7.5x3", "70x51x3", "99999x1"):
            self.assertIn("--size", self.refused_render("gas.toml", "-o", "a.png", "--size", size))
        self.assertIn("even", self.refused_render("gas.toml", "-o", "a.mp4", "--size", "65x48"))
        self.assertIn("1 to 8", self.refused_render("gas.toml", "-o", "a.png", "--supersample", 9))
        self.assertIn("frames a second", self.refused_render("gas.toml", "-o", "a.mp4", "--fps", 0))
        self.assertIn("impact_rate", self.refused_render("gas.toml", "-o", "a.png", "--colour-by", "age"))
        self.assertIn("--legend needs", self.refused_render("gas.toml", "-o", "a.png", "--legend"))
        self.write("bad.toml", "[camera]\nfield_of_view = 0\n")
        self.assertIn("bad.toml:2: camera.field_of_view", self.refused_render("bad.toml", "-o", "a.png"))

    def test_what_cannot_be_written(self):
        small = ("--size", "16x16", "--time", 0.1)
        self.assertIn("nowhere/a.png", self.refused_render("gas.toml", "-o", "nowhere/a.png", *small, expect=1))
        self.assertIn("nowhere/a.mp4", self.refused_render("gas.toml", "-o", "nowhere/a.mp4", *small, expect=1))
        self.assertIn("pixels with this driver",
                      self.refused_render("gas.toml", "-o", "a.png", "--size", "32768x8", "--supersample", 8,
                                          "--time", 0.1, expect=1))

    def test_a_missing_or_broken_ffmpeg(self):
        film = ("gas.toml", "-o", "a.mp4", "--size", "16x16")
        message = self.refused_render(*film, expect=1, env=dict(os.environ, PATH="/nowhere"))
        self.assertIn("ffmpeg: is missing, and films need it", message)
        tools = self.folder / "tools"
        tools.mkdir()
        (tools / "ffmpeg").write_text("#!/bin/sh\necho strange codec >&2\nexit 3\n")
        (tools / "ffmpeg").chmod(0o755)
        message = self.refused_render(*film, expect=1, env=dict(os.environ, PATH=f"{tools}:{os.environ['PATH']}"))
        self.assertIn("a.mp4: ffmpeg has failed: strange codec", message)

    def test_a_disk_that_is_full(self):
        # Files may not grow beyond so many bytes: fewer than the pictures take, or than pictures and sound do.
        def full_at(size):
            def prepare():
                signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
                resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))
            return prepare

        film = ("spin.toml", "-o", "a.mp4", "--size", "320x180", "--fps", 10)
        self.render(*film, "--no-sound")
        silent = len(self.read("a.mp4"))
        (self.folder / "a.mp4").unlink()
        self.assertGreater(silent, 5000)
        for size in (1000, silent + 100) if HAS_SOUND else (1000,):
            before = self.files()
            _, message = self.render(*film, expect=1, preexec_fn=full_at(size))
            self.assertRegex(message, r"carom: a\.mp4: ffmpeg has failed: .*File too large") # and what the driver says
            self.assertEqual(self.files(), before)

    def test_missing_or_old_graphics(self):
        picture = ("gas.toml", "-o", "a.png", "--size", "16x16", "--time", 0.1)
        old = dict(os.environ, MESA_GL_VERSION_OVERRIDE="3.3", LIBGL_ALWAYS_SOFTWARE="1")
        self.assertIn("OpenGL 4.5 core", self.refused_render(*picture, expect=1, env=old))
        self.write("libEGL.so.1", "")
        missing = dict(os.environ, LD_LIBRARY_PATH=str(self.folder))
        self.assertIn("libEGL.so.1 is missing", self.refused_render(*picture, expect=1, env=missing))

    def wait_until_a_film_is_begun(self):
        deadline = time.monotonic() + 60
        while not (self.folder / "a.mp4.part").exists() and time.monotonic() < deadline:
            time.sleep(0.02)
        time.sleep(0.3)

    def test_interrupts(self):
        for number, code in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            process = self.start("render", ROOT / "scenes/gas.toml", "-o", "a.mp4", "--size", "64x48", "--time", 1000,
                                 *SILENT)
            self.wait_until_a_film_is_begun()
            process.send_signal(number)
            _, err = process.communicate(timeout=60)
            self.assertEqual(process.returncode, code, err)
            self.assertIn("nothing was written", err)
            self.assertEqual(self.files(), ["gas.toml", "spin.toml"])

    def start_with_a_long_step(self, seconds, name):
        """A picture or a film in its first step, which takes so many seconds of the world."""
        self.write("slow.toml", dense_gas(seconds))
        process = self.start("render", "slow.toml", "-o", name, "--size", "64x48", "--time", 1e9, "--no-sound")
        self.wait_until_it_notes_interrupts(process)
        if name.endswith(".mp4"):
            self.wait_until_a_film_is_begun()
        return process

    def test_an_interrupt_waits_for_the_end_of_the_step(self):
        for name in ("a.png", "a.mp4"):
            process = self.start_with_a_long_step(100, name)
            process.send_signal(signal.SIGINT)
            _, err = process.communicate(timeout=120)
            self.assertEqual(process.returncode, 130, err)
            self.assertIn("nothing was written", err)
            self.assertEqual(self.files(), ["gas.toml", "slow.toml", "spin.toml"])

    def test_a_second_interrupt_ends_it_at_once(self):
        for name in ("a.png", "a.mp4"):
            process = self.start_with_a_long_step(1e4, name)  # a step of minutes
            process.send_signal(signal.SIGINT)
            time.sleep(1)
            self.assertIsNone(process.poll())
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=60)
            self.assertEqual(process.returncode, -signal.SIGINT)
            self.assertNotIn(name, self.files())


if __name__ == "__main__":
    unittest.main()
