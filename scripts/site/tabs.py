# SPDX-License-Identifier: Apache-2.0
"""A hook of mkdocs: blocks of code in several languages, one after the other, become tabs.

So the pages stay plain Markdown, which the tests of the pages read and GitHub shows.
"""
import re

NAMES = {"cpp": "C++", "python": "Python", "sh": "Command line"}
FENCE = r"```(cpp|python|sh)\n(?:(?!```)[^\n]*\n)*```\n"
GROUP = re.compile(rf"^(?:{FENCE}){{2,}}", re.M)


def tabs(group):
    blocks = [match[0] for match in re.finditer(FENCE, group)]
    languages = [block[3:block.index("\n")] for block in blocks]
    if len(set(languages)) != len(languages):
        return group
    lines = []
    for language, block in zip(languages, blocks):
        lines += [f'=== "{NAMES[language]}"', ""]
        lines += ["    " + line if line else "" for line in block.splitlines()] + [""]
    return "\n".join(lines) + "\n"


def on_page_markdown(markdown, page, **_):
    if page.file.src_uri != "guide.md":
        return markdown
    return GROUP.sub(lambda match: tabs(match[0]), markdown)
