#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Reads README.md, HACKING.md and docs/ as a stranger would: everything they say is tried.

- ```cpp with a main() is compiled and run. If the next block is ```text, that is what it prints.
- ```cpp without one is compiled: declarations at the top of a file, or statements in a function in
  which `mesh`, `scene`, `ray`, `rays`, `hits` and `point` exist (see CONTEXT).
- ```sh: commands that start with `pierce` are run, also in a row (|), in a folder that holds
  bunny.obj, rays.npy and points.npy (after ```sh long they are not); scripts (./x) must exist and
  be executable, cmake presets must exist. Other commands are the reader's own (git, cd, ...).
- Options (`--x`) named beside `pierce COMMAND` exist in the help of that command.
- Links lead to files, and to headings, that exist; so do paths written as `src/...` in HACKING.md.

usage: check_docs.py --source DIR --compiler CXX --library FILE --tool FILE --work DIR
       check_docs.py --self-test
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

import samples

FENCE = re.compile(r"^```([^\n]*)\n(.*?)^```\s*$", re.M | re.S)
LINK = re.compile(r"(?<!!)\[[^\]]*\]\(([^)\s]+)\)|!\[[^\]]*\]\(([^)\s]+)\)")
OPTION = re.compile(r"(?<![\w-])--[a-z][a-z-]*")
TREE_PATH = re.compile(
    r"`((?:src|tool|bench|proofs|examples|docs|scripts|tests|include|cmake)/[\w./*-]*)`")

CONTEXT = """
#include <pierce/pierce.h>
#include <cstdio>
#include <iostream>
#include <vector>
DECLARATIONS
[[maybe_unused]] static void statements(
    pierce::MeshView<float> mesh, const pierce::Scene<float>& scene, pierce::Ray<float> ray,
    const std::vector<pierce::Ray<float>>& rays, std::vector<pierce::Hit<float>>& hits,
    pierce::Vec3<float> point) {
  (void)mesh, (void)scene, (void)ray, (void)rays, (void)hits, (void)point;
STATEMENTS
}
int main() {}
"""


class Page:
    """A page and its blocks of code: (language, text, line number)."""

    def __init__(self, path):
        self.path = path
        self.text = path.read_text(encoding="utf-8")
        self.blocks = [(m[1], m[2], self.text.count("\n", 0, m.start()) + 1)
                       for m in FENCE.finditer(self.text)]
        self.prose = FENCE.sub("", self.text)

    def headings(self):
        """Anchors as GitHub makes them."""
        for line in self.prose.splitlines():
            if line.startswith("#"):
                title = re.sub(r"[^\w\- ]", "", line.lstrip("#").strip().lower())
                yield title.replace(" ", "-")


def pages_of(source):
    names = [source / "README.md", source / "HACKING.md", *sorted((source / "docs").rglob("*.md"))]
    return [Page(p) for p in names if p.is_file()]


def check_links(page, source):
    for match in LINK.finditer(page.prose):
        target = match[1] or match[2]
        if re.match(r"[a-z]+:", target):
            continue
        name, _, anchor = target.partition("#")
        path = (page.path.parent / name).resolve() if name else page.path
        if not path.exists():
            yield f"the link {target} leads nowhere"
        elif anchor and path.suffix == ".md" and anchor not in Page(path).headings():
            yield f"the link {target} names a heading that does not exist"
    for match in TREE_PATH.finditer(page.prose):
        if not any(source.glob(match[1].rstrip("/"))):
            yield f"`{match[1]}` does not exist"


def wrap(text):
    """A fragment as a whole program."""
    if re.search(r"\bmain\s*\(", text):
        return text
    is_declaration = re.match(r"\s*(#include|template|struct|class|namespace|using|enum)\b", text)
    parts = (text, "") if is_declaration else ("", text)
    return CONTEXT.replace("DECLARATIONS", parts[0]).replace("STATEMENTS", parts[1])


def check_program(setup, page, number):
    """Compiles block `number` of the page; runs it if it is a whole program."""
    language, text, line = page.blocks[number]
    where = f"{page.path.name}:{line}"
    program = setup.work / f"{page.path.stem}_{line}"
    code = program.with_suffix(".cpp")
    code.write_text(wrap(text))
    command = [setup.compiler, "-std=c++20", "-Wall", "-Wextra", "-Werror",
               f"-I{setup.source}/include", str(code), "-o", str(program), *setup.link]
    run = subprocess.run(command, capture_output=True, text=True, check=False)
    if run.returncode:
        return [f"{where}: does not compile: {run.stderr}"]
    if not re.search(r"\bmain\s*\(", text):
        return []
    run = subprocess.run([program], capture_output=True, text=True, check=False, cwd=setup.work)
    if run.returncode:
        return [f"{where}: exit status {run.returncode}: {run.stderr}"]
    following = page.blocks[number + 1] if number + 1 < len(page.blocks) else ("", "", 0)
    if following[0] == "text" and run.stdout != following[1]:
        return [f"{where}: the page says\n{following[1]}the program says\n{run.stdout}"]
    return []


def commands_of(text):
    joined = text.replace("\\\n", " ")
    for line in joined.splitlines():
        words = shlex.split(line, comments=True)
        if words:
            yield words


def check_preset(words, source):
    presets = json.loads((source / "CMakePresets.json").read_text())
    known = {p["name"] for p in presets["configurePresets"] if not p.get("hidden")}
    for before, name in zip(words, words[1:]):
        if before == "--preset" and name not in known:
            yield f"the preset {name} does not exist"


def check_shell(setup, page, block):
    language, text, line = block
    where = f"{page.path.name}:{line}"
    for words in commands_of(text):
        while words and re.fullmatch(r"[A-Z_]+=\S*", words[0]):
            words = words[1:]
        if words[:1] == ["pierce"] and language == "sh":
            environment = dict(os.environ, PATH=f"{setup.tool.parent}:{os.environ['PATH']}")
            line = " ".join(word if word == "|" else shlex.quote(word) for word in words)
            run = subprocess.run(["bash", "-o", "pipefail", "-c", line], capture_output=True,
                                 text=True, check=False, cwd=setup.work, env=environment,
                                 stdin=subprocess.DEVNULL)
            if run.returncode:
                yield f"{where}: {shlex.join(words)}: exit status {run.returncode}: {run.stderr}"
        elif words and "/" in words[0] and not words[0].startswith("/"):
            script = setup.source / words[0]
            is_built = words[0].startswith("build/")
            if not is_built and not (script.is_file() and os.access(script, os.X_OK)):
                yield f"{where}: {words[0]} is not there, or cannot be run"
        elif words[:1] == ["cmake"] or words[:1] == ["ctest"]:
            for text in check_preset(words, setup.source):
                yield f"{where}: {text}"


def help_of(setup, command):
    if command not in setup.help:
        words = [setup.tool, *command.split(), "--help"]
        run = subprocess.run(words, capture_output=True, text=True, check=False)
        setup.help[command] = run.stdout if run.returncode == 0 else ""
    return setup.help[command]


def check_options(setup, page):
    """`pierce COMMAND ... --option` on one line, in prose or in a block."""
    for number, line in enumerate(page.text.replace("\\\n", " ").splitlines(), 1):
        for match in re.finditer(r"\bpierce ([a-z]+)((?: [^`|]*)?)", line):
            options = OPTION.findall(match[2])
            if not options:
                continue
            command = match[1]
            if command == "job":  # which has commands of its own
                command += " " + match[2].split()[0]
            text = help_of(setup, command)
            if not text:
                yield f"{page.path.name}:{number}: pierce {command} is not a command"
            for option in options:
                if not re.search(rf"(?<![\w-]){option}(?![\w-])", text):
                    yield f"{page.path.name}:{number}: pierce {command} has no option {option}"


def check(setup):
    found = []
    jobs = []
    setup.help = {}
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for page in pages_of(setup.source):
            found += [f"{page.path.name}: {text}" for text in check_links(page, setup.source)]
            found += check_options(setup, page)
            for number, block in enumerate(page.blocks):
                if block[0] == "cpp":
                    jobs.append(pool.submit(check_program, setup, page, number))
                elif block[0] in ("sh", "sh long"):
                    found += check_shell(setup, page, block)
    for job in jobs:
        found += job.result()
    return found


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--self-test", action="store_true")
    parser.add_argument("--source", type=pathlib.Path)
    parser.add_argument("--work", type=pathlib.Path)
    parser.add_argument("--tool", type=pathlib.Path)
    parser.add_argument("--library", type=pathlib.Path)
    parser.add_argument("--compiler", default="c++")
    setup = parser.parse_args()
    if setup.self_test:
        with tempfile.TemporaryDirectory() as folder:
            found = samples.self_test(check, pathlib.Path(folder))
    else:
        shutil.rmtree(setup.work, ignore_errors=True)  # a job is not created twice
        setup.work.mkdir(parents=True)
        samples.write_inputs(setup.work)
        setup.link = [setup.library, f"-Wl,-rpath,{setup.library.parent}", "-ltbb", "-lhwy"]
        found = check(setup)
    print(*found, sep="\n")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
