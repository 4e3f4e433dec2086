"""A function of the library with all that it needs of it, as text that runs with numpy and scipy alone.

A solution is the library's own function. In a notebook it must stand by itself, and so must what it calls:
definitions are copied as they are written but for types, comments and all, those that are needed
before those that need them. Two definitions of one name, from two modules, part by the module's
name.
"""

import ast
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import NamedTuple

from hdrlab.course.source_code.library_source import (
    SymbolRef,
    module,
    parse_reference,
    statements,
    targets,
)
from hdrlab.errors import InputError


class Block(NamedTuple):
    """What one function adds to a notebook: its imports, what it needs, and itself; whose it is."""

    key: SymbolRef
    imports: tuple[str, ...]
    needs: str
    source: str

    @property
    def text(self) -> str:
        """All of it, as one cell."""
        return "\n\n".join(
            filter(None, ("\n".join(_grouped(self.imports)), self.needs, self.source))
        )


def inlined(functions: Mapping[str, str], given: Iterable[str] = ()) -> dict[str, Block]:
    """Return a Block for each function, in order; what an earlier one has brought is not brought again.

    Parameters
    ----------
    functions : mapping
        The name that each is to have, and what it is: {"gsolve": "response.debevec.gsolve"}, under
        hdrlab.
    given : iterable of str
        Classes that stand in the notebook already, dotted likewise.

    Raises
    ------
    ValueError
        For a function that the library does not have, or one that cannot stand alone.

    Examples
    --------
    >>> block = inlined({"tent": "core.weights.hat"})["tent"]
    >>> scope = {}
    >>> exec(block.text, scope)
    >>> "hdrlab" in block.text, float(scope["tent"]()[0])
    (False, 0.0)
    """
    wanted = {parse_reference(function): name for name, function in functions.items()}
    orders = [_in_order(key) for key in wanted]
    names = _names(wanted, [key for order in orders for key in order])
    done = {_text(key, {}) for key in map(parse_reference, given)}
    return {wanted[order[-1]]: _block(order, names, done) for order in orders}


def _block(order: Sequence[SymbolRef], names: dict[SymbolRef, str], done: set[str]) -> Block:
    """Return the Block of an order whose last key is the function; `done` holds what is there so far."""
    imports, texts = set(), []
    for key in order:
        imports |= {one.target for one in targets(key) if isinstance(one.target, str)} - done
        text = _text(key, names)
        # what is asked for is there, though an earlier one needed it
        if text not in done or key == order[-1]:
            texts.append(text)
            done.add(text)
    done |= imports
    *needed, source = texts
    return Block(order[-1], tuple(sorted(imports, key=_rank)), _joined(needed), source)


def _grouped(imports: Sequence[str]) -> list[str]:
    """Return the imports, those from one module in one line.

    Examples
    --------
    >>> _grouped(["import numpy as np", "from typing import Any", "from typing import NamedTuple"])
    ['import numpy as np', 'from typing import Any, NamedTuple']
    """
    lines: dict[str, str] = {}
    for line in imports:
        module, _, name = line.partition(" import ")
        lines[module] = f"{lines[module]}, {name}" if name and module in lines else line
    return list(lines.values())


def _rank(line: str) -> tuple[bool, bool, str]:
    """Return where an import stands: the standard library's first, `import` before `from`."""
    outside = any(package in line for package in ("numpy", "scipy", "skimage"))
    return outside, line.startswith("from"), line


def _joined(texts: Iterable[str]) -> str:
    """Return definitions below each other: functions and classes a line apart, constants close."""
    text, before = "", False
    for one in texts:
        long = (
            one.lstrip("@#").startswith(("def ", "class ")) or "\ndef " in one or "\nclass " in one
        )
        text += ("" if not text else "\n\n" if long or before else "\n") + one
        before = long
    return text


def _in_order(key: SymbolRef, seen: set[SymbolRef] | None = None) -> list[SymbolRef]:
    """Return all that a definition needs, itself last: each after what it needs."""
    seen = set() if seen is None else seen
    if key in seen:
        return []
    seen.add(key)
    needed = [one.target for one in targets(key) if isinstance(one.target, SymbolRef)]
    return [*(one for target in needed for one in _in_order(target, seen)), key]


