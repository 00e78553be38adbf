#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Compiles each public header by itself, as a careful user would: warnings are errors.

Every header under include/ must compile alone, and twice in one file, with each compiler that is
there (g++, clang++).

usage: check_headers.py [ROOT]        exit status 1 and the compilers' complaints
       check_headers.py --self-test   proves that each rule can fail
"""
import concurrent.futures
import os
import pathlib
import shutil
import subprocess
import sys

import self_test

COMPILERS = [c for c in ("g++", "clang++") if shutil.which(c)]
FLAGS = ["-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Wconversion",
         "-Wshadow", "-Werror", "-x", "c++", "-"]


def compile_alone(compiler, folder, name):
    text = f'#include "{name}"\n#include "{name}"\n'
    run = subprocess.run([compiler, f"-I{folder}", *FLAGS], input=text, capture_output=True,
                         text=True, check=False)
    return run.returncode == 0, f"{name} ({compiler}):\n{run.stderr}"


def check(root):
    """All offences under root, as lines of text."""
    folder = root / "include"
    names = sorted(p.relative_to(folder).as_posix() for p in folder.rglob("*.h"))
    if not COMPILERS:
        return ["neither g++ nor clang++ is there: apt-get install g++"]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        jobs = [pool.submit(compile_alone, c, folder, n) for c in COMPILERS for n in names]
        results = [job.result() for job in jobs]
    return [text for good, text in results if not good]


GOOD = {
    "include/pierce/a.h": "#pragma once\n#include <vector>\nstruct A { std::vector<int> v; };\n",
    "include/pierce/b.h": '#pragma once\n#include "pierce/a.h"\nstruct B { A a; };\n',
}
BAD = {
    "a header that leans on another": ("include/pierce/b.h", "#pragma once\nstruct B { A a; };\n"),
    "a header that is not guarded": ("include/pierce/b.h", "struct B {};\n"),
    "a warning": ("include/pierce/b.h", "#pragma once\ninline int f(long x) { return x; }\n"),
}

if __name__ == "__main__":
    sys.exit(self_test.main(check, GOOD, BAD, pathlib.Path(__file__)))
