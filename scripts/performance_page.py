#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes docs/performance.md and its plots from what `pierce bench` measured, and README's figures.

    build/release/tool/pierce bench --suite --json docs/performance.json
    PIERCE_KERNEL=avx2 build/release/tool/pierce bench --suite --json docs/performance_avx2.json
    scripts/performance_page.py docs/performance.json docs/performance_avx2.json

Everything on the page comes from the JSON, and so does what stands between the marks in README.md.
The first file is told in full; of others, with other kernels or from other machines
(docs/performance_amd_25_17_avx512.json), the ratios.
Needs nothing but Python.
"""
import argparse
import json
import math
import pathlib
import re
import statistics
import sys

from performance_plot import COLORS, plot

# (one, other, ray sets or None for all, must of each cell, aim of the geometric mean, words)
COMPARISONS = [
    ("pierce", "embree", None, 1.0, 1.4, "ray by ray, against Embree's fast mode"),
    ("pierce", "embree-robust", None, None, None, "ray by ray, against Embree's robust mode"),
    ("pierce-batch", "embree-16", ("primary", "rows"), 1.0, 1.3,
     "batches of camera rays, against Embree's coherent packets of 16"),
    ("pierce-batch", "embree", ("bounce", "random"), 1.2, 2.0,
     "batches of incoherent rays, against Embree's fast mode ray by ray"),
    ("pierce", "embree4", None, None, None, "ray by ray, against Embree 4 (fast)"),
    ("pierce-batch", "embree4", ("bounce", "random"), None, None,
     "batches of incoherent rays, against Embree 4 ray by ray"),
    ("pierce-batch", "pierce", None, 1.0, None, "a batch, against its own rays one by one"),
    ("pierce-double", "pierce", None, 0.7, 0.9,
     "double scene, against the float scene, ray by ray"),
    ("pierce-double-batch", "pierce-batch", None, 0.7, 0.9,
     "double scene, against the float scene, batches"),
    ("pierce-batch-all", "pierce-batch", None, None, None, "all threads, against one"),
    ("pierce", "cgal", None, None, None, "ray by ray, against CGAL's AABB tree"),
]

def speeds(timing):
    return [timing["rays"] / s for s in timing["seconds"]]


def paired_ratio(one, other):
    """The median over the rounds of the ratio of speeds within a round."""
    return statistics.median(a / b for a, b in zip(speeds(one), speeds(other)))


def comparable(data, one, other):
    """Threads are timed by the wall, so beside the CPU's clock they say nothing."""
    return data["clock"] == "wall" or one["threads"] == other["threads"]


def cells(data):
    for mesh in data["meshes"]:
        for cell in mesh["cells"]:
            yield mesh, cell, {t["contender"]: t for t in cell["timings"]}


def contenders_of(data):
    names = []
    for _, _, timings in cells(data):
        names += [name for name in timings if name not in names]
    return names


def table(head, rows):
    """Markdown; the first column to the left, the others to the right."""
    lines = ["| " + " | ".join(head) + " |", "| --- |" + " ---: |" * (len(head) - 1)]
    return lines + ["| " + " | ".join(row) + " |" for row in rows]


def speed_text(per_second):
    millions = per_second * 1e-6
    return f"{millions:.1f}" if millions >= 10 else f"{millions:.2f}" if millions >= 0.1 \
        else f"{millions:.4f}"


def mean_of(ratios):
    """The geometric mean."""
    return math.exp(statistics.fmean(math.log(r) for r in ratios))


def ratios_of(data, comparison):
    """What a comparison found: (ratio, mesh, cell) for each of its cells."""
    one, other, sets = comparison[:3]
    return [(paired_ratio(timings[one], timings[other]), mesh["mesh"], cell)
            for mesh, cell, timings in cells(data)
            if one in timings and other in timings and (not sets or cell["set"] in sets)
            and comparable(data, timings[one], timings[other])]


