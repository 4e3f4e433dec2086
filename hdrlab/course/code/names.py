"""Which names a piece of Python binds, and which it takes from outside: read from its tree, never run."""

import ast
from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

Function = ast.FunctionDef | ast.AsyncFunctionDef | ast.Lambda
INNER = (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)
COMPREHENSIONS = (ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)


class Use(NamedTuple):
    """A name that stands for something outside the piece, and where it is written.

    With an attribute, as in weights.hat, `whole` is where both are written.
    """

    node: ast.Name
    whole: ast.expr
    attribute: str


def free(node: ast.AST) -> list[Use]:
    """Return the uses of names that a piece does not bind around them, in the order of reading.

    Examples
    --------
    >>> [use.node.id for use in free(ast.parse("def f(x, y=a): return [x * b for z in y]").body[0])]
    ['a', 'b']
    """
    return list(_uses(node, frozenset()))


def bound(node: ast.AST) -> list[str]:
    """Return the names that a statement binds where it stands, not those inside functions within it.

    Examples
    --------
    >>> bound(ast.parse("for i, (j, k) in pairs: n = i").body[0])
    ['i', 'j', 'k', 'n']
    """
    return list(dict.fromkeys(_bound(node)))


def _bound(node: ast.AST) -> Iterator[str]:
    if isinstance(node, ast.Name):
        yield from [node.id] if isinstance(node.ctx, ast.Store) else []
    elif isinstance(node, INNER):
        yield node.name
    elif isinstance(node, ast.Import | ast.ImportFrom):
        yield from (alias.asname or alias.name.split(".")[0] for alias in node.names)
    elif not isinstance(node, ast.Lambda):
        if isinstance(node, ast.ExceptHandler | ast.MatchAs | ast.MatchStar) and node.name:
            yield node.name
        yield from (name for one in _inside(node) for name in _bound(one))


def _inside(node: ast.AST) -> Iterable[ast.AST]:
    """Return the parts of a node in which it binds: the targets of a comprehension are its own."""
    if not isinstance(node, COMPREHENSIONS):
        return ast.iter_child_nodes(node)
    return [one for one in ast.walk(node) if isinstance(one, ast.NamedExpr)]


def _uses(node: ast.AST, around: frozenset[str]) -> Iterator[Use]:
    if isinstance(node, ast.Name):
        if isinstance(node.ctx, ast.Load) and node.id not in around:
            yield Use(node, node, "")
    elif isinstance(node, ast.Attribute) and isinstance(node.value, ast.Name):
        if node.value.id not in around:
            yield Use(node.value, node, node.attr)
    elif isinstance(node, Function):
        yield from _of_function(node, around)
    elif isinstance(node, COMPREHENSIONS):
        generators = node.generators
        own = around.union(*(bound(one.target) for one in generators))
        yield from _each([one for one in ast.iter_child_nodes(node) if one not in generators], own)
        yield from _each(generators, own)
    else:
        yield from _each(ast.iter_child_nodes(node), around)


def _of_function(node: Function, around: frozenset[str]) -> Iterator[Use]:
    """Yield the uses of a function: its head is outside of it, its body knows its arguments."""
    yield from _each(head(node), around)
    body: Sequence[ast.AST] = node.body if isinstance(node.body, list) else [node.body]
    arguments = {one.arg for one in ast.walk(node.args) if isinstance(one, ast.arg)}
    parts = (part for one in body for part in ast.walk(one) if isinstance(part, ast.Global))
    outside = {name for part in parts for name in part.names}
    own = around.union(arguments, *map(bound, body)) - outside
    yield from _each(body, own)


def head(node: ast.AST) -> list[ast.AST]:
    """Return what of a function is run when it is defined: decorators, defaults and annotations."""
    parts = (getattr(node, "args", None), getattr(node, "returns", None))
    return [*getattr(node, "decorator_list", ()), *(one for one in parts if isinstance(one, ast.AST))]


def _each(nodes: Iterable[ast.AST], around: frozenset[str]) -> Iterator[Use]:
    return (use for one in nodes for use in _uses(one, around))
