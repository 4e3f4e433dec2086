"""Count the files and the lines of code that a reader needs for a function, with all that it calls.

    python -m tools.reading_distance

The script prints the counts of each task and method, and the lines of code of each folder of hdrlab.
It sets no limits. Docstrings, comments and empty lines do not count. Names are followed through the
imports inside hdrlab; what is looked up at run time is not.
"""

import ast
import tomllib
from collections import Counter, defaultdict
from dataclasses import dataclass
from functools import cache
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
METHODS = (
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
LESSON_FOLDERS = (
    "core",
    "capture",
    "align",
    "response",
    "calibration",
    "radiance",
    "tonemap",
    "enhance",
    "beyond",
    "fast",
    "diagnostics",
    "pipeline",
)
DOCUMENTED_NODES = (ast.Module, ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)


@dataclass(frozen=True)
class Distance:
    """What a reader of a function has to open: the number of files, and of lines of code in them."""

    file_count: int
    line_count: int


def code_line_numbers(text):
    """Return the numbers of the lines that hold code."""
    lines = set()
    for number, line in enumerate(text.split("\n"), 1):
        if line.strip() and not line.strip().startswith("#"):
            lines.add(number)
    docstring_lines = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Constant | ast.JoinedStr):
            # a long string is code, also where a line of it is empty or looks like a comment
            lines.update(range(node.lineno, node.end_lineno + 1))
        if isinstance(node, DOCUMENTED_NODES) and ast.get_docstring(node) is not None:
            docstring = node.body[0]
            docstring_lines.update(range(docstring.lineno, docstring.end_lineno + 1))
    return lines - docstring_lines


class Library:
    """The definitions, imports and code lines of every module of a package.

    Parameters
    ----------
    sources : the source text of each module, by its dotted name
    """

    def __init__(self, sources):
        self.definitions = {}
        self.imports = {}
        self.code_lines = {}
        for module, text in sources.items():
            self.code_lines[module] = code_line_numbers(text)
            self.definitions[module] = {}
            self.imports[module] = {}
            for node in ast.parse(text).body:
                self._add_statement(module, node)

    def _add_statement(self, module, node):
        if isinstance(node, ast.ImportFrom) and node.module:
            for alias in node.names:
                self.imports[module][alias.asname or alias.name] = (node.module, alias.name)
        elif isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            self.definitions[module][node.name] = node
        elif isinstance(node, (ast.Assign, ast.AnnAssign)):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            for target in targets:
                for part in ast.walk(target):
                    if isinstance(part, ast.Name):
                        self.definitions[module][part.id] = node

    def resolve(self, module, name):
        """Return where a name of a module is defined.

        Returns
        -------
        (module, name), or (module, None) if the name is a module, or None if it is not in the package
        """
        while name not in self.definitions.get(module, {}):
            source, name = self.imports.get(module, {}).get(name, (None, None))
            if f"{source}.{name}" in self.definitions:
                return f"{source}.{name}", None
            if source not in self.definitions:
                return None
            module = source
        return module, name

    def needed_definitions(self, function):
        """Return all definitions that a function needs, including itself, as a set of (module, name).

        Raises
        ------
        LookupError
            If the function does not exist.
        """
        module, _, name = function.rpartition(".")
        start = self.resolve(module, name)
        if start is None:
            raise LookupError(f"there is no function {function}")
        needed = set()
        waiting = [start]
        while waiting:
            place = waiting.pop()
            if place is None or place[1] is None or place in needed:
                continue
            needed.add(place)
            waiting.extend(self._used_places(*place))
        return needed

    def _used_places(self, module, name):
        """Yield where the names that a definition uses are defined; None for names from elsewhere."""
        for node in ast.walk(self.definitions[module][name]):
            if isinstance(node, ast.Name):
                yield self.resolve(module, node.id)
            elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
                owner = self.resolve(module, node.value.id)
                if owner is not None and owner[1] is None:
                    yield self.resolve(owner[0], node.attr)

    def distance(self, function):
        """Return the Distance of a function."""
        lines = defaultdict(set)
        for module, name in self.needed_definitions(function):
            node = self.definitions[module][name]
            decorators = getattr(node, "decorator_list", [])
            first = min([node.lineno, *(decorator.lineno for decorator in decorators)])
            node_lines = range(first, node.end_lineno + 1)
            lines[module] |= self.code_lines[module].intersection(node_lines)
        return Distance(len(lines), sum(len(numbers) for numbers in lines.values()))

    def folder_line_counts(self):
        """Return the number of lines of code of each folder of the package."""
        counts = Counter()
        for module, lines in self.code_lines.items():
            _, _, rest = module.partition(".")
            folder = rest.partition(".")[0] or "(top)"
            counts[folder] += len(lines)
        return counts


@cache
def read_library(package=ROOT / "hdrlab"):
    """Return the Library of a package. It takes seconds and is cached."""
    sources = {}
    for path in sorted(package.rglob("*.py")):
        parts = path.relative_to(package.parent).with_suffix("").parts
        module = ".".join(parts).removesuffix(".__init__")
        sources[module] = path.read_text(encoding="utf8")
    return Library(sources)


def task_functions(package=ROOT / "hdrlab"):
    """Return the functions that the tasks of the course plan ask for."""
    plan = tomllib.loads((package / "course" / "plan.toml").read_text(encoding="utf8"))
    functions = []
    for table in plan.values():
        if isinstance(table, dict):
            functions.extend(f"hdrlab.{task['function']}" for task in table.get("tasks", []))
    return functions


def main():
    """Print the distance of each task and method, and the lines of code of each folder."""
    library = read_library()
    print(f"{'':50}{'files':>6}{'lines':>7}")
    for function in [*task_functions(), *(f"hdrlab.{method}" for method in METHODS)]:
        distance = library.distance(function)
        print(f"{function:50}{distance.file_count:6}{distance.line_count:7}")
    counts = library.folder_line_counts()
    for folder, count in counts.most_common():
        print(f"{folder:56}{count:7}")
    print(f"{'the folders of the lessons':56}{sum(counts[folder] for folder in LESSON_FOLDERS):7}")
    print(f"{'hdrlab':56}{counts.total():7}")


if __name__ == "__main__":
    main()