def ratio_section(data, first=None):
    machine = data["machine"]
    lines = [f"## Ratios: {on_which(data)}", ""]
    if first and machine["commit"] != first["machine"]["commit"]:
        lines += [f"Measured {machine['date']} at commit {machine['commit']}.", ""]
    lines += ["Speed of the first over that of the second; each is the median over the rounds of",
              "the ratio within a round. *Must* is what each cell has to reach, *aim* what the",
              "geometric mean should.", ""]
    rows, details = [], []
    for comparison in COMPARISONS:
        one, other, _, must, aim, words = comparison
        ratios = ratios_of(data, comparison)
        if not ratios:
            continue
        least, mesh, cell = min(ratios, key=lambda r: r[0])
        mean = mean_of(r[0] for r in ratios)
        rows.append([words, str(len(ratios)), f"{mean:.2f}",
                     f"{least:.2f} ({mesh}, {cell['set']}, {cell['query']})",
                     "" if must is None else f"{must:g}" + (" kept" if least >= must
                                                              else " **missed**"),
                     "" if aim is None else f"{aim:g}" + (" kept" if mean >= aim else " missed")])
        details += ["", f"`{one}` / `{other}`: {words}.", ""]
        columns = []
        for r, _, c in ratios:
            key = f"{c['set']} {c['query']}"
            columns += [key] if key not in columns else []
        meshes = list(dict.fromkeys(m for _, m, _ in ratios))
        found = {(m, f"{c['set']} {c['query']}"): r for r, m, c in ratios}
        details += table(["mesh"] + columns,
                         [[m] + [f"{found[m, c]:.2f}" if (m, c) in found else "" for c in columns]
                          for m in meshes])
    lines += table(["comparison", "cells", "geometric mean", "least", "must", "aim"], rows)
    return lines + details + [""]


def build_section(data):
    lines = ["## Building and memory", "",
             "Median build time, all threads; bytes a triangle beside the caller's mesh (Embree's",
             "by its own memory monitor, CGAL's by the sizes of what it keeps); expected cost of a",
             "random ray by the surface area heuristic, where the engine tells.", ""]
    rows = []
    for mesh in data["meshes"]:
        for build in mesh["builds"]:
            sah = build.get("sah_cost")
            rows.append([mesh["mesh"], build["engine"], f"{mesh['triangles']:,}",
                         f"{build['mtri_per_second']:.2f}", f"{build['bytes_per_triangle']:.1f}",
                         f"{sah:.1f}" if sah else ""])
    lines += table(["mesh", "engine", "triangles", "Mtri/s", "bytes/triangle", "SAH cost"], rows)
    return lines + [""]


def speed_section(data):
    names = contenders_of(data)
    lines = ["## Speeds", "",
             "Millions of rays a second: the median, with the quartiles below it.", ""]
    for mesh in data["meshes"]:
        rows = []
        for cell in mesh["cells"]:
            timings = {t["contender"]: t for t in cell["timings"]}
            row = [f"{cell['set']} {cell['query']} ({100 * cell['hits'] / cell['rays']:.0f} % hit)"]
            for name in names:
                t = timings.get(name)
                row.append("" if t is None else
                           f"{speed_text(t['rays_per_second'])}<br><sub>"
                           f"{speed_text(t['lower_quartile'])} to "
                           f"{speed_text(t['upper_quartile'])}</sub>")
            rows.append(row)
        lines += [f"### {mesh['mesh']}: {mesh['triangles']:,} triangles", ""]
        lines += table(["rays"] + names, rows) + [""]
    return lines


def wrong_answers(data):
    """Of each contender: how many answers were compared, missed, invented, another."""
    sums = {}
    for _, _, timings in cells(data):
        for name, t in timings.items():
            total = sums.setdefault(name, [0, 0, 0, 0])
            for i, key in enumerate(("compared", "missed", "invented", "other_triangle")):
                total[i] += t[key]
    return sums


def wrong_section(data):
    rows = [[name] + [f"{n:,}" for n in total] for name, total in wrong_answers(data).items()]
    lines = ["## Wrong answers", "",
             "Answers were compared before anything was timed. pierce's batches, threads and",
             "double scenes agree with its single rays bit by bit, or nothing would have been",
             "timed. The others' answers were counted: *missed* a hit, *invented* one, or named",
             "*another* triangle, at another t, than the nearest.", ""]
    return lines + table(["contender", "compared", "missed", "invented", "another"], rows) + [""]


def ladder_section(data):
    lines = ["## What each rung of the ladder saw", "",
             "Sums over all ray sets of a mesh, one query of each kind a ray.", ""]
    keys = ("rays", "nodes", "leaves", "candidates", "certified", "settled", "settled_big",
            "orders_certified", "orders_settled", "hits", "rounded_exactly")
    rows = []
    for mesh in data["meshes"]:
        ladders = [c["ladder"] for c in mesh["cells"] if "ladder" in c]
        if ladders:
            rows.append([mesh["mesh"]] + [f"{sum(l[k] for l in ladders):,}" for k in keys])
    if not rows:
        return []
    return lines + table(["mesh"] + [k.replace("_", " ") for k in keys], rows) + [""]


