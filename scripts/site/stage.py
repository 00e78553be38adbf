#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Lays the site's pages out: docs/, README.md, HACKING.md, the references, the lesson.

Links to other files of the repository lead to copies of these, so that the site needs no other.

usage: stage.py SOURCE PAGES
"""
import os
import pathlib
import re
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import cpp_api  # noqa: E402
import python_api  # noqa: E402

LINK = re.compile(r"(!?\[(?:[^\[\]]|\[[^\]]*\])*\]\()([^)\s]+)(\))")
FENCE = re.compile(r"^```.*?^```\s*$", re.M | re.S)
RENAMED = {"README.md": "index.md", "HACKING.md": "hacking.md",
           "CONTRIBUTING.md": "contributing.md", "docs/decisions/README.md": "decisions/index.md"}


class Stage:
    def __init__(self, source, pages):
        self.source, self.pages = source, pages
        self.files = {}  # of the repository, beside pages: path -> where its copy lies

    def page_of(self, path):
        """Where a page of the repository lies on the site; None if it is none."""
        name = path.relative_to(self.source).as_posix()
        if name in RENAMED:
            return RENAMED[name]
        return name.removeprefix("docs/") if name.startswith("docs/") else None

    def place_of(self, path):
        page = self.page_of(path)
        if page is not None and path.is_file():
            return page
        name = path.relative_to(self.source).as_posix()
        self.files[path] = f"files/{name}/index.md" if path.is_dir() else f"files/{name}.txt"
        return self.files[path]

    def relinked(self, text, path, place):
        def link(match):
            target, hash_, anchor = match[2].partition("#")
            if not target or re.match(r"[a-z]+:", target):
                return match[0]
            to = (path.parent / target).resolve()
            if not to.exists():
                raise SystemExit(f"{path}: the link {target} leads nowhere")
            return match[1] + os.path.relpath(
                self.place_of(to), os.path.dirname(place) or ".") + hash_ + anchor + match[3]

        parts, at = [], 0
        for fence in FENCE.finditer(text):
            parts += [LINK.sub(link, text[at:fence.start()]), fence[0]]
            at = fence.end()
        return "".join(parts) + LINK.sub(link, text[at:])

    def write(self, place, text):
        to = self.pages / place
        to.parent.mkdir(parents=True, exist_ok=True)
        to.write_text(text, encoding="utf-8")

    def lay_out(self):
        for path in [*(self.source / name for name in RENAMED), *self.source.glob("docs/**/*")]:
            if not path.is_file():
                continue
            place = self.page_of(path)
            if path.suffix == ".md":
                self.write(place, self.relinked(path.read_text(encoding="utf-8"), path, place))
            elif path.suffix in (".svg", ".png"):
                (self.pages / place).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(path, self.pages / place)
        for path, place in self.files.items():
            if path.is_file():
                (self.pages / place).parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(path, self.pages / place)
                continue
            lines = [f"# {path.relative_to(self.source).as_posix()}/", ""]
            for inside in sorted(path.rglob("*")):
                if inside.is_file() and "__pycache__" not in inside.parts:
                    lines.append(f"- `{inside.relative_to(path).as_posix()}`")
            self.write(place, "\n".join(lines) + "\n")
        self.write("reference/cpp.md", cpp_api.reference(self.source))
        self.write("reference/python.md", python_api.reference(self.source))
        lesson = self.source / "web/dist/index.html"
        if lesson.is_file():
            (self.pages / "lesson").mkdir()
            shutil.copy(lesson, self.pages / "lesson/index.html")
            page = self.pages / "lesson.md"
            button = "[Open the lesson and the playground](lesson/index.html)"
            page.write_text(f"{page.read_text()}\n{button}{{ .md-button .md-button--primary }}\n")


def main():
    source, pages = (pathlib.Path(word).resolve() for word in sys.argv[1:])
    shutil.rmtree(pages, ignore_errors=True)
    Stage(source, pages).lay_out()


if __name__ == "__main__":
    main()
