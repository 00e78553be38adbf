# SPDX-License-Identifier: Apache-2.0
"""What check_docs.py needs beside the pages: files for the commands, and pages that must fail."""
import argparse
import pathlib
import shutil
import stat
import struct

BUNNY = pathlib.Path("/usr/share/glmark2/models/bunny.obj")
CUBE = """\
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 2 3 7 6
f 3 4 8 7
f 4 1 5 8
"""


def write_npy(path, rows):
    """A two-dimensional float32 array in NumPy's format 1.0."""
    header = f"{{'descr': '<f4', 'fortran_order': False, 'shape': ({len(rows)}, {len(rows[0])}), }}"
    header = header.ljust(117) + "\n"
    numbers = [x for row in rows for x in row]
    path.write_bytes(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode()
                     + struct.pack(f"<{len(numbers)}f", *numbers))


def write_inputs(folder):
    """The files that the pages' commands name."""
    if BUNNY.is_file():
        shutil.copy(BUNNY, folder / "bunny.obj")
    else:
        (folder / "bunny.obj").write_text(CUBE)
    (folder / "cube.obj").write_text(CUBE)
    grid = [(x / 16 - 0.5, y / 16 - 0.5) for y in range(16) for x in range(16)]
    write_npy(folder / "rays.npy", [(x, y, 5, 0, 0, -1) for x, y in grid])
    write_npy(folder / "points.npy", [(x, y, 0) for x, y in grid])


TOOL = """#!/bin/sh
[ "$1" = cast ] && [ "$2" = --help ] && echo "  --rays FILE" && exit 0
[ "$1" = cast ] && exit 0
exit 2
"""
GOOD = """# A page

[the same page](#a-page), [itself](README.md)

```cpp
#include <cstdio>
int main() { std::puts("pierced"); }
```
```text
pierced
```
```cpp
std::printf("%zu\\n", rays.size());
```
```sh
./run.sh
pierce cast bunny.obj --rays rays.npy
cmake --preset release
```
"""
BAD = {
    "a dead link": "[x](docs/none.md)\n",
    "a dead heading": "[x](#none)\n",
    "a path that is not there": "`src/none.cpp`\n",
    "a program that does not compile": "```cpp\nint main() { return x; }\n```\n",
    "a fragment that does not compile": "```cpp\nscene.nothing();\n```\n",
    "a program that fails": "```cpp\nint main() { return 1; }\n```\n",
    "another output": "```cpp\nint main() {}\n```\n```text\npierced\n```\n",
    "a command that fails": "```sh\npierce render bunny.obj\n```\n",
    "a script that is not there": "```sh\n./none.sh\n```\n",
    "a preset that is not there": "```sh\ncmake --preset none\n```\n",
    "an option that is not there": "`pierce cast --none`\n",
    "a command that is not there": "`pierce none --rays`\n",
}
# Enough of the library for the fragments' context to compile.
HEADER = """#pragma once
namespace pierce {
template <class> struct MeshView {};
template <class> struct Scene {};
template <class> struct Ray {};
template <class> struct Hit {};
template <class> struct Vec3 {};
}
"""


def self_test(check, folder):
    """The good page passes, each bad one gives an offence."""
    source = folder / "source"
    (source / "include/pierce").mkdir(parents=True)
    (source / "include/pierce/pierce.h").write_text(HEADER)
    (source / "CMakePresets.json").write_text('{"configurePresets": [{"name": "release"}]}')
    work = folder / "work"
    work.mkdir()
    tool = folder / "bin" / "pierce"
    tool.parent.mkdir()
    for path, text in ((tool, TOOL), (source / "run.sh", "#!/bin/sh\n")):
        path.write_text(text)
        path.chmod(path.stat().st_mode | stat.S_IXUSR)
    setup = argparse.Namespace(source=source, work=work, tool=tool, compiler="c++", link=[])

    failures = []
    page = source / "README.md"
    page.write_text(GOOD)
    failures += [f"the good page gives: {line}" for line in check(setup)]
    for what, text in BAD.items():
        page.write_text("# A page\n\n" + text)
        if not check(setup):
            failures.append(f"not noticed: {what}")
    print(f"self-test: {len(BAD)} offences tried, {len(failures)} failures")
    return failures
