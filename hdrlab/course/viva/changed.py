"""A function in another version: one token of it is another, or a line of it is left without use.

What is changed is the student's own text, so that its names, comments and lines stay. It is read
and never run here; what does not compile is no version.

source    text of a task with all that it needs, see `code.closure`
"""

import ast
import io
import re
import tokenize
import tomllib
from collections.abc import Iterator
from contextlib import suppress
from itertools import accumulate
from pathlib import Path
from typing import NamedTuple

from hdrlab.course.code import names

INSTEAD: dict[str, list[str]] = tomllib.loads(
    Path(__file__).with_name("tokens.toml").read_text("utf8")
)
LONGEST = 20_000  # characters of a source that is asked about
SHOWN = 80  # lines of a function that is shown
USES = 3  # of a name whose value is written out instead

# behind a source: fresh memory then holds other numbers, so what an answer has of it shows
FILLED = """
import numpy
numpy.empty = lambda shape, dtype=float, *_, **__: numpy.full(shape, 113, dtype)
numpy.empty_like = lambda array, dtype=None, *_, **__: numpy.full_like(array, 113, dtype)
"""


class Version(NamedTuple):
    """A changed source; its function with the change, the line of it, the change in words, the old line."""

    source: str
    function: str
    line: int = 0
    change: str = ""
    was: str = ""


def versions(source: str) -> list[Version]:
    r"""Return every version of a source with one token changed, in the order of the text.

    Examples
    --------
    >>> [one.change for one in versions("def twice(x):\n    return 2 * x  # not 3\n")]
    ['2 → 3', '2 → 1', '* → /', '* → +']
    """
    found = []
    for start, text in functions(source):
        for token in tokenize.generate_tokens(io.StringIO(text).readline):
            (row, column), (_, end) = token.start, token.end
            for new in instead(token) if row > 1 else ():
                lines = text.split("\n")
                was = lines[row - 1]
                lines[row - 1] = was[:column] + new + was[end:]
                changed = "\n".join(lines)
                with suppress(*names.BROKEN):
                    compile(changed, "", "exec", dont_inherit=True)
                    whole = source[:start] + changed + source[start + len(text) :]
                    found.append(Version(whole, changed, row, f"{token.string} → {new}", was))
    return found


def functions(source: str) -> Iterator[tuple[int, str]]:
    """Yield where each function of a source begins, and its text; none of what is too long to be shown."""
    if len(source) > LONGEST or "\f" in source:
        return
    starts = [0, *accumulate(len(line) + 1 for line in source.split("\n"))]
    for node in ast.parse(source).body:
        last = node.end_lineno or 0
        if isinstance(node, ast.FunctionDef) and last - node.lineno < SHOWN:
            yield (
                starts[node.lineno - 1],
                source[starts[node.lineno - 1] : starts[last]].rstrip("\n"),
            )


def parameters(source: str, task: str) -> list[str]:
    r"""Return the names of a task's parameters that a call gives by their place.

    Examples
    --------
    >>> parameters("def scale(x, by=2, *, offset=0):\n    return by * x + offset\n", "scale")
    ['x', 'by']
    """
    functions = {
        one.name: one.args for one in ast.parse(source).body if isinstance(one, ast.FunctionDef)
    }
    return [one.arg for one in functions[task].posonlyargs + functions[task].args]


def instead(token: tokenize.TokenInfo) -> list[str]:
    """Return what may stand in a token's place."""
    if token.type != tokenize.NUMBER:
        return INSTEAD.get(token.string, []) if token.type in (tokenize.OP, tokenize.NAME) else []
    value = ast.literal_eval(token.string)
    if isinstance(value, int):
        return [str(value + 1), *([str(value - 1)] if value else [])]
    return [repr(2 * value or 1.0), repr(value / 2)] if isinstance(value, float) else []


def unused(text: str) -> dict[int, str]:
    r"""Return, by the number of each line that names a value, the text in which nothing needs this line.

    The value is written out where the name stood. Whether that changes an answer is for a run to
    say.

    Examples
    --------
    >>> unused("def f(x):\n    y = x + 1\n    return 2 * y\n")
    {2: 'def f(x):\n    y = x + 1\n    return 2 * (x + 1)\n'}
    """
    found, lines = {}, text.split("\n")
    functions = [one for one in ast.parse(text).body if isinstance(one, ast.FunctionDef)]
    for function in functions if len(lines) <= SHOWN else ():
        parts = list(ast.walk(function))
        loads = [
            one for one in parts if isinstance(one, ast.Name) and isinstance(one.ctx, ast.Load)
        ]
        loads.sort(key=lambda one: (one.lineno, one.col_offset), reverse=True)
        for node in parts:
            match node:
                case ast.Assign([ast.Name(name)], value) if node.lineno == node.end_lineno:
                    uses = [one for one in loads if one.id == name and one.lineno > node.lineno]
                    if 0 < len(uses) <= USES and ";" not in lines[node.lineno - 1]:
                        found[node.lineno] = _written_out(
                            lines, uses, ast.get_source_segment(text, value)
                        )
    return dict(sorted(found.items()))


def _written_out(lines: list[str], uses: list[ast.Name], value: str | None) -> str:
    """Return a text in which a value stands where its name was used; the last use comes first."""
    written = [line.encode() for line in lines]
    for use in uses:
        row = written[use.lineno - 1]
        written[use.lineno - 1] = (
            row[: use.col_offset] + f"({value})".encode() + row[use.end_col_offset :]
        )
    return b"\n".join(written).decode()


def without(text: str, line: int) -> str:
    """Return a text without one of its lines; the others keep their numbers."""
    rows = enumerate(text.split("\n"), 1)
    return "\n".join(re.sub(r"\S.*", "pass", row) if n == line else row for n, row in rows)
