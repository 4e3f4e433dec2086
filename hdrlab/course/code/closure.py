"""A task's function with all that it needs of a notebook's other cells, as text that runs by itself.

Names are followed through the statements at the top of the cells: imports, helpers, classes and
constants. So cells may be renamed, split or moved. Of what the handout gives, our own copy is
taken.
"""

import ast
import re
import textwrap
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import accumulate
from typing import NamedTuple

from hdrlab.course.code import names

# modules of which all names may be imported, and magics over plain Python
STARRED = ("numpy", "scipy", "math", "cmath", "random", "itertools", "functools", "typing")
TIMED = ("%%time", "%%timeit", "%%capture", "%%prun", "%%script python")


class Cell(NamedTuple):
    """A code cell: its text, the task that it was handed out for, and whether the handout gives it."""

    text: str
    task: str = ""
    given: bool = False
    where: str = ""


class Statement(NamedTuple):
    """A statement at the top of a cell: its place, its text, the names it binds, and those it needs.

    Of a function, `head` are those needed when it is defined: in its decorators, defaults and
    annotations.
    """

    place: int
    text: str
    binds: frozenset[str]
    needs: frozenset[str]
    head: frozenset[str]
    cell: Cell


def closed(
    cells: Sequence[Cell], tasks: Sequence[str], given: Sequence[Cell] = ()
) -> tuple[dict[str, str], list[str]]:
    """Return the text of each task's function with what it needs, and what is wrong, in words."""
    problems: list[str] = []
    statements: list[Statement] = []
    for cell in [*given, *(one for one in cells if not (one.given and given))]:
        try:
            statements += _statements(cell, len(statements))
        except names.BROKEN as error:
            line = (
                f", line {error.lineno}" if isinstance(error, SyntaxError) and error.lineno else ""
            )
            said = error.msg if isinstance(error, SyntaxError) else str(error)
            mine = f", which holds {cell.task}," if cell.task in tasks else ""
            problems.append(f"{cell.where}{mine} is no Python{line}: {said}")
    sources, binding = {}, _binding(statements)
    for task in tasks:
        found = [one for one in binding.get(task, ()) if not one.cell.given]
        marked = [one for one in found if one.cell.task == task]
        if not found:
            problems.append(f"{task} was not found: no cell defines a function of this name")
            continue
        if len({one.cell for one in found}) > 1:
            which = (
                "that of its own cell" if len({one.cell for one in marked}) == 1 else "the last one"
            )
            problems.append(f"{task} is defined in several cells; {which} counts")
        last = (marked or found)[-1]
        sources[task] = "\n\n".join(one.text for one in _needed(last, task, binding)) + "\n"
    return sources, problems


def _binding(statements: Sequence[Statement]) -> dict[str, list[Statement]]:
    """Return the statements that bind each name, in order; those that import every name bind "*"."""
    binding: dict[str, list[Statement]] = {}
    for one in statements:
        for name in one.binds:
            binding.setdefault(name, []).append(one)
    return binding


def _needed(
    task: Statement, name: str, binding: Mapping[str, Sequence[Statement]]
) -> list[Statement]:
    """Return a statement and all that it needs, each after what it needs to be run.

    A name that is bound several times counts with all of its bindings by plain statements, which
    build on each other, but of functions, classes and imports the last one alone.
    """
    every = [
        one
        for one in binding.get("*", ())
        if one.text.split(maxsplit=2)[1].split(".")[0] in STARRED
    ]
    givers: dict[str, Sequence[Statement]] = {name: [task]}
    chosen, wanted = {one.place: one for one in [task, *every]}, sorted(task.needs)
    while wanted:
        one = wanted.pop()
        if one not in givers:
            givers[one] = _givers(task.cell, binding.get(one, ()))
            fresh = [giver for giver in givers[one] if giver.place not in chosen]
            chosen |= {giver.place: giver for giver in fresh}
            wanted += sorted(
                {need for giver in fresh for need in giver.needs if need not in givers}
            )
    first = sorted(chosen.values(), key=lambda one: (not _is_import(one), one.place))
    return _ordered(first, givers)


def _givers(cell: Cell, near: Sequence[Statement]) -> Sequence[Statement]:
    """Return which of a name's bindings make what it stands for; those of the task's own cell come first."""
    whole = [one for one in near if _is_whole(one)]
    whole = [one for one in whole if one.cell is cell] or whole
    if not whole:
        return near
    if _is_import(whole[-1]):  # what is done to numpy is not part of a function
        return [whole[-1]]
    return [
        one
        for one in near
        if one is whole[-1] or (one.place > whole[-1].place and not _is_whole(one))
    ]


