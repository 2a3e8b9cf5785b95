"""What bench/run and bench/compare share."""

import json
import subprocess
import sys


def json_of(*command):
    """What a program prints as JSON. Its errors go to the terminal, and end this program with its exit code."""
    done = subprocess.run([str(word) for word in command], stdout=subprocess.PIPE, check=False)
    if done.returncode != 0:
        sys.exit(done.returncode if done.returncode > 0 else f"{command[0]}: killed by signal {-done.returncode}")
    return json.loads(done.stdout)


def progress(text):
    """Shows what goes on, on a terminal, in a line that the next one overwrites."""
    if sys.stderr.isatty():
        print(f"\r\033[K{text}", end="", file=sys.stderr, flush=True)
