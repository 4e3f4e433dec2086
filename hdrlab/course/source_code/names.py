"""Find the names that a piece of Python binds, and those that it takes from outside, without running it."""

import ast
import contextlib
from collections.abc import Iterable, Iterator
from typing import NamedTuple

Function = ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda
DEFINITIONS = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
# what Python's parser raises for a text that is no Python
PARSE_ERRORS = (SyntaxError, ValueError, RecursionError, MemoryError)
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
    uses: list[FreeName] = []
    # a stack instead of recursion: a student's code may be nested deeper than Python's calls go
    waiting: list[tuple[ast.AST, frozenset[str]]] = [(node, frozenset())]
    while waiting:
        part, bound = waiting.pop()
        if isinstance(part, ast.Name):
            if isinstance(part.ctx, ast.Load) and part.id not in bound:
                uses.append(FreeName(part, part, ""))
        elif isinstance(part, ast.Attribute) and isinstance(part.value, ast.Name):
            if part.value.id not in bound:
                uses.append(FreeName(part.value, part, part.attr))
        else:
            waiting += reversed(list(_parts(part, bound)))
    return uses


def bound_names(node: ast.AST) -> list[str]:
    """Return the names that a statement binds where it stands, not those inside functions within it.

    Examples
    --------
    >>> bound_names(ast.parse("for i, (j, k) in pairs: n = i").body[0])
    ['i', 'j', 'k', 'n']
    """
    bound: list[str] = []
    waiting = [node]
    while waiting:
        part = waiting.pop()
        if isinstance(part, ast.Name):
            if isinstance(part.ctx, ast.Store):
                bound.append(part.id)
        elif isinstance(part, DEFINITIONS):
            bound.append(part.name)
        elif isinstance(part, ast.Import | ast.ImportFrom):
            bound += [alias.asname or alias.name.split(".")[0] for alias in part.names]
        elif isinstance(part, COMPREHENSIONS):  # its own loop variables are not visible outside
            walrus = [inner for inner in ast.walk(part) if isinstance(inner, ast.NamedExpr)]
            bound += [inner.target.id for inner in walrus]
        elif not isinstance(part, ast.Lambda):
            if isinstance(part, ast.ExceptHandler | ast.MatchAs | ast.MatchStar) and part.name:
                bound.append(part.name)
            waiting += reversed(list(ast.iter_child_nodes(part)))
    return list(dict.fromkeys(bound))


def _parts(node: ast.AST, bound: frozenset[str]) -> Iterator[tuple[ast.AST, frozenset[str]]]:
    """Yield the parts of a node in the order of reading, each with the names that are bound around it."""
    if isinstance(node, Function):
        for part in head(node):
            yield part, bound
        body = node.body if isinstance(node.body, list) else [node.body]
        inside = (bound | _bound_inside(node)) - _globals_of(body)
        for part in body:
            yield part, inside
        return
    parts: Iterable[ast.AST] = ast.iter_child_nodes(node)
    if isinstance(node, COMPREHENSIONS):
        bound = bound.union(*(bound_names(generator.target) for generator in node.generators))
        # the element comes first in the text, and its loops after it
        parts = sorted(parts, key=lambda part: isinstance(part, ast.comprehension))
    for part in parts:
        yield part, bound


def _bound_inside(node: Function) -> frozenset[str]:
    """Return the arguments of a function and the names that its body binds."""
    arguments = {part.arg for part in ast.walk(node.args) if isinstance(part, ast.arg)}
    body = node.body if isinstance(node.body, list) else [node.body]
    return frozenset(arguments.union(*(bound_names(statement) for statement in body)))


def _globals_of(body: Iterable[ast.AST]) -> frozenset[str]:
    """Return the names that a function's body declares as global."""
    declarations = [
        part for statement in body for part in ast.walk(statement) if isinstance(part, ast.Global)
    ]
    return frozenset(name for declaration in declarations for name in declaration.names)


def head(node: ast.AST) -> list[ast.AST]:
    """Return the parts of a function that run when it is defined: decorators, defaults, annotations."""
    parts = [
        *getattr(node, "decorator_list", ()),
        getattr(node, "args", None),
        getattr(node, "returns", None),
    ]
    return [part for part in parts if isinstance(part, ast.AST)]


def modules(source: str | bytes) -> set[str]:
    """Return the modules that a text imports, dotted; imported names count, for they may be modules.

    A text that is no Python imports nothing.
    """
    imported: set[str] = set()
    with contextlib.suppress(*PARSE_ERRORS):
        for node in ast.walk(ast.parse(source)):
            if isinstance(node, ast.Import):
                imported |= {alias.name for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.module and node.level == 0:
                imported.add(node.module)
                imported |= {f"{node.module}.{alias.name}" for alias in node.names}
    return imported


def imported_numpy_modules(sources: Iterable[str]) -> list[str]:
    """Return the parts of numpy and scipy that some sources import, so that they are imported once.

    Examples
    --------
    >>> sources = ["from scipy import ndimage", "import scipy.sparse.linalg as la, os", "not Python"]
    >>> imported_numpy_modules(sources)
    ['scipy', 'scipy.ndimage', 'scipy.sparse.linalg']
    """
    imported = {name for source in sources for name in modules(source)}
    return sorted(name for name in imported if name.split(".")[0] in ("numpy", "scipy"))