def _ordered(
    first: Sequence[Statement], givers: Mapping[str, Sequence[Statement]]
) -> list[Statement]:
    """Return statements in this order, but each after what it needs to be run: of a function its head alone.

    What runs at once, and a function that such a statement may call, needs all of its names: deep.
    """
    order: dict[int, Statement] = {}
    begun: set[tuple[int, bool]] = set()
    come: dict[tuple[str, bool], int] = {}  # how many of a name's givers are begun, deep and else
    for start in first:
        waiting = [(start, False)]
        running: list[tuple[Statement, Iterator[tuple[Statement, bool]]]] = []
        while waiting or running:
            if waiting:
                one, deep = waiting.pop()
                deep = deep or not one.text.startswith(("def ", "async def "))
                if (one.place, deep) not in begun:
                    begun.add((one.place, deep))
                    running.append((one, _before(one, deep, givers, come)))
                continue
            one, before = running[-1]
            waiting += [step] if (step := next(before, None)) else []
            if not waiting:
                running.pop()
                order.setdefault(one.place, one)
    return list(order.values())


def _before(
    one: Statement,
    deep: bool,
    givers: Mapping[str, Sequence[Statement]],
    come: dict[tuple[str, bool], int],
) -> Iterator[tuple[Statement, bool]]:
    """Yield what is to be run before a statement, and was not begun for the same name."""
    for name in sorted(one.needs if deep else one.head):
        each, key = givers.get(name, ()), (name, deep)
        while (n := come.get(key, 0)) < len(each):
            if name in one.binds and each[n].place >= one.place:
                break
            come[key] = n + 1
            yield each[n], deep


def _is_whole(one: Statement) -> bool:
    return _is_import(one) or one.text.startswith(("def ", "class ", "@", "async def "))


def _is_import(one: Statement) -> bool:
    return one.text.startswith(("import ", "from "))


def _statements(cell: Cell, first: int) -> list[Statement]:
    """Return the statements of a cell that bind names; calls, pictures and prints are left out."""
    text = re.sub(r"\r\n?", "\n", plain(cell.text))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of odd escapes, which are the student's own business
        body = ast.parse(text).body
    data = text.encode()  # whose bytes and lines the parser counts: a form feed ends no line
    starts = [0, *accumulate(len(line) + 1 for line in data.split(b"\n"))]
    found: list[Statement] = []
    for node in body:
        binds = frozenset(names.bound(node))
        changes = frozenset(name for one in _shallow(node) for name in _changed(one))
        if not binds | changes:
            continue
        start = min([node.lineno, *(one.lineno for one in getattr(node, "decorator_list", ()))])
        needs = frozenset(use.node.id for use in names.free(node))
        if hasattr(node, "body"):  # a loop's own variable is nothing from another cell
            needs -= binds
        head = frozenset(use.node.id for one in names.head(node) for use in names.free(one))
        begin = starts[start - 1] + (node.col_offset if start == node.lineno else 0)
        end = starts[(node.end_lineno or start) - 1] + (node.end_col_offset or 0)
        text, place = data[begin:end].decode(), first + len(found)
        found.append(Statement(place, text, binds | changes, needs | changes, head, cell))
    return found


def _shallow(node: ast.AST) -> Iterable[ast.AST]:
    """Yield a node and what is in it, without going into functions and classes."""
    waiting = [node]
    while waiting:
        one = waiting.pop()
        yield one
        if not isinstance(one, (*names.INNER, ast.Lambda)):
            waiting += ast.iter_child_nodes(one)


def _changed(node: ast.AST) -> Iterable[str]:
    """Return the names whose things a statement changes: table[0] = 0 and names.append(1) do."""
    targets: list[ast.expr] = []
    if isinstance(node, ast.Assign | ast.AugAssign):
        targets = node.targets if isinstance(node, ast.Assign) else [node.target]
    elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
        targets = [node.value.func] if isinstance(node.value.func, ast.Attribute) else []
    roots = []
    for one in targets:
        while isinstance(one, ast.Subscript | ast.Attribute):
            one = one.value
        roots += [one.id] if isinstance(one, ast.Name) else []
    return roots


def plain(text: str) -> str:
    r"""Return a cell without what only a notebook understands: magics, shell lines, questions.

    Examples
    --------
    >>> plain("%matplotlib inline\nx = 1")
    'pass\nx = 1'
    """
    text = textwrap.dedent(text)
    head = text.lstrip()
    if head.startswith("%%"):
        if not head.startswith(TIMED):
            return ""
        text = head.partition("\n")[2]
    lines = text.split("\n")
    if not any(map(_is_notebooks, lines)):
        return text
    try:
        ast.parse(text)
        return text  # such lines stand in a string
    except names.BROKEN:
        blank = [
            re.sub(r"[^ \t].*", "pass", one, count=1) if _is_notebooks(one) else one
            for one in lines
        ]
        return "\n".join(blank)


def _is_notebooks(line: str) -> bool:
    """Return whether a line is one that only a notebook understands."""
    return line.lstrip(" \t")[:1] in {"%", "!", "?"} or line.rstrip(" \t\r").endswith("?")
