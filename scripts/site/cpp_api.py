# SPDX-License-Identifier: Apache-2.0
"""The C++ reference: every public header with all of its documented declarations.

A declaration is what follows a comment of /// lines. Plain structs and enums are shown whole, with
the comments that stand in them; of classes each member by itself.
"""
import re

DOC = re.compile(r"^\s*///(?!<) ?(.*)$")


def documented(lines):
    """(doc, declaration, depth) for each comment and what it stands before."""
    at = 0
    while at < len(lines):
        match = DOC.match(lines[at])
        if not match:
            at += 1
            continue
        indent = len(lines[at]) - len(lines[at].lstrip())
        doc = []
        while at < len(lines) and (match := DOC.match(lines[at])):
            doc.append(match[1])
            at += 1
        end = declaration_end(lines, at)
        declaration = [line[indent:] for line in lines[at:end]]
        yield "\n".join(doc), declaration, indent
        if not opens_class(declaration):
            at = end
        else:
            at += 1


def declaration_end(lines, at):
    """One past the declaration: further declarations in the lines right below belong to it."""
    depth = 0
    while at < len(lines) and (lines[at].strip() or depth):
        text = re.sub(r"//.*", "", lines[at])
        depth += text.count("{") + text.count("(") - text.count("}") - text.count(")")
        if depth < 0 or (depth == 0 and at and DOC.match(lines[at])):
            return at
        at += 1
    return at


def opens_class(declaration):
    """Whether the members of it are documented by themselves: a class, or a struct of functions."""
    head = next((line for line in declaration if not line.startswith("template")), "")
    return re.match(r"class\b", head) is not None and any("{" in line for line in declaration)


def shown(declaration):
    """Without the bodies of functions; a class without its members."""
    if opens_class(declaration):
        head = []
        for line in declaration:
            head.append(line)
            if "{" in line:
                break
        return "\n".join(head).split("{")[0].rstrip() + ";"
    text = "\n".join(declaration).rstrip()
    body = re.search(r"\)[^;={]*(\{)\s*\n", text)
    if body and not re.match(r"(template.*\n)?(struct|enum)\b", text):
        return text[:body.start(1)].rstrip() + ";"
    return text


def title_of(declaration):
    text = " ".join(line for line in declaration if not re.match(r"\s*(template|requires)\b", line))
    match = (re.match(r"(?:class|struct|enum class|enum)(?: \[\[[^\]]*\]\])? (\w+)", text) or
             re.search(r"\busing (\w+)", text) or re.search(r"(operator\S+)\(", text) or
             re.search(r"(\w+)\s*\(", re.sub(r"\[\[.*?\]\]", "", text)) or
             re.search(r"(\w+)(?:\{[^}]*\})?(?: = [^;]*)?;", text))
    return match[1] if match else text.strip()[:40]


def header_comment(lines):
    text = []
    for line in lines[1:]:
        if not line.startswith("//"):
            break
        text.append(line[2:].removeprefix(" "))
    return "\n".join(text).strip("\n")


def prose(doc):
    """A comment as Markdown: indented lines are code; what looks like a tag is none."""
    lines, before = [], ""
    for line in doc.splitlines():
        is_code = line.startswith("  ") and (before.startswith("  ") or not before)
        if is_code:
            lines.append("    " + line.strip())
        else:
            parts = line.split("`")
            parts[::2] = [re.sub(r"<(?=[\w/])", r"\\<", part) for part in parts[::2]]
            lines.append("`".join(parts))
        before = line
    return "\n".join(lines)


def reference(source):
    folder = source / "include/pierce"
    out = ["# C++ reference", "",
           "Made from the comments of the public headers; all of it is in namespace `pierce`. "
           "`pierce/pierce.h` includes all but the textbook's and the C header.",
           ""]
    for path in sorted(folder.glob("**/*.h")):
        lines = path.read_text(encoding="utf-8").splitlines()
        name = path.relative_to(source / "include").as_posix()
        out += [f"## {name}", "", prose(header_comment(lines)), ""]
        if path.suffix == ".h" and path.name == "pierce_c.h":
            out += ["```c", *lines[2:], "```", ""]
            continue
        owner = ""
        for doc, declaration, indent in documented(lines):
            if not any(line.strip() for line in declaration):
                out += [prose(doc), ""]
                continue
            title = title_of(declaration)
            if indent == 0:
                owner = title if opens_class(declaration) else ""
            full = f"{owner}::{title}" if indent and owner else title
            level = "####" if indent else "###"
            out += [f"{level} {full}", "", prose(doc), "", "```cpp", shown(declaration), "```", ""]
    return "\n".join(out) + "\n"
