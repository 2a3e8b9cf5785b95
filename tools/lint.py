#!/usr/bin/env python3
"""Checks the sources: layout, clang-tidy, public headers, layers, links in the documentation, shell scripts.

usage: tools/lint.py [CHECK]...        (all of them by default)

clang-tidy takes its commands from build/release/compile_commands.json. Which files it found nothing in is
remembered in build/lint under a hash of all that it read, so that a second run looks only at what changed.
"""

import concurrent.futures
import hashlib
import json
import os
import pathlib
import re
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
CLANG_FORMAT = "clang-format-22"
CLANG_TIDY = "clang-tidy-22"
# clang does not know all of gcc's warnings; gcc's standard headers use parts that clang knows to be deprecated;
# and double to long double is a promotion to clang, while gcc warns of what costs: float to double.
TIDY_ARGUMENTS = [f"--extra-arg=-Wno-{name}" for name in
                  ("unknown-warning-option", "deprecated-declarations", "double-promotion")]
MAX_PUBLIC_HEADERS = 10
FOLDERS = ("include", "src", "apps", "bindings", "bench", "tests", "examples", "docs", "cmake", "tools")

# Which folders of src/ a folder may include from, besides itself: arrows point one way.
LAYERS = {
    "include/carom": (),
    "src/collision": (),
    "src/space": ("collision",),
    "src/contact": ("collision", "space"),
    "src/impact": ("collision", "space", "contact"),
    "src/world": ("collision", "space", "contact", "impact"),
    "src/observe": ("collision",),
    "src/scene": ("collision",),
    "src/validate": ("collision", "scene"),
    "apps/viewer/render": (),
    "apps/viewer": ("collision", "scene"),
    "apps/carom": ("scene", "validate"),
}
SRC_FOLDERS = ("collision", "space", "contact", "impact", "world", "observe", "scene", "validate")
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)
LINK = re.compile(r"\[[^\]]*\]\(([^)#\s]+)(?:#[^)]*)?\)")


def run(*command):
    return subprocess.run(command, cwd=ROOT, text=True, capture_output=True, check=False)


def files(*patterns):
    """Files below the folders of sources and documentation, and in the root, whose names match a pattern."""
    found = [path for pattern in patterns for path in ROOT.glob(pattern)]
    for folder in FOLDERS:
        found += [path for pattern in patterns for path in (ROOT / folder).rglob(pattern)]
    return sorted({str(path.relative_to(ROOT)) for path in found})


def includes(name):
    """Names between the brackets or quotes of a file's #include lines, with their line numbers."""
    text = (ROOT / name).read_text()
    return [(text.count("\n", 0, match.start(2)) + 1, match[2]) for match in INCLUDE.finditer(text)]


def check_format():
    """Layout as .clang-format says; `./dev format` puts it right."""
    result = run(CLANG_FORMAT, "--dry-run", "-Werror", *files("*.cpp", "*.hpp"))
    return result.stderr.splitlines() if result.returncode else []


def own_dependencies(name):
    """The file and the headers of this project that it includes, directly or not."""
    found, waiting = set(), [name]
    while waiting:
        current = waiting.pop()
        found.add(current)
        for _, included in includes(current):
            for folder in ("include", "src", "apps", "tests", os.path.dirname(current)):
                path = os.path.normpath(os.path.join(folder, included))
                if path not in found and (ROOT / path).is_file():
                    waiting.append(path)
    return sorted(found)


def tidy(entry, common):
    """Runs clang-tidy on one file, unless it found nothing in the very same text before."""
    name = os.path.relpath(entry["file"], ROOT)
    key = hashlib.sha256(common + entry["command"].encode())
    for dependency in own_dependencies(name):
        key.update(dependency.encode() + (ROOT / dependency).read_bytes())
    stamp = ROOT / "build/lint" / key.hexdigest()
    if stamp.exists():
        return []
    result = run(CLANG_TIDY, "--quiet", "-p", "build/release", *TIDY_ARGUMENTS, name)
    if result.returncode == 0:
        stamp.touch()
        return []
    return (result.stdout.strip() or result.stderr.strip()).splitlines()


def check_tidy():
    """clang-tidy with .clang-tidy, over every file that a release build compiles."""
    (ROOT / "build/lint").mkdir(parents=True, exist_ok=True)
    commands = json.loads((ROOT / "build/release/compile_commands.json").read_text())
    known = set(files("*.cpp"))
    entries = [entry for entry in commands if os.path.relpath(entry["file"], ROOT) in known]
    version = run(CLANG_TIDY, "--version").stdout
    common = f"{version}{TIDY_ARGUMENTS}{(ROOT / '.clang-tidy').read_text()}".encode()
    findings = []
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for done, found in enumerate(pool.map(lambda entry: tidy(entry, common), entries), 1):
            print(f"   clang-tidy [{done}/{len(entries)}]", flush=True)
            findings += found
    # A finding in a header is reported once for every file that includes it.
    return list(dict.fromkeys(findings))


def check_headers():
    """The public headers: few, and without anything of third parties inside."""
    headers = [name for name in files("*.hpp") if name.startswith("include/carom/")]
    findings = []
    if len(headers) > MAX_PUBLIC_HEADERS:
        findings.append(f"include/carom: {len(headers)} headers, at most {MAX_PUBLIC_HEADERS} are allowed")
    for name in headers:
        for line, included in includes(name):
            standard = "/" not in included and "." not in included
            if not standard and not included.startswith("carom/"):
                findings.append(f"{name}:{line}: {included} is neither carom's nor the standard library's")
    return findings


def check_layers():
    """Nothing includes from a folder above its own."""
    findings = []
    for folder, below in LAYERS.items():
        allowed = (*below, os.path.basename(folder))
        for name in (name for name in files("*.cpp", "*.hpp") if name.startswith(folder + "/")):
            for line, included in includes(name):
                target = included.split("/")[0]
                if "/" in included and target in SRC_FOLDERS and target not in allowed:
                    findings.append(f"{name}:{line}: {folder} must not know {target}")
    return findings


def check_links():
    """Relative links in the documentation lead to files."""
    findings = []
    for name in files("*.md"):
        for target in LINK.findall((ROOT / name).read_text()):
            if not re.match(r"[a-z]+:", target) and not (ROOT / os.path.dirname(name) / target).exists():
                findings.append(f"{name}: no such file: {target}")
    return findings


def check_scripts():
    """shellcheck on the shell scripts."""
    result = run("shellcheck", "dev", ".ci/run", *files("*.sh"))
    return result.stdout.splitlines()


CHECKS = {
    "format": check_format,
    "headers": check_headers,
    "layers": check_layers,
    "links": check_links,
    "scripts": check_scripts,
    "tidy": check_tidy,
}


def main():
    chosen = sys.argv[1:] or list(CHECKS)
    if unknown := set(chosen) - set(CHECKS):
        sys.exit(f"lint: unknown check {', '.join(sorted(unknown))}; there are: {', '.join(CHECKS)}")
    failed = []
    for name in chosen:
        findings = CHECKS[name]()
        print("\n".join(findings + [f"lint: {name}: {'FAILED' if findings else 'ok'}"]), flush=True)
        if findings:
            failed.append(name)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
