#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The hot path pleases clang, too: it warns where g++ does not, and its presets would not build.

Every .cpp under src/kernels, and those files of src/scene that bring rays there, are read by
clang++ with the warnings of cmake/pierce_flags.cmake as errors; no code is made. All of the library
would take half a minute. Without clang++ there is nothing to check.

usage: check_clang.py [ROOT]        exit status 1 and one line for every file that does not pass
       check_clang.py --self-test   proves that an offence is noticed
"""
import concurrent.futures
import os
import pathlib
import re
import shutil
import subprocess
import sys

import self_test

CLANG = shutil.which("clang++")
FLAGS = "cmake/pierce_flags.cmake"
SCENE = [f"src/scene/{name}.cpp"
         for name in ("rays/batch", "rays/crossings", "rays/hit_lists", "scene")]


def warnings(root):
    return sorted(set(re.findall(r"\s(-W[\w-]+)", (root / FLAGS).read_text(encoding="utf-8"))))


def complaint(root, path):
    """What clang++ says first, or None."""
    command = [CLANG, "-std=c++20", "-fsyntax-only", "-Werror", *warnings(root),
               "-DHWY_SHARED_DEFINE", "-DPIERCE_PARALLEL_TBB",
               f"-I{root / 'src'}", f"-I{root / 'include'}", str(path)]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode == 0:
        return None
    first = next((line for line in done.stderr.splitlines() if "error:" in line), "fails")
    return f"{path.relative_to(root)}: {first}"


def check(root):
    if CLANG is None:
        return []
    files = sorted((root / "src" / "kernels").rglob("*.cpp")) + [root / name for name in SCENE]
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return [c for c in pool.map(lambda path: complaint(root, path), files) if c]


GOOD = {
    FLAGS: "target_compile_options(f INTERFACE\n  -Wall -Wextra -Wshadow)\n",
    "src/kernels/a.cpp": "namespace n {\nconstexpr int k = 1;\nint f() { return k; }\n}\n",
} | {name: "bool f();\nbool g();\nbool h() { return f() && g(); }\n" for name in SCENE}
BAD = {
    "a name that hides another": (
        "src/kernels/b.cpp",
        "namespace n {\nconstexpr int k = 1;\nint f() { constexpr int k = 2; return k; }\n}\n"),
    "bits of answers": (
        "src/scene/rays/batch.cpp", "bool f();\nbool g();\nbool h() { return f() & g(); }\n"),
} if CLANG else {}

if __name__ == "__main__":
    sys.exit(self_test.main(check, GOOD, BAD, pathlib.Path(__file__)))
