#!/usr/bin/env python3
"""Draws a picture of every scene, and a short film of some, into docs/gallery, with a page that says what they cost.

usage: tools/gallery.py [--figures] [SCENE]...     (names of scenes; all of them by default)

With --figures only what they cost is measured anew, on a machine that has nothing else to do. The figures of scenes
that are not named stay as they are.
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
CAROM = ROOT / "build/release/bin/carom"
GALLERY = ROOT / "docs/gallery"
PAGE = GALLERY / "README.md"
FIGURES = GALLERY / "figures.json"
PICTURE = ("--size", "720x405", "--supersample", "3")
# Films, and how many seconds of the world they show.
FILMS = {"drum": 6, "heap": 8, "hopper": 3, "newtons_cradle": 12, "tower": 4}
FILM = ("--size", "480x270", "--fps", "24", "--supersample", "2")


def processor():
    """What the machine calls its processor."""
    text = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8")
    name = re.search(r"^model name\s*:\s*(.*)$", text, re.MULTILINE)
    return f"{name[1] if name else 'an unknown processor'}, {os.cpu_count()} cores"


def carom(*arguments):
    return subprocess.run([CAROM, *map(str, arguments)], cwd=ROOT, check=True, text=True, stdout=subprocess.PIPE).stdout


def draw(scene):
    """Draws a scene, and makes a film of it if it is to have one."""
    carom("render", scene, "-o", GALLERY / f"{scene.stem}.png", *PICTURE)
    if scene.stem in FILMS:
        carom("render", scene, "-o", GALLERY / f"{scene.stem}.mp4", "--time", FILMS[scene.stem], *FILM)


def measure(scene):
    """Runs a scene as it is. Returns what the run took."""
    with tempfile.TemporaryDirectory() as folder:
        run = json.loads(carom("run", scene, "--out", folder, "--json"))
    return {"bodies": run["bodies"], "steps": run["steps"], "impacts": run["impacts"],
            "nanoseconds": round(run["ns_per_body_step"]), "machine": processor()}


def grouped(number):
    return f"{number:,}".replace(",", " ")


def first_words(scene):
    """The remark that a scene file begins with, up to its first empty line."""
    lines = []
    for line in scene.read_text(encoding="utf-8").splitlines():
        if not line.startswith("# "):
            break
        lines.append(line[2:])
    return " ".join(lines)


def entry(scene, figures):
    title = tomllib.loads(scene.read_text(encoding="utf-8"))["title"]
    film = f" [A film of it]({scene.stem}.mp4)." if scene.stem in FILMS else ""
    return (f"## {title}\n\n![{title}]({scene.stem}.png)\n\n{first_words(scene)}{film}\n\n"
            f"*{grouped(figures['bodies'])} bodies, {grouped(figures['nanoseconds'])} ns per body and step on average of "
            f"{grouped(figures['steps'])} steps, with {grouped(figures['impacts'])} impacts; {figures['machine']}. "
            f"[scenes/{scene.name}](../../scenes/{scene.name})*\n")


def main():
    scenes = sorted((ROOT / "scenes").glob("*.toml"))
    only_figures = "--figures" in sys.argv
    names = [name for name in sys.argv[1:] if name != "--figures"] or [scene.stem for scene in scenes]
    if unknown := set(names) - {scene.stem for scene in scenes}:
        sys.exit(f"gallery: no scene {', '.join(sorted(unknown))}")
    GALLERY.mkdir(parents=True, exist_ok=True)
    figures = json.loads(FIGURES.read_text(encoding="utf-8")) if FIGURES.exists() else {}
    for scene in scenes:
        if scene.stem in names:
            print(f"   {scene.stem}", flush=True)
            if not only_figures:
                draw(scene)
            figures[scene.stem] = measure(scene)
    figures = {scene.stem: figures[scene.stem] for scene in scenes if scene.stem in figures}
    FIGURES.write_text(json.dumps(figures, indent=4) + "\n", encoding="utf-8")
    page = ("# The scenes\n\nDrawn by `./dev gallery` with `carom render`, each as its `[camera]` and `[picture]` say. "
            "A body that is hardly ever met costs less than one in a crowd.\n\n")
    page += "\n".join(entry(scene, figures[scene.stem]) for scene in scenes if scene.stem in figures)
    PAGE.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
