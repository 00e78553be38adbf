#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Whether every link of the site leads somewhere, and whether the references are complete.

usage: check.py SOURCE PAGES HTML      exit status 1 if not
       check.py --self-test
"""
import html.parser
import pathlib
import re
import sys
import tempfile
import urllib.parse


class Page(html.parser.HTMLParser):
    def __init__(self, text):
        super().__init__()
        self.anchors, self.links = set(), []
        self.feed(text)

    def handle_starttag(self, tag, attributes):
        for name, value in attributes:
            if name in ("id", "name"):
                self.anchors.add(value)
            if value and name in ("href", "src") and tag != "base":
                self.links.append(value)


def broken(folder):
    """(page, link) for each that leads nowhere."""
    pages = {path: Page(path.read_text(encoding="utf-8")) for path in folder.rglob("*.html")
             if "lesson" not in path.relative_to(folder).parts[:-1]}
    for path, page in pages.items():
        for link in page.links:
            parts = urllib.parse.urlsplit(link)
            if parts.scheme in ("http", "https", "mailto", "data") or path.name == "404.html":
                continue
            to = (path.parent / urllib.parse.unquote(parts.path)).resolve() if parts.path else path
            if to.is_dir():
                to /= "index.html"
            if not to.is_file():
                yield path, link
            elif parts.fragment and to in pages:
                anchor = urllib.parse.unquote(parts.fragment)
                if anchor not in pages[to].anchors and not anchor.startswith("__"):
                    yield path, link


def missing(source, pages):
    """Lines of the public headers' comments, and public names of Python, that no page has."""
    text = (pages / "reference/cpp.md").read_text(encoding="utf-8").replace("\\<", "<")
    for path in (source / "include").rglob("*.h"):
        for line in path.read_text(encoding="utf-8").splitlines():
            doc = re.match(r"\s*///<? ?(.*\S)", line)
            if doc and doc[1] not in text:
                yield f"{path.name}: {doc[1]}"
    python = (pages / "reference/python.md").read_text(encoding="utf-8")
    listed = re.search(r"__all__ = \[(.*?)\]",
                       (source / "bindings/python/pierce/__init__.py").read_text(), re.S)[1]
    for name in re.findall(r'"(\w+)"', listed):
        if f"## pierce.{name}\n" not in python and not name.startswith("_"):
            yield f"pierce.{name}"


def self_test():
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "a.html").write_text('<p id="x"><a href="b.html#y">b</a><a href="#x">x</a>')
        (folder / "b.html").write_text('<p id="y"><a href="a.html#z">a</a><img src="c.png">')
        found = sorted(link for _, link in broken(folder))
    assert found == ["a.html#z", "c.png"], found
    print("two broken links out of four, found")
    return 0


def main():
    if sys.argv[1:] == ["--self-test"]:
        return self_test()
    source, pages, folder = (pathlib.Path(word).resolve() for word in sys.argv[1:])
    faults = [f"{path.relative_to(folder)}: {link} leads nowhere" for path, link in broken(folder)]
    faults += [f"the reference has not: {line}" for line in missing(source, pages)]
    print("\n".join(faults[:50]))
    print(f"{len(list(folder.rglob('*.html')))} pages, {len(faults)} faults")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
