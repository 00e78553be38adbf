# SPDX-License-Identifier: Apache-2.0
"""The Python reference: every public function and class of the package, from its docstrings.

The sources are read, not run, so that nothing needs to be compiled.
"""
import ast
import inspect
import re

MODULES = ["__init__", "rays", "barycentric", "textbook", "job", "io", "dask", "ray", "trimesh",
           "open3d", "pyvista", "embreex"]


class Package:
    def __init__(self, folder):
        self.trees = {path.stem: ast.parse(path.read_text(encoding="utf-8"))
                      for path in folder.glob("*.py")}

    def find(self, module, name):
        """The definition of a name, through imports; (module, node) or None."""
        for node in self.trees[module].body:
            if isinstance(node, (ast.ClassDef, ast.FunctionDef)) and node.name == name:
                return module, node
            if isinstance(node, ast.ImportFrom) and node.level == 1:
                for alias in node.names:
                    if (alias.asname or alias.name) == name and node.module in self.trees:
                        return self.find(node.module, alias.name)
        return None

    def members(self, module, node):
        """Public methods and properties, those of base classes of the package too."""
        own = [(module, n) for n in node.body if isinstance(n, ast.FunctionDef)]
        for base in node.bases:
            found = self.find(module, base.id) if isinstance(base, ast.Name) else None
            if found and isinstance(found[1], ast.ClassDef):
                known = {n.name for _, n in own}
                own += [(m, n) for m, n in self.members(*found) if n.name not in known]
        return own

    def public(self, module):
        for node in self.trees[module].body:
            if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "__all__":
                return ast.literal_eval(node.value)
        return [n.name for n in self.trees[module].body
                if isinstance(n, (ast.ClassDef, ast.FunctionDef)) and not n.name.startswith("_")]


def prose(docstring):
    """A docstring as Markdown: sections become lists, examples blocks of code."""
    lines, out, at = inspect.cleandoc(docstring).splitlines(), [], 0
    while at < len(lines):
        line = lines[at]
        if line.startswith(">>> "):
            end = at
            while end < len(lines) and lines[end].strip():
                end += 1
            out += ["```pycon", *lines[at:end], "```"]
            at = end
        elif re.match(r"(Args|Attributes|Returns|Raises):$", line):
            out += [f"**{line[:-1]}**", ""]
            at += 1
            while at < len(lines) and (not lines[at].strip() or lines[at].startswith(" ")):
                entry = re.match(r"    (\*{0,2}\w[\w, *]*): (.*)$", lines[at])
                out.append(f"- `{entry[1]}`: {entry[2]}" if entry else "  " + lines[at].strip())
                at += 1
            out.append("")
        else:
            out.append(line)
            at += 1
    return "\n".join(out)


def signature(name, node):
    words = f"{name}({ast.unparse(node.args)})"
    return words + (f" -> {ast.unparse(node.returns)}" if node.returns else "")


def described(node):
    return prose(ast.get_docstring(node) or "")


def is_property(node):
    return any(isinstance(d, ast.Name) and d.id == "property" for d in node.decorator_list)


def reference(source):
    package = Package(source / "bindings/python/pierce")
    out = ["# Python reference", "",
           "Made from the docstrings of the package; `help(pierce.Scene)` shows the same.", ""]
    for module in MODULES:
        title = "pierce" if module == "__init__" else f"pierce.{module}"
        out += [f"## {title}", "", prose(ast.get_docstring(package.trees[module]) or ""), ""]
        for name in package.public(module):
            found = package.find(module, name)
            if found is None:
                continue
            where, node = found
            full = f"{title}.{name}"
            out += [f"### {full}", ""]
            if isinstance(node, ast.FunctionDef):
                out += ["```python", signature(name, node), "```", "", described(node), ""]
                continue
            members = package.members(where, node)
            made = next((n for _, n in members if n.name == "__init__"), None)
            if made is not None:
                out += ["```python", signature(name, made).replace("(self, ", "("), "```", ""]
            out += [described(node), ""]
            for _, member in members:
                if member.name.startswith("_"):
                    continue
                text = (member.name if is_property(member)
                        else signature(member.name, member).replace("(self, ", "(").replace(
                            "(self)", "()"))
                out += [f"#### {name}.{member.name}", "", "```python", text, "```", "",
                        described(member), ""]
    return "\n".join(out) + "\n"
