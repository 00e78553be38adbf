#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs one Gappa script with the constants of src/predicate/bounds.h put in front of it.

usage: run_proof.py --bounds PRINT_BOUNDS [--seconds N] SCRIPT.g
           exit status 0 if every property is proved
       run_proof.py --bounds PRINT_BOUNDS --can-fail SCRIPT.g
           exit status 0 if the proof fails as soon as any constant it names is weakened: to a
           quarter, or as WEAKER says
"""
import argparse
import pathlib
import re
import shutil
import subprocess
import sys

# The powers of two that make a constant weaker, if not a quarter. Floors against underflow have
# that much room and more; nearer than kNearestFarthest more is left out.
WEAKER = {"kSmallestSlope": [44], "kFarthestOrigin": [2], "kNearOrigin": [-2, 2],
          "kKeptOrigin": [2], "kMoveError": [-6], "kTauFloorKept": [-50], "kSmallestReach": [-90],
          "kAxisFloor": [-50], "kSideFloor": [-80], "kRangeFloor": [-80], "kNearestShortest": [-60],
          "kNearestFarthest": [-30], "kLargestBlur": [4], "kSmallestComponent": [-240]}
# Factors a little above 1: what they are above it, to a quarter.
FACTORS = ["kNearestRoom"]
QUIET = ["-Wno-hint-difference", "-Wno-null-denominator", "-Eno-auto-dichotomy"]


def constants(program):
    """name -> (m, e), the value being m 2^e."""
    text = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    return {name: (int(m), int(e))
            for name, m, e in re.findall(r"^(\w+) = (-?\d+)b(-?\d+);$", text, re.M)}


def prove(script, values, seconds):
    """(proved, what Gappa said)."""
    code = re.sub(r"#.*", "", script)
    used = {name: value for name, value in values.items() if re.search(rf"\b{name}\b", code)}
    unknown = set(re.findall(r"\bk[A-Z]\w*\b", code)) - set(used)
    if unknown:
        return False, f"no such constant in bounds.h: {', '.join(sorted(unknown))}"
    head = "".join(f"{name} = {m}b{e};\n" for name, (m, e) in used.items())
    try:
        run = subprocess.run(["gappa", *QUIET], input=head + script, capture_output=True,
                             text=True, timeout=seconds)
    except subprocess.TimeoutExpired:
        return False, f"no proof found in {seconds} s"
    return run.returncode == 0, run.stderr + run.stdout


def weakened(name, m, e):
    """The values that the proof must not do with."""
    if name in FACTORS:
        one = 1 << -e
        return [(4 * one + (m - one), e - 2)]
    return [(m, e + by) for by in WEAKER.get(name, [-2])]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--bounds", required=True)
    parser.add_argument("--can-fail", action="store_true")
    parser.add_argument("--seconds", type=int, default=300, help="after which a proof is given up")
    parser.add_argument("script", type=pathlib.Path)
    options = parser.parse_args()
    if shutil.which("gappa") is None:
        sys.exit("gappa is missing: apt-get install gappa")
    script = options.script.read_text(encoding="utf-8")
    values = constants(options.bounds)
    if not options.can_fail:
        proved, said = prove(script, values, options.seconds)
        if not proved:
            sys.exit(f"{options.script.name}: not proved\n{said}")
        return
    code = re.sub(r"#.*", "", script)
    names = [name for name in values if re.search(rf"\b{name}\b", code)]
    for name in names:
        proved = all(prove(script, {**values, name: value}, 10)[0]
                     for value in weakened(name, *values[name]))
        print(f"{options.script.name} {name}: {'STILL PROVED' if proved else 'noticed'}")
        if proved:
            sys.exit(f"{options.script.name} does not need {name}: weakened, all is still proved")
    if not names and "cull_inputs" not in options.script.name:
        sys.exit(f"{options.script.name} names no constant")


if __name__ == "__main__":
    main()
