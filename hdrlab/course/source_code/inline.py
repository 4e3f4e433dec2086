"""Copy a function of the library with everything that it needs, as text that runs with numpy and scipy.

A solution is the library's own function. In a notebook it must work without hdrlab, and so must the
functions that it calls. Definitions are copied as they are written, comments included, without type
annotations; each comes after those that it needs. If two modules define the same name differently,
the second gets its module's name appended.
"""

import ast
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from hdrlab.course.source_code.library_source import (
    SymbolRef,
    module,
    parse_reference,
    statements,
    targets,
)
from hdrlab.errors import InputError

OUTSIDE_PACKAGES = ("numpy", "scipy", "skimage")
DEFINITION_STARTS = ("def ", "class ")

# (first column in bytes, end column, new text) of a name in a line
Edit = tuple[int, int, str]


@dataclass(frozen=True)
class Block:
    """What one function adds to a notebook.

    Attributes
    ----------
    key : where the library defines the function
    imports : the import statements that it needs
    needs : the definitions that it needs, as text
    source : the function itself
    """

    key: SymbolRef
    imports: tuple[str, ...]
    needs: str
    source: str

    @property
    def text(self) -> str:
        """Imports, needed definitions and the function, as one cell."""
        parts = ["\n".join(_group_imports(self.imports)), self.needs, self.source]
        return "\n\n".join(part for part in parts if part)


def inlined(functions: Mapping[str, str], given: Iterable[str] = ()) -> dict[str, Block]:
    """Return a Block for each function, in order; none repeats what an earlier one has brought.

    Parameters
    ----------
    functions : mapping
        The name that each function gets, and where it is under hdrlab:
        {"gsolve": "response.debevec.gsolve"}.
    given : iterable of str
        Classes that the notebook has already, dotted in the same way.

    Raises
    ------
    InputError
        For a function that the library does not have, or one that cannot be copied.

    Examples
    --------
    >>> block = inlined({"tent": "core.weights.hat"})["tent"]
    >>> scope = {}
    >>> exec(block.text, scope)
    >>> "hdrlab" in block.text, float(scope["tent"]()[0])
    (False, 0.0)
    """
    name_of = {parse_reference(function): name for name, function in functions.items()}
    orders = [_dependency_order(key) for key in name_of]
    names = _choose_names(name_of, [key for order in orders for key in order])
    present = {_text(parse_reference(dotted), {}) for dotted in given}
    return {name_of[order[-1]]: _block(order, names, present) for order in orders}


def _block(order: Sequence[SymbolRef], names: dict[SymbolRef, str], present: set[str]) -> Block:
    """Return the Block of the last key of an order.

    `present` holds the imports and definitions that the notebook has so far; it grows.
    """
    function = order[-1]
    imports: set[str] = set()
    texts = []
    for key in order:
        for use in targets(key):
            if isinstance(use.target, str) and use.target not in present:
                imports.add(use.target)
        text = _text(key, names)
        # the function itself is always written, even if an earlier block has brought it
        if text not in present or key == function:
            texts.append(text)
            present.add(text)
    present |= imports
    *needed, source = texts
    return Block(
        key=function,
        imports=tuple(sorted(imports, key=_import_rank)),
        needs=_join_definitions(needed),
        source=source,
    )


def _group_imports(imports: Sequence[str]) -> list[str]:
    """Return the imports, with one line for all names from one module.

    Examples
    --------
    >>> _group_imports(["import numpy as np", "from typing import Any", "from typing import NamedTuple"])
    ['import numpy as np', 'from typing import Any, NamedTuple']
    """
    lines: dict[str, str] = {}
    for line in imports:
        module_name, _, name = line.partition(" import ")
        if name and module_name in lines:
            lines[module_name] += f", {name}"
        else:
            lines[module_name] = line
    return list(lines.values())


def _import_rank(line: str) -> tuple[bool, bool, str]:
    """Return the sort key of an import: the standard library first, `import` before `from`."""
    is_outside = any(package in line for package in OUTSIDE_PACKAGES)
    return is_outside, line.startswith("from"), line


def _join_definitions(texts: Iterable[str]) -> str:
    """Return definitions below each other, with an empty line around functions and classes."""
    joined = ""
    previous_is_long = False
    for text in texts:
        starts_definition = text.lstrip("@#").startswith(DEFINITION_STARTS)
        is_long = starts_definition or "\ndef " in text or "\nclass " in text
        if joined:
            joined += "\n\n" if is_long or previous_is_long else "\n"
        joined += text
        previous_is_long = is_long
    return joined


def _dependency_order(key: SymbolRef, seen: set[SymbolRef] | None = None) -> list[SymbolRef]:
    """Return a definition and all that it needs, each after what it needs itself."""
    seen = set() if seen is None else seen
    if key in seen:
        return []
    seen.add(key)
    order: list[SymbolRef] = []
    for use in targets(key):
        if isinstance(use.target, SymbolRef):
            order += _dependency_order(use.target, seen)
    return [*order, key]


