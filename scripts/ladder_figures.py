#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""What one ray and one triangle cost on each rung, beside Moeller-Trumbore, GMP and CGAL.

    ninja -C build/release micro_predicate
    scripts/ladder_figures.py build/release/bench/micro_predicate

Prints the table of docs/decisions/0002-ladder.md in Markdown, all of it from one run: medians of
nine repetitions, one thread. Exit status 1 if anything of ours is wrong or slower than it may be.
"""
import argparse
import json
import pathlib
import subprocess
import sys

ROWS = [  # name, what it is, the most it may take: nanoseconds, or times another row
    ("plain_moller_trumbore/mixed", "Moeller-Trumbore, double; one in two hits", None),
    ("certify/mixed", "certify, the same cases", (2, "plain_moller_trumbore/mixed")),
    ("plain_moller_trumbore/hits", "Moeller-Trumbore, hits only", None),
    ("certify/hits", "certify, the same cases", (2, "plain_moller_trumbore/hits")),
    ("cgal_do_intersect/ordinary", "CGAL `do_intersect`; one in two hits", None),
    ("gmp_rational/ordinary", "Moeller-Trumbore over GMP rationals, the same cases", None),
    ("plain_moller_trumbore/hard_float", "Moeller-Trumbore; through an edge, floats", None),
    ("settle/hard_float", "settle, the same cases", 500),
    ("cgal_do_intersect/hard_float", "CGAL `do_intersect`, the same cases", None),
    ("gmp_rational/hard_float", "GMP rationals, the same cases", None),
    ("plain_moller_trumbore/hard_double", "Moeller-Trumbore; through an edge, doubles", None),
    ("settle/hard_double", "settle, the same cases", 3000),
    ("cgal_do_intersect/hard_double", "CGAL `do_intersect`, the same cases", None),
    ("gmp_rational/hard_double", "GMP rationals, the same cases", None),
    ("settle/wild_double", "settle; every number of another size, 2^-500 to 2^500", None),
    ("cgal_do_intersect/wild_double", "CGAL `do_intersect`, the same cases", None),
    ("gmp_rational/wild_double", "GMP rationals, the same cases", None),
    ("round<float>", "round a hit of a float scene", 30),
    ("round_batch<float>", "the same, in a batch", None),
    ("round<double>", "round a hit of a double scene", 120),
    ("round_batch<double>", "the same, in a batch", None),
    ("decide_and_round<float>", "certify and round, float", None),
    ("decide_and_round<double>", "certify and round, double", None),
]
OTHERS = ("plain_", "gmp_", "cgal_")


def measured(program):
    """From names to what the benchmark says of them, times being medians."""
    run = subprocess.run([program, "--benchmark_format=json", "--benchmark_repetitions=9",
                          "--benchmark_report_aggregates_only=true"],
                         capture_output=True, text=True, check=False)
    if run.returncode != 0:
        sys.exit(run.stderr)
    return {entry["run_name"]: entry for entry in json.loads(run.stdout)["benchmarks"]
            if entry["aggregate_name"] == "median"}


def most(limit, times):
    """What it may take, in nanoseconds, and how the table says it."""
    if limit is None:
        return float("inf"), ""
    if isinstance(limit, tuple):
        factor, other = limit
        return factor * times[other]["cpu_time"], f"{factor} x {times[other]['cpu_time']:.1f}"
    return limit, f"{limit}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("micro_predicate", type=pathlib.Path)
    times = measured(parser.parse_args().micro_predicate)
    print("| one ray, one triangle | ns | may take | wrong |\n| --- | --- | --- | --- |")
    failures = []
    for name, what, limit in ROWS:
        if name not in times:  # built without CGAL
            continue
        entry = times[name]
        limit, shown = most(limit, times)
        wrong = f"{entry['wrong']:.0f} of {entry['cases']:.0f}" if "wrong" in entry else ""
        print(f"| {what} | {entry['cpu_time']:.{1 if entry['cpu_time'] < 100 else 0}f} | {shown} | "
              f"{wrong} |")
        if entry["cpu_time"] > limit:
            failures.append(f"{name}: {entry['cpu_time']:.1f} ns, may take {limit:.1f}")
        if entry.get("wrong", 0) > 0 and not name.startswith(OTHERS):
            failures.append(f"{name}: {wrong} are wrong")
    sys.exit("\n".join(failures) if failures else 0)


if __name__ == "__main__":
    main()
