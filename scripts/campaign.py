#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Attacks the library for a given time, with every kernel that this machine has.

    ninja -C build/release campaign
    scripts/campaign.py --minutes 10 [--seed S] [--build build/release] [--save FOLDER]

Hard random cases (tests/campaign/) are asked in every way the library can be asked, and every
answer is compared with rational arithmetic that shares nothing with the library. A new seed each
time unless one is given; the kernels take turns, each with cases of its own. Prints what was asked
how often. Each case with a difference is saved as a file that `campaign --replay FILE` runs again.
Exit status: 0 if all agreed, 1 if not.
"""
import argparse
import collections
import os
import pathlib
import subprocess
import sys
import time

KERNELS = ["avx512", "avx2", "sse4", "neon", "plain"]
TURN = 60.0    # seconds of one kernel before the next
GRACE = 1800.0  # seconds that the last case of a turn may take: more is an endless loop
NO_SUCH_KERNEL = 3


def run(program, kernel, arguments, limit):
    environment = dict(os.environ, PIERCE_KERNEL=kernel)
    return subprocess.run([program, *arguments], env=environment, text=True, timeout=limit,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT)


def kernels_here(program):
    here = [kernel for kernel in KERNELS
            if run(program, kernel, ["--cases", "0"], GRACE).returncode != NO_SUCH_KERNEL]
    if not here:
        sys.exit(f"{program} runs on no kernel: build it again")
    return here


class Campaign:
    """Sums over all turns."""

    def __init__(self, program, save):
        self.program, self.save = program, save
        self.counts = {"kind": collections.Counter(), "query": collections.Counter()}
        self.cases = collections.Counter()
        self.processor = 0
        self.failures = 0

    def turn(self, kernel, seed, seconds):
        arguments = ["--seed", str(seed), "--seconds", str(seconds), "--save", str(self.save)]
        try:
            done = run(self.program, kernel, arguments, seconds + GRACE)
        except subprocess.TimeoutExpired:
            self.fail(f"kernel {kernel}, seed {seed}: a case did not end")
            return
        for line in done.stdout.splitlines():
            self.note(line, kernel, seed)
        print(f"{kernel:7} {self.cases[kernel]:8,} cases; {self.processor / 60:.1f} minutes of one "
              "core in all", flush=True)
        if done.returncode not in (0, 1):
            self.fail(f"kernel {kernel}, seed {seed}: exit status {done.returncode}")

    def note(self, line, kernel, seed):
        word, *rest = line.split(" ", 2)
        if word in self.counts and len(rest) == 2:
            self.counts[word][rest[1]] += int(rest[0])
        elif word == "cases":
            self.cases[kernel] += int(rest[0])
        elif word == "processor":
            self.processor += float(rest[0])
        else:
            self.fail(f"kernel {kernel}, seed {seed}: {line}")

    def fail(self, text):
        self.failures += 1
        print(text, flush=True)

    def report(self):
        for word, counter in self.counts.items():
            for name, count in sorted(counter.items()):
                print(f"{word:6}{count:12,}  {name}")
        for kernel, count in self.cases.items():
            print(f"kernel{count:12,}  cases on {kernel}")
        answers = sum(self.counts["query"].values())
        print(f"{sum(self.cases.values()):,} cases, {answers:,} answers, {self.processor / 60:.1f} "
              f"minutes of one core, {self.failures} lines about differences")


def parse():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--minutes", type=float, required=True, help="how long, by the clock")
    parser.add_argument("--seed", type=int, help="a whole number; the same cases again")
    parser.add_argument("--build", default="build/release", help="where `campaign` was built")
    parser.add_argument("--save", default="campaign-cases", help="where cases with differences go")
    arguments = parser.parse_args()
    if arguments.seed is None:
        arguments.seed = int.from_bytes(os.urandom(4), "little")
    program = pathlib.Path(arguments.build) / "tests/campaign/campaign"
    if not program.is_file():
        parser.error(f"{program} is missing: build the target `campaign` there")
    return arguments, program.resolve()


def main():
    arguments, program = parse()
    print(f"seed {arguments.seed}", flush=True)
    campaign = Campaign(program, pathlib.Path(arguments.save).resolve())
    kernels = kernels_here(program)
    end = time.monotonic() + 60 * arguments.minutes
    turn = min(TURN, 60 * arguments.minutes / len(kernels))
    number = 0
    try:
        while time.monotonic() < end or number < len(kernels):
            kernel = kernels[number % len(kernels)]
            campaign.turn(kernel, arguments.seed * 1000 + number, turn)
            number += 1
    except KeyboardInterrupt:
        print("interrupted; up to here:")
    campaign.report()
    return 1 if campaign.failures else 0


if __name__ == "__main__":
    sys.exit(main())
