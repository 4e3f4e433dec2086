"""Which names a piece of Python binds, and which it takes from outside: read from its tree, never run."""

import ast
import contextlib
from collections.abc import Iterable, Iterator
from typing import NamedTuple

Function = ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda
INNER = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
BROKEN = (SyntaxError, ValueError, RecursionError, MemoryError)  # what text may do to a parser
COMPREHENSIONS = (ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)


class FreeName(NamedTuple):
    """A name that stands for something outside the piece, and where it is written.

    With an attribute, as in weights.hat, `whole` is where both are written.
    """

    node: ast.Name
    whole: ast.expr
    attribute: str


def free_names(node: ast.AST) -> list[FreeName]:
    """Return the uses of names that a piece does not bind around them, in the order of reading.

    Examples
    --------
    >>> [use.node.id for use in free_names(ast.parse("def f(x, y=a): return [x * b for z in y]").body[0])]
    ['a', 'b']
    """
    found: list[FreeName] = []
    waiting: list[tuple[ast.AST, frozenset[str]]] = [(node, frozenset())]
    while waiting:  # by hand: what a student wrote may be nested deeper than calls go
        one, around = waiting.pop()
        if isinstance(one, ast.Name):
            if isinstance(one.ctx, ast.Load) and one.id not in around:
                found.append(FreeName(one, one, ""))
        elif isinstance(one, ast.Attribute) and isinstance(one.value, ast.Name):
            if one.value.id not in around:
                found.append(FreeName(one.value, one, one.attr))
        else:
            waiting += reversed(list(_parts(one, around)))
    return found


def bound_names(node: ast.AST) -> list[str]:
    """Return the names that a statement binds where it stands, not those inside functions within it.

    Examples
    --------
    >>> bound_names(ast.parse("for i, (j, k) in pairs: n = i").body[0])
    ['i', 'j', 'k', 'n']
    """
    found: list[str] = []
    waiting = [node]
    while waiting:
        one = waiting.pop()
        if isinstance(one, ast.Name):
            found += [one.id] if isinstance(one.ctx, ast.Store) else []
        elif isinstance(one, INNER):
            found.append(one.name)
        elif isinstance(one, ast.Import | ast.ImportFrom):
            found += [alias.asname or alias.name.split(".")[0] for alias in one.names]
        elif isinstance(one, COMPREHENSIONS):  # its targets are its own
            inner = [part for part in ast.walk(one) if isinstance(part, ast.NamedExpr)]
            found += [part.target.id for part in inner]
        elif not isinstance(one, ast.Lambda):
            if isinstance(one, ast.ExceptHandler | ast.MatchAs | ast.MatchStar) and one.name:
                found.append(one.name)
            waiting += reversed(list(ast.iter_child_nodes(one)))
    return list(dict.fromkeys(found))


def _parts(node: ast.AST, around: frozenset[str]) -> Iterator[tuple[ast.AST, frozenset[str]]]:
    """Yield the parts of a node in the order of reading, each with the names that are bound around it."""
    if isinstance(node, Function):
        yield from ((one, around) for one in head(node))
        own = _inside(node, around)
        yield from (
            (one, own) for one in (node.body if isinstance(node.body, list) else [node.body])
        )
        return
    parts: Iterable[ast.AST] = ast.iter_child_nodes(node)
    if isinstance(node, COMPREHENSIONS):
        around = around.union(*(bound_names(one.target) for one in node.generators))
        parts = sorted(parts, key=lambda one: isinstance(one, ast.comprehension))
    yield from ((one, around) for one in parts)


def _inside(node: Function, around: frozenset[str]) -> frozenset[str]:
    """Return the names that are bound around what is inside a function."""
    own = around.union(one.arg for one in ast.walk(node.args) if isinstance(one, ast.arg))
    if isinstance(node, ast.Lambda):
        return own.union(bound_names(node.body))
    inner = (part for one in node.body for part in ast.walk(one) if isinstance(part, ast.Global))
    return own.union(*map(bound_names, node.body)).difference(*(part.names for part in inner))


def head(node: ast.AST) -> list[ast.AST]:
    """Return what of a function is run when it is defined: decorators, defaults and annotations."""
    parts = (getattr(node, "args", None), getattr(node, "returns", None))
    return [
        *getattr(node, "decorator_list", ()),
        *(one for one in parts if isinstance(one, ast.AST)),
    ]


def modules(source: str | bytes) -> set[str]:
    """Return what a text imports, dotted, with names that may be modules; nothing of what is no Python."""
    found: set[str] = set()
    with contextlib.suppress(*BROKEN):
        for node in ast.walk(ast.parse(source)):
            if isinstance(node, ast.Import):
                found |= {alias.name for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
                found |= {node.module} | {f"{node.module}.{alias.name}" for alias in node.names}
    return found


def imported_numpy_modules(sources: Iterable[str]) -> list[str]:
    """Return the parts of numpy and scipy that some sources import, so that they are imported once.

    Examples
    --------
    >>> sources = ["from scipy import ndimage", "import scipy.sparse.linalg as la, os", "not Python"]
    >>> imported_numpy_modules(sources)
    ['scipy', 'scipy.ndimage', 'scipy.sparse.linalg']
    """
    found = set().union(*map(modules, sources))
    return sorted(one for one in found if one.split(".")[0] in ("numpy", "scipy"))
