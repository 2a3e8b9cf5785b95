"""carom render: pictures and films are whole, repeatable and of the size asked for, and what is missing is named."""

import os
import re
import signal
import struct
import subprocess
import time
import unittest

from carom_cli import GAS, ROOT, CliTest

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
        return self.carom("render", *arguments, **options)

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
        command = ["ffprobe", "-v", "error", "-count_frames", "-show_entries",
                   "stream=width,height,r_frame_rate,nb_read_frames", "-of", "csv=p=0", name]
        return subprocess.run(command, cwd=self.folder, text=True, capture_output=True, check=True).stdout.strip()

    def frames(self, name):
        """A checksum of each frame of a film."""
        command = ["ffmpeg", "-v", "error", "-i", name, "-f", "framemd5", "-"]
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
        self.assertEqual(len([name for name in self.files() if name.endswith(".png")]), 5)

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

    def test_bad_usage(self):
        self.assertIn(".png", self.refused_render("gas.toml", "-o", "a.gif"))
        self.assertIn("--output is required", self.refused_render("gas.toml"))
        for size in ("70", "70x", "x5", "0x5", "5x0", "7.5x3", "70x51x3", "99999x1"):
            self.assertIn("--size", self.refused_render("gas.toml", "-o", "a.png", "--size", size))
        self.assertIn("even", self.refused_render("gas.toml", "-o", "a.mp4", "--size", "65x48"))
        self.assertIn("1 to 8", self.refused_render("gas.toml", "-o", "a.png", "--supersample", 9))
        self.assertIn("frames a second", self.refused_render("gas.toml", "-o", "a.mp4", "--fps", 0))
        self.assertIn("impact_rate", self.refused_render("gas.toml", "-o", "a.png", "--colour-by", "age"))
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

    def test_missing_or_old_graphics(self):
        picture = ("gas.toml", "-o", "a.png", "--size", "16x16", "--time", 0.1)
        old = dict(os.environ, MESA_GL_VERSION_OVERRIDE="3.3", LIBGL_ALWAYS_SOFTWARE="1")
        self.assertIn("OpenGL 4.5 core", self.refused_render(*picture, expect=1, env=old))
        self.write("libEGL.so.1", "")
        missing = dict(os.environ, LD_LIBRARY_PATH=str(self.folder))
        self.assertIn("libEGL.so.1 is missing", self.refused_render(*picture, expect=1, env=missing))

    def test_interrupts(self):
        for number, code in ((signal.SIGINT, 130), (signal.SIGTERM, 143)):
            process = self.start("render", ROOT / "scenes/gas.toml", "-o", "a.mp4", "--size", "64x48", "--time", 1000)
            deadline = time.monotonic() + 60
            while not (self.folder / "a.mp4.part").exists() and time.monotonic() < deadline:
                time.sleep(0.02)
            time.sleep(0.3)
            process.send_signal(number)
            _, err = process.communicate(timeout=60)
            self.assertEqual(process.returncode, code, err)
            self.assertIn("nothing was written", err)
            self.assertEqual(self.files(), ["gas.toml", "spin.toml"])


if __name__ == "__main__":
    unittest.main()
