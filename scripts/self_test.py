# SPDX-License-Identifier: Apache-2.0
"""The frame of the house checks: run on the tree, or prove on small samples that each rule fails.

A check is a function from a root folder to a list of offences. GOOD is a sample tree without any;
each entry of BAD names one file to add or replace in it, which must then give an offence.
"""
import pathlib
import sys
import tempfile


def write_tree(root, files):
    for name, text in files.items():
        path = root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(text.encode("utf-8"))


def self_test(check, good, bad):
    failures = []
    with tempfile.TemporaryDirectory() as folder:
        root = pathlib.Path(folder) / "good"
        write_tree(root, good)
        failures += [f"the good sample gives: {line}" for line in check(root)]
        for number, (what, (name, text)) in enumerate(bad.items()):
            root = pathlib.Path(folder) / f"bad{number}"
            write_tree(root, {**good, name: text})
            if not check(root):
                failures.append(f"not noticed: {what}")
    print(f"self-test: {len(bad)} offences tried, {len(failures)} failures")
    return failures


def main(check, good, bad, script):
    """The command line of a check; returns the exit status."""
    arguments = sys.argv[1:]
    if arguments == ["--self-test"]:
        offences = self_test(check, good, bad)
    else:
        root = pathlib.Path(arguments[0]) if arguments else script.resolve().parent.parent
        offences = check(root.resolve())
    for line in offences:
        print(line)
    return 1 if offences else 0
