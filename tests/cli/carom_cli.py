"""What the tests of the command line share: the program, a folder, and small scenes."""

import json
import os
import pathlib
import re
import signal
import subprocess
import tempfile
import time
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("CAROM", str(ROOT / "build/release/bin/carom"))

# 60 elastic spheres that meet often.
GAS = """
title = "Small gas"
seed = 5
[run]
time = 1
dt = "1/60"
[region]
kind = "box"
min = [0, 0, 0]
max = [6, 6, 6]
restitution = 1
[[bodies]]
generator = "jittered_lattice"
count = 60
radius = 0.5
mass = 1
restitution = 1
velocity = { distribution = "uniform", min = -5, max = 5 }
"""

# Spheres that fall, lose energy, and come to rest on the floor.
RAIN = """
title = "Small rain"
seed = 5
[world]
gravity = [0, 0, -9.81]
drag = { quadratic = 0.1 }
[run]
time = 2
dt = 0.01
[region]
kind = "box"
min = [0, 0, 0]
max = [9, 9, 9]
[[bodies]]
generator = "jittered_lattice"
count = 40
radius = 0.2
mass = 2
restitution = 0.5
"""


def dense_gas(dt):
    """1000 spheres that meet a few ten thousand times a second of the world: a step of 100 s takes seconds."""
    return f"""
[run]
dt = {dt}
time = 1e9
[region]
kind = "box"
min = [0, 0, 0]
max = [10, 10, 10]
[[bodies]]
generator = "random"
count = 1000
min = [0, 0, 0]
max = [10, 10, 10]
radius = 0.2
mass = 1
restitution = 1
velocity = {{ distribution = "uniform", min = -5, max = 5 }}
"""


def figure(text):
    """Prints what was measured; ./dev test shows these lines at its end."""
    print(f"figure: {text}")


class CliTest(unittest.TestCase):
    """A test with an empty folder as its working directory."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="carom_cli_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, text):
        (self.folder / name).write_text(text)
        return name

    def start(self, *arguments, **options):
        """The program, running in the test's folder."""
        options.setdefault("stdout", subprocess.PIPE)
        options.setdefault("stderr", subprocess.PIPE)
        command = [PROGRAM, *map(str, arguments)]
        process = subprocess.Popen(command, cwd=self.folder, text=True, **options)
        self.addCleanup(self.end, process)
        return process

    @staticmethod
    def end(process):
        """Leaves nothing behind of a test that failed."""
        if process.poll() is None:
            process.kill()
            process.communicate()

    def wait_until_it_notes_interrupts(self, process):
        """Returns once the program catches Ctrl-C: from then on it steps."""
        deadline = time.monotonic() + 60
        while time.monotonic() < deadline:
            status = pathlib.Path(f"/proc/{process.pid}/status").read_text(encoding="ascii")
            if int(re.search(r"SigCgt:\s*(\w+)", status)[1], 16) >> (signal.SIGINT - 1) & 1:
                return
            time.sleep(0.01)
        self.fail("it never did")

    def carom(self, *arguments, expect=0, **options):
        """Runs the program to its end, and checks its exit code. Returns what it wrote to stdout and stderr."""
        process = self.start(*arguments, **options)
        out, err = process.communicate(timeout=120)
        self.assertEqual(process.returncode, expect, f"carom {arguments}\n{out}\n{err}")
        return out, err

    def json(self, *arguments, **options):
        """What the program prints with --json."""
        return json.loads(self.carom(*arguments, "--json", **options)[0])

    def refused(self, *arguments, expect=2):
        """Checks that the program refuses this with nothing on stdout; returns the message."""
        out, err = self.carom(*arguments, expect=expect)
        self.assertEqual(out, "")
        self.assertTrue(err.startswith("carom: "), err)
        return err

    def read(self, *names):
        return self.folder.joinpath(*names).read_bytes()

    def files(self, *names):
        """Names of all files in a folder, hidden ones included."""
        return sorted(path.name for path in self.folder.joinpath(*names).iterdir())
