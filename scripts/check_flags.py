#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds the compiler to the arithmetic that the proofs assume.

Every object of the project is compiled with -ffp-contract=off (but for the contenders of the
benchmark, which are built as their own users build them) and without any flag that lets the
compiler change the value of a floating-point expression, be it undone by a later one; every .cpp
under src/exact and src/predicate is in the build; no source asks for such a change by itself
(pragma, attribute); and g++ gets -fno-tree-slp-vectorize, for the reason in
cmake/pierce_flags.cmake. (src/exact/arithmetic.h refuses other people's -ffast-math.)

usage: check_flags.py ROOT COMPILE_COMMANDS.json     exit status 1 and one line for every offence
       check_flags.py --self-test                    proves that each rule can fail
"""
import json
import pathlib
import re
import shlex
import sys

import self_test

CHANGES_VALUES = {
    "-ffast-math", "-Ofast", "-funsafe-math-optimizations", "-fassociative-math",
    "-freciprocal-math", "-ffinite-math-only", "-fno-signed-zeros", "-fno-honor-nans",
    "-fno-honor-infinities", "-fapprox-func", "-m32", "-mdaz-ftz", "-fcx-limited-range",
    "-fsingle-precision-constant",
}
# Flags that take a value: the values that change nothing.
HARMLESS_VALUES = {
    "-ffp-contract": {"off"}, "-ffp-model": {"strict"}, "-fexcess-precision": {"standard", "16"},
    "-ffp-eval-method": {"source"}, "-mfpmath": {"sse"}, "-mrecip": {"none"},
    "-fdenormal-fp-math": {"ieee", "ieee,ieee"}, "-fdenormal-fp-math-f32": {"ieee", "ieee,ieee"},
}
ASKS_IN_SOURCE = re.compile(
    r"#\s*pragma\s+(STDC\s+FP_CONTRACT\s+ON|GCC\s+optimize|float_control|fp_contract"
    r"|clang\s+fp)|optimize\s*\(\s*\"|_MM_SET_(FLUSH|DENORMALS)")
EXACT_FOLDERS = ("src/exact", "src/predicate")


def changes_values(flag):
    name, _, value = flag.partition("=")
    return flag in CHANGES_VALUES or value not in HARMLESS_VALUES.get(name, {value})


def arguments_of(entry):
    return entry.get("arguments") or shlex.split(entry["command"])


def check_commands(root, commands, found):
    compiled = set()
    for entry in commands:
        path = pathlib.Path(entry["directory"], entry["file"]).resolve()
        if not path.is_relative_to(root):
            continue
        name = path.relative_to(root).as_posix()
        compiled.add(name)
        arguments = arguments_of(entry)
        for flag in sorted(filter(changes_values, set(arguments))):
            found.append(f"{name}: compiled with {flag}")
        # The first may be ccache, or env, a variable and ccache.
        is_clang = any("clang" in word for word in arguments[:4])
        if name.startswith("src/") and not is_clang and "-fno-tree-slp-vectorize" not in arguments:
            found.append(f"{name}: compiled by g++ without -fno-tree-slp-vectorize")
        contender = (name.startswith("bench/contenders/") or name.endswith("_peer.cpp")
                     or re.match(r"bench/\w+/cgal_\w+\.cpp$", name) is not None)
        if "-ffp-contract=off" not in arguments and not contender:
            found.append(f"{name}: compiled without -ffp-contract=off")
    for folder in EXACT_FOLDERS:
        for path in sorted((root / folder).glob("**/*.cpp")):
            name = path.relative_to(root).as_posix()
            if name not in compiled:
                found.append(f"{name}: is not in the build")


def check(root, database=None):
    """All offences under root, as lines of text."""
    found = []
    root = pathlib.Path(root).resolve()
    commands = json.loads((database or root / "compile_commands.json").read_text("utf-8"))
    check_commands(root, commands, found)
    for folder in ("src", "include"):
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in {".h", ".cpp"} and ASKS_IN_SOURCE.search(path.read_text("utf-8")):
                found.append(f"{path.relative_to(root)}: asks for other arithmetic in the source")
    return found


NO_SLP = "-fno-tree-slp-vectorize"


def database(flags, compiler="g++"):
    file = "src/exact/sum.cpp"
    return json.dumps([{"directory": ".", "file": file, "arguments": [compiler, *flags, file]}])


def sample_check(root):
    """A sample moves, and the database names folders: point it to where the sample is."""
    path = root / "compile_commands.json"
    path.write_text(path.read_text().replace('"directory": "."', f'"directory": "{root}"'))
    return check(root)


SOURCE = "int sum();\n"
GOOD = {"src/exact/sum.cpp": SOURCE, "include/pierce/a.h": SOURCE,
        "compile_commands.json": database(["-ffp-contract=off", NO_SLP])}
BAD = {f"{flag}": ("compile_commands.json", database(["-ffp-contract=off", NO_SLP, flag]))
       for flag in sorted(CHANGES_VALUES) + [
           "-ffp-contract=fast", "-ffp-contract=on", "-ffp-contract=fast-honor-pragmas",
           "-ffp-model=fast", "-ffp-model=precise", "-ffp-model=aggressive",
           "-fexcess-precision=fast", "-ffp-eval-method=extended", "-mfpmath=387",
           "-mfpmath=sse,387", "-mfpmath=both", "-mrecip", "-mrecip=all",
           "-fdenormal-fp-math=preserve-sign", "-fdenormal-fp-math=positive-zero",
           "-fdenormal-fp-math-f32=preserve-sign"]}
BAD |= {
    "contraction left on": ("compile_commands.json", database([NO_SLP])),
    "g++ as it comes": ("compile_commands.json", database(["-ffp-contract=off"])),
    "a file outside the build": ("src/predicate/decide.cpp", SOURCE),
    "a pragma": ("src/exact/sum.cpp", "#pragma STDC FP_CONTRACT ON\n"),
    "an attribute": ("src/exact/sum.cpp", '[[gnu::optimize("fast-math")]] int f();\n'),
    "flushing to zero": ("src/exact/sum.cpp", "_MM_SET_FLUSH_ZERO_MODE(_MM_FLUSH_ZERO_ON);\n"),
}

if __name__ == "__main__":
    if len(sys.argv) == 3:
        offences = check(sys.argv[1], pathlib.Path(sys.argv[2]))
        print(*offences, sep="\n", end="\n" if offences else "")
        sys.exit(1 if offences else 0)
    if sys.argv[1:] != ["--self-test"]:
        sys.exit(__doc__)
    sys.exit(self_test.main(sample_check, GOOD, BAD, pathlib.Path(__file__)))
