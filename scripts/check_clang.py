#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The kernels please clang, too: it warns where g++ does not, and its presets would not build.

Every .cpp under src/kernels is read by clang++ with the warnings of cmake/pierce_flags.cmake as
errors; no code is made. Without clang++ there is nothing to check.

usage: check_clang.py [ROOT]        exit status 1 and one line for every file that does not pass
       check_clang.py --self-test   proves that an offence is noticed
"""
import pathlib
import re
import shutil
import subprocess
import sys

import self_test

CLANG = shutil.which("clang++")
FLAGS = "cmake/pierce_flags.cmake"


def warnings(root):
    return sorted(set(re.findall(r"\s(-W[\w-]+)", (root / FLAGS).read_text(encoding="utf-8"))))


def check(root):
    if CLANG is None:
        return []
    offences = []
    for path in sorted((root / "src" / "kernels").glob("*.cpp")):
        command = [CLANG, "-std=c++20", "-fsyntax-only", "-Werror", *warnings(root),
                   "-DHWY_SHARED_DEFINE", f"-I{root / 'src'}", f"-I{root / 'include'}", str(path)]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode == 0:
            continue
        first = next((line for line in done.stderr.splitlines() if "error:" in line), "fails")
        offences.append(f"{path.relative_to(root)}: {first}")
    return offences


GOOD = {
    FLAGS: "target_compile_options(f INTERFACE\n  -Wall -Wextra -Wshadow)\n",
    "src/kernels/a.cpp": "namespace n {\nconstexpr int k = 1;\nint f() { return k; }\n}\n",
}
BAD = {
    "a name that hides another": (
        "src/kernels/b.cpp",
        "namespace n {\nconstexpr int k = 1;\nint f() { constexpr int k = 2; return k; }\n}\n"),
} if CLANG else {}

if __name__ == "__main__":
    sys.exit(self_test.main(check, GOOD, BAD, pathlib.Path(__file__)))