def bars_of_cells(data):
    """For each cell its label and the ratio of each contender to Embree's fast mode."""
    return [(f"{m['mesh']}  {c['set']}/{c['query']}",
             {name: paired_ratio(t[name], t["embree"]) for name in t if name in COLORS})
            for m, c, t in cells(data) if "embree" in t]


def bars_of_means(data):
    """The same for each kind of rays and query: geometric means over the meshes."""
    kinds = {}
    for _, c, t in cells(data):
        for name in t:
            if name in COLORS and "embree" in t:
                means = kinds.setdefault(f"{c['set']} {c['query']}", {})
                means.setdefault(name, []).append(paired_ratio(t[name], t["embree"]))
    return [(kind, {name: mean_of(ratios) for name, ratios in means.items()})
            for kind, means in kinds.items()]


def flags_of(data):
    """The options of this measurement that are not the defaults of --suite."""
    flags = [f" --{name} {data[key]}" for name, key, usual in
             (("rounds", "rounds", 5), ("build-rounds", "build_rounds", 7), ("side", "side", 1024))
             if data.get(key, usual) != usual]
    return "".join(flags) + ("" if data["clock"] == "wall" else " --cpu-clock")


def processor(data):
    """Who made it, and which it is of theirs: its family and model."""
    cpu = data["machine"]["cpu"]
    maker = re.match(r"\w+", cpu)[0]
    which = re.search(r"family (\d+) model (\d+)", cpu)
    return f"{maker} {which[1]}-{which[2]}" if which else maker


def on_which(data):
    return f"{data['machine']['cpu']}, {data['machine']['kernel']}"


def sources(all_data):
    """Where the JSON of each kernel and machine lies, the first one's first."""
    def name(data):
        kernel = data["machine"]["kernel"]
        here = data["machine"]["cpu"] == all_data[0]["machine"]["cpu"]
        which = re.sub(r"\W", "_", processor(data).lower())
        return f"docs/performance_{kernel if here else f'{which}_{kernel}'}.json"
    return ["docs/performance.json"] + [name(d) for d in all_data[1:]]


def commands(all_data):
    lines = []
    for data, source in zip(all_data, sources(all_data)):
        if data["machine"]["cpu"] != all_data[0]["machine"]["cpu"]:
            continue
        kernel = "" if data is all_data[0] else f"PIERCE_KERNEL={data['machine']['kernel']} "
        lines += [f"{kernel}build/release/tool/pierce bench --suite{flags_of(data)} \\",
                  f"  --json {source}"]
    return lines + ["scripts/performance_page.py " + " \\\n  ".join(sources(all_data))]


def page(all_data, picture):
    data = all_data[0]
    machine = data["machine"]
    lines = ["# Performance", "",
             "<!-- Made by scripts/performance_page.py: do not edit. -->", "",
             f"Measured {machine['date']} at commit {machine['commit']} on {machine['cpu']},",
             f"{machine['cores']} cores ({machine['caches']}, {machine['memory']}), "
             f"{machine['compiler']}, kernel {machine['kernel']}. Queries on one thread,",
             "unless a name says otherwise.", "",
             f"![Speeds relative to Embree's fast mode]({picture})", "",
             "Speeds relative to Embree's fast mode, ray by ray (the line at 1); further to the",
             "right is faster.", "", "## How", "",
             "Meshes x ray sets x queries x contenders, each contender set up as its own manual",
             "advises (Embree: denormals flushed, shared buffers, coherent flag on packets). All",
             "answers are compared first, which is the warm-up, too. Then the contenders take",
             f"turns in one process, {data['rounds']} rounds, another one beginning each; sets of",
             "fewer than 2^19 rays are cast once before, not timed. CGAL answers 2^14 of each",
             "set's rays, evenly spread. "
             + ("Time is wall time." if data["clock"] == "wall" else
                "Time is the thread's CPU\ntime, for the machine was shared."), "",
             "To reproduce, on a machine that does nothing else:", "", "```",
             "cmake --preset release && cmake --build --preset release",
             *commands(all_data), "```", "",
             "A single cell, while tuning:", "", "```",
             "pierce bench --meshes bunny --sets primary --queries closest "
             "--contenders pierce,embree",
             "```", ""]
    lines += ratio_section(data)
    for other in all_data[1:]:
        lines += ratio_section(other, data)
    lines += build_section(data) + speed_section(data)
    lines += wrong_section(data) + ladder_section(data)
    lines += ["## The machine", ""]
    lines += table(["", ""], [[k, f"`{v}`"] for k, v in machine.items()])
    return "\n".join(lines) + "\n"


