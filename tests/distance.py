"""How far a slide is from its code: the files, and lines of code, that a function needs with all it calls.

    python tests/distance.py     # prints tasks, verbs and rooms; it sets no limits

A line of code is one that is no docstring, comment or empty line. Names are followed through the
imports inside hdrlab; what is looked up at run time is not.
"""

import ast
import tomllib
from collections import Counter, defaultdict
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
VERBS = (
    "align.mtb.align",
    "align.cerman.align",
    "response.debevec.recover",
    "response.robertson.recover",
    "response.mitsunaga.recover",
    "response.grossberg.recover",
    "response.mann.recover",
    "radiance.merge.merge",
    "tonemap.ward.tonemap",
    "tonemap.chiu.tonemap",
    "tonemap.durand.tonemap",
    "tonemap.reinhard.tonemap",
    "tonemap.fattal.tonemap",
    "tonemap.local_laplacian.tonemap",
    "enhance.mertens.fuse",
    "enhance.battiato.correct",
)
LESSONS = ("core", "capture", "align", "response", "calibration", "radiance", "tonemap", "enhance")
LESSONS += ("beyond", "fast", "diagnostics", "pipeline")
DOCUMENTED = (ast.Module, ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)


def code_lines(text):
    """Return the numbers of the lines that hold code."""
    words = [line.strip() for line in text.split("\n")]
    lines, docstrings = {n for n, word in enumerate(words, 1) if word and word[0] != "#"}, set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(
            node, ast.Constant | ast.JoinedStr
        ):  # a long string is code, whatever it holds
            lines.update(range(node.lineno, node.end_lineno + 1))
        if isinstance(node, DOCUMENTED) and ast.get_docstring(node) is not None:
            docstrings.update(range(node.body[0].lineno, node.body[0].end_lineno + 1))
    return lines - docstrings


class Library:
    """The definitions, imports and code lines of every module of a package, read from the source."""

    def __init__(self, sources):
        self.definitions, self.imports, self.code = {}, {}, {}
        for name, text in sources.items():
            self.code[name] = code_lines(text)
            self.definitions[name], self.imports[name] = {}, {}
            for node in ast.parse(text).body:
                self._enter(name, node)

    def _enter(self, module, node):
        if isinstance(node, ast.ImportFrom) and node.module:
            for alias in node.names:
                self.imports[module][alias.asname or alias.name] = (node.module, alias.name)
        elif isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            self.definitions[module][node.name] = node
        elif isinstance(node, (ast.Assign, ast.AnnAssign)):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            for part in (part for target in targets for part in ast.walk(target)):
                if isinstance(part, ast.Name):
                    self.definitions[module][part.id] = node

    def resolve(self, module, name):
        """Return where a name of a module is defined: (module, name), (module, None) if a module, or None."""
        while name not in self.definitions.get(module, {}):
            source, name = self.imports.get(module, {}).get(name, (None, None))
            if f"{source}.{name}" in self.definitions:
                return f"{source}.{name}", None
            if source not in self.definitions:
                return None
            module = source
        return module, name

    def needs(self, function):
        """Return all definitions that a function needs, its own included, as a set of (module, name)."""
        module, _, name = function.rpartition(".")
        reached, waiting = set(), [self.resolve(module, name)]
        assert waiting[0], f"{function} is not there"
        while waiting:
            place = waiting.pop()
            if place in reached or place is None or place[1] is None:
                continue
            reached.add(place)
            for node in ast.walk(self.definitions[place[0]][place[1]]):
                if isinstance(node, ast.Name):
                    waiting.append(self.resolve(place[0], node.id))
                elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
                    owner = self.resolve(place[0], node.value.id)
                    if owner and owner[1] is None:
                        waiting.append(self.resolve(owner[0], node.attr))
        return reached

    def distance(self, function):
        """Return how many files, and lines of code, a function needs."""
        lines = defaultdict(set)
        for module, name in self.needs(function):
            node = self.definitions[module][name]
            first = min([node.lineno, *(one.lineno for one in getattr(node, "decorator_list", []))])
            lines[module] |= self.code[module].intersection(range(first, node.end_lineno + 1))
        return len(lines), sum(map(len, lines.values()))

    def rooms(self):
        """Return the lines of code of each room."""
        count = Counter()
        for module, lines in self.code.items():
            count[(module.split(".") + ["(top)"])[1]] += len(lines)
        return count


@cache
def read(package=ROOT / "hdrlab"):
    """Return the Library of a package; reading takes seconds."""
    sources = {}
    for path in sorted(package.rglob("*.py")):
        name = ".".join(path.relative_to(package.parent).with_suffix("").parts).removesuffix(
            ".__init__"
        )
        sources[name] = path.read_text(encoding="utf8")
    return Library(sources)


def tasks(package=ROOT / "hdrlab"):
    """Return the function of each task of the plan."""
    plan = tomllib.loads((package / "course" / "plan.toml").read_text(encoding="utf8"))
    each = [homework for homework in plan.values() if isinstance(homework, dict)]
    return {
        task["id"]: f"hdrlab.{task['function']}" for one in each for task in one.get("tasks", [])
    }


def main():
    """Print the distance of each task and method, and the lines of code of each room."""
    library = read()
    print(f"{'':50}{'files':>6}{'lines':>7}")
    for name in (*tasks().values(), *(f"hdrlab.{verb}" for verb in VERBS)):
        print("{:50}{:6}{:7}".format(name, *library.distance(name)))
    rooms = library.rooms()
    for room, lines in rooms.most_common():
        print(f"{room:56}{lines:7}")
    print(
        f"{'the lesson rooms':56}{sum(rooms[one] for one in LESSONS):7}\n{'hdrlab':56}{rooms.total():7}"
    )


if __name__ == "__main__":
    main()
