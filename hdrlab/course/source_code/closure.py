"""Extract a task's function with everything that it needs from a notebook's other cells.

Names are followed through the statements at the top level of the cells: imports, helpers, classes
and constants. So a student may rename, split or move cells. For the cells that the handout gives,
hdrlab uses its own copy.
"""

import ast
import re
import textwrap
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import accumulate
from typing import NamedTuple

from hdrlab.course.source_code import names

# packages from which every name may be imported by `*`
STAR_IMPORT_PACKAGES = (
    "numpy",
    "scipy",
    "math",
    "cmath",
    "random",
    "itertools",
    "functools",
    "typing",
)
# cell magics above plain Python
PYTHON_CELL_MAGICS = ("%%time", "%%timeit", "%%capture", "%%prun", "%%script python")
FUNCTION_STARTS = ("def ", "async def ")
# the start of a statement that binds its name completely
WHOLE_STARTS = ("def ", "class ", "@", "async def ")


class Cell(NamedTuple):
    """A code cell.

    Attributes
    ----------
    text : the code
    task : the task that the cell was handed out for, "" if for none
    given : whether the handout gives the code
    where : the cell's place, for messages
    """

    text: str
    task: str = ""
    given: bool = False
    where: str = ""


@dataclass(frozen=True, eq=False)
class Statement:
    """A statement at the top level of a cell.

    Attributes
    ----------
    place : its index among the statements of all cells
    text : the code
    binds : the names that it binds or changes
    needs : the names that it needs
    head : of a function, the names needed when it is defined: in decorators, defaults, annotations
    cell : the cell that it is in
    """

    place: int
    text: str
    binds: frozenset[str]
    needs: frozenset[str]
    head: frozenset[str]
    cell: Cell

    @property
    def is_import(self) -> bool:
        """Whether the statement is an import."""
        return self.text.startswith(("import ", "from "))

    @property
    def is_whole(self) -> bool:
        """Whether the statement binds its name completely: an import, a function or a class."""
        return self.is_import or self.text.startswith(WHOLE_STARTS)


def extract_sources(
    cells: Sequence[Cell], tasks: Sequence[str], given: Sequence[Cell] = ()
) -> tuple[dict[str, str], list[str]]:
    """Return the source text of each task's function with what it needs, and a list of problems.

    Parameters
    ----------
    cells : the cells of the submission
    tasks : ids of the tasks, which are the names of their functions
    given : hdrlab's copy of the cells that the handout gives; they replace the submission's
    """
    problems: list[str] = []
    statements: list[Statement] = []
    own = [cell for cell in cells if not (cell.given and given)]
    for cell in [*given, *own]:
        try:
            statements += _statements(cell, len(statements))
        except names.PARSE_ERRORS as error:
            problems.append(_describe_broken(cell, tasks, error))
    binding = _statements_by_name(statements)
    sources = {}
    for task in tasks:
        definitions = [statement for statement in binding.get(task, ()) if not statement.cell.given]
        if not definitions:
            problems.append(f"{task} was not found: no cell defines a function of this name")
            continue
        marked = [statement for statement in definitions if statement.cell.task == task]
        if len({statement.cell for statement in definitions}) > 1:
            has_one_marked_cell = len({statement.cell for statement in marked}) == 1
            which = "that of its own cell" if has_one_marked_cell else "the last one"
            problems.append(f"{task} is defined in several cells; {which} counts")
        last = (marked or definitions)[-1]
        needed = _needed(last, task, binding)
        sources[task] = "\n\n".join(statement.text for statement in needed) + "\n"
    return sources, problems


def _describe_broken(cell: Cell, tasks: Sequence[str], error: BaseException) -> str:
    """Return the message for a cell that cannot be parsed."""
    mine = f", which holds {cell.task}," if cell.task in tasks else ""
    line = ""
    reason = str(error)
    if isinstance(error, SyntaxError):
        line = f", line {error.lineno}" if error.lineno else ""
        reason = error.msg
    return f"{cell.where}{mine} is no Python{line}: {reason}"


def _statements_by_name(statements: Sequence[Statement]) -> dict[str, list[Statement]]:
    """Return the statements that bind each name, in order; star imports bind "*"."""
    binding: dict[str, list[Statement]] = {}
    for statement in statements:
        for name in statement.binds:
            binding.setdefault(name, []).append(statement)
    return binding


def _needed(
    task: Statement, name: str, binding: Mapping[str, Sequence[Statement]]
) -> list[Statement]:
    """Return a statement and everything that it needs, each after what it needs to run.

    If plain statements bind a name several times, all of them are kept, because they build on each
    other. Of functions, classes and imports only the last one is kept.
    """
    star_imports = [
        statement for statement in binding.get("*", ()) if _is_allowed_star_import(statement)
    ]
    providers: dict[str, Sequence[Statement]] = {name: [task]}
    chosen = {statement.place: statement for statement in [task, *star_imports]}
    wanted = sorted(task.needs)
    while wanted:
        needed_name = wanted.pop()
        if needed_name in providers:
            continue
        providers[needed_name] = _providers(task.cell, binding.get(needed_name, ()))
        new = [statement for statement in providers[needed_name] if statement.place not in chosen]
        needs: set[str] = set()
        for statement in new:
            chosen[statement.place] = statement
            needs |= statement.needs
        wanted += sorted(needs - providers.keys())
    imports_first = sorted(
        chosen.values(), key=lambda statement: (not statement.is_import, statement.place)
    )
    return _ordered(imports_first, providers)


