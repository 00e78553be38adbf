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

from mutant_kinds import BOUNDS
from mutants import MUTANTS

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "algorithm.md"
BEGIN, END = "<!-- mutations: begin -->\n", "<!-- mutations: end -->\n"
# What the tests are linked with.
LIBRARY = [f"src/{layer}/**/*.cpp" for layer in
           ("support", "exact", "predicate", "mesh", "space", "bvh", "kernels", "scene")]
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


def softened(source, names):
    """Constants that are made of those named, or of one another, are no longer the compiler's."""
    def soften(match):
        if not names.intersection(re.findall(r"\bk\w+", match[3])):
            return match[0]
        names.update(re.findall(r"\b(k\w+)(?:\[\d*\])? =", match[2] + match[3]))
        return f"const {match[1]} {match[2]}{match[3]};"
    return re.sub(r"constexpr (auto|double|float) (k\w+)([^;()]* = [^;]*);", soften, source)


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
        bounds = set(re.findall(r"inline const \w+ (k\w+) =", source))
        for path in [p for p in (self.root / "src").rglob("*") if p.suffix in (".h", ".cpp")]:
            source = path.read_text(encoding="utf-8")
            soft = softened(source, set(bounds))
            if soft != source:
                path.write_text(soft, encoding="utf-8")

    def flags(self):
        page = (self.root / "cmake" / "pierce_flags.cmake").read_text(encoding="utf-8")
        options = re.search(r"target_compile_options\((.*?)\n\s*set\(|$", page, re.S)[0]
        return ["-std=c++20", "-O2", "-DNDEBUG", *re.findall(r"-f[\w=-]+", options),
                f'-DPIERCE_SOURCE_DIR="{self.root}"', "-march=haswell", "-maes",  # AVX2 to Highway
                "-DHWY_COMPILE_ONLY_STATIC", "-DPIERCE_PARALLEL_TBB",
                "-Isrc", "-Itests", "-Iinclude"]

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
    """The first two cells of each row -> the row."""
    table = page[page.index(BEGIN) + len(BEGIN):page.index(END)]
    return {key_of_line(line): line + "\n" for line in table.splitlines()[2:]}


def key_of_line(line):
    cells = line.split("|")
    return cells[1].strip(" `"), cells[2].strip()


def write_page(rows):
    page = PAGE.read_text(encoding="utf-8")
    table = "| bound or fallback | weakened | proof that fails | test that fails |\n"
    table += "| --- | --- | --- | --- |\n"
    table += "".join(rows[m[:2]] for m in MUTANTS if m[:2] in rows)
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
    keys = [m[:2] for m in MUTANTS]
    stale = [": ".join(k) for k in [*keys, *rows] if k not in rows or k not in keys]
    if stale:
        sys.exit(f"docs/algorithm.md, the table of mutants: {', '.join(stale)}; run "
                 "scripts/mutation_check.py")
    survivors = [": ".join(k) for k, line in rows.items() if line.count("| - ") == 2]
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
                survivors.append(": ".join(mutant[:2]))
            if not options.keep_page:
                page = PAGE.read_text(encoding="utf-8")
                rows = rows_of(page)
                rows[mutant[:2]] = line
                write_page(rows)
    if survivors:
        sys.exit(f"nothing notices: {', '.join(survivors)}")


if __name__ == "__main__":
    main()
