#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Holds the tree to its layers: includes point one way only.

support <- exact <- predicate <- mesh <- space <- bvh <- kernels <- scene <- io <- tool, bindings

A folder may include itself, whatever stands left of it, and the public headers. Only kernels may
include Highway; the core (exact to scene) includes no third-party library but Boost, oneTBB and
Highway. Public headers include only public headers and the standard library, and define no macro.
Threads come through src/support/parallel.h and lock.h alone: no other file under src names oneTBB
or the standard library's threads and locks, and none under tool names oneTBB. Examples are written
as users write: public headers only. Every folder under src is a layer.

usage: check_includes.py [ROOT]        exit status 1 and one line for every offence
       check_includes.py --self-test   proves that each rule can fail
"""
import pathlib
import re
import sys

import self_test

LAYERS = ["support", "exact", "predicate", "mesh", "space", "bvh", "kernels", "scene", "io"]
CORE = LAYERS[:-1]
ABOVE = ["tool", "bindings"]  # may include every layer
CORE_LIBRARIES = {"boost", "tbb", "oneapi", "hwy"}
# Headers of the system that the core may use: huge pages, scene files, forks, floating-point modes.
SYSTEM = {"sys/mman.h", "sys/stat.h", "fcntl.h", "unistd.h", "pthread.h", "xmmintrin.h"}
# The header for C may include these, and ask whether it is C++ that reads it.
C_STANDARD = {"stddef.h", "stdint.h"}
# Threads: who may name them, and how they are called.
THREADS = re.compile(r"src/support/(parallel_\w+\.(h|cpp)|lock\.h)$")
ONE_TBB = re.compile(r"\btbb::|<(oneapi/)?tbb\b")
STANDARD_THREADS = re.compile(
    r"<(thread|mutex|shared_mutex|condition_variable|future|pthread\.h)>"
    r"|\bstd::(this_thread|j?thread|\w*mutex|\w+_lock|lock_guard|once_flag|call_once|async)\b")
SOURCES = {".h", ".hpp", ".cpp"}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def sources(folder):
    return sorted(p for p in folder.rglob("*") if p.suffix in SOURCES) if folder.is_dir() else []


def includes(path):
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        match = INCLUDE.match(line)
        if match:
            yield number, match[1] == '"', match[2]


def is_standard(name):
    return "/" not in name and "." not in name


def check_core_or_io(root, path, layer, offend):
    for number, quoted, name in includes(path):
        first = name.split("/")[0]
        if quoted and first == "pierce":
            if not (root / "include" / name).is_file():
                offend(path, number, f'"{name}" is not a public header')
        elif quoted and first in LAYERS:
            if LAYERS.index(first) > LAYERS.index(layer):
                offend(path, number, f'{layer} includes "{name}": {first} stands above {layer}')
            elif not (root / "src" / name).is_file():
                offend(path, number, f'"{name}" does not exist')
        elif quoted and layer != "io":
            offend(path, number, f'"{name}": name it from src/ or as "pierce/..."')
        elif first == "hwy" and layer != "kernels":
            offend(path, number, f"<{name}>: only kernels includes Highway")
        elif layer in CORE and not is_standard(name) and name not in SYSTEM:
            if first not in CORE_LIBRARIES:
                offend(path, number, f"<{name}>: the core needs only Highway, oneTBB and Boost")


def check_public(root, path, offend):
    for_c = path.name == "pierce_c.h"
    for number, _, name in includes(path):
        if name.startswith("pierce/"):
            if not (root / "include" / name).is_file():
                offend(path, number, f'"{name}" does not exist')
        elif not is_standard(name) and not (for_c and name in C_STANDARD):
            offend(path, number, f"{name}: a public header includes only public and standard ones")
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if for_c and line == "#ifdef __cplusplus":
            continue
        if re.match(r"\s*#\s*(define|if|ifdef|ifndef|undef)\b", line):
            offend(path, number, "a public header neither defines nor asks for macros")


def check_example(path, offend):
    for number, _, name in includes(path):
        if not name.startswith("pierce/") and not is_standard(name):
            offend(path, number, f"{name}: an example includes only public and standard headers")


def check_above(path, offend):
    for number, _, name in includes(path):
        if name.split("/")[0] == "hwy":
            offend(path, number, f"<{name}>: only kernels includes Highway")


def check_threads(root, path, offend):
    """Threads are had in one way, so that they can be had in another, or not at all."""
    name = path.relative_to(root).as_posix()
    if THREADS.match(name):
        return
    for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
        if ONE_TBB.search(line):
            offend(path, number, "names oneTBB: support/parallel.h has what is needed")
        elif name.startswith("src/") and STANDARD_THREADS.search(line):
            offend(path, number, "names threads: support/parallel.h and lock.h have them")


def check(root):
    """All offences under root, as lines of text."""
    found = []

    def offend(path, number, text):
        found.append(f"{path.relative_to(root)}:{number}: {text}")

    src = root / "src"
    for folder in sorted(src.iterdir()):
        if folder.is_dir() and folder.name not in LAYERS:
            offend(folder, 0, "is not a layer; give it a place in scripts/check_includes.py")
        elif folder.suffix in SOURCES:
            offend(folder, 0, "belongs to no layer; move it into a folder")
    for layer in LAYERS:
        for path in sources(src / layer):
            check_core_or_io(root, path, layer, offend)
    for path in sources(root / "include"):
        check_public(root, path, offend)
    for path in sources(root / "examples"):
        check_example(path, offend)
    for folder in ("src", *ABOVE):
        for path in sources(root / folder):
            check_threads(root, path, offend)
    for folder in ABOVE + ["bench"]:
        for path in sources(root / folder):
            check_above(path, offend)
    return found


GOOD = {
    "include/pierce/types.h": "#include <vector>\n",
    "include/pierce/scene.h": '#include "pierce/types.h"\n',
    "include/pierce/pierce_c.h": "#include <stdint.h>\n#ifdef __cplusplus\n#endif\n",
    "src/exact/sum.h": "#include <boost/multiprecision/cpp_int.hpp>\n",
    "src/kernels/cull.cpp": '#include <hwy/highway.h>\n#include "exact/sum.h"\n',
    "src/io/obj.cpp": '#include <tiny_obj_loader.h>\n#include "kernels/cull.h"\n',
    "src/kernels/cull.h": "#pragma once\n",
    "tool/main.cpp": '#include "io/obj.h"\n#include <thread>\n',
    "src/support/parallel_tbb.h": "#include <tbb/parallel_invoke.h>\nusing tbb::parallel_invoke;\n",
    "src/support/lock.h": "#include <mutex>\nusing Mutex = std::mutex;\n",
    "examples/ask.cpp": "#include <pierce/pierce.h>\n",
}
BAD = {
    "an upward include": ("src/exact/sum.h", '#include "kernels/cull.h"\n'),
    "the top layer from below": ("src/kernels/cull.h", '#include "io/obj.h"\n'),
    "Highway outside kernels": ("src/exact/sum.h", "#include <hwy/highway.h>\n"),
    "Highway in the tool": ("tool/main.cpp", "#include <hwy/highway.h>\n"),
    "oneTBB in the core": ("src/bvh/sort.h", "#include <tbb/parallel_sort.h>\n"),
    "oneTBB in the tool": ("tool/main.cpp", "int n = tbb::arena::most();\n"),
    "a thread in the core": ("src/bvh/sort.h", "void f() { std::thread(f).detach(); }\n"),
    "a lock in the core": ("src/bvh/sort.h", "#include <mutex>\n"),
    "a foreign library in the core": ("src/exact/sum.h", "#include <fmt/core.h>\n"),
    "a private header in a public one": ("include/pierce/types.h", '#include "exact/sum.h"\n'),
    "a library in a public header": ("include/pierce/types.h", "#include <tbb/task.h>\n"),
    "a macro in a public header": ("include/pierce/types.h", "#define PIERCE_WIDE 1\n"),
    "a macro in the header for C": ("include/pierce/pierce_c.h", "#ifdef WIDE\n#endif\n"),
    "a public header that is not there": ("src/exact/sum.h", '#include "pierce/none.h"\n'),
    "a header without its folder": ("src/exact/sum.h", '#include "round.h"\n'),
    "a folder that is no layer": ("src/extra/more.h", "#pragma once\n"),
    "a file outside the layers": ("src/loose.cpp", "int loose;\n"),
    "an example that looks inside": ("examples/ask.cpp", '#include "exact/sum.h"\n'),
}

if __name__ == "__main__":
    sys.exit(self_test.main(check, GOOD, BAD, pathlib.Path(__file__)))