README_WORDS = {
    ("pierce", "embree"): "one ray at a time | Embree, fast mode",
    ("pierce", "embree-robust"): "one ray at a time | Embree, robust mode",
    ("pierce-batch", "embree-16"): "a batch of camera rays | Embree, coherent packets of 16",
    ("pierce-batch", "embree"): "a batch of incoherent rays | Embree, fast mode, ray by ray",
    ("pierce-batch", "pierce"): "a batch | its own rays, one by one",
    ("pierce", "cgal"): "one ray at a time | CGAL's AABB tree, exact predicates",
}


def times_as_fast(data, comparison):
    """The mean, and the least to the most; empty if it was not measured."""
    ratios = [r[0] for r in ratios_of(data, comparison)]
    return f"{mean_of(ratios):.2f} ({min(ratios):.2f} to {max(ratios):.2f})" if ratios else ""


def readme_figures(all_data):
    """The table for README: who is how fast, and how many answers were wrong."""
    data = all_data[0]
    wrong = wrong_answers(data)
    rows = []
    for comparison in COMPARISONS:
        one, other = comparison[:2]
        if (one, other) in README_WORDS and times_as_fast(data, comparison):
            compared, *errors = wrong[other]
            rows.append([*README_WORDS[one, other].split(" | "),
                         *[times_as_fast(d, comparison) for d in all_data],
                         f"{sum(errors):,} of {compared:,}"])
    heads = [f"times as fast, {processor(d)} {d['machine']['kernel']}" for d in all_data]
    machines = dict.fromkeys((d["machine"]["cpu"], d["machine"]["date"][:10]) for d in all_data)
    measured = "; ".join(f"{cpu}, {date}" for cpu, date in machines)
    return [f"One thread. {measured}. Of pierce's own "
            f"{wrong['pierce'][0]:,} answers {sum(wrong['pierce'][1:]) or 'none'} are wrong.", "",
            *table(["pierce", "beside", *heads, "their wrong answers"], rows)]


def put_between_marks(path, lines):
    text = path.read_text(encoding="utf-8")
    begin, end = "<!-- figures: begin (scripts/performance_page.py) -->", "<!-- figures: end -->"
    block = "\n".join([begin, "", *lines, "", end])
    text, found = re.subn(re.escape(begin) + ".*?" + re.escape(end), lambda _: block, text,
                          flags=re.S)
    if found != 1:
        sys.exit(f"performance_page.py: {path}: the marks are not there")
    path.write_text(text, encoding="utf-8")


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("json", type=pathlib.Path, nargs="+", help="from pierce bench --json")
    root = pathlib.Path(__file__).resolve().parent.parent
    parser.add_argument("--out", type=pathlib.Path, default=root / "docs" / "performance.md")
    arguments = parser.parse_args()
    all_data = []
    for path in arguments.json:
        try:
            all_data.append(json.loads(path.read_text(encoding="utf-8")))
        except (OSError, ValueError) as error:
            sys.exit(f"performance_page.py: {path}: {error}; "
                     "make it with pierce bench --suite --json FILE")
    data = all_data[0]
    picture = arguments.out.with_suffix(".svg")
    names = [n for n in contenders_of(data) if n in COLORS]
    picture.write_text(plot(names, bars_of_cells(data)), encoding="utf-8")
    means = arguments.out.with_name(arguments.out.stem + "_means.svg")
    means.write_text(plot(names, bars_of_means(data)), encoding="utf-8")
    arguments.out.write_text(page(all_data, picture.name), encoding="utf-8")
    print(f"{arguments.out}\n{picture}\n{means}")
    if arguments.out.parent == root / "docs":
        put_between_marks(root / "README.md", readme_figures(all_data))
        print(root / "README.md")


if __name__ == "__main__":
    main()
