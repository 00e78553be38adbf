#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Weakens each bound and takes out each fallback, one at a time, and asks which test notices.

Works in a copy of the tree, built once: bounds change with an environment variable, each fallback
rebuilds what it touches (about a minute). Then the tests that are concerned run, and the proofs.
The table goes into docs/algorithm.md, between the marks. Exit status 1 if nothing notices one of
them.

usage: mutation_check.py [--work DIR] [--only NAME ...] [--keep-page]     about an hour on two cores
       mutation_check.py --check   only that every mutant still applies and has its row in the table
"""
import argparse
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "algorithm.md"
BEGIN, END = "<!-- mutations: begin -->\n", "<!-- mutations: end -->\n"
# What the tests are linked with.
LIBRARY = ["src/exact/*.cpp", "src/predicate/*.cpp", "src/kernels/*.cpp", "src/bvh/*.cpp",
           "src/scene/*.cpp"]
COPIED = ["cmake", "src", "include", "tests", "proofs"]
SECONDS = 300

# What a bound is taken through: `kName*factor` or `kName=value` in PIERCE_MUTANT changes it.
SOFT = """#include <cstdlib>
#include <cstring>
namespace pierce::bounds {
template <class Real>
Real mutant(const char* name, Real value) {
  const char* text = std::getenv("PIERCE_MUTANT");
  const std::size_t length = std::strlen(name);
  if (text == nullptr || std::strncmp(text, name, length) != 0) return value;
  if (text[length] == '*') return value * static_cast<Real>(std::atof(text + length + 1));
  if (text[length] == '=') return static_cast<Real>(std::strtod(text + length + 1, nullptr));
  return value;
}
}  // namespace pierce::bounds
"""

CULL = ["property_never_culls_a_hit_test"]
AXIS = ["property_axis_cull_test", "unit_axis_passage_test"]
BOX = ["property_box_test_test"]
DOUBLE = ["unit_certify_bounds_test", "differential_one_triangle_test"]
ROUND = ["unit_round_bounds_test", "differential_one_triangle_test"]
NEAREST = ["property_nearest_bounds_test", "differential_nearest_test"]
SPACE = ["unit_filter_space_test"] + BOX + CULL
FILTERS = ["unit_query_options_test", "differential_filters_test"]
AFFINE = ["differential_affine_test", "property_instances_test"]
EXACT = ["unit_exact_fixed_int_test", "unit_exact_round_ratio_test",
         "differential_one_triangle_test"]

BOUNDS = "src/predicate/bounds.h"


def constant(name, tests, change="*0.25", what="a quarter"):
    """A constant of bounds.h, changed while the programs run: `*factor` or `=value`."""
    return (name, what, BOUNDS, rf"constexpr (?:float|double) {name} =", change, tests)


def text(name, what, path, old, new, tests):
    """A piece of text, replaced."""
    return (name, what, path, re.escape(old), new, tests)


MUTANTS = [
    constant("kNearOrigin", SPACE),
    constant("kFarthestOrigin", SPACE, "*256", "256 times as far"),
    constant("kTauLimit", SPACE),
    constant("kTauPad", CULL + BOX),
    constant("kBoxPad", BOX + CULL),
    constant("kSmallestSlope", BOX + CULL, "=0x1p-8", "2^-8"),
    constant("kCutSlack", AXIS),
    constant("kPointPad", AXIS),
    constant("kEdgeLinear", CULL),
    constant("kEdgeSquare", CULL),
    constant("kEdgeFloor", CULL),
    constant("kSumFactor", CULL),
    constant("kEdgeExact", CULL),
    constant("kTauReach", CULL),
    constant("kTauInput", CULL),
    constant("kTauCube", CULL),
    constant("kTauSquare", CULL),
    constant("kAxisSquare", AXIS),
    constant("kAxisInput", AXIS),
    constant("kAxisMore", AXIS),
    constant("kAxisFloor", AXIS, "=0", "none"),
    constant("kNearestLow", NEAREST),
    constant("kNearestHigh", NEAREST),
    constant("kNearestRoom", NEAREST, "=1", "none"),
    constant("kNearestShortest", NEAREST, "=0", "none"),
    constant("kNearestFloat", NEAREST, "=0x1p60", "2^60"),
    constant("kNearestPlainCopy", NEAREST),
    constant("kNearestPlainReach", NEAREST),
    # Larger is slower, not wrong: distances then say nothing and the referee decides. Smaller
    # leaves out more than kNearestFar covers.
    constant("kNearestFarthest", NEAREST, "=0x1p10", "2^10"),
    constant("kNearestFar", NEAREST),
    constant("kSideFloor", ["unit_axis_passage_test"], "=0", "none"),
    constant("kSideFactor", ["unit_axis_passage_test"]),
    constant("kDenFactor", DOUBLE),
    constant("kUvFactor", DOUBLE),
    constant("kTFactor", DOUBLE),
    constant("kSmallestMagnitude", DOUBLE, "=0x1p-600", "2^-600"),
    constant("kLargestMagnitude", DOUBLE, "=0x1p600", "2^600"),
    constant("kDoubleDoubleFactor", ROUND),
    text("the far road", "double places every origin", "src/bvh/filter_space.cpp",
         "if (!(distance <= bounds::kFarthestOrigin) || !move_origin(ray, placed)) {",
         "if (!move_origin(ray, placed)) {", SPACE),
    text("the overflowing shift", "not looked for", "src/bvh/filter_space.cpp",
         "if (!std::isfinite(placed.origin.x + placed.origin.y + placed.origin.z)) return false;",
         "", SPACE),
    text("exact rays", "every ray counts as exact", "src/kernels/filter_ray.h",
         "copies_exact && placed.origin_kept && is_float(placed.origin) && "
         "is_float(placed.direction);", "true;", CULL),
    text("exact points", "every point counts as exact", "src/scene/axis_points.cpp",
         "packet.exact &= static_cast<double>(nearest) == p.at[axis];", "", AXIS),
    text("den near zero, in float", "tau is believed", "src/kernels/cull-inl.h",
         "safe_ = hn::Gt(den_, hn::Set(d, bounds_.sum_e));",
         "safe_ = hn::Ge(den_, hn::Set(d, 0.0F));", CULL),
    text("certainty, in float", "inside without a margin", "src/kernels/cull-inl.h",
         "const V e = hn::Set(d, bounds_.e);", "const V e = hn::Set(d, 0.0F);", CULL),
    text("the order of near hits, in float", "not asked of the referee", "src/kernels/leaf-inl.h",
         "if (place.high >= tau.low && !referee().is_before(candidate, triangle)) return;",
         "if (place.high >= tau.high) return;", CULL),
    text("the order of near hits, in a packet", "the lower one is taken",
         "src/kernels/packet_hits-inl.h", "hn::Lt(cull.high(), hn::Load(d, hits.low + i))",
         "hn::Lt(cull.low(), hn::Load(d, hits.low + i))", CULL),
    text("rays of a parted packet", "one of sixteen is left behind",
         "src/kernels/packet_walk-inl.h",
         "rays[g] = rays_entering(box, planes, g, p) & p.rays[g];",
         "rays[g] = rays_entering(box, planes, g, p) & p.rays[g] & 0x7fffU;",
         ["property_batches_test"]),
    text("rounding from copies", "uncertain hits, too", "src/scene/ray_query.h",
         """if (asked_) return false;
    if constexpr (std::is_same_v<Real, float>) {
      if (geometries_.copies_usable() && filter_ray_.exact && !road_) {""",
         """if constexpr (std::is_same_v<Real, float>) {
      if (geometries_.copies_usable() && filter_ray_.exact) {""", ["differential_scene_test"]),
    text("a border between floats, in lanes", "not looked for", "src/kernels/round-inl.h",
         "hn::And(hn::Eq(low, high), hn::Ne(low, hn::Zero(df)))", "hn::Ne(low, hn::Zero(df))",
         ROUND),
    text("a border between doubles, in lanes", "not looked for", "src/kernels/round-inl.h",
         "return bits_of(d, hn::Eq(low, high));", "return bits_of(d, hn::Eq(low, low));",
         ROUND),
    text("den near zero, in double", "its sign is believed", "src/predicate/certify.cpp",
         "if (den <= f.den_err) return Certified::Unsure;", "", DOUBLE),
    text("the window of magnitudes", "not looked at", "src/predicate/certify.cpp",
         "if (!f.usable) return Certified::Unsure;", "", DOUBLE),
    text("unsure of the triangle", "taken for a miss", "src/predicate/certify.cpp",
         ": Certified::Unsure;", ": Certified::No;", DOUBLE),
    text("unsure of the range", "taken for no", "src/predicate/certify.cpp",
         "return Certified::Unsure;  // also", "return Certified::No;  // also", DOUBLE),
    text("unsure of the order", "taken for a tie", "src/predicate/decide.cpp",
         "return settle_order(ray, first.triangle, second.triangle);",
         "return std::strong_ordering::equal;", DOUBLE),
    text("a border between floats", "not looked for", "src/predicate/round.cpp",
         "return low == high && low != 0;", "return low != 0;", ROUND),
    text("a float that rounds to zero", "not looked for", "src/predicate/round.cpp",
         "return low == high && low != 0;", "return low == high;", ROUND),
    text("a border between doubles", "not looked for", "src/predicate/round.cpp",
         "return low == high;", "return true;", ROUND),
    text("integers of any size", "two limbs have to do", "src/predicate/exact_pair.h",
         "return bits <= exact::kCoordinateBits<2> ? Width::Two : Width::Any;",
         "return Width::Two;", EXACT),
    text("room for carries", "none", "src/exact/scaled_integers.h",
         "static_cast<int>(64 * N) - 4;", "static_cast<int>(64 * N) - 1;", EXACT),
    text("the remainder of a ratio", "not looked at", "src/exact/round_ratio.cpp",
         "return {quotient, !rest.is_zero()};", "return {quotient, false};", EXACT),
    text("certainty under a filter", "what float is certain of counts", "src/kernels/filter_ray.h",
         "ray.tau_first = std::numeric_limits<float>::infinity();", "static_cast<void>(ray);",
         FILTERS),
    text("a border between floats, of a placed vertex", "not looked for", "src/exact/affine.cpp",
         "const double off = 0x1p-51 * std::fabs(sum.high) + 2 * sum.rest;",
         "const double off = 2 * sum.rest;", AFFINE),
    text("a border between doubles, of a placed vertex", "not looked for", "src/exact/affine.cpp",
         "if (sum.rest == 0) return true;", "if (sum.rest >= 0) return true;", AFFINE),
    text("products that underflow, of a placed vertex", "counted as exact", "src/exact/affine.cpp",
         "constexpr double kLeast = 0x1p-960;", "constexpr double kLeast = 0x1p-1074;", AFFINE),
    text("-0 of a placed vertex", "left as it is", "src/exact/affine.cpp",
         "return result + Real(0);", "return result;", AFFINE),
    text("pairs of doubles through float", "the compiler is let loose", "cmake/pierce_flags.cmake",
         "-fno-tree-slp-vectorize>", "-ftree-slp-vectorize>", ["unit_compiler_test"]),
]


def mutated(mutant, source):
    """The text with the mutant in it; that of a constant stays as it is."""
    name, _, path, pattern, change, _ = mutant
    text_after, count = re.subn(pattern, lambda m: m[0] if is_constant(mutant) else change, source)
    if count != 1:
        sys.exit(f"{name}: its text occurs {count} times in {path}, not once")
    return text_after


def is_constant(mutant):
    return mutant[2] == BOUNDS


def copy_tree(to):
    for name in COPIED:
        shutil.copytree(ROOT / name, to / name, dirs_exist_ok=True)


def run(command, **options):
    return subprocess.run(command, capture_output=True, text=True, **options)


class Tree:
    """The copy and its build: no more than the tests of this script need, one instruction set."""

    def __init__(self, work):
        self.root, self.build = work / "tree", work / "build"
        self.root.mkdir(parents=True, exist_ok=True)
        self.build.mkdir(parents=True, exist_ok=True)
        copy_tree(self.root)
        self.soften()
        proofs = sorted((self.root / "proofs").glob("*.g"))
        self.proofs = {p: re.sub(r"#.*", "", p.read_text(encoding="utf-8")) for p in proofs}
        self.library = [str(p.relative_to(self.root)) for folder in LIBRARY
                        for p in sorted(self.root.glob(folder))]

    def soften(self):
        """Makes the constants of the copy change with the environment, so that one build serves for
        all of them."""
        path = self.root / BOUNDS
        source = path.read_text(encoding="utf-8")
        source = re.sub(r"inline constexpr (float|double) (k\w+) =\s*([^;]+);",
                        r'inline const \1 \2 = mutant<\1>("\2", \3);', source)
        begin = "namespace pierce::bounds {\n"
        source = source.replace(begin, SOFT + begin, 1)
        path.write_text(source, encoding="utf-8")
        for path in [p for p in (self.root / "src").rglob("*") if p.suffix in (".h", ".cpp")]:
            source = path.read_text(encoding="utf-8")
            soft = re.sub(r"constexpr (double (?:kFiner|kUlp|kPads\[4\]))", r"const \1", source)
            if soft != source:
                path.write_text(soft, encoding="utf-8")

    def flags(self):
        page = (self.root / "cmake" / "pierce_flags.cmake").read_text(encoding="utf-8")
        options = re.search(r"target_compile_options\((.*?)\n\s*set\(|$", page, re.S)[0]
        return ["-std=c++20", "-O2", "-DNDEBUG", *re.findall(r"-f[\w=-]+", options),
                f'-DPIERCE_SOURCE_DIR="{self.root}"', "-march=haswell", "-maes",  # AVX2 to Highway
                "-DHWY_COMPILE_ONLY_STATIC", "-Isrc", "-Itests", "-Iinclude"]

    def compiled(self, source):
        """The object file, made again if the source, what it includes or the flags are newer."""
        target = self.build / (source.replace("/", "_") + ".o")
        needs = [source, "cmake/pierce_flags.cmake"]
        listed = target.with_suffix(".d")
        if listed.is_file():
            needs += listed.read_text().replace("\\\n", " ").split()[1:]
        made = target.stat().st_mtime if target.is_file() else 0
        if any((self.root / n).stat().st_mtime >= made for n in needs if (self.root / n).exists()):
            done = run(["g++", *self.flags(), "-MMD", "-c", source, "-o", str(target)],
                       cwd=self.root)
            if done.returncode != 0:
                sys.exit(f"{source} does not compile:\n{done.stderr[-4000:]}")
        return str(target)

    def program(self, source, library):
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            objects = list(pool.map(self.compiled, [source, *(self.library if library else [])]))
        program = self.build / pathlib.Path(source).stem
        libraries = ["-lgtest_main", "-lgtest", "-lgmpxx", "-lgmp", "-lhwy", "-ltbb",
                     "-lpthread"]
        done = run(["g++", *objects, *(libraries if library else []), "-o", str(program)])
        if done.returncode != 0:
            sys.exit(f"{source} does not link:\n{done.stderr[-4000:]}")
        return str(program)

    def failing_proofs(self, name, environment):
        """The scripts that name the constant and are no longer proved."""
        concerned = [p for p, code in self.proofs.items() if re.search(rf"\b{name}\b", code)]
        if not concerned:
            return []
        bounds = self.program("proofs/print_bounds.cpp", False)
        command = [sys.executable, str(self.root / "proofs" / "run_proof.py"), "--bounds", bounds,
                   "--seconds", "60"]
        return [p.name for p in concerned
                if run([*command, str(p)], env=environment).returncode != 0]

    def failing_tests(self, tests, environment):
        """The first test that fails, if any does."""
        for test in tests:
            kind, _, rest = test.partition("_")
            program = self.program(f"tests/{kind}/{rest}.cpp", True)
            try:
                if run([program], timeout=SECONDS, env=environment).returncode != 0:
                    return [test]
            except subprocess.TimeoutExpired:
                return [test + " (does not end)"]
        return []

    def try_mutant(self, mutant):
        name, _, path, _, change, tests = mutant
        if is_constant(mutant):
            environment = {**os.environ, "PIERCE_MUTANT": f"{name}{change}"}
            return self.failing_proofs(name, environment), self.failing_tests(tests, environment)
        file = self.root / path
        before = file.read_text(encoding="utf-8")
        file.write_text(mutated(mutant, before), encoding="utf-8")
        try:
            return [], self.failing_tests(tests, None)
        finally:
            file.write_text(before, encoding="utf-8")

    def healthy(self, tests):
        """That without any mutant every test passes, and that there is a wide kernel to be
        weakened."""
        failing = [t for t in sorted(tests) if self.failing_tests([t], None)]
        if failing:
            sys.exit(f"fails without any mutant: {', '.join(failing)}")
        probe = self.root / "tests" / "wide_kernel.cpp"
        probe.write_text('#include "kernels/kernel.h"\n'
                         "int main() { return pierce::kernels::kernels().size() > 1 ? 0 : 1; }\n",
                         encoding="utf-8")
        if run([self.program("tests/wide_kernel.cpp", True)]).returncode != 0:
            sys.exit("there is no wide kernel in this build")


def row(mutant, proofs, tests):
    name, what = mutant[:2]
    shown = f"`{name}`" if name.startswith("k") else name
    cell = lambda names: ", ".join(f"`{n}`" for n in names) or "-"
    return f"| {shown} | {what} | {cell(proofs)} | {cell(tests)} |\n"


def rows_of(page):
    """The first cell of each row -> the row."""
    table = page[page.index(BEGIN) + len(BEGIN):page.index(END)]
    return {line.split("|")[1].strip(" `"): line + "\n" for line in table.splitlines()[2:]}


def write_page(rows):
    page = PAGE.read_text(encoding="utf-8")
    table = "| bound or fallback | weakened | proof that fails | test that fails |\n"
    table += "| --- | --- | --- | --- |\n"
    table += "".join(rows[m[0]] for m in MUTANTS if m[0] in rows)
    head, rest = page.split(BEGIN)
    PAGE.write_text(head + BEGIN + table + END + rest.split(END)[1], encoding="utf-8")


def check():
    for mutant in MUTANTS:
        mutated(mutant, (ROOT / mutant[2]).read_text(encoding="utf-8"))
    constants = re.findall(r"constexpr (?:float|double) (k\w+)", (ROOT / BOUNDS).read_text())
    names = [m[0] for m in MUTANTS]
    missing = [c for c in constants if c not in names and c != "kDoubleUlp"]
    if missing:
        sys.exit(f"no mutant for {', '.join(missing)}")
    rows = rows_of(PAGE.read_text(encoding="utf-8"))
    stale = [n for n in names if n not in rows] + [n for n in rows if n not in names]
    if stale:
        sys.exit(f"docs/algorithm.md, the table of mutants: {', '.join(stale)}; run "
                 "scripts/mutation_check.py")
    survivors = [n for n, line in rows.items() if line.count("| - ") == 2]
    if survivors:
        sys.exit(f"nothing notices: {', '.join(survivors)}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--only", nargs="*")
    parser.add_argument("--keep-page", action="store_true")
    parser.add_argument("--work", type=pathlib.Path)
    options = parser.parse_args()
    if options.check:
        return check()
    chosen = [m for m in MUTANTS if not options.only or m[0] in options.only]
    survivors = []
    with tempfile.TemporaryDirectory() as temporary:
        tree = Tree(options.work or pathlib.Path(temporary))
        tree.healthy({t for m in chosen for t in m[5]})
        for mutant in chosen:
            proofs, tests = tree.try_mutant(mutant)
            line = row(mutant, proofs, tests)
            print(line, end="", flush=True)
            if not proofs and not tests:
                survivors.append(mutant[0])
            if not options.keep_page:
                page = PAGE.read_text(encoding="utf-8")
                rows = rows_of(page)
                rows[mutant[0]] = line
                write_page(rows)
    if survivors:
        sys.exit(f"nothing notices: {', '.join(survivors)}")


if __name__ == "__main__":
    main()