def _names(wanted: dict[SymbolRef, str], needed: Sequence[SymbolRef]) -> dict[SymbolRef, str]:
    """Return the name that each definition gets: its own, or with its module's where that one is taken."""
    names, taken = dict(wanted), {name: _text(key, {}) for key, name in wanted.items()}
    local: dict[SymbolRef, set[str]] = {}  # names that would hide a definition where it is used
    for key in needed:
        for target, node in targets(key):
            if isinstance(target, SymbolRef) and ast.unparse(node) != target.name:
                hidden = {name for one in statements(key) for name in _all_bound(one)}
                local.setdefault(target, set()).update(hidden)
    for key in needed:
        if key in names:
            continue
        source, home = _text(key, {}), re.split(r"[./\\]", key.module.removesuffix(".py"))[-1]
        for name in (key.name, f"{key.name}_{home}", f"{key.name}_{key.module.replace('.', '_')}"):
            if name not in local.get(key, ()) and taken.setdefault(name, source) == source:
                names[key] = name
                break
    return names


def _text(key: SymbolRef, names: dict[SymbolRef, str]) -> str:
    """Return a definition as it is written, with the comment above it, under the names given."""
    lines = module(key.module).lines
    edits: dict[int, list[tuple[int, int, str]]] = {}
    renamed = names.get(key, key.name)
    for target, node in targets(key):
        if isinstance(target, SymbolRef) and names.get(target, target.name) != ast.unparse(node):
            if node.lineno != node.end_lineno:
                raise InputError(f"{key.module}, line {node.lineno}: expected the name on one line")
            edit = (node.col_offset, node.end_col_offset or 0, names.get(target, target.name))
            edits.setdefault(node.lineno, []).append(edit)
    own = statements(key) if renamed != key.name else ()
    for inner in (within for one in own for within in ast.walk(one)):
        if isinstance(inner, ast.Name) and inner.id == key.name:
            edits.setdefault(inner.lineno, []).append(
                (inner.col_offset, inner.end_col_offset or 0, renamed)
            )
    texts = []
    for statement in statements(key):
        first = min(
            [statement.lineno, *(one.lineno for one in getattr(statement, "decorator_list", ()))]
        )
        while first > 1 and lines[first - 2].startswith("#"):
            first -= 1
        places = range(first, (statement.end_lineno or 0) + 1)
        written, at = (
            [_edited(lines[n - 1], edits.get(n, [])) for n in places],
            statement.lineno - first,
        )
        if renamed != key.name and isinstance(statement, ast.FunctionDef | ast.ClassDef):
            written[at] = written[at].replace(f" {key.name}", f" {renamed}", 1)
        texts.append("\n".join(_shortened(statement, written, first)))
    return "\n".join(texts)


def _shortened(statement: ast.stmt, written: list[str], first: int) -> list[str]:
    """Return a definition's lines with the first paragraph of each docstring; the sheet has the rest."""
    inner = [one for one in ast.walk(statement) if isinstance(one, ast.FunctionDef | ast.ClassDef)]
    for one in inner:
        start, end = one.body[0].lineno - first, (one.body[0].end_lineno or 0) - first
        blank = next((n for n in range(start, end) if not written[n].strip()), None)
        if ast.get_docstring(one) is not None and blank is not None:
            written[blank - 1] += '"""'
            written[blank : end + 1] = [None] * (end + 1 - blank)  # type: ignore[list-item]
    return [line for line in written if line is not None]


def _edited(line: str, edits: Iterable[tuple[int, int, str]]) -> str:
    data = line.encode()  # columns are counted in bytes
    for start, end, text in sorted(set(edits), reverse=True):
        data = data[:start] + text.encode() + data[end:]
    return data.decode()


def _all_bound(node: ast.AST) -> set[str]:
    """Return every name that is bound anywhere within a statement."""
    inner = list(ast.walk(node))
    stored = {
        one.id for one in inner if isinstance(one, ast.Name) and isinstance(one.ctx, ast.Store)
    }
    return stored | {one.arg for one in inner if isinstance(one, ast.arg)}