def _is_allowed_star_import(statement: Statement) -> bool:
    package = statement.text.split(maxsplit=2)[1].split(".")[0]
    return package in STAR_IMPORT_PACKAGES


def _providers(cell: Cell, bindings: Sequence[Statement]) -> Sequence[Statement]:
    """Return which bindings of a name make up its value; those in the task's own cell come first."""
    whole = [statement for statement in bindings if statement.is_whole]
    whole = [statement for statement in whole if statement.cell is cell] or whole
    if not whole:
        return bindings
    last = whole[-1]
    if last.is_import:  # changes of an imported module are not part of a function
        return [last]
    return [
        statement
        for statement in bindings
        if statement is last or (statement.place > last.place and not statement.is_whole)
    ]


def _ordered(
    first: Sequence[Statement], providers: Mapping[str, Sequence[Statement]]
) -> list[Statement]:
    """Return statements in this order, but each after what it needs to run.

    A function needs only the names in its head. A statement that runs immediately needs all of its
    names, and so do the functions that it may call: `deep`.
    """
    order: dict[int, Statement] = {}
    begun: set[tuple[int, bool]] = set()
    # how many of a name's providers are begun, by (name, deep)
    counts: dict[tuple[str, bool], int] = {}
    for start in first:
        waiting = [(start, False)]
        running: list[tuple[Statement, Iterator[tuple[Statement, bool]]]] = []
        while waiting or running:
            if waiting:
                statement, deep = waiting.pop()
                deep = deep or not statement.text.startswith(FUNCTION_STARTS)
                if (statement.place, deep) not in begun:
                    begun.add((statement.place, deep))
                    running.append((statement, _before(statement, deep, providers, counts)))
                continue
            statement, before = running[-1]
            step = next(before, None)
            if step is not None:
                waiting.append(step)
            else:
                running.pop()
                order.setdefault(statement.place, statement)
    return list(order.values())


def _before(
    statement: Statement,
    deep: bool,
    providers: Mapping[str, Sequence[Statement]],
    counts: dict[tuple[str, bool], int],
) -> Iterator[tuple[Statement, bool]]:
    """Yield what must run before a statement, and was not begun for the same name."""
    for name in sorted(statement.needs if deep else statement.head):
        sequence = providers.get(name, ())
        key = (name, deep)
        while counts.get(key, 0) < len(sequence):
            n = counts.get(key, 0)
            if name in statement.binds and sequence[n].place >= statement.place:
                break
            counts[key] = n + 1
            yield sequence[n], deep


def _statements(cell: Cell, first: int) -> list[Statement]:
    """Return the statements of a cell that bind names; calls, plots and prints are left out."""
    text = re.sub(r"\r\n?", "\n", plain(cell.text))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # invalid escapes are the student's own business
        body = ast.parse(text).body
    data = text.encode()  # the parser counts bytes, and a form feed ends no line
    line_starts = [0, *accumulate(len(line) + 1 for line in data.split(b"\n"))]
    statements: list[Statement] = []
    for node in body:
        binds = frozenset(names.bound_names(node))
        changes = frozenset(name for part in _shallow(node) for name in _changed_names(part))
        if not binds and not changes:
            continue
        needs = frozenset(use.node.id for use in names.free_names(node))
        if hasattr(node, "body"):  # a loop's own variable comes from no other cell
            needs -= binds
        head = frozenset(use.node.id for part in names.head(node) for use in names.free_names(part))
        decorators = getattr(node, "decorator_list", ())
        first_line = min([node.lineno, *(decorator.lineno for decorator in decorators)])
        begin = line_starts[first_line - 1]
        if first_line == node.lineno:
            begin += node.col_offset
        end = line_starts[(node.end_lineno or first_line) - 1] + (node.end_col_offset or 0)
        statement = Statement(
            place=first + len(statements),
            text=data[begin:end].decode(),
            binds=binds | changes,
            needs=needs | changes,
            head=head,
            cell=cell,
        )
        statements.append(statement)
    return statements


def _shallow(node: ast.AST) -> Iterable[ast.AST]:
    """Yield a node and what is in it, without the contents of functions and classes."""
    waiting = [node]
    while waiting:
        part = waiting.pop()
        yield part
        if not isinstance(part, (*names.DEFINITIONS, ast.Lambda)):
            waiting += ast.iter_child_nodes(part)


def _changed_names(node: ast.AST) -> Iterable[str]:
    """Return the names whose objects a statement changes, as table[0] = 0 and names.append(1) do."""
    targets: list[ast.expr] = []
    if isinstance(node, ast.Assign):
        targets = node.targets
    elif isinstance(node, ast.AugAssign):
        targets = [node.target]
    elif isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
        targets = [node.value.func] if isinstance(node.value.func, ast.Attribute) else []
    roots = []
    for target in targets:
        while isinstance(target, ast.Subscript | ast.Attribute):
            target = target.value
        if isinstance(target, ast.Name):
            roots.append(target.id)
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
        if not head.startswith(PYTHON_CELL_MAGICS):
            return ""
        text = head.partition("\n")[2]
    lines = text.split("\n")
    if not any(map(_is_notebook_syntax, lines)):
        return text
    try:
        ast.parse(text)
        return text  # the lines are in a string
    except names.PARSE_ERRORS:
        kept = [
            re.sub(r"[^ \t].*", "pass", line, count=1) if _is_notebook_syntax(line) else line
            for line in lines
        ]
        return "\n".join(kept)


def _is_notebook_syntax(line: str) -> bool:
    """Return whether only a notebook understands a line."""
    return line.lstrip(" \t")[:1] in {"%", "!", "?"} or line.rstrip(" \t\r").endswith("?")
