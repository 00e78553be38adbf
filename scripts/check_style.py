#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds every file to the house style.

Code: SPDX tag on line 1 (after a #! line if there is one), at most 400 lines of at most 100
columns, ASCII, no tab, no trailing blank, a newline at the end; no note of unfinished work, no dead
code, no disabled test; C++ as clang-format would have it, and a file that a comment of it names by
its path is there. Pages (.md): ASCII.

usage: check_style.py [ROOT]        exit status 1 and one line for every offence
       check_style.py --self-test   proves that each rule can fail
"""
import pathlib
import re
import shutil
import subprocess
import sys

import self_test

CPP = {".h", ".hpp", ".cpp"}
CODE = CPP | {".py", ".sh", ".cmake", ".g", ".in"}
PAGES = {".md"}
SKIPPED_FOLDERS = {".git", "build", "out", "__pycache__", "data", "node_modules", "third_party"}
NO_TAG = {"pierce.pc.in", "pierce_c.pc.in"}
MAX_LINES = 400
MAX_COLUMNS = 100
# Written in pieces, so that this file does not offend against itself.
FORBIDDEN = [
    (re.compile(r"\b(TO" r"DO|FIX" r"ME|XX" r"X|HA" r"CK)\b"), "unfinished work: finish it"),
    (re.compile(r"^\s*#\s*if\s+(0|false)\b"), "dead code: delete it"),
    (re.compile(r"\bDISA" r"BLED_\w"), "a disabled test: mend or delete it"),
]


def files(root):
    for path in sorted(root.rglob("*")):
        parts = path.relative_to(root).parts
        skipped = any(p in SKIPPED_FOLDERS or p.startswith("build") for p in parts[:-1])
        if path.is_file() and not skipped:
            yield path


def is_code(path):
    return path.suffix in CODE or path.name == "CMakeLists.txt"


def check_code(path, lines, offend):
    tag_line = 1 if lines and lines[0].startswith("#!") else 0
    tag = "SPDX-License-Identifier: Apache-2.0"
    if path.name not in NO_TAG and (len(lines) <= tag_line or tag not in lines[tag_line]):
        offend(tag_line + 1, "the SPDX tag is missing")
    if len(lines) > MAX_LINES:
        offend(len(lines), f"{len(lines)} lines: one concept a file, at most {MAX_LINES} lines")
    for number, line in enumerate(lines, 1):
        if len(line) > MAX_COLUMNS:
            offend(number, f"{len(line)} columns; at most {MAX_COLUMNS}")
        if "\t" in line or line != line.rstrip():
            offend(number, "a tab or a trailing blank")
        for pattern, text in FORBIDDEN:
            if pattern.search(line):
                offend(number, text)


# A path in a comment: from the root, from where includes are looked up, or from its own folder.
PATH = re.compile(r"(?<![\w./-])(?:[\w-]+/)+[\w-]+\.(?:h|cpp|md|py|g|sh|cmake)\b")
PLACES = ["", "src", "include", "bench", "tests"]


def check_paths(root, path, lines, offend):
    for number, line in enumerate(lines, 1):
        comment = re.search(r"(?<!:)//.*", line)
        for name in PATH.findall(comment[0]) if comment else []:
            folders = [root / place for place in PLACES] + [path.parent]
            if not any((folder / name).exists() for folder in folders):
                offend(number, f"{name} is not there")


def check_format(root, paths, found):
    """clang-format over all C++ files in one go; its complaints name file and line."""
    program = shutil.which("clang-format", path="/usr/bin") or shutil.which("clang-format")
    if not program:
        found.append("clang-format is missing: apt-get install clang-format")
        return
    style = (pathlib.Path(__file__).resolve().parent.parent / ".clang-format").as_posix()
    run = subprocess.run(
        [program, "--dry-run", "-Werror", f"--style=file:{style}", *map(str, paths)],
        capture_output=True, text=True, check=False)
    places = dict.fromkeys(re.findall(r"^(.*?:\d+):\d+: error", run.stderr, re.M))
    for place in places:
        found.append(f"{place.replace(str(root) + '/', '')}: run clang-format -i on this file")
    if run.returncode != 0 and not places:
        found.append(f"clang-format: {run.stderr.strip()[:300]}")


def check(root):
    """All offences under root, as lines of text."""
    found = []
    cpp = []
    for path in files(root):
        if not is_code(path) and path.suffix not in PAGES:
            continue
        name = path.relative_to(root)

        def offend(number, text, name=name):
            found.append(f"{name}:{number}: {text}")

        data = path.read_bytes()
        text = data.decode("utf-8", errors="replace")
        lines = text.split("\n")
        for number, line in enumerate(lines, 1):
            if not line.isascii():
                offend(number, "a character that is not ASCII")
        if data and not data.endswith(b"\n"):
            offend(len(lines), "no newline at the end")
        if is_code(path):
            check_code(path, lines[:-1] if lines[-1] == "" else lines, offend)
        if path.suffix in CPP:
            cpp.append(path)
            check_paths(root, path, lines, offend)
    if cpp:
        check_format(root, cpp, found)
    return found


TAG = "// SPDX-License-Identifier: Apache-2.0\n"
GOOD = {
    "src/exact/sum.h": TAG + "// See exact/sum.h.\nint sum(int a, int b);\n",
    "scripts/run.py": "#!/usr/bin/env python3\n# SPDX-License-Identifier: Apache-2.0\n",
    "README.md": "# A page\n",
}
BAD = {
    "no tag": ("src/exact/sum.h", "int sum(int a, int b);\n"),
    "no tag in CMake": ("CMakeLists.txt", "project(x)\n"),
    "no tag after #!": ("scripts/run.py", "#!/usr/bin/env python3\nprint()\n"),
    "a long line": ("src/exact/sum.h", TAG + "//" + "x" * 100 + "\n"),
    "a long file": ("src/exact/sum.h", TAG + "int a;\n" * 400),
    "not ASCII": ("src/exact/sum.h", TAG + "// \u00b1\n"),
    "a page that is not ASCII": ("README.md", "# \u00e9\n"),
    "a tab": ("scripts/run.py", "# SPDX-License-Identifier: Apache-2.0\nif 1:\n\tx = 1\n"),
    "no newline at the end": ("src/exact/sum.h", TAG + "int a;"),
    "unfinished work": ("src/exact/sum.h", TAG + "// TO" "DO more\n"),
    "dead code": ("src/exact/sum.h", TAG + "#if" " 0\n#endif\n"),
    "a comment about a file that is gone": ("src/exact/sum.h", TAG + "// See exact/none.h.\n"),
    "a disabled test": ("tests/unit/a_test.cpp", TAG + "TEST(A, DISA" "BLED_b) {}\n"),
    "a file not formatted": ("src/exact/sum.h", TAG + "int  sum( int a,int b );\n"),
}

if __name__ == "__main__":
    sys.exit(self_test.main(check, GOOD, BAD, pathlib.Path(__file__)))
