#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What a pierce library shows to the linker.

A shared one: whatever is exported is declared in the public headers, and every template that they
declare extern is exported for float and for double.

A static one: no function with floating-point arithmetic in it that a caller's object could have as
well, for the linker keeps one copy of such a function (weak, of a name that is not ours alone), and
the caller's may be compiled with -ffast-math.

usage: symbols.py shared|static LIBRARY HEADERS     exit status 1 and one line for every offence
"""
import pathlib
import re
import subprocess
import sys

# Parts of the library that no public header declares: nobody else has a function of theirs.
# (Some names are too much for c++filt and stay mangled: 5scene.)
# (Names that are too much for c++filt stay as they are: 5scene.)
FOLDERS = "(?:bvh|exact|kernels|mesh|parallel|predicate|scene|space)"
INSIDE = rf"\b{FOLDERS}::|\(anonymous namespace\)|^_Z.*\d{FOLDERS}\d"
ARITHMETIC = re.compile(
    r"\t(?:v?(?:add|sub|mul|div|sqrt|min|max|u?comi|cmp\w*|fn?m\w+|round|cvt\w*)[sp][sd]\w*"  # x86
    r"|f(?:add|sub|mul|div|cmp|cmpe|madd|msub|nmadd|nmsub|mla|mls|sqrt|min|max|cvt\w*)\t)")


def output_of(*command):
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout


def names(*command):
    """mangled -> demangled, of the symbols that nm lists."""
    mangled = [line.split()[-1] for line in output_of("nm", *command).splitlines() if line.strip()
               and len(line.split()) > 2]
    plain = subprocess.run(["c++filt"], input="\n".join(mangled), capture_output=True, text=True,
                           check=True).stdout.splitlines()
    return dict(zip(mangled, plain))


def without_arguments(name):
    """pierce::Scene<float>::build(std::span<...>) -> pierce::Scene::build, result type left out."""
    name = re.sub(r"^(?:vtable|typeinfo(?: name)?|(?:non-)?virtual thunk) (?:for|to) ", "", name)
    depth, kept = 0, ""
    for character in re.sub(r"operator(?:<=>|[-+*/=<>!&|^]+|\(\))", "operator", name):
        if character == "(" and depth == 0:
            break
        depth += (character in "<(") - (character in ">)")
        kept += character if depth == 0 and character not in ">)" else ""
    return kept.split(" ")[-1]


def extern_templates(headers):
    """Names of what the headers promise to be in the library, with the type it is for."""
    text = "\n".join(p.read_text("utf-8") for p in sorted(headers.rglob("*.h")))
    for declaration in re.findall(r"extern template ([^;]*);", text):
        kind = re.search(r"<(float|double)>", declaration)[1]
        of_class = re.match(r"(?:class|struct) (\w+)", declaration)
        yield (of_class or re.search(r"(\w+)\(", declaration))[1], kind


def words_of(headers):
    return set(re.findall(r"\w+", "\n".join(p.read_text("utf-8") for p in headers.rglob("*.h"))))


def shared(library, headers):
    """Offences of a shared library."""
    exported = names("-D", "--defined-only", library).values()
    words = words_of(headers)
    for name in exported:
        parts = without_arguments(name).split("::")
        if parts[0] != "pierce" or "Impl" in parts or "detail" in parts or not all(
                part.lstrip("~") in words for part in parts):
            yield f"{name}: leaves the library, and no public header declares it"
    for function, kind in sorted(set(extern_templates(headers))):
        if not any(re.search(rf"\bpierce::{function}<{kind}>", name) for name in exported):
            yield f"pierce::{function}<{kind}>: is declared in a public header, and not exported"
    if not exported:
        yield "nothing is exported"


def static(library, headers):
    """Offences of a static library."""
    weak = {mangled: name for mangled, name in names("--defined-only", library).items()}
    kinds = dict(line.split()[-1:-3:-1] for line in output_of(
        "nm", "--defined-only", library).splitlines() if len(line.split()) > 2)
    promised = "|".join(sorted({name for name, _ in extern_templates(headers)}))
    public = "|".join(sorted(words_of(headers)))
    ours = re.compile(rf"{INSIDE}|\bpierce::(?:{promised})<|\bpierce::(?!(?:{public})\b)\w")
    found, current = set(), ""
    for line in output_of("objdump", "-d", "--no-show-raw-insn", library).splitlines():
        heading = re.match(r"[0-9a-f]+ <(.*)>:$", line)
        if heading:
            current = heading[1]
        elif kinds.get(current) in ("W", "V", "u") and ARITHMETIC.search(line):
            found.add(current)
    if not found:
        yield "no weak function computes with floating-point numbers: this looks at nothing"
    for mangled in sorted(found):
        if not ours.search(weak[mangled]):
            yield f"{weak[mangled]}: the linker may take a caller's copy"


if __name__ == "__main__":
    if len(sys.argv) != 4 or sys.argv[1] not in ("shared", "static"):
        sys.exit(__doc__)
    check = shared if sys.argv[1] == "shared" else static
    offences = list(check(sys.argv[2], pathlib.Path(sys.argv[3])))
    print(*offences, sep="\n", end="\n" if offences else "")
    sys.exit(1 if offences else 0)