def _choose_names(
    name_of: dict[SymbolRef, str], needed: Sequence[SymbolRef]
) -> dict[SymbolRef, str]:
    """Return the name of each definition: its own, or with its module's name if that one is taken."""
    names = dict(name_of)
    text_of_name = {name: _text(key, {}) for key, name in name_of.items()}
    hiding = _hiding_names(needed)
    for key in needed:
        if key in names:
            continue
        text = _text(key, {})
        module_name = re.split(r"[./\\]", key.module.removesuffix(".py"))[-1]
        candidates = (
            key.name,
            f"{key.name}_{module_name}",
            f"{key.name}_{key.module.replace('.', '_')}",
        )
        for name in candidates:
            if name in hiding.get(key, ()):
                continue
            if text_of_name.setdefault(name, text) == text:
                names[key] = name
                break
    return names


def _hiding_names(needed: Sequence[SymbolRef]) -> dict[SymbolRef, set[str]]:
    """Return the local names that would hide a definition where it is used under a dotted name."""
    hiding: dict[SymbolRef, set[str]] = {}
    for key in needed:
        for target, node in targets(key):
            if isinstance(target, SymbolRef) and ast.unparse(node) != target.name:
                bound = {name for statement in statements(key) for name in _bound_names(statement)}
                hiding.setdefault(target, set()).update(bound)
    return hiding


def _text(key: SymbolRef, names: dict[SymbolRef, str]) -> str:
    """Return a definition as it is written, with the comment above it, under its new names."""
    lines = module(key.module).lines
    edits = _edits(key, names)
    new_name = names.get(key, key.name)
    texts = []
    for statement in statements(key):
        first = _first_line(statement, lines)
        last = statement.end_lineno or 0
        written = [
            _edit_line(lines[number - 1], edits.get(number, []))
            for number in range(first, last + 1)
        ]
        if new_name != key.name and isinstance(statement, ast.FunctionDef | ast.ClassDef):
            name_line = statement.lineno - first
            written[name_line] = written[name_line].replace(f" {key.name}", f" {new_name}", 1)
        texts.append("\n".join(_shorten_docstrings(statement, written, first)))
    return "\n".join(texts)


def _edits(key: SymbolRef, names: dict[SymbolRef, str]) -> dict[int, list[Edit]]:
    """Return the edits of each line that give a definition and what it uses their new names."""
    edits: dict[int, list[Edit]] = {}
    for target, node in targets(key):
        if not isinstance(target, SymbolRef):
            continue
        new_name = names.get(target, target.name)
        if new_name == ast.unparse(node):
            continue
        if node.lineno != node.end_lineno:
            raise InputError(f"{key.module}, line {node.lineno}: expected the name on one line")
        edit = (node.col_offset, node.end_col_offset or 0, new_name)
        edits.setdefault(node.lineno, []).append(edit)
    own_name = names.get(key, key.name)
    if own_name == key.name:
        return edits
    for statement in statements(key):  # a function that calls itself
        for inner in ast.walk(statement):
            if isinstance(inner, ast.Name) and inner.id == key.name:
                edit = (inner.col_offset, inner.end_col_offset or 0, own_name)
                edits.setdefault(inner.lineno, []).append(edit)
    return edits


def _first_line(statement: ast.stmt, lines: Sequence[str]) -> int:
    """Return the number of a definition's first line, with its decorators and the comment above it."""
    decorators = getattr(statement, "decorator_list", ())
    first = min([statement.lineno, *(decorator.lineno for decorator in decorators)])
    while first > 1 and lines[first - 2].startswith("#"):
        first -= 1
    return first


def _shorten_docstrings(statement: ast.stmt, lines: Sequence[str], first: int) -> list[str]:
    """Return a definition's lines with only the first paragraph of each docstring.

    The assignment has the rest. `first` is the number of the first line.
    """
    kept: list[str | None] = list(lines)
    for node in ast.walk(statement):
        if not isinstance(node, ast.FunctionDef | ast.ClassDef) or ast.get_docstring(node) is None:
            continue
        start = node.body[0].lineno - first
        end = (node.body[0].end_lineno or 0) - first
        blank_lines = [number for number in range(start, end) if not (kept[number] or "").strip()]
        if blank_lines:
            blank = blank_lines[0]
            kept[blank - 1] = f'{kept[blank - 1]}"""'
            for number in range(blank, end + 1):
                kept[number] = None
    return [line for line in kept if line is not None]


def _edit_line(line: str, edits: Iterable[Edit]) -> str:
    """Return a line with its edits; columns are counted in bytes."""
    data = line.encode()
    for start, end, text in sorted(set(edits), reverse=True):
        data = data[:start] + text.encode() + data[end:]
    return data.decode()


def _bound_names(node: ast.AST) -> set[str]:
    """Return every name that is bound anywhere within a statement."""
    bound = set()
    for inner in ast.walk(node):
        if isinstance(inner, ast.Name) and isinstance(inner.ctx, ast.Store):
            bound.add(inner.id)
        elif isinstance(inner, ast.arg):
            bound.add(inner.arg)
    return bound
