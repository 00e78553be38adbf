#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""How many lines of src/io the tests of the readers and of the tool run (g++, gcov).

Builds build/coverage with src/io counted, runs tests/unit/io_* and tests/tool/*_test.py, and prints
each file's share and the lines that were not run; 1 if fewer than --least percent were run.

usage: scripts/coverage.py [--jobs 2] [--least 95] [--no-run]
"""

import argparse
import collections
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILD = ROOT / "build" / "coverage"


def build_and_run(jobs):
    # As the preset has it, so that ccache knows the rest.
    subprocess.run(["cmake", "--preset", "release", "-B", BUILD, "-DPIERCE_COVERAGE=ON",
                    "-DPIERCE_BUILD_BENCH=OFF", "-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"],
                   cwd=ROOT, check=True, stdout=subprocess.DEVNULL)
    tests = sorted("unit_" + path.stem for path in (ROOT / "tests/unit").glob("io_*_test.cpp"))
    subprocess.run(["ninja", "-C", BUILD, f"-j{jobs}", "pierce_tool", *tests], check=True)
    for counts in BUILD.rglob("*.gcda"):
        counts.unlink()
    scripts = sorted("tool_" + path.stem for path in (ROOT / "tests/tool").glob("*_test.py"))
    subprocess.run(["ctest", "--test-dir", BUILD, f"-j{jobs}", "--output-on-failure", "-R",
                    f"^({'|'.join(tests + scripts)})$"], check=True)


def counted_lines():
    """{file: {line: how often it was run}}, all objects together."""
    lines = collections.defaultdict(collections.Counter)
    objects = sorted((BUILD / "src/io").rglob("*.gcno"))
    for counts in objects:
        told = subprocess.run(["gcov", "--json-format", "--stdout", counts], cwd=BUILD, check=True,
                              stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout
        for text in told.splitlines():
            for file in json.loads(text)["files"]:
                path = (BUILD / file["file"]).resolve()
                if path.is_relative_to(ROOT / "src/io"):
                    for line in file["lines"]:
                        lines[path][line["line_number"]] += line["count"]
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--least", type=float, default=95)
    parser.add_argument("--no-run", action="store_true", help="look at the last run again")
    options = parser.parse_args()
    if not options.no_run:
        build_and_run(options.jobs)
    ran = there = 0
    for path, counts in sorted(counted_lines().items()):
        missed = sorted(number for number, count in counts.items() if count == 0)
        ran += len(counts) - len(missed)
        there += len(counts)
        text = path.read_text(encoding="utf-8").splitlines()
        print(f"{path.name:24} {len(counts) - len(missed):5} of {len(counts):5}")
        for number in missed:
            print(f"{number:8}: {text[number - 1].strip()}")
    print(f"{100 * ran / max(there, 1):.2f} % of {there} lines")
    return 1 if there == 0 or 100 * ran < options.least * there else 0


if __name__ == "__main__":
    sys.exit(main())
