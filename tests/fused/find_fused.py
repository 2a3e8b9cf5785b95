#!/usr/bin/env python3
"""Looks through machine code for what would make results differ from one machine to another.

FILEs are objects, archives, libraries or programs for x86-64 or aarch64. Looked for, in code of every instruction set:
fused multiply-adds, which round once where other code rounds twice; approximate reciprocals and square roots, which
each maker of processors defines for itself; x87 arithmetic, which keeps more digits; and calls of those functions of
the C library that are not rounded correctly, so that each version rounds as it likes. Exit status: 0 nothing found,
1 something found and listed, 2 a file could not be searched.
"""

import argparse
import re
import subprocess
import sys

INSTRUCTIONS = {
    "x86-64": {
        "fused multiply-add": r"v4?f[nc]?m(add|sub|ul)\w*",
        "approximation": r"v?(rcp|rsqrt)\w*|vexp2p[sd]",
        "x87 arithmetic": r"fi?(add|subr?|mul|divr?)p?[sl]?|fsqrt|fscale|fprem1?",
    },
    "aarch64": {
        # fmadd and fnmsub are scalar, fmla is NEON's and SVE's, fmad and fmsb are SVE's, bf... compute with bfloat16.
        "fused multiply-add": r"f(n?m(add|sub|la|ls|ad|sb)|cmla|mmla|ml[as]l)\w*|bf(ml|mmla|dot)\w*",
        "approximation": r"f(recp[es]|rsqrt[es])",
    },
}
C_LIBRARY = re.compile(r"(a?(sin|cos|tan)h?|sincos|atan2|exp(2|10|m1)?|log(2|10|1p)?|pow|cbrt|hypot|erfc?|[lt]gamma|fma)"
                       r"[fl]?")

FORMAT = re.compile(r"file format elf64-(?:little)?(\S+)$")
FUNCTION = re.compile(r"^[0-9a-f]+ <(.*)>:$")
INSTRUCTION = re.compile(r"^ *[0-9a-f]+:\t(?:\{\w+\} )?([a-z]\w*)")
# In objects the name stands in a relocation, in linked files behind the address.
CALL = re.compile(r"(?:: R_\w+\t|<)(\w+)(?:[-+]0x[0-9a-f]+|@.*>|>)?$")


class NotSearched(Exception):
    pass


def disassembled(objdump, file):
    command = [objdump, "--disassemble", "--reloc", "--no-show-raw-insn", "--demangle", file]
    result = subprocess.run(command, text=True, errors="replace", capture_output=True, check=False)
    if result.returncode:
        raise NotSearched(result.stderr.strip().split("\n")[0])
    return result.stdout.splitlines()


def patterns_for(architecture):
    if architecture not in INSTRUCTIONS:
        raise NotSearched(f"no list of instructions for {architecture}")
    return {what: re.compile(pattern) for what, pattern in INSTRUCTIONS[architecture].items()}


def search(lines, may_call):
    """The number of instructions, and a line for each thing found."""
    count, found = 0, []
    patterns, function = {}, ""
    for line in lines:
        if match := INSTRUCTION.match(line):
            count += 1
            for what, pattern in patterns.items():
                if pattern.fullmatch(match[1]):
                    found.append(f"{what} in {function}: {line.split(chr(9), 1)[1].strip()}")
        elif match := FUNCTION.match(line):
            function = match[1]
        elif match := FORMAT.search(line):
            patterns = patterns_for(match[1])
        if (match := CALL.search(line)) and match[1] not in may_call and C_LIBRARY.fullmatch(match[1]):
            found.append(f"call of the C library in {function}: {match[1]}")
    if count == 0:
        raise NotSearched("no instructions in it")
    return count, found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--objdump", default="objdump", help="the one for the files' architecture")
    parser.add_argument("--may-call", action="append", default=[], metavar="NAME",
                        help="a function of the C library that no result depends on")
    parser.add_argument("file", nargs="+")
    arguments = parser.parse_args()
    clean = True
    for file in arguments.file:
        try:
            count, found = search(disassembled(arguments.objdump, file), arguments.may_call)
        except NotSearched as reason:
            print(f"{file}: {reason}", file=sys.stderr)
            return 2
        for line in found:
            print(f"{file}: {line}")
        print(f"{file}: {count} instructions searched, {len(found)} findings")
        clean = clean and not found
    return 0 if clean else 1


if __name__ == "__main__":
    sys.exit(main())
